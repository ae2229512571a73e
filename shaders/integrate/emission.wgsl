// The optical model dI/dt = color, along a segment.
#use integrate/light.wgsl
#use integrate/weights.wgsl

const MODEL_EMITS: bool = true;
const MODEL_ABSORBS: bool = false;
const MODEL_COLOR_IS_PER_LENGTH: bool = true;

// What the colors at the front and at the back count where they are linear.
fn model_linear(extinction: vec2<f32>, length: f32) -> Weights {
    return Weights(0.5 * length, 0.5 * length, 0.0);
}

// The same everywhere on the segment.
fn model_constant(extinction: f32, color: vec3<f32>, length: f32) -> Light {
    return Light(color * length, 0.0);
}
