// Puts a target that was blended into over the picture: one invocation one pixel.
//
// In: frame (extent), blended (rgb and opacity, of what lies before the picture so far). In and out: picture (rgb and packed opacity).
//
// A target of 16-bit floats is put over the picture after every draw block, so that its rounding adds up over few layers.

#use include/frame.wgsl
#use include/opacity.wgsl

@group(0) @binding(13) var<storage, read_write> picture: array<vec4<f32>>;
@group(0) @binding(42) var blended: texture_2d<f32>;

@compute @workgroup_size(TILE_SIDE, TILE_SIDE)
fn accumulate(@builtin(global_invocation_id) pixel: vec3<u32>) {
    if any(pixel.xy >= frame.extent) {
        return;
    }
    let place = pixel.y * frame.extent.x + pixel.x;
    let before = textureLoad(blended, pixel.xy, 0);
    let behind = picture[place];
    picture[place] = vec4<f32>(before.rgb + (1.0 - before.a) * behind.rgb, with_opacity(behind.a, before.a));
}

// Empties the picture.
@compute @workgroup_size(TILE_SIDE, TILE_SIDE)
fn empty(@builtin(global_invocation_id) pixel: vec3<u32>) {
    if all(pixel.xy < frame.extent) {
        picture[pixel.y * frame.extent.x + pixel.x] = vec4<f32>();
    }
}
