// Ranks handed on along a ray. The rank at the entry to a cell is that of the exit before, where one cell begins at the depth at which
// the last one ended: so each surface is met exactly once on the way from one side to the other, whatever rounding does to the scalars
// there.
//
// frame: where depths count from.

#use effects/joint.wgsl
#use include/frame.wgsl

// Depths are off by at most this share of a cell's own range of depths, as its faces are not steeper than set-up lets them be, and by
// this share of the depth itself, which counts from where the mesh begins: a few roundings.
const SLACK_OF_CELL: f32 = 1e-4;
const SLACK_OF_DEPTH: f32 = 1e-6;
// Most of it, as a share of the cell's range of depths: where f32 does not tell one cell's depth from the next one's, cells in a wrong
// order would take each other's ranks. Then each has its own.
const MOST_SLACK: f32 = 0.05;

// How far the depths of a cell's faces may be off.
fn joint_slack(corners: array<vec4<i32>, 4>) -> f32 {
    let nearest = min(min(corners[0].z, corners[1].z), min(corners[2].z, corners[3].z));
    let farthest = max(max(corners[0].z, corners[1].z), max(corners[2].z, corners[3].z));
    let range = f32(farthest - nearest) * LATTICE_STEP;
    // From the base, where depths count from.
    let start = frame.eye.z + frame.eye.w;
    let depth = max(abs(f32(farthest) * LATTICE_STEP - start), abs(f32(nearest) * LATTICE_STEP - start));
    return min(SLACK_OF_CELL * range + SLACK_OF_DEPTH * depth, MOST_SLACK * range);
}

// The rank at the front: that of the exit before where the two are one place, else the cell's own. Remembers the exit that is farthest: where
// the eye lies in a face but for rounding, either cell of the face may come first, and what the ray has of one of them is next to nothing.
//
// - depth, ranks: at the entry and at the exit
fn carry_joint(joint: ptr<function, Joint>, depth: vec2<f32>, slack: f32, ranks: vec2<f32>) -> f32 {
    let before = *joint;
    let most_slack = max(slack, before.slack);
    if depth.y >= before.depth - most_slack {
        *joint = Joint(depth.y, slack, ranks.y);
    }
    return select(ranks.x, before.rank, abs(depth.x - before.depth) <= most_slack);
}
