//! Volumes that are nothing but bytes.

use std::fs;
use std::path::Path;

use glam::DVec3;
use tetrascope::{ArrayValues, Cells, DataArray, Dataset, StructuredBlock};

use crate::Failure;

/// Reads a file whose name says its size, such as `neghip_64x64x64_uint8.raw`: one byte a point, x fastest.
///
/// Points lie one length apart, the first at the origin; the array is called `value`.
pub(super) fn read(path: &Path) -> Result<Dataset, Failure> {
    let name = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
    let dims = dims(name)
        .ok_or_else(|| format!("{}: no size in the name; call it as in neghip_64x64x64_uint8.raw", path.display()))?;
    let bytes = fs::read(path)?;
    dataset(dims, bytes).map_err(|problem| format!("{}: {problem}", path.display()).into())
}

/// The part of a name between underscores that reads as `NXxNYxNZ`.
fn dims(name: &str) -> Option<[usize; 3]> {
    name.split('_').find_map(|part| {
        let sides: Vec<usize> = part.split('x').map(|side| side.parse().ok()).collect::<Option<_>>()?;
        sides.try_into().ok()
    })
}

fn dataset(dims: [usize; 3], bytes: Vec<u8>) -> Result<Dataset, String> {
    let count = dims.iter().try_fold(1_usize, |product, &side| product.checked_mul(side));
    if count != Some(bytes.len()) {
        return Err(format!("{} bytes, where {} x {} x {} are named", bytes.len(), dims[0], dims[1], dims[2]));
    }
    let mut points = Vec::with_capacity(bytes.len());
    for k in 0..dims[2] {
        for j in 0..dims[1] {
            points.extend((0..dims[0]).map(|i| DVec3::new(i as f64, j as f64, k as f64)));
        }
    }
    Ok(Dataset {
        points,
        cells: Cells::Structured(vec![StructuredBlock { dims, first_point: 0, hidden_points: Vec::new() }]),
        point_arrays: vec![DataArray { name: "value".to_owned(), components: 1, values: ArrayValues::U8(bytes) }],
        cell_arrays: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn size_is_read_from_the_name_and_checked() {
        assert_eq!(dims("neghip_64x32x16_uint8"), Some([64, 32, 16]));
        assert_eq!(dims("a_64x64_b"), None);
        assert_eq!(dims("axbxc"), None);

        let read = dataset([2, 3, 4], (0..24).collect()).unwrap();
        assert_eq!(read.points[1], DVec3::X);
        assert_eq!(read.points[2], DVec3::Y);
        assert_eq!(read.points[23], DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(read.point_arrays[0].component(0)[6], 6.0);
        assert!(dataset([2, 3, 4], vec![0; 23]).unwrap_err().contains("23 bytes, where 2 x 3 x 4"));
        assert!(dataset([usize::MAX, 2, 1], vec![0; 8]).is_err());
    }
}
