//! Meshes that keep every rule of their files and are no mesh all the same.

use glam::DVec3;
use tetrascope::{
    ArrayValues, Backend, CellKind, Cells, DataArray, Dataset, Error, LinearImage, Picture, Silent, StructuredBlock,
    UnstructuredCells, Volume, render_volume,
};

use super::{is_sound, scene};

/// Two tetrahedra that share a face, with a scalar.
fn two_cells(points: [[f64; 3]; 5], scalars: [f64; 5]) -> Dataset {
    Dataset {
        points: points.map(DVec3::from).to_vec(),
        cells: Cells::Unstructured(UnstructuredCells {
            kinds: vec![CellKind::Tetrahedron; 2],
            offsets: vec![0, 4, 8],
            connectivity: vec![0, 1, 2, 3, 1, 2, 3, 4],
            polyhedra: Vec::new(),
        }),
        point_arrays: vec![DataArray {
            name: "s".to_owned(),
            components: 1,
            values: ArrayValues::F64(scalars.to_vec()),
        }],
        cell_arrays: Vec::new(),
    }
}

const POINTS: [[f64; 3]; 5] = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [1., 1., 1.]];
const SCALARS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Both renderers end in the same way: in a sound picture, or in an error that names the mesh.
fn ends_well(what: &str, dataset: &Dataset) -> Result<LinearImage, String> {
    let draw = |backend: Backend| -> Result<Picture, Error> {
        render_volume(&Volume::from_dataset(dataset.clone(), "the hostile mesh")?, &scene(backend), &Silent)
    };
    let [fast, slow] = [Backend::Cpu, Backend::Reference].map(|backend| match draw(backend) {
        Ok(picture) => {
            assert!(is_sound(&picture.image), "{what}: {backend:?} gives unsound pixels");
            Ok(picture.image)
        }
        Err(error) => Err(error.to_string()),
    });
    match (&fast, &slow) {
        (Ok(_), Ok(_)) => {}
        (Err(a), Err(b)) => {
            assert_eq!(a, b, "{what}");
            assert!(a.contains("the hostile mesh") || a.contains("camera") || a.contains("the scene"), "{what}: {a}");
        }
        (fast, slow) => panic!("{what}: {:?} and {:?}", fast.as_ref().err(), slow.as_ref().err()),
    }
    println!("{what}: {}", fast.as_ref().err().map_or("a picture", |error| error));
    fast
}

#[test]
fn hostile_meshes_without_anything_to_draw_are_refused() {
    let sound = two_cells(POINTS, SCALARS);
    let refused = |what: &str, dataset: Dataset, words: &str| {
        let error = ends_well(what, &dataset).unwrap_err();
        assert!(error.contains(words), "{what}: {error}");
    };
    refused("no cells", Dataset { cells: Cells::default(), ..sound.clone() }, "no cells");
    refused("nothing", Dataset::default(), "no points");
    refused("no blocks", Dataset { cells: Cells::Structured(Vec::new()), ..sound.clone() }, "no cells");
    let block = StructuredBlock { dims: [5, 1, 1], first_point: 0, hidden_points: Vec::new() };
    refused("a flat block", Dataset { cells: Cells::Structured(vec![block]), ..sound.clone() }, "the hostile mesh");
    refused("all NaN", two_cells([[f64::NAN; 3]; 5], SCALARS), "finite coordinates");
    refused("all infinite", two_cells([[f64::INFINITY, 0.0, f64::NEG_INFINITY]; 5], SCALARS), "finite coordinates");
    refused("one place", two_cells([[3.0; 3]; 5], SCALARS), "flat");
    refused("one line", two_cells([0., 1., 2., 3., 4.].map(|x| [x; 3]), SCALARS), "flat");
    refused("no finite scalar", two_cells(POINTS, [f64::NAN; 5]), "no finite value");
    refused("infinite scalars", two_cells(POINTS, [f64::INFINITY; 5]), "no finite value");
    refused("no array", Dataset { point_arrays: Vec::new(), ..sound }, "no point or cell array");
}

