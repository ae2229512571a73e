// How much a stage over a list has to do: see `layout::Work`.

struct Work {
    most: u32,
    count_at: u32,
    shift: u32,
    unused: u32,
}

@group(0) @binding(29) var<uniform> work: Work;

// Groups that a list of `length` takes; at least one.
fn blocks_of(length: u32) -> u32 {
    return max((length + LIST_BLOCK - 1u) / LIST_BLOCK, 1u);
}
