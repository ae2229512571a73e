// Light in front of light.

#use integrate/light.wgsl

fn over(front: Light, behind: Light) -> Light {
    return Light(front.rgb + front.transmittance * behind.rgb, front.transmittance * behind.transmittance);
}
