// Light of a segment that isosurfaces may cut: cut where its scalar crosses them, the volume integrated in front of, between and behind
// the surfaces, and all composed along the ray. Nothing is extracted.
//
// Which surfaces are crossed follows from ranks: on which side of each surface the two ends lie. With CARRIES_JOINTS the rank at the
// entry is handed on from the cell before. Without, as where cells are drawn as triangles one by one, ends within rounding of a surface
// ask the faces, which are common to two cells. Either way each surface is met exactly once.

#use cell/cell.wgsl
#use integrate/light.wgsl
#use effects/carry.wgsl
#use effects/cell_corners.wgsl
#use effects/face_ranks.wgsl
#use effects/over.wgsl
#use effects/surface_set.wgsl
#use <volume>
#use <volume_light>
#use <surface_light>

// Scalars that differ by less are one: their difference has no inverse.
const LEAST_WIDTH: f32 = 1e-30;

// The value of a surface as a cell sees it: from its reference scalar.
fn local_value(index: u32, reference: i32) -> f32 {
    return f32(surfaces[index].value - reference) * LATTICE_STEP;
}

// Number of the cell's surfaces that are not above two scalars.
fn surface_ranks(near: vec2<u32>, reference: i32, tolerance: f32, scalars: vec2<f32>) -> vec2<u32> {
    var ranks = vec2<u32>(0u);
    for (var index = near.x; index < near.x + near.y; index++) {
        let value = local_value(index, reference) - tolerance;
        ranks += select(vec2<u32>(0u), vec2<u32>(1u), scalars >= vec2<f32>(value));
    }
    return ranks;
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
    let intensity = volume_intensity(corners, vertices, sample);
    let near = surfaces_near(scalars.x, scalars.y);
    if near.y == 0u {
        // Nothing is crossed here, and no scalar in reach of rounding to a surface is handed on.
        let light = volume(optics, sample.front, sample.back, sample.length);
        return Light(light.rgb * intensity, light.opacity);
    }

    let tolerance = surface_tolerance(scalars.x, scalars.y);
    let low = min(sample.front, sample.back);
    let high = max(sample.front, sample.back);
    var ranks: vec2<u32>;
    if CARRIES_JOINTS {
        let own = surface_ranks(near, cell.reference, tolerance, vec2<f32>(sample.front, sample.back));
        let all = vec2<f32>(own + near.x);
        let front = carry_joint(joint, sample.depth, joint_slack(corners), all) - f32(near.x);
        ranks = vec2<u32>(u32(clamp(front, 0.0, f32(near.y))), own.y);
    } else {
        let ends = vec2<f32>(sample.front, sample.back);
        ranks = surface_ranks(near, cell.reference, tolerance, ends);
        // Sides change a tolerance below the values: clear of that is what lies half a tolerance beyond there and beyond the values.
        let least = surface_ranks(near, cell.reference, tolerance, ends - 1.5 * tolerance);
        let most = surface_ranks(near, cell.reference, tolerance, ends + 0.5 * tolerance);
        if any(least != most) {
            let pixel = vec2<i32>(round(sample.center + 0.5 * vec2<f32>(frame.size) - 0.5));
            let of_faces = face_ranks(corners, near, pixel);
            let is_own = least == most;
            ranks.x = select(of_faces.enter, ranks.x, is_own.x || !of_faces.enters);
            ranks.y = select(of_faces.leave, ranks.y, is_own.y);
            ranks.y = select(ranks.x, ranks.y, of_faces.meets);
        }
    }

    let rises = ranks.x < ranks.y;
    let crossed = max(ranks.x, ranks.y) - min(ranks.x, ranks.y);
    let across = sample.back - sample.front;
    let is_flat = high - low < LEAST_WIDTH;
    let inverse = select(1.0 / select(across, 1.0, is_flat), 0.0, is_flat);
    var light = Light(vec3<f32>(0.0), 0.0);
    // The scalar up to where the segment is composed.
    var reached = sample.front;
    // Behind an opaque surface nothing is seen. No return within the loop: drivers are known to end the loops around it as well.
    for (var step = 0u; step < crossed && light.opacity < 1.0; step++) {
        let index = near.x + select(ranks.x - 1u - step, ranks.x + step, rises);
        let surface = surfaces[index];
        let value = local_value(index, cell.reference);
        // Between the surface before and the back, also where ranks and scalars do not agree on which way is up.
        let next = clamp(value, min(reached, sample.back), max(reached, sample.back));
        let share = (next - reached) * inverse;
        if share > 0.0 {
            let part = volume(optics, reached, next, sample.length * share);
            light = over(light, Light(part.rgb * intensity, part.opacity));
        }
        reached = next;

        *crossings += 1u;
        let along = clamp((value - sample.front) * inverse, 0.0, 1.0);
        let depth = sample.depth.x + (sample.depth.y - sample.depth.x) * along;
        let rgb = surface.opacity * select(surface.color, surface.back_color, rises);
        let lit = surface_light(rgb, surface.opacity, surface.shading, corners, vertices, sample, depth);
        light = over(light, Light(lit, surface.opacity));
    }
    let rest = select((sample.back - reached) * inverse, 1.0, is_flat);
    if rest > 0.0 && light.opacity < 1.0 {
        let part = volume(optics, reached, sample.back, sample.length * rest);
        light = over(light, Light(part.rgb * intensity, part.opacity));
    }
    return light;
}
