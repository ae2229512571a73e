// A homogeneous segment of a density that emits, for tests.

#use integrate/light.wgsl

const MODEL_EMITS: bool = true;
const MODEL_ABSORBS: bool = true;
const MODEL_COLOR_IS_PER_LENGTH: bool = false;

fn model_constant(extinction: f32, color: vec3<f32>, length: f32) -> Light {
    let transmittance = exp(-extinction * length);
    return Light(color * (1.0 - transmittance), transmittance);
}
