// The optical model dI/dt = -extinction I, along a segment.
#use integrate/light.wgsl
#use integrate/weights.wgsl

const MODEL_EMITS: bool = false;
const MODEL_ABSORBS: bool = true;
const MODEL_COLOR_IS_PER_LENGTH: bool = false;

// Colors do not count; extinction at both ends.
fn model_linear(extinction: vec2<f32>, length: f32) -> Weights {
    return Weights(0.0, 0.0, opacity_transmittance(0.5 * (extinction.x + extinction.y) * length).x);
}

// The same everywhere on the segment. No light and not the color: with isosurfaces, light is added in every model.
fn model_constant(extinction: f32, color: vec3<f32>, length: f32) -> Light {
    return Light(vec3<f32>(0.0), opacity_transmittance(extinction * length).x);
}
