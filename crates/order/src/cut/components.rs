//! Strongly connected components of a relation, in an order that respects it.

/// The components of the relation `front_of`, those in front first: each as its members, ascending.
///
/// - `front_of`: for every member those in front of it
///
/// Among components that are not related, that of the first member comes first. Linear; no recursion. Source: [Tarjan 1972].
pub(super) fn components(front_of: &[Vec<u32>]) -> Vec<Vec<u32>> {
    const UNSEEN: u32 = u32::MAX;
    let count = front_of.len();
    let (mut number, mut low) = (vec![UNSEEN; count], vec![0_u32; count]);
    let mut is_waiting = vec![false; count];
    let (mut waiting, mut open): (Vec<u32>, Vec<(usize, usize)>) = (Vec::new(), Vec::new());
    let (mut next, mut found) = (0, Vec::new());
    for root in 0..count {
        if number[root] != UNSEEN {
            continue;
        }
        open.push((root, 0));
        while let Some((member, done)) = open.last_mut() {
            let member = *member;
            if number[member] == UNSEEN {
                (number[member], low[member]) = (next, next);
                next += 1;
                waiting.push(member as u32);
                is_waiting[member] = true;
            }
            if let Some(&other) = front_of[member].get(*done) {
                *done += 1;
                let other = other as usize;
                if number[other] == UNSEEN {
                    open.push((other, 0));
                } else if is_waiting[other] {
                    low[member] = low[member].min(number[other]);
                }
                continue;
            }
            open.pop();
            if let Some(&(before, _)) = open.last() {
                low[before] = low[before].min(low[member]);
            }
            // What lies in front was complete before: components come out front to back.
            if low[member] == number[member] {
                let first = waiting.iter().rposition(|&m| m as usize == member).unwrap_or(0);
                let mut component = waiting.split_off(first);
                for &m in &component {
                    is_waiting[m as usize] = false;
                }
                component.sort_unstable();
                found.push(component);
            }
        }
    }
    found
}
