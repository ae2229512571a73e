// Set-up: a cell becomes four planes about a reference inside of it, or its corners where f32 cannot hold the planes.
#use cell/cell.wgsl
#use cell/outline.wgsl
#use cell/ray.wgsl

// A face counts as steep when its plane, over the cell's pixels, runs through this many times the cell's own range of nearness: rounding
// then takes some 2e-6 of the cell's chord, and the cell goes by its corners instead.
const STEEP: f32 = 24.0;
// A cell whose nearest point is closer than this share of its farthest goes by its corners: it reaches the plane of the eye, or nearly.
const NEAR: f32 = 1e-2;

struct Planes {
    faces: array<vec4<i32>, 4>,
    // Entry faces; 0 if one of the faces is too steep.
    entry_count: u32,
}

fn set_up(vertices: vec4<u32>) -> Cell {
    return set_up_within(vertices, whole_part());
}

// The same for a box of pixels, first column and row, last column and row: the reference is in the middle of what the cell covers there, so that however
// large the cell is on the screen, no plane is followed farther than the box reaches.
fn set_up_within(vertices: vec4<u32>, box: vec4<i32>) -> Cell {
    let corner = bare(vertices);
    let a = points[corner.x];
    let b = points[corner.y];
    let c = points[corner.z];
    let d = points[corner.w];
    let low = min(min(a.w, b.w), min(c.w, d.w));
    let high = max(max(a.w, b.w), max(c.w, d.w));

    // By corners, unless all that follows goes well.
    var cell: Cell;
    cell.faces = array<vec4<i32>, 4>(a, b, c, d);
    let outline = find_outline(vertices);
    cell.outline = vec4<i32>(max(outline.xy, box.xy), min(outline.zw, box.zw));
    cell.pixel = (cell.outline.xy + cell.outline.zw) / 2;
    cell.reference = a.w;
    cell.scalars = vec2<f32>(f32(low - a.w), f32(high - a.w)) * LATTICE_STEP;
    cell.entry_count = 0u;

    // Edges from the first corner, and outward normals.
    let ab = vec3<f32>(b.xyz - a.xyz) * LATTICE_STEP;
    let ac = vec3<f32>(c.xyz - a.xyz) * LATTICE_STEP;
    let ad = vec3<f32>(d.xyz - a.xyz) * LATTICE_STEP;
    let outward = select(1.0, -1.0, (vertices.w & NEGATIVE_BIT) != 0u);
    let n1 = -outward * cross(ac, ad);
    let n2 = outward * cross(ab, ad);
    let n3 = -outward * cross(ab, ac);
    let n0 = outward * cross(ac - ab, ad - ab);

    // The reference: on the ray of the middle pixel, at the corners' mean depth.
    let middle = 0.25 * (ab.z + ac.z + ad.z);
    let is_perspective = frame.is_perspective != 0u;
    let center = pixel_center(cell.pixel);
    let direction = vec3<f32>(center * frame.slope.xy, 1.0);
    let from_a = vec3<f32>(direction.xy * middle - beside_in_units(ray_of(cell.pixel), a.xyz), middle);
    cell.depth = f32(a.z) * LATTICE_STEP + middle - start_from_base();
    let depth = f32(a.z) * LATTICE_STEP + middle - frame.eye.z;
    cell.length = select(1.0, depth, is_perspective);

    // Depths of the corners from the reference's.
    let nearest = min(min(0.0, ab.z), min(ac.z, ad.z)) - middle;
    let farthest = max(max(0.0, ab.z), max(ac.z, ad.z)) - middle;
    if depth + nearest <= select(0.0, NEAR * (depth + farthest), is_perspective) {
        return cell;
    }
    cell.nearness = -vec2<f32>(farthest, nearest);
    if is_perspective {
        cell.nearness /= depth + vec2<f32>(farthest, nearest);
    }
    let range = cell.nearness.y - cell.nearness.x;

    // Pixels from the reference to the outline's ends, and a little for pixels beside it.
    let half = vec2<f32>(max(cell.outline.zw - cell.pixel, vec2<i32>(0))) + 0.25;
    let across = frame.slope.zw * cell.length;
    var planes: Planes;
    planes.faces = cell.faces;
    var exits = 0u;
    let normals = array<vec3<f32>, 4>(n0, n1, n2, n3);
    for (var face = 0u; face < 4u; face++) {
        let normal = normals[face];
        let height = dot(normal, select(from_a, from_a - ab, face == 0u));
        // How far the face's plane is from the eye: what remains from the reference on.
        let away = select(normal.z, depth * dot(normal, direction) - height, is_perspective);
        let slopes = normal.xy * across;
        // Written so that a face without area, or seen edge-on, goes the other way.
        if !(abs(height) + dot(abs(slopes), half) < STEEP * range * abs(away)) {
            return cell;
        }
        let plane = bitcast<vec3<i32>>(vec3<f32>(height, slopes) / away);
        if away < 0.0 {
            planes.faces[planes.entry_count] = vec4<i32>(plane, 0);
            planes.entry_count += 1u;
        } else {
            planes.faces[3u - exits] = vec4<i32>(plane, 0);
            exits += 1u;
        }
    }

    // A corner's share grows against the normal of the face opposite to it. In a sliver the terms are large, whatever their sum.
    let six_volume = -dot(n1, ab);
    let differences = vec3<f32>(vec3<i32>(b.w, c.w, d.w) - a.w) * LATTICE_STEP;
    let limit = STEEP * six_volume * (cell.scalars.y - cell.scalars.x);
    let gradient = -(n1 * differences.x + n2 * differences.y + n3 * differences.z);
    let along = dot(gradient, direction) * cell.length;
    let rise = dot(gradient, from_a);
    let terms = abs(n1 * differences.x) + abs(n2 * differences.y) + abs(n3 * differences.z);
    let is_flat = all(differences == vec3<f32>(0.0));
    let is_gentle = dot(terms.xy * across, half) <= limit && dot(terms, abs(direction)) * cell.length * range <= limit
        // Also within what an integer holds.
        && dot(terms, abs(from_a)) <= limit && abs(rise) <= six_volume;
    if planes.entry_count == 0u || exits == 0u || six_volume <= 0.0 || !(is_flat || is_gentle) {
        return cell;
    }
    cell.faces = planes.faces;
    cell.entry_count = planes.entry_count;
    if !is_flat {
        cell.scalar = vec3<f32>(gradient.xy * across, along) / six_volume;
        cell.reference = a.w + i32(round(rise / six_volume / LATTICE_STEP));
        cell.scalars = vec2<f32>(f32(low - cell.reference), f32(high - cell.reference)) * LATTICE_STEP;
    }
    return cell;
}