#[test]
fn hostile_coordinates_and_scalars_end_well() {
    let scaled = |factor: f64| POINTS.map(|p| p.map(|x| x * factor));
    for factor in [1e300, 1e200, 1e154, 1e100, 1e38, 1e-38, 1e-100, 1e-154, 1e-200, 1e-300, 5e-324] {
        let _ = ends_well(&format!("points at {factor:e}"), &two_cells(scaled(factor), SCALARS));
    }
    let moved = |by: f64| POINTS.map(|p| p.map(|x| x + by));
    for by in [1e15, 1e16, 1e100, 1e300, -1e308] {
        let _ = ends_well(&format!("points moved by {by:e}"), &two_cells(moved(by), SCALARS));
    }
    // One point far from all others, infinitely far, or nowhere: the cell without it is drawn, or none.
    for x in [1e10, 1e100, 1e300, f64::MAX, f64::INFINITY, f64::NAN] {
        let mut points = POINTS;
        points[4] = [x, 1.0, 1.0];
        let image = ends_well(&format!("a point at {x:e}"), &two_cells(points, SCALARS));
        assert!(x.is_finite() || image.is_ok(), "the other cell is sound");
    }
    for value in [1e300, f64::MAX, -f64::MAX, 1e-300, f64::MIN_POSITIVE, 5e-324, f64::INFINITY, f64::NAN, -0.0] {
        let mut scalars = SCALARS;
        scalars[0] = value;
        let image = ends_well(&format!("a scalar of {value:e}"), &two_cells(POINTS, scalars));
        assert!(image.is_ok(), "{value:e}: {:?}", image.err());
        let _ = ends_well(&format!("scalars of {value:e}"), &two_cells(POINTS, scalars.map(|s| s * value)));
    }
    let ends = [f64::MAX, -f64::MAX, 0.0, f64::MAX, -f64::MAX];
    let _ = ends_well("scalars over all of f64", &two_cells(POINTS, ends));
    let subnormal = [0.0, 5e-324, 1e-323, 1.5e-323, 2e-323];
    let _ = ends_well("subnormal scalars", &two_cells(POINTS, subnormal));
}

/// What a reader would never hand over, from a program that uses the library: an error, no panic.
#[test]
fn hostile_datasets_that_contradict_themselves_are_refused() {
    let change = |what: &str, change: &dyn Fn(&mut UnstructuredCells)| {
        let mut dataset = two_cells(POINTS, SCALARS);
        if let Cells::Unstructured(cells) = &mut dataset.cells {
            change(cells);
        }
        let error = ends_well(what, &dataset).unwrap_err();
        assert!(error.contains("contradict"), "{what}: {error}");
    };
    change("a point beyond", &|cells| cells.connectivity[2] = 5);
    change("the largest index", &|cells| cells.connectivity[2] = u32::MAX);
    change("offsets that fall", &|cells| cells.offsets = vec![0, 8, 4]);
    change("offsets beyond", &|cells| cells.offsets[2] = usize::MAX);
    change("too few offsets", &|cells| cells.offsets = vec![0, 8]);
    change("no faces", &|cells| cells.kinds[0] = CellKind::Polyhedron);
    let block = |dims, first_point, hidden_points| Dataset {
        cells: Cells::Structured(vec![StructuredBlock { dims, first_point, hidden_points }]),
        ..two_cells(POINTS, SCALARS)
    };
    for (what, dataset) in [
        ("a block beyond the points", block([2, 2, 2], 0, Vec::new())),
        ("a block behind the points", block([1, 1, 5], usize::MAX, Vec::new())),
        ("a block of too many points", block([1 << 22, 1 << 22, 1 << 22], 0, Vec::new())),
        ("a block with a flag too few", block([5, 1, 1], 0, vec![true; 4])),
    ] {
        assert!(ends_well(what, &dataset).is_err(), "{what}");
    }
}
