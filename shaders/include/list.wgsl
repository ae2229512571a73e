// Work over lists: groups are numbered through however many dimensions they are spread.

fn group_number(group: vec3<u32>, groups: vec3<u32>) -> u32 {
    return group.y * groups.x + group.x;
}
