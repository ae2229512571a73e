// Shows the picture over a background: one invocation of `resolve` gives one pixel, linear; the target turns it into 8-bit sRGB.
//
// In: frame (extent), picture (rgb and packed opacity), background (linear rgb; the last is unused). The target has the size of the part drawn.

#use include/frame.wgsl
#use include/opacity.wgsl

@group(0) @binding(13) var<storage, read> picture: array<vec4<f32>>;
@group(0) @binding(43) var<uniform> background: vec4<f32>;

// One triangle over the whole target.
@vertex
fn cover(@builtin(vertex_index) number: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(vec2<u32>(number & 1u, number >> 1u)) * 4.0 - 1.0;
    return vec4<f32>(corner, 0.0, 1.0);
}

@fragment
fn resolve(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<u32>(position.xy);
    let light = picture[pixel.y * frame.extent.x + pixel.x];
    return vec4<f32>(light.rgb + through(light.a) * background.rgb, 1.0);
}
