// Phong's model: how much of its color a surface sends to the eye, and the highlight on top of it. The normal is the gradient's direction or
// the opposite one, whichever faces the eye.

#use include/frame.wgsl
#use effects/axes.wgsl
#use effects/power.wgsl

struct Lamp {
    // From the surface towards the light, along the mesh's axes, of length 1.
    direction: vec3<f32>,
    // 1 if the light is at the eye instead.
    is_at_eye: u32,
    ambient: f32,
    diffuse: f32,
    specular: f32,
    shininess: f32,
}

@group(0) @binding(17) var<uniform> lamp: Lamp;

// A gradient whose largest component is below that has no direction: it may have been rounded to 0 on its way.
const LEAST_GRADIENT: f32 = 1e-36;

// What a color is multiplied by, and what is added to each channel.
//
// - gradient: along the camera's axes, of any length; zero gives `ambient` alone
// - center: of the pixel, from the middle of the picture
fn lamp_intensities(gradient: vec3<f32>, center: vec2<f32>) -> vec2<f32> {
    let ray = vec3<f32>(center * frame.slope.xy, 1.0);
    let to_eye = -ray / sqrt(dot(ray, ray));
    var to_light = to_eye;
    if lamp.is_at_eye == 0u {
        to_light = along_camera(lamp.direction);
    }

    // The largest component becomes 1, so that no square over- or underflows.
    let sizes = abs(gradient);
    let largest = max(sizes.x, max(sizes.y, sizes.z));
    if largest < LEAST_GRADIENT {
        return vec2<f32>(lamp.ambient, 0.0);
    }
    let scaled = gradient / largest;
    let normal = scaled / sqrt(dot(scaled, scaled));
    let to_eye_cosine = dot(normal, to_eye);
    let to_light_cosine = dot(normal, to_light);
    let facing = select(to_light_cosine, -to_light_cosine, to_eye_cosine < 0.0);
    if facing <= 0.0 {
        return vec2<f32>(lamp.ambient, 0.0);
    }
    let mirrored = clamp(2.0 * facing * abs(to_eye_cosine) - dot(to_light, to_eye), 0.0, 1.0);
    return vec2<f32>(lamp.ambient + lamp.diffuse * facing, lamp.specular * power(mirrored, lamp.shininess));
}
