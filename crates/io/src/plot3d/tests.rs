//! Every layout, written here and read back; and files that fit none.

use std::path::PathBuf;

use super::{
    layout::{Layout, all_layouts},
    synthetic::{Written, file, written},
    *,
};

fn source(bytes: Vec<u8>) -> Source {
    Source { path: PathBuf::from("grid.xyz"), bytes, ..Default::default() }
}

/// The grids that a layout's file is filled with: one, or three of different sizes.
fn grids(layout: Layout) -> Vec<Written> {
    let quantities = layout.floats_per_point();
    let dims: &[[usize; 3]] = if layout.multi { &[[4, 3, 5], [2, 2, 2], [3, 6, 2]] } else { &[[5, 4, 3]] };
    dims.iter().zip(1..).map(|(dims, shift)| written(&dims[..layout.axes], quantities, f64::from(shift))).collect()
}

fn numbers<T: Real>(content: &Content<'_>, fit: &Fit) -> Vec<(Vec<f64>, Vec<f64>, Vec<i32>)> {
    let plain = |values: &[T]| values.iter().map(|&v| v.into()).collect();
    let blocks = blocks::read::<T>(content, fit).unwrap();
    blocks.iter().map(|block| (plain(&block.reference), plain(&block.values), block.iblank.clone())).collect()
}

#[test]
fn every_layout_is_told_apart_and_read() {
    let mut tried = 0;
    for kind in [Kind::Grid, Kind::Solution] {
        for layout in [all_layouts(kind, false, 3), all_layouts(kind, true, 3)].concat() {
            let grids = grids(layout);
            for padding in [0, 484] {
                if layout.encoding == Encoding::Text && padding > 0 {
                    continue;
                }
                let mut bytes = file(layout, &grids);
                bytes.resize(bytes.len() + padding, 0);
                let content = content_of(&bytes, 0).unwrap();
                let fit = detect(&content, kind).unwrap_or_else(|no_fit| panic!("{layout}: {no_fit:?}"));
                assert_eq!(fit.layout, layout);
                assert_eq!(fit.padding, padding, "{layout}");
                let read = match layout.encoding {
                    Encoding::Binary { precision: Precision::Single, .. } => numbers::<f32>(&content, &fit),
                    _ => numbers::<f64>(&content, &fit),
                };
                for (grid, (reference, values, iblank)) in grids.iter().zip(read) {
                    assert_eq!(values, grid.values, "{layout}");
                    assert_eq!(iblank, if layout.iblank { grid.iblank.clone() } else { vec![] }, "{layout}");
                    assert_eq!(reference, if kind == Kind::Solution { grid.reference.to_vec() } else { vec![] });
                }
                // And not taken for the other kind.
                let other = if kind == Kind::Grid { Kind::Solution } else { Kind::Grid };
                assert!(padding > 0 || detect(&content, other).is_err(), "{layout}");
                assert!(PLOT3D.recognizes(&bytes), "{layout}");
                tried += 1;
            }
        }
    }
    // Order x marks x precision x multi (x iblank), with and without padding; text.
    assert_eq!(tried, 16 * 2 * 2 + 16 * 2 + 4 + 2);
}

#[test]
fn every_layout_cut_short_is_an_error_that_names_it() {
    for kind in [Kind::Grid, Kind::Solution] {
        for layout in [all_layouts(kind, false, 3), all_layouts(kind, true, 3)].concat() {
            let whole = file(layout, &grids(layout));
            let mut cut = whole.len() - 27;
            if layout.encoding == Encoding::Text {
                // Half a number may be one too, or an error of its own.
                cut = whole[..cut].iter().rposition(u8::is_ascii_whitespace).unwrap();
            }
            let content = content_of(&whole[..cut], 0).unwrap();
            let NoFit::Nearest(misfit) = detect(&content, kind).unwrap_err() else { panic!("{layout}") };
            // By its size alone a file could also be one without iblank and with something after the data.
            assert_eq!(misfit.layout.encoding, layout.encoding, "{}", misfit.problem);
            assert_eq!(misfit.layout.multi, layout.multi, "{}", misfit.problem);
        }
    }
}

