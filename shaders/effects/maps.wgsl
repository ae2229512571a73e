// Light of a segment with isosurfaces that are looked up in maps over the scalars at both ends.
//
// MAP_PASSES says how a surface gets into a cell: MAP_BEHIND: one map, behind a volume whose integral stops at the surface;
// MAP_BOTH_BEHIND: one for the front faces and one for the back faces, behind such a volume; MAP_AROUND: the same with the whole cell's
// volume between them. Texels are handed on along the ray with CARRIES_JOINTS; without, those of both ends are taken a little apart, so
// that none is missed where two cells round a scalar to different texels.
//
// maps: an entry is premultiplied color and opacity; texel (front, back) is entry front * texels + back, the second map behind the first.

#use cell/cell.wgsl
#use integrate/light.wgsl
#use effects/carry.wgsl
#use effects/cell_corners.wgsl
#use effects/over.wgsl
#use effects/surface_set.wgsl
#use <volume>
#use <volume_light>
#use <surface_light>

struct MapAxis {
    // Scalar of the coordinate 0, lattice steps.
    start: i32,
    // Texels a side; 2 or more.
    texels: u32,
    // Texels per unit of scalars.
    per_scalar: f32,
    // How light falls on the surfaces, on all alike.
    shading: u32,
}

struct Maps {
    axis: MapAxis,
    entries: array<vec4<f32>>,
}

@group(0) @binding(15) var<storage, read> maps: Maps;

// The texels of two scalars that count from a reference.
fn texels_of(reference: i32, scalars: vec2<f32>) -> vec2<f32> {
    let axis = maps.axis;
    let at_reference = f32(reference - axis.start) * LATTICE_STEP * axis.per_scalar;
    return floor(clamp(scalars * axis.per_scalar + at_reference, vec2<f32>(0.0), vec2<f32>(f32(axis.texels - 1u))));
}

// Whether rays may cross surfaces in a cell: whether the map has any between its lowest and its highest scalar. So the list of surfaces
// needs no binding, of which there are few.
fn maps_may_show(low: i32, high: i32) -> bool {
    let margin = surface_margin(low, high);
    let size = maps.axis.texels;
    let entry = u32(texels_of(low - margin, vec2<f32>(0.0)).x) * size + u32(texels_of(high + margin, vec2<f32>(0.0)).x);
    var opacity = maps.entries[entry].a;
    if MAP_PASSES != MAP_BEHIND {
        opacity += maps.entries[size * size + entry].a;
    }
    return opacity > 0.0;
}

fn map_light(entry: vec4<f32>, corners: array<vec4<i32>, 4>, vertices: vec4<u32>, sample: Sample, depth: f32) -> Light {
    return Light(surface_light(entry.rgb, entry.a, maps.axis.shading, corners, vertices, sample, depth), entry.a);
}

fn shade(
    cell: Cell,
    vertices: vec4<u32>,
    optics: Optics,
    sample: Sample,
    joint: ptr<function, Joint>,
    crossings: ptr<function, u32>,
) -> Light {
    let corners = cell_corners(vertices);
    let scalars = corner_scalars(corners);
    let part = volume(optics, sample.front, sample.back, sample.length);
    let inside = Light(part.rgb * volume_intensity(corners, vertices, sample), part.opacity);
    if !maps_may_show(scalars.x, scalars.y) {
        return inside;
    }

    var texels: vec2<f32>;
    if CARRIES_JOINTS {
        texels = texels_of(cell.reference, vec2<f32>(sample.front, sample.back));
        texels.x = carry_joint(joint, sample.depth, joint_slack(corners), texels);
    } else {
        let half = 0.5 * surface_tolerance(scalars.x, scalars.y);
        let apart = select(vec2<f32>(half, -half), vec2<f32>(-half, half), sample.front <= sample.back);
        texels = texels_of(cell.reference, vec2<f32>(sample.front, sample.back) + apart);
    }
    let size = maps.axis.texels;
    let entry = u32(texels.x) * size + u32(texels.y);
    let near = maps.entries[entry];
    var far = vec4<f32>(0.0);
    if MAP_PASSES != MAP_BEHIND {
        far = maps.entries[size * size + entry];
    }
    // In most cells there is no surface: then nothing is to be lit.
    if near.a + far.a <= 0.0 {
        return inside;
    }
    *crossings += 1u;
    let near_light = map_light(near, corners, vertices, sample, sample.depth.x);
    if MAP_PASSES == MAP_BEHIND {
        return over(inside, near_light);
    }
    let far_light = map_light(far, corners, vertices, sample, sample.depth.y);
    if MAP_PASSES == MAP_BOTH_BEHIND {
        return over(inside, over(near_light, far_light));
    }
    return over(near_light, over(inside, far_light));
}
