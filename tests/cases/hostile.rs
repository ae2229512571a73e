//! Every broken or odd file beside the repository, from the file to the picture.
//!
//! Whatever a file holds, the way ends in a picture of finite numbers or in an error that names the file; never in a panic.
//! `EXPECTED` says which of the two for each file, so that a change of either kind shows.

mod meshes;
mod scenes;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use glam::DVec3;
use tetrascope::{
    Backend, Cells, Choice, Dataset, Error, LinearImage, Picture, ReadOptions, SceneFile, Silent, UnstructuredCells,
    Volume, is_blank, render_volume,
};
use tetrascope_tests::pictures::{Worst, largest, mean_opacity};
use tetrascope_tests::{fuzz::check_whole, shared};

const SIDE: u32 = 64;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Outcome {
    /// Something to see.
    Picture,
    /// A blank picture that says so: the mesh is 1e-7 as thick as it is wide, and defaults go by its width.
    Blank,
    /// An error whose text has these words and names the file.
    Error(&'static str),
}
use Outcome::{Blank as DrawsNothing, Error as Fails, Picture as Draws};

const EXPECTED: &[(&str, Outcome)] = &[
    ("all_nan_scalars.vtu", Fails("no finite value")),
    ("array_name_empty.vtu", Draws),
    ("array_names_odd.vtu", Draws),
    ("array_names_repeated.vtu", Draws),
    ("bad_base64.vtu", Fails("base64")),
    ("connectivity_negative.vtu", Fails("point -3")),
    ("connectivity_out_of_range.vtu", Fails("point 999999")),
    ("constant_scalar.vtu", Draws),
    ("corrupt_zlib.vtu", Fails("zlib")),
    ("crlf.vtk", Draws),
    ("duplicate_points.vtu", Draws),
    ("empty_mesh.vtu", Fails("no points")),
    ("garbage_numbers.vtu", Fails("value 4")),
    ("huge_and_tiny_scalars.vtu", Draws),
    ("huge_block_header.vtu", Fails("4611686018427387904")),
    ("huge_count.msh", Fails("$Nodes, line")),
    ("huge_count.vtk", Fails("48000000000")),
    ("huge_count.vtu", Fails("12000000000000")),
    ("huge_count_overflow.vtu", Fails("18446744073709551615")),
    ("huge_dims_plot3d.xyz", Fails("2147483647x2147483647x2147483647")),
    ("huge_sizes.nrrd", Fails("3000000000x3000000000x3000000000 samples")),
    ("huge_zlib_block_count.vtu", Fails("72057594037927935")),
    ("inverted_tets.vtu", Draws),
    ("legacy_vtk_named.msh", Draws),
    ("missing_data_file.nhdr", Fails("`does_not_exist.raw` cannot be read")),
    ("nan_coordinates.vtu", Draws),
    ("nan_inf_scalars_ascii.vtu", Draws),
    ("nan_inf_scalars_binary.vtu", Draws),
    ("nanometres.vtu", Draws),
    ("negative_dims_plot3d.xyz", Fails("-4x5x6")),
    ("no_3d_cells.vtu", Fails("no three-dimensional cell")),
    ("no_arrays.vtu", Fails("no point or cell array")),
    ("no_piece.vtu", Fails("Piece")),
    ("nonconforming_faces.vtu", Draws),
    ("offsets_not_monotone.vtu", Fails("offsets")),
    ("offsets_past_end.vtu", Fails("offsets")),
    ("overlapping_tets.vtu", Draws),
    ("png_named.vtu", Fails("PNG")),
    ("points_but_no_cells.vtu", Fails("no cells")),
    ("polydata_as_vtu.vtu", Fails("PolyData")),
    ("q_dims_differ.q", Fails("solution")),
    ("q_dims_differ.xyz", Fails("3x5x4")),
    ("repeated_vertex_cells.vtu", Draws),
    ("scalar_wrong_length.vtu", Fails("100 values")),
    ("scale_1e20.vtu", Draws),
    ("short_data.nrrd", Fails("4096 samples")),
    ("sliver_aspect_1e7.vtu", DrawsNothing),
    ("tet_with_three_points.vtu", Draws),
    ("truncated_appended_raw.vtu", Fails("are left")),
    ("truncated_appended_zlib.vtu", Fails("are left")),
    ("truncated_ascii.vtu", Fails("ends")),
    ("truncated_binary.vtk", Fails("are left")),
    ("unknown_cell_type.vtu", Draws),
    ("utf8_bom.vtu", Draws),
    ("utm_offset_float32.vtu", Draws),
    ("utm_offset_float64.vtu", Draws),
    ("vtu_named.vtk", Draws),
    ("xml_deep_nesting.vtu", Fails("Piece")),
    ("xml_entity_bomb.vtu", Fails("entities are not expanded")),
    ("zero_bytes.vtu", Fails("empty")),
    ("zero_volume_tets.vtu", Draws),
    ("zlib_bomb.vtu", Fails("inflates")),
];

fn folder(test: &str) -> Option<PathBuf> {
    Some(shared::folder(test)?.join("data/hostile"))
}

fn scene(backend: Backend) -> SceneFile {
    let mut scene = SceneFile::of_mesh("in memory");
    (scene.image.width, scene.image.height) = (SIDE, SIDE);
    scene.quality.backend = Choice::Named(backend);
    scene
}

fn draw(path: &Path, backend: Backend) -> Result<Picture, Error> {
    // The one PLOT3D solution here belongs to the grid of the same name.
    let solution = path.with_extension("q");
    let is_grid = path.extension().is_some_and(|e| e == "xyz") && solution.is_file();
    let volume = Volume::load(path, &ReadOptions::with_solution(is_grid.then_some(solution.as_path())))?;
    render_volume(&volume, &scene(backend), &Silent)
}

/// File, place and remedy: as fields of an error of a file, which are not empty; in the words of all others, whose place is the mesh or the
/// field, the remedy stands behind a colon or a semicolon.
fn names_all(error: &Error, path: &Path) -> bool {
    let text = error.to_string();
    let behind = text.split_once(&format!("{}: ", path.display())).map(|(_, words)| words);
    let remedies = ["; ", ": check", ": only cells", "choose another"];
    match error {
        Error::Io(_) => check_whole(error, path).is_ok(),
        Error::Mesh { .. } | Error::Field { .. } => {
            let place =
                behind.is_some_and(|words| ["the mesh", "the field", "the file"].iter().any(|p| words.starts_with(p)));
            place && remedies.iter().any(|remedy| text.contains(remedy)) && check_whole(error, path).is_ok()
        }
        _ => false,
    }
}

/// Colors are finite and not negative, opacities from 0 to 1.
fn is_sound(image: &LinearImage) -> bool {
    image.pixels().iter().all(|p| p.iter().all(|c| c.is_finite() && *c >= 0.0) && p[3] <= 1.0)
}

#[test]
fn hostile_files_end_in_a_picture_or_in_an_error() {
    let Some(folder) = folder("hostile files") else { return };
    let mut names: Vec<String> =
        std::fs::read_dir(&folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    let mut failures = Vec::new();
    for name in &names {
        let result = catch_unwind(AssertUnwindSafe(|| draw(&folder.join(name), Backend::Cpu)));
        let expected = EXPECTED.iter().find(|(expected, _)| expected == name).map(|(_, outcome)| *outcome);
        let found = match &result {
            Err(_) => "panic".to_owned(),
            Ok(Err(error)) => format!("error: {error}"),
            Ok(Ok(picture)) => {
                let blank = if is_blank(&picture.image) { ", blank" } else { "" };
                let sound = if is_sound(&picture.image) { "" } else { ", with unsound pixels" };
                format!("picture of opacity {:.4}{blank}{sound}, {:?}", mean_opacity(&picture.image), picture.warnings)
            }
        };
        println!("{name}: {found}");
        let is_right = match (&result, expected) {
            (Ok(Ok(picture)), Some(Draws)) => !is_blank(&picture.image) && is_sound(&picture.image),
            (Ok(Ok(picture)), Some(DrawsNothing)) => {
                is_blank(&picture.image)
                    && is_sound(&picture.image)
                    && picture.warnings.iter().any(|w| w.contains("blank"))
            }
            (Ok(Err(error)), Some(Fails(words))) => {
                let text = error.to_string();
                // The solution is named where it does not fit its grid.
                text.contains(words)
                    && text.contains(name.trim_end_matches("xyz"))
                    && names_all(error, &folder.join(name))
            }
            _ => false,
        };
        if !is_right {
            failures.push(format!("{name}: {expected:?} expected, found {found}"));
        }
    }
    for (name, _) in EXPECTED {
        if !names.iter().any(|n| n == name) {
            failures.push(format!("{name} is gone"));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

/// What is said of a file that is drawn although something in it is odd.
const SAID: &[(&str, &[&str])] = &[
    ("array_name_empty.vtu", &["point array has no name", "`unnamed1`"]),
    ("array_names_repeated.vtu", &["two point arrays are named `s`", "`s_2`"]),
    ("constant_scalar.vtu", &["the field is 2.5 everywhere"]),
    ("inverted_tets.vtu", &["160 of 320 tetrahedra were inverted"]),
    ("legacy_vtk_named.msh", &["named .msh", "its content is VTK legacy"]),
    ("nan_coordinates.vtu", &["32 cells use points whose coordinates are not finite"]),
    ("nan_inf_scalars_ascii.vtu", &["38 of 320 tetrahedra are left out", "5 points"]),
    ("nan_inf_scalars_binary.vtu", &["38 of 320 tetrahedra are left out", "5 points"]),
    ("nonconforming_faces.vtu", &["2 of 3 tetrahedra were inverted"]),
    ("overlapping_tets.vtu", &["the mesh overlaps itself", "1 pairs of tetrahedra"]),
    ("repeated_vertex_cells.vtu", &["2 of 320 tetrahedra have no volume"]),
    ("sliver_aspect_1e7.vtu", &["the picture is blank"]),
    ("tet_with_three_points.vtu", &["cell 3 (Tetrahedron) has 3 points, its kind has 4"]),
    ("unknown_cell_type.vtu", &["VTK's type 250", "points, lines or faces"]),
    ("utm_offset_float32.vtu", &["160 of 320 tetrahedra have no volume"]),
    ("vtu_named.vtk", &["named .vtk", "its content is VTK XML"]),
    ("zero_volume_tets.vtu", &["3 of 43 tetrahedra have no volume"]),
];

#[test]
fn hostile_files_that_are_drawn_say_what_is_odd() {
    let Some(folder) = folder("what is odd in hostile files") else { return };
    for (name, words) in SAID {
        let volume = load(&folder, name);
        let picture = render_volume(&volume, &scene(Backend::Cpu), &Silent).unwrap();
        // As the program tells it: of the file, of the cells, and of the picture.
        let said = [&volume.warnings[..], &volume.decomposition.counts.findings(), &picture.warnings].concat();
        let field = volume.field(None).unwrap();
        let said = [&said[..], &field.on_mesh.warning().into_iter().collect::<Vec<_>>()].concat().join("\n");
        for word in *words {
            assert!(said.contains(word), "{name}: \"{word}\" is not in: {said}");
        }
    }
}

/// The opacity of both renderers agrees on every file that gives a picture: neither order nor f32 can explain a difference of
/// more than 2e-5, the limit of the reference pictures.
#[test]
fn hostile_files_look_the_same_to_both_renderers() {
    let Some(folder) = folder("hostile files by both renderers") else { return };
    let mut worst = Worst::new("hostile files, opacity of fast against reference", 2e-5);
    assert!(EXPECTED.iter().filter(|(_, outcome)| *outcome == Draws).count() > 20);
    for (name, _) in EXPECTED.iter().filter(|(_, outcome)| *outcome == Draws) {
        let path = folder.join(name);
        let fast = draw(&path, Backend::Cpu).unwrap().image;
        let slow = draw(&path, Backend::Reference).unwrap().image;
        worst.note(largest(&fast, &slow, 3..4), || (*name).to_owned());
    }
    worst.finish();
}

fn load(folder: &Path, name: &str) -> Volume {
    Volume::load(&folder.join(name), &ReadOptions::default()).unwrap()
}

fn picture_of(volume: &Volume) -> LinearImage {
    let image = render_volume(volume, &scene(Backend::Cpu), &Silent).unwrap().image;
    assert!(!is_blank(&image));
    image
}

fn cells_of(dataset: &mut Dataset) -> &mut UnstructuredCells {
    match &mut dataset.cells {
        Cells::Unstructured(cells) => cells,
        Cells::Structured(_) => panic!("a block"),
    }
}

/// To the bit: which way round a cell's points are named is gone after it is loaded.
#[test]
fn inverted_tetrahedra_give_the_picture_of_upright_ones() {
    let Some(folder) = folder("inverted tetrahedra") else { return };
    let inverted = load(&folder, "inverted_tets.vtu");
    assert_eq!(inverted.decomposition.counts.inverted, 160);

    // Turned here.
    let mut dataset = inverted.dataset.clone();
    let cells = cells_of(&mut dataset);
    for cell in (0..cells.kinds.len()).step_by(2) {
        cells.connectivity.swap(cells.offsets[cell] + 1, cells.offsets[cell] + 2);
    }
    let upright = Volume::from_dataset(dataset, "upright").unwrap();
    assert_eq!(upright.decomposition.counts.inverted, 0);
    assert_eq!(picture_of(&inverted), picture_of(&upright));

    // As another file has them.
    let twin = load(&folder, "utf8_bom.vtu");
    assert_eq!(twin.dataset.points, upright.dataset.points);
    assert_eq!(picture_of(&inverted), picture_of(&twin));
}

/// Cells that share no point numbers are still side by side: opacity, which no order changes, is the same within 1e-5. The faces
/// of such cells have their planes from points in another order, so the last bits differ.
#[test]
fn duplicate_points_give_the_picture_of_shared_ones() {
    let Some(folder) = folder("duplicate points") else { return };
    let apart = load(&folder, "duplicate_points.vtu");
    let mut dataset = apart.dataset.clone();
    let points = dataset.points.clone();
    let first_at = |p: DVec3| points.iter().position(|q| *q == p).unwrap() as u32;
    for corner in &mut cells_of(&mut dataset).connectivity {
        *corner = first_at(points[*corner as usize]);
    }
    let shared = Volume::from_dataset(dataset, "shared points").unwrap();
    let difference = largest(&picture_of(&apart), &picture_of(&shared), 3..4);
    println!("duplicate points: opacity differs by {difference:e}");
    assert!(difference < 1e-5, "{difference:e}");
}

/// The same box at three sizes and far from the origin, with the same field: defaults make the same picture of the boxes that are
/// cubes, and none is blank.
#[test]
fn tiny_huge_and_distant_boxes_are_seen() {
    let Some(folder) = folder("tiny, huge and distant boxes") else { return };
    let usual = load(&folder, "utf8_bom.vtu");
    let expected = picture_of(&usual);
    for name in ["nanometres.vtu", "scale_1e20.vtu", "utm_offset_float64.vtu", "utm_offset_float32.vtu"] {
        let volume = load(&folder, name);
        let image = picture_of(&volume);
        println!("{name}: opacity {}, usual {}", mean_opacity(&image), mean_opacity(&expected));
        assert!(mean_opacity(&image) > 0.5 * mean_opacity(&expected), "{name}");
    }
}