#[test]
fn planar_files_are_refused_as_such() {
    for layout in [all_layouts(Kind::Grid, false, 2), all_layouts(Kind::Grid, true, 2)].concat() {
        let error = PLOT3D.read(&source(file(layout, &grids(layout)))).unwrap_err();
        assert!(matches!(&error, IoError::Unsupported { what, .. } if what.contains("planar")), "{error}");
    }
}

#[test]
fn plane_by_plane_files_are_named_as_such() {
    let layout = all_layouts(Kind::Grid, false, 3).into_iter().find(|l| l.to_string().contains("with record marks"));
    let grid = written(&[4, 3, 5], 3, 1.0);
    let whole = file(layout.unwrap(), &[grid]);
    let (header, body) = whole.split_at(4 + 12 + 4);
    let mut bytes = header.to_vec();
    for plane in body[4..body.len() - 4].chunks_exact(4 * 3 * 3 * 4) {
        let mark = 144_i32.to_be_bytes();
        bytes.extend([&mark[..], plane, &mark].concat());
    }
    let error = PLOT3D.read(&source(bytes)).unwrap_err();
    assert!(error.to_string().contains("plane by plane"), "{error}");
}

fn big_endian_single(grid: &Written) -> Vec<u8> {
    file(all_layouts(Kind::Grid, false, 3)[0], std::slice::from_ref(grid))
}

#[test]
fn a_file_that_fits_two_layouts_is_refused() {
    // One point with iblank, or a count of one grid of one point: 28 bytes either way.
    let bytes = [1_i32, 1, 1, 1, 2, 2, 2].iter().flat_map(|i| i.to_le_bytes()).collect();
    let message = PLOT3D.read(&source(bytes)).unwrap_err().to_string();
    assert!(message.contains("several layouts"), "{message}");
    assert!(message.contains("single-grid, with iblank of 1x1x1; or "), "{message}");
    assert!(message.contains("multi-grid, no iblank of 1x1x1"), "{message}");
}

#[test]
fn padding_is_not_taken_for_data() {
    // 27 points: with 484 zero bytes the same dimensions also fit with iblank, and with floats of twice the size.
    let mut bytes = big_endian_single(&written(&[3, 3, 3], 3, 1.0));
    bytes.resize(bytes.len() + 484, 0);
    let loaded = PLOT3D.read(&source(bytes)).unwrap();
    assert!(loaded.format.contains("32-bit") && loaded.format.contains("no iblank"), "{}", loaded.format);
    assert!(loaded.warnings.iter().any(|w| w.starts_with("484 zero bytes")), "{:?}", loaded.warnings);
}

#[test]
fn padding_must_be_zero_and_short() {
    let whole = big_endian_single(&written(&[5, 4, 3], 3, 1.0));
    let mut dirty = whole.clone();
    dirty.extend([0, 0, 7, 0]);
    let message = PLOT3D.read(&source(dirty)).unwrap_err().to_string();
    assert!(message.contains("grid of 5x4x3 needs 732 bytes, the file has 736, and the rest is not zero"), "{message}");

    let mut long = whole;
    long.resize(100_000, 0);
    let message = PLOT3D.read(&source(long)).unwrap_err().to_string();
    assert!(message.contains("too much for padding"), "{message}");
}

#[test]
fn grid_alone_has_points_blanks_and_a_warning() {
    let layout = all_layouts(Kind::Grid, false, 3).into_iter().find(|l| l.multi && l.iblank).unwrap();
    let mut both = vec![written(&[2, 3, 4], 3, 1.0), written(&[3, 2, 2], 3, 50.0)];
    both[0].iblank.fill(-1);
    let loaded = PLOT3D.read(&source(file(layout, &both))).unwrap();
    assert_eq!(loaded.format, format!("PLOT3D, {layout}, 2x3x4 + 3x2x2"));
    assert!(loaded.warnings[0].contains("solution"), "{:?}", loaded.warnings);
    assert_eq!(loaded.dataset.points.len(), 36);
    assert_eq!(loaded.dataset.points[24].to_array(), [0, 12, 24].map(|i| both[1].values[i]));
    let Cells::Structured(blocks) = &loaded.dataset.cells else { panic!() };
    assert_eq!((blocks[1].dims, blocks[1].first_point), ([3, 2, 2], 24));
    assert!(blocks[0].hidden_points.is_empty(), "negative values do not hide");
    assert_eq!(blocks[1].hidden_points.iter().filter(|&&hidden| hidden).count(), 2);
    assert_eq!(loaded.dataset.point_arrays.len(), 1);
    assert_eq!(loaded.dataset.point_arrays[0].name, "IBlank");
    assert_eq!(loaded.dataset.point_arrays[0].tuple_count(), 36);
}

