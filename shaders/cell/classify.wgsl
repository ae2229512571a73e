// The silhouette of a cell: class, fan of triangles, and the thickest chord. The twin of `tetrascope_classify::project`.
//
// A face's signed volume comes from its own corners in ascending order and exact edges, so that two cells of one face agree. Rounding may
// give a tiny one the wrong sign; all sums below run over terms of one sign, and the picture changes with it continuously.
#use include/frame.wgsl
#use cell/outline.wgsl

const CLASS_DEGENERATE: u32 = 0u;
const CLASS_ONE_A: u32 = 1u;
const CLASS_ONE_B: u32 = 2u;
const CLASS_TWO: u32 = 3u;
const CLASS_THREE_A: u32 = 4u;
const CLASS_THREE_B: u32 = 5u;
const CLASS_FOUR: u32 = 6u;
const CLASS_EYE_INSIDE: u32 = 7u;

struct Classified {
    // For each corner that of the opposite face: above 0 where it faces away from the eye. Perspective: six times the volume between the face
    // and the eye; else twice the area as seen. Local units.
    volumes: vec4<f32>,
    // Scalars at the front and the back of the thickest chord, from the first corner's, units of 2^29 lattice steps.
    scalars: vec2<f32>,
    // The thick vertex on the screen, pixels from the middle of the picture; (0, 0) where it is not in front of the eye.
    screen: vec2<f32>,
    // The chord's length, local units.
    length: f32,
    // Depth of its front from the eye, and of its back.
    depth: vec2<f32>,
    // Perspective: inverse depth at the front minus that at the back, linear on the screen; else the difference of depths, as `length`.
    nearness: f32,
    // Class, see the constants.
    class_number: u32,
    // Corners around the thick vertex, counterclockwise on the screen, four bits each; and how many: one more than triangles, or 0.
    ring: u32,
    ring_count: u32,
    // The corner in whose place the thick vertex lies; 4 for none.
    corner: u32,
}

// A corner of the ring.
fn ring_corner(ring: u32, index: u32) -> u32 {
    return (ring >> (4u * index)) & 15u;
}

fn pack_ring(a: u32, b: u32, c: u32, d: u32, e: u32) -> u32 {
    return a | (b << 4u) | (c << 8u) | (d << 12u) | (e << 16u);
}

// Positive where the corners run clockwise as the eye sees them.
fn face_volume(p: vec4<i32>, q: vec4<i32>, r: vec4<i32>) -> f32 {
    let normal = cross(vec3<f32>(q.xyz - p.xyz) * LATTICE_STEP, vec3<f32>(r.xyz - p.xyz) * LATTICE_STEP);
    if frame.is_perspective == 0u {
        return normal.z;
    }
    return dot(normal, vec3<f32>(p.xyz) * LATTICE_STEP - frame.eye.xyz);
}

// Whether three corners run clockwise as the eye sees them; the face that they are must not be seen edge-on.
fn turns_clockwise(i: u32, j: u32, k: u32, volumes: vec4<f32>, is_negative: bool) -> bool {
    let missing = 6u - i - j - k;
    // Ascending corners run clockwise for a positive volume where the missing corner is even.
    let swaps = u32(i > j) + u32(j > k) + u32(i > k) + missing + u32(is_negative);
    return (volumes[missing] > 0.0) == ((swaps & 1u) == 0u);
}

