// From the mesh's axes to the camera's.

#use include/frame.wgsl

// - direction: along the mesh's axes. Gives right, down, forward.
fn along_camera(direction: vec3<f32>) -> vec3<f32> {
    let scaled = direction * AXIS_STEP;
    return vec3<f32>(
        dot(vec3<f32>(frame.right.xyz), scaled),
        dot(vec3<f32>(frame.down.xyz), scaled),
        dot(vec3<f32>(frame.forward.xyz), scaled),
    );
}
