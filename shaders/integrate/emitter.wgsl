// The optical model dI/dt = color - extinction I, along a segment.
#use integrate/light.wgsl
#use integrate/weights.wgsl

const MODEL_EMITS: bool = true;
const MODEL_ABSORBS: bool = true;
const MODEL_COLOR_IS_PER_LENGTH: bool = true;

// What the colors at the front and at the back count where extinction and color are linear; extinction at both ends.
fn model_linear(extinction: vec2<f32>, length: f32) -> Weights {
    let weights = emitter_weights(extinction * length);
    return Weights(weights.front * length, weights.back * length, weights.opacity);
}

// The same everywhere on the segment.
fn model_constant(extinction: f32, color: vec3<f32>, length: f32) -> Light {
    let depth = extinction * length;
    let whole = opacity_transmittance(depth);
    // Where the depth is next to nothing the quotient is 1.
    let has_depth = depth > 1e-20;
    let weight = select(1.0, whole.x / select(1.0, depth, has_depth), has_depth);
    return Light(color * (weight * length), whole.x);
}
