// Light as the blending takes it.

#use integrate/light.wgsl

// Color and opacity; a float of 16 bits ends at MOST_LIGHT.
fn assembled(light: Light) -> vec4<f32> {
    return vec4<f32>(min(light.rgb, vec3<f32>(MOST_LIGHT)), light.opacity);
}