fn classify(vertices: vec4<u32>) -> Classified {
    let index = bare(vertices);
    let is_negative = (vertices.w & NEGATIVE_BIT) != 0u;
    let corners = array<vec4<i32>, 4>(points[index.x], points[index.y], points[index.z], points[index.w]);
    let a = corners[0];
    let b = corners[1];
    let c = corners[2];
    let d = corners[3];
    let outward = select(1.0, -1.0, is_negative);
    var found: Classified;
    found.corner = 4u;
    found.volumes = outward * vec4<f32>(face_volume(b, c, d), -face_volume(a, c, d), face_volume(a, b, d), -face_volume(a, b, c));
    let volumes = found.volumes;
    let ab = vec3<f32>(b.xyz - a.xyz) * LATTICE_STEP;
    let ac = vec3<f32>(c.xyz - a.xyz) * LATTICE_STEP;
    let ad = vec3<f32>(d.xyz - a.xyz) * LATTICE_STEP;
    let six_volume = outward * dot(cross(ab, ac), ad);

    // Corners by the sign of their volumes, four bits each.
    var plus = 0u;
    var minus = 0u;
    var zero = 0u;
    var counts = vec3<u32>(0u);
    for (var corner = 0u; corner < 4u; corner++) {
        let volume = volumes[corner];
        if volume > 0.0 {
            plus |= corner << (4u * counts.x);
            counts.x += 1u;
        } else if volume < 0.0 {
            minus |= corner << (4u * counts.y);
            counts.y += 1u;
        } else {
            zero |= corner << (4u * counts.z);
            counts.z += 1u;
        }
    }
    if !(six_volume > 0.0) || counts.x == 0u {
        return found;
    }
    if counts.y == 0u {
        found.class_number = select(CLASS_DEGENERATE, CLASS_EYE_INSIDE, frame.is_perspective != 0u);
        return found;
    }
    find_ring(&found, plus, minus, zero, counts, is_negative);

    // Means over corners of one sign.
    let weights_plus = max(volumes, vec4<f32>(0.0));
    let weights_minus = max(-volumes, vec4<f32>(0.0));
    let sum_plus = weights_plus.x + weights_plus.y + weights_plus.z + weights_plus.w;
    let sum_minus = weights_minus.x + weights_minus.y + weights_minus.z + weights_minus.w;
    let share_plus = weights_plus / sum_plus;
    let share_minus = weights_minus / sum_minus;
    let scalars = vec4<f32>(0.0, vec3<f32>(vec3<i32>(b.w, c.w, d.w) - a.w) * LATTICE_STEP);
    found.scalars = vec2<f32>(mean_scalar(share_plus, scalars), mean_scalar(share_minus, scalars));
    let origin = corners[ring_corner(plus, 0u)];
    let near = vec3<f32>(origin.xyz) * LATTICE_STEP - frame.eye.xyz
        + share_plus.x * vec3<f32>(a.xyz - origin.xyz) * LATTICE_STEP
        + share_plus.y * vec3<f32>(b.xyz - origin.xyz) * LATTICE_STEP
        + share_plus.z * vec3<f32>(c.xyz - origin.xyz) * LATTICE_STEP
        + share_plus.w * vec3<f32>(d.xyz - origin.xyz) * LATTICE_STEP;
    // Where rounding makes up all of the volumes the quotient can be anything; no chord exceeds the longest edge.
    let longest = sqrt(max(
        max(max(dot(ab, ab), dot(ac, ac)), dot(ad, ad)),
        max(max(dot(ac - ab, ac - ab), dot(ad - ab, ad - ab)), dot(ad - ac, ad - ac)),
    ));
    if frame.is_perspective == 0u {
        found.length = min(six_volume / (0.5 * sum_plus + 0.5 * sum_minus), longest);
        found.nearness = found.length;
        found.depth = vec2<f32>(near.z, near.z + found.length);
        found.screen = near.xy / frame.slope.zw;
        return found;
    }
    found.length = min(length(near) * (six_volume / sum_minus), longest);
    if near.z > 0.0 {
        found.depth = near.z * vec2<f32>(1.0, sum_plus / sum_minus);
        found.nearness = six_volume / sum_plus / near.z;
        found.screen = near.xy / (near.z * frame.slope.xy);
    }
    return found;
}

// A mean of the corners' scalars; never outside of those that count.
fn mean_scalar(shares: vec4<f32>, scalars: vec4<f32>) -> f32 {
    let low = select(vec4<f32>(8.0), scalars, shares > vec4<f32>(0.0));
    let high = select(vec4<f32>(-8.0), scalars, shares > vec4<f32>(0.0));
    return clamp(dot(shares, scalars), min(min(low.x, low.y), min(low.z, low.w)), max(max(high.x, high.y), max(high.z, high.w)));
}

fn find_ring(found: ptr<function, Classified>, plus: u32, minus: u32, zero: u32, counts: vec3<u32>, is_negative: bool) {
    let p = vec3<u32>(ring_corner(plus, 0u), ring_corner(plus, 1u), ring_corner(plus, 2u));
    let n = vec3<u32>(ring_corner(minus, 0u), ring_corner(minus, 1u), ring_corner(minus, 2u));
    let z = vec2<u32>(ring_corner(zero, 0u), ring_corner(zero, 1u));
    // The ring, and three corners that turn as the ring does.
    var ring = array<u32, 5>(0u, 0u, 0u, 0u, 0u);
    var turn = vec3<u32>(0u, 1u, 2u);
    var count = 0u;
    let code = counts.x * 4u + counts.y;
    if code == 7u || code == 13u {
        let is_first = code == 7u;
        turn = select(p, n, is_first);
        ring = array<u32, 5>(turn.x, turn.y, turn.z, turn.x, 0u);
        count = 4u;
        (*found).class_number = select(CLASS_ONE_B, CLASS_ONE_A, is_first);
        (*found).corner = select(n.x, p.x, is_first);
    } else if code == 10u {
        ring = array<u32, 5>(p.x, n.x, p.y, n.y, p.x);
        turn = vec3<u32>(p.x, n.x, p.y);
        count = 5u;
        (*found).class_number = CLASS_TWO;
    } else if code == 6u || code == 9u {
        let is_first = code == 6u;
        let pair = select(p.xy, n.xy, is_first);
        turn = vec3<u32>(pair.x, z.x, pair.y);
        ring = array<u32, 5>(turn.x, turn.y, turn.z, 0u, 0u);
        count = 3u;
        (*found).class_number = select(CLASS_THREE_B, CLASS_THREE_A, is_first);
        (*found).corner = select(n.x, p.x, is_first);
    } else {
        ring = array<u32, 5>(z.x, z.y, 0u, 0u, 0u);
        turn = vec3<u32>(p.x, z.x, z.y);
        count = 2u;
        (*found).class_number = CLASS_FOUR;
        (*found).corner = p.x;
    }
    let is_reversed = turns_clockwise(turn.x, turn.y, turn.z, (*found).volumes, is_negative);
    for (var i = 0u; i < count; i++) {
        let corner = ring[select(i, count - 1u - i, is_reversed)];
        (*found).ring |= corner << (4u * i);
    }
    (*found).ring_count = count;
}
