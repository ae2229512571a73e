// The isosurfaces of the plan, and which of them rays may cross in a cell.
//
// surfaces: those that can be seen, by ascending value.

struct Surface {
    // Linear color of the side that faces rising scalars, and the share of what lies behind that it hides.
    color: vec3<f32>,
    opacity: f32,
    // Linear color of the other side.
    back_color: vec3<f32>,
    // Lattice steps.
    value: i32,
    // SHADING_NONE, SHADING_FLAT or SHADING_SMOOTH.
    shading: u32,
}

@group(0) @binding(14) var<storage, read> surfaces: array<Surface>;

// Isosurfaces whose values lie this share of a cell's own range, and so many lattice steps (4e-6 of the scalars' unit), beyond the cell's
// range count as inside: rounding may put a scalar at its faces there. Too many cost a little time and nothing else.
const MARGIN_OF_CELL: f32 = 1e-4;
const MARGIN_OF_FIELD: f32 = 2147.0;

// How far below the value of a surface a scalar still counts as on it, as a share of the cell's range and of the scalars' unit: above
// what a scalar at a face rounds to, far below what a picture shows. It says whether a segment ends on the far side of a surface and
// changes nothing else: segments are cut at the value itself, or at the end that is nearest to it. Without it, a surface in the faces of
// cells, or in the mesh's boundary, would be there or not as each pixel rounds.
const ON_SURFACE_OF_CELL: f32 = 1e-5;
const ON_SURFACE_OF_FIELD: f32 = 2e-6;

// Number of surfaces whose values are below a scalar, lattice steps.
fn surfaces_below(scalar: i32) -> u32 {
    var first = 0u;
    var count = arrayLength(&surfaces);
    while count > 0u {
        let half = count / 2u;
        if surfaces[first + half].value < scalar {
            first += half + 1u;
            count -= half + 1u;
        } else {
            count = half;
        }
    }
    return first;
}

// How far beyond a cell's range of scalars surfaces count as inside, lattice steps.
fn surface_margin(low: i32, high: i32) -> i32 {
    return i32(MARGIN_OF_CELL * f32(high - low) + MARGIN_OF_FIELD) + 1;
}

// The surfaces that rays may cross in a cell: first, and how many.
//
// - low, high: its scalars, lattice steps
fn surfaces_near(low: i32, high: i32) -> vec2<u32> {
    let margin = surface_margin(low, high);
    let first = surfaces_below(low - margin);
    return vec2<u32>(first, surfaces_below(high + margin + 1) - first);
}

// How far below the value of a surface a scalar still counts as on it; units of scalars.
fn surface_tolerance(low: i32, high: i32) -> f32 {
    return ON_SURFACE_OF_CELL * (f32(high - low) * LATTICE_STEP) + ON_SURFACE_OF_FIELD;
}
