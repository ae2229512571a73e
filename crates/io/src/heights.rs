//! Heights of a mesh's points as a file: what the power order found once, kept beside the mesh.
//!
//! 24 bytes of header, then one little-endian f64 a point. The header is the text `TETRASCOPE-HEIGHTS`, a line feed, the
//! version 1 as one byte, and the number of heights as a little-endian u32.

use std::path::Path;

use crate::opened::read_whole;
use crate::picture::write_whole;
use crate::{IoError, ReadOptions};

const MAGIC: &[u8; 19] = b"TETRASCOPE-HEIGHTS\n";
const VERSION: u8 = 1;
const HEADER: usize = MAGIC.len() + 1 + size_of::<u32>();

/// Reads heights, one a point, as [`write_heights`] wrote them.
///
/// They are finite. Whether they belong to a mesh only their number says; the power order proves anew what they are worth.
///
/// # Errors
/// [`IoError::Read`] when the system does not give the file, [`IoError::Unsupported`] when it is no such file or of a later
/// version, [`IoError::Invalid`] when its length is not what its header says or a height is not finite.
pub fn read_heights(path: &Path) -> Result<Vec<f64>, IoError> {
    let bytes = read_whole(path, &ReadOptions::default())?;
    let remedy = || "have the heights computed again, or do not name the file".to_owned();
    let unsupported = |what: String| IoError::Unsupported { path: path.to_owned(), what, remedy: remedy() };
    let invalid =
        |place: String, problem: String| IoError::Invalid { path: path.to_owned(), place, problem, remedy: remedy() };
    let Some(rest) = bytes.strip_prefix(MAGIC) else {
        return Err(unsupported("a file of heights that does not begin with TETRASCOPE-HEIGHTS".to_owned()));
    };
    let Some((&[version, a, b, c, d], values)) = rest.split_first_chunk::<5>() else {
        let problem = format!("the file ends after {} bytes of a header of {HEADER}", bytes.len());
        return Err(invalid("header".to_owned(), problem));
    };
    if version != VERSION {
        return Err(unsupported(format!("version {version} of files of heights")));
    }
    let declared = u64::from(u32::from_le_bytes([a, b, c, d]));
    let expected = declared * size_of::<f64>() as u64;
    if values.len() as u64 != expected {
        let problem = format!("{declared} heights take {expected} bytes, but {} follow", values.len());
        return Err(invalid("header".to_owned(), problem));
    }
    let (chunks, _) = values.as_chunks::<8>();
    let heights: Vec<f64> = chunks.iter().map(|&chunk| f64::from_le_bytes(chunk)).collect();
    if let Some(index) = heights.iter().position(|height| !height.is_finite()) {
        return Err(invalid(format!("height {index}"), format!("it is {}, which is not finite", heights[index])));
    }
    Ok(heights)
}

/// Writes heights, one a point. The file appears whole or not at all; the same heights give the same bytes.
///
/// # Errors
/// [`IoError::Write`] when there are more heights than a mesh may have points (2³² - 1), one is not finite, or the file cannot be
/// written; nothing is left of it then.
pub fn write_heights(path: &Path, heights: &[f64]) -> Result<(), IoError> {
    let refused = |problem: String| IoError::Write { path: path.to_owned(), problem, remedy: "keep none of this mesh" };
    let count = u32::try_from(heights.len()).map_err(|_| refused(format!("there are {} heights", heights.len())))?;
    if let Some(index) = heights.iter().position(|height| !height.is_finite()) {
        return Err(refused(format!("height {index} is {}, which is not finite", heights[index])));
    }
    let mut bytes = Vec::with_capacity(HEADER + size_of_val(heights));
    bytes.extend(MAGIC);
    bytes.push(VERSION);
    bytes.extend(count.to_le_bytes());
    heights.iter().for_each(|height| bytes.extend(height.to_le_bytes()));
    write_whole(path, &bytes)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn heights_come_back_bit_for_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mesh.heights");
        for heights in [vec![], vec![0.0, -0.0, 1e-310, f64::MAX, -3.5]] {
            write_heights(&path, &heights).unwrap();
            let back = read_heights(&path).unwrap();
            assert_eq!(
                back.iter().map(|h| h.to_bits()).collect::<Vec<_>>(),
                heights.iter().map(|h| h.to_bits()).collect::<Vec<_>>()
            );
            assert_eq!(fs::metadata(&path).unwrap().len(), (HEADER + 8 * heights.len()) as u64);
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing temporary is left");
    }

    #[test]
    fn nothing_is_written_for_what_is_not_finite() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mesh.heights");
        for bad in [f64::NAN, f64::INFINITY] {
            let error = write_heights(&path, &[1.0, bad]).unwrap_err().to_string();
            assert!(error.contains("height 1") && error.contains("mesh.heights"), "{error}");
        }
        assert!(!path.exists());
    }

    #[test]
    fn broken_files_are_errors_with_a_remedy() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mesh.heights");
        write_heights(&path, &[1.0, 2.0, 3.0]).unwrap();
        let whole = fs::read(&path).unwrap();
        let message = |bytes: &[u8]| {
            fs::write(&path, bytes).unwrap();
            let message = read_heights(&path).unwrap_err().to_string();
            assert!(message.contains("mesh.heights"), "{message}");
            message
        };
        // Cut anywhere, or with something after the end.
        for length in 0..whole.len() {
            message(&whole[..length]);
        }
        assert!(message(&[&whole[..], &[0]].concat()).contains("3 heights take 24 bytes, but 25 follow"));
        // As many heights as the header can declare: refused by the length, before anything is reserved.
        let mut huge = whole.clone();
        huge[20..24].fill(0xff);
        assert!(message(&huge).contains("4294967295 heights"));
        let mut later = whole.clone();
        later[19] = 2;
        assert!(message(&later).contains("version 2"));
        let mut nan = whole.clone();
        nan[HEADER + 8..HEADER + 16].copy_from_slice(&f64::NAN.to_le_bytes());
        assert!(message(&nan).contains("height 1"));
        assert!(message(b"<?xml version=\"1.0\"?><VTKFile/>").contains("does not begin with"));
        assert!(read_heights(folder.path()).unwrap_err().to_string().contains("folder"));
        assert!(matches!(read_heights(&folder.path().join("none")).unwrap_err(), IoError::Read { .. }));
    }
}
