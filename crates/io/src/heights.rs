//! Heights of a mesh's points, kept in a file beside the mesh.
//!
//! A line of text, then the number of points and one height each, in 64 bits, little-endian.

use std::path::Path;

use crate::IoError;
use crate::bytes::{ByteCursor, ByteOrder};
use crate::picture::write_whole;

const FIRST_LINE: &[u8] = b"tetrascope heights 1\n";

/// Reads what [`write_heights`] wrote: one height a point.
///
/// # Errors
/// [`IoError::Read`] if there is no such file, [`IoError::Invalid`] if it is none of heights, ends too early, goes on too long, or holds a
/// number that is not finite.
pub fn read_heights(path: &Path) -> Result<Vec<f64>, IoError> {
    let bytes = std::fs::read(path).map_err(|source| IoError::Read { path: path.to_owned(), source })?;
    let wrong = |place: String, problem: String| IoError::Invalid {
        path: path.to_owned(),
        place,
        problem,
        remedy: "remove the file; it is made anew".to_owned(),
    };
    let Some(numbers) = bytes.strip_prefix(FIRST_LINE) else {
        return Err(wrong("the first line".to_owned(), "it is no file of heights".to_owned()));
    };
    let mut cursor = ByteCursor::new(numbers, ByteOrder::Little);
    let cut = || wrong(format!("byte {}", bytes.len()), "the file ends too early".to_owned());
    let count: u64 = cursor.one().map_err(|_| cut())?;
    let heights: Vec<f64> = usize::try_from(count).ok().and_then(|count| cursor.many(count).ok()).ok_or_else(cut)?;
    if !cursor.rest().is_empty() {
        let problem = format!("{} bytes follow after {count} heights", cursor.rest().len());
        return Err(wrong(format!("byte {}", bytes.len() - cursor.rest().len()), problem));
    }
    match heights.iter().position(|height| !height.is_finite()) {
        Some(point) => Err(wrong(format!("height {point}"), format!("it is {}", heights[point]))),
        None => Ok(heights),
    }
}

/// Writes one height a point.
///
/// # Errors
/// [`IoError::Write`]; what was at the path is left alone then.
pub fn write_heights(path: &Path, heights: &[f64]) -> Result<(), IoError> {
    let mut bytes = Vec::with_capacity(FIRST_LINE.len() + 8 + 8 * heights.len());
    bytes.extend_from_slice(FIRST_LINE);
    bytes.extend_from_slice(&(heights.len() as u64).to_le_bytes());
    heights.iter().for_each(|height| bytes.extend_from_slice(&height.to_le_bytes()));
    write_whole(path, &bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_and_what_is_broken_is_said() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.vtu.heights");
        let heights = [0.0, -1.5e-300, 2.0_f64.sqrt(), 1e300];
        write_heights(&path, &heights).unwrap();
        assert_eq!(read_heights(&path).unwrap(), heights);
        let good = std::fs::read(&path).unwrap();
        let mut nan = good.clone();
        let end = nan.len();
        nan[end - 8..].copy_from_slice(&f64::NAN.to_le_bytes());
        let mut many = good.clone();
        many[FIRST_LINE.len()..FIRST_LINE.len() + 8].fill(0xff);
        for (bytes, said) in [
            (good[..end - 1].to_vec(), "ends too early"),
            (good[..FIRST_LINE.len() + 3].to_vec(), "ends too early"),
            (many, "ends too early"),
            ([good.as_slice(), &[0]].concat(), "1 bytes follow"),
            (nan, "height 3"),
            (b"# vtk DataFile".to_vec(), "no file of heights"),
            (Vec::new(), "no file of heights"),
        ] {
            std::fs::write(&path, bytes).unwrap();
            let text = read_heights(&path).unwrap_err().to_string();
            assert!(text.contains(said) && text.contains("a.vtu.heights"), "{said}: {text}");
        }
        assert!(matches!(read_heights(&folder.path().join("absent")), Err(IoError::Read { .. })));
    }
}
