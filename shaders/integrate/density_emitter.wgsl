// The optical model dI/dt = extinction (color - I), along a segment.
#use integrate/light.wgsl
#use integrate/weights.wgsl

const MODEL_EMITS: bool = true;
const MODEL_ABSORBS: bool = true;
const MODEL_COLOR_IS_PER_LENGTH: bool = false;

// What the colors at the front and at the back count where extinction and color are linear; extinction at both ends.
fn model_linear(extinction: vec2<f32>, length: f32) -> Weights {
    return density_emitter_weights(extinction * length);
}

// The same everywhere on the segment.
fn model_constant(extinction: f32, color: vec3<f32>, length: f32) -> Light {
    let whole = opacity_transmittance(extinction * length);
    return Light(color * whole.x, whole.x);
}