#[test]
fn coordinates_that_are_not_finite_are_kept_and_counted() {
    let mut grid = written(&[3, 3, 3], 3, 1.0);
    grid.values[4] = f64::NAN;
    grid.values[20] = f64::INFINITY;
    let loaded = PLOT3D.read(&source(big_endian_single(&grid))).unwrap();
    assert!(loaded.warnings.iter().any(|w| w.starts_with("2 of 27 points")), "{:?}", loaded.warnings);
}

#[test]
fn flat_grids_load_with_a_warning() {
    let loaded = PLOT3D.read(&source(big_endian_single(&written(&[5, 4, 1], 3, 1.0)))).unwrap();
    assert!(loaded.warnings.iter().any(|w| w.contains("no volume")), "{:?}", loaded.warnings);
}

#[test]
fn derived_quantities_and_voids() {
    // Point 0: rho 2, m (2, 4, 4), e 12: |m|^2 / 2 rho = 9, p = 0.4 * 3. Point 1: rho 0.
    let block = Block {
        reference: vec![0.0; 4],
        values: vec![2.0_f64, 0.0, 2.0, 1.0, 4.0, 1.0, 4.0, 1.0, 12.0, 5.0],
        iblank: vec![],
    };
    let mut warnings = Vec::new();
    let arrays = derived::solution_arrays(&[block], &mut warnings);
    let names: Vec<_> = arrays.iter().map(|a| (a.name.as_str(), a.components)).collect();
    assert_eq!(
        names,
        [
            ("Density", 1),
            ("Momentum", 3),
            ("StagnationEnergy", 1),
            ("Pressure", 1),
            ("Velocity", 3),
            ("Temperature", 1)
        ]
    );
    let values: Vec<_> = arrays.iter().map(|a| a.values.to_f64()).collect();
    assert_eq!(values[0], [2.0, 0.0]);
    assert_eq!(values[1], [2.0, 4.0, 4.0, 1.0, 1.0, 1.0]);
    assert!((values[3][0] - 1.2).abs() < 1e-15);
    assert_eq!(values[4][..3], [1.0, 2.0, 2.0]);
    assert!((values[5][0] - 0.6).abs() < 1e-15);
    assert!(values[3][1].is_nan() && values[4][3..].iter().all(|v| v.is_nan()) && values[5][1].is_nan());
    assert_eq!(warnings.len(), 1);
    assert!(warnings[0].contains("0 at 1 of 2 points"), "{warnings:?}");
}

#[test]
fn text_that_is_wrong_names_its_line() {
    let error = PLOT3D.read(&source(b"2 2 2\n1 2 3\n4 water 6\n".to_vec())).unwrap_err().to_string();
    assert!(error.contains("line 3") && error.contains("\"water\""), "{error}");
    let error = PLOT3D.read(&source(b"2 2 2\n1 2 3\n".to_vec())).unwrap_err().to_string();
    assert!(error.contains("2x2x2 needs 27 numbers, the file has 6"), "{error}");
}

#[test]
fn text_with_repeat_counts() {
    let loaded = PLOT3D.read(&source(b"3*2\n4*0.0 4*1.0\n2*0 2*1 2*0 2*1\n8*1.5D0".to_vec())).unwrap();
    assert_eq!(loaded.dataset.points.len(), 8);
    assert_eq!(loaded.dataset.points[6].to_array(), [1.0, 1.0, 1.5]);
}
