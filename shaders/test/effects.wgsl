// For tests: one invocation a ray, which shades its segments one after the other; and one a range of scalars, which asks for surfaces.
//
// segments, rays: in; rays have the first of their segments and how many. lights: rgb and opacity of each ray. counts: crossings of
// each ray, or 1 where a surface may show.

#use cell/cell.wgsl
#use integrate/light.wgsl
#use include/list.wgsl
#use effects/over.wgsl
#use <effects>
#use <surface_visibility>

struct TestSegment {
    vertices: vec4<u32>,
    scalars: vec2<f32>,
    depth: vec2<f32>,
    center: vec2<f32>,
    length: f32,
    reference: i32,
}

@group(0) @binding(70) var<storage, read> segments: array<TestSegment>;
@group(0) @binding(71) var<storage, read> rays: array<vec2<u32>>;
@group(0) @binding(72) var<storage, read_write> lights: array<vec4<f32>>;
@group(0) @binding(73) var<storage, read_write> counts: array<u32>;
@group(0) @binding(74) var<storage, read> scalar_ranges: array<vec2<i32>>;

@compute @workgroup_size(64)
fn shade_rays(
    @builtin(local_invocation_index) index: u32,
    @builtin(workgroup_id) workgroup_id: vec3<u32>,
    @builtin(num_workgroups) num_workgroups: vec3<u32>,
) {
    let number = group_number(workgroup_id, num_workgroups) * 64u + index;
    if number >= arrayLength(&rays) {
        return;
    }
    var joint = no_joint();
    var crossings = 0u;
    var light = Light(vec3<f32>(0.0), 0.0);
    let ray = rays[number];
    for (var place = ray.x; place < ray.x + ray.y; place++) {
        let segment = segments[place];
        var cell: Cell;
        cell.reference = segment.reference;
        var sample: Sample;
        sample.front = segment.scalars.x;
        sample.back = segment.scalars.y;
        sample.length = segment.length;
        sample.depth = segment.depth;
        sample.center = segment.center;
        sample.covered = true;
        var optics: Optics;
        optics.reference = segment.reference;
        light = over(light, shade(cell, segment.vertices, optics, sample, &joint, &crossings));
    }
    lights[number] = vec4<f32>(light.rgb, light.opacity);
    counts[number] = crossings;
}

@compute @workgroup_size(64)
fn ask(
    @builtin(local_invocation_index) index: u32,
    @builtin(workgroup_id) workgroup_id: vec3<u32>,
    @builtin(num_workgroups) num_workgroups: vec3<u32>,
) {
    let number = group_number(workgroup_id, num_workgroups) * 64u + index;
    if number >= arrayLength(&scalar_ranges) {
        return;
    }
    let range = scalar_ranges[number];
    counts[number] = select(0u, 1u, surfaces_may_show(range.x, range.y));
}
