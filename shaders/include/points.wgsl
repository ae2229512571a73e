// The points as the frame sees them: along the camera's axes right, down and forward, from the base, and the scalar; lattice steps.

@group(0) @binding(2) var<storage, read> points: array<vec4<i32>>;
