// The draw block: see `layout::Block`.

struct Block {
    first: u32,
    count: u32,
    capacity: u32,
    unused: u32,
}

@group(0) @binding(19) var<uniform> block: Block;
