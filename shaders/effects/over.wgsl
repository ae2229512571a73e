// Light in front of light.

#use integrate/light.wgsl

fn over(front: Light, behind: Light) -> Light {
    let through = 1.0 - front.opacity;
    return Light(front.rgb + through * behind.rgb, front.opacity + through * behind.opacity);
}
