//! Fields that are one constant a cell: every way against the reference, and against the same field at the points.

use tetrascope::{ArrayValues, Cells, Choice, DataArray, OrderMethod, SceneFile, StructuredBlock, Volume};
use tetrascope_tests::compare::difference;
use tetrascope_tests::meshes::{Random, bent_block_dataset};
use tetrascope_tests::ways::Way;

/// A bent block with a random constant a cell, some of which are no number, and the constant 1 at points and cells.
fn volume(seed: u64) -> Volume {
    let mut dataset = bent_block_dataset(4, 0.1, seed);
    let cells = match &dataset.cells {
        Cells::Unstructured(cells) => cells.kinds.len(),
        Cells::Structured(blocks) => blocks.iter().map(StructuredBlock::cell_count).sum(),
    };
    let mut random = Random::new(seed);
    let array = |name: &str, values: Vec<f64>| DataArray {
        name: name.to_owned(),
        components: 1,
        values: ArrayValues::F64(values),
    };
    let constants = (0..cells).map(|cell| if cell % 13 == 5 { f64::NAN } else { random.unit() }).collect();
    dataset.cell_arrays = vec![array("c", constants), array("one", vec![1.0; cells])];
    dataset.point_arrays = vec![array("one", vec![1.0; dataset.points.len()])];
    Volume::from_dataset(dataset, "block").unwrap()
}

fn scene(eye: [f64; 3], field: &str) -> SceneFile {
    let text = format!(
        "[mesh]\npath = \"block\"\nfield = \"{field}\"\ncells = true\n[image]\nwidth = 48\nheight = 48\n[camera]\neye = {eye:?}\n\
         [transfer]\ncolor = [[0.0, 1.0, 0.0, 0.0], [0.4, 0.0, 1.0, 0.0], [0.4, 0.0, 0.0, 1.0], [1.0, 1.0, 1.0, 0.0]]\n\
         extinction = [[0.0, 0.2], [0.7, 4.0], [0.7, 0.0], [1.0, 2.0]]\n"
    );
    SceneFile::parse(&text, "constants.toml".as_ref()).unwrap()
}

#[test]
fn constants_of_cells_are_the_same_in_every_way() {
    let mut largest = 0.0_f64;
    for seed in 0..3 {
        let volume = volume(seed);
        for eye in [[3.0, 2.0, 4.0], [0.05, -0.1, 0.2], [0.0, 0.0, -5.0]] {
            let mut scene = scene(eye, "c");
            let exact = Way::Reference.draw(&volume, &scene).unwrap().image;
            assert!(exact.pixels().iter().flatten().any(|channel| *channel > 0.1));
            for order in [OrderMethod::BspXmpvo, OrderMethod::PerPixel] {
                scene.quality.order = Choice::Named(order);
                for way in Way::here("constants") {
                    if way == Way::Reference || (order == OrderMethod::PerPixel && way == Way::Triangles) {
                        continue;
                    }
                    let found = difference(&way.draw(&volume, &scene).unwrap().image, &exact, 1e-5, &[]);
                    largest = largest.max(found.largest);
                    assert!(found.largest < 2e-5, "seed {seed}, {eye:?}, {order:?}, {way}: {found:?}");
                }
            }
        }
    }
    println!("constants a cell: at most {largest:.1e} from the reference");
}

#[test]
fn cells_that_share_a_constant_are_as_points_that_do() {
    let volume = volume(9);
    for way in Way::here("constants") {
        let mut scene = scene([3.0, 2.0, 4.0], "one");
        let by_cells = way.draw(&volume, &scene).unwrap().image;
        scene.mesh.cells = false;
        let by_points = way.draw(&volume, &scene).unwrap().image;
        assert_eq!(by_cells.pixels(), by_points.pixels(), "{way}");
    }
}
