//! Makes a failing file small.

/// Removes from a file what it fails without: halves first, then smaller and smaller pieces, down to single bytes.
///
/// - `fails`: whether a file fails in the same way; asked `most` times at the most
///
/// Source: [Zeller 2002], the algorithm ddmin without its tests of single pieces.
pub fn reduce(file: &[u8], most: usize, mut fails: impl FnMut(&[u8]) -> bool) -> Vec<u8> {
    let mut file = file.to_vec();
    let mut asked = 0;
    let mut piece = file.len().div_ceil(2);
    while piece > 0 && asked < most {
        let mut at = 0;
        let mut has_shrunk = false;
        while at < file.len() && asked < most {
            let end = file.len().min(at + piece);
            let without = [&file[..at], &file[end..]].concat();
            asked += 1;
            if fails(&without) {
                file = without;
                has_shrunk = true;
            } else {
                at = end;
            }
        }
        if !has_shrunk || piece > file.len() {
            piece /= 2;
        }
    }
    file
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_failure_needs_is_left() {
        let file: Vec<u8> = (0..=255).collect();
        let fails = |file: &[u8]| file.contains(&17) && file.contains(&200);
        assert_eq!(reduce(&file, 10_000, fails), [17, 200]);
        assert!(reduce(&file, 3, fails).len() >= 64);
        assert_eq!(reduce(&file, 10_000, |file| !file.is_empty()).len(), 1);
        assert!(reduce(&[], 10, |_| true).is_empty());
    }
}
