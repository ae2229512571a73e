//! What can be known of the comparison without VTK.

use super::*;
use tetrascope::{Camera, OpticalModel};
use tetrascope_tests::hard::{scene_of, volume_of};

fn flat(value: f32) -> LinearImage {
    let mut image = LinearImage::transparent(4, 2);
    image.pixels_mut().fill([value, 0.0, 0.0, 1.0]);
    image
}

fn row(name: &str, projected: f32, ray_cast: Result<f32, &str>) -> Row {
    let errors = |value: f32| Errors::between(&flat(value), &flat(0.0));
    let vtk = |drawn| Vtk { drawn, ..Vtk::default() };
    Row {
        name: name.to_owned(),
        ours: errors(1e-6),
        projected: vtk(Ok(errors(projected))),
        ray_cast: vtk(ray_cast.map(errors).map_err(str::to_owned)),
    }
}

#[test]
fn errors_are_known_channel_by_channel() {
    let mut drawn = flat(0.25);
    drawn.pixels_mut()[3] = [0.75, 0.01, 0.0, 1.0];
    let errors = Errors::between(&drawn, &flat(0.25));
    assert_eq!(errors.largest, [0.5, f64::from(0.01_f32), 0.0, 0.0]);
    assert!((errors.rms[0] - (0.25_f64 / 8.0).sqrt()).abs() < 1e-12);
    assert_eq!(errors.share, 1.0 / 8.0);
    drawn.pixels_mut()[0][2] = f32::NAN;
    assert_eq!(Errors::between(&drawn, &flat(0.25)).worst(), f64::INFINITY);
}

#[test]
fn absence_is_said_with_what_to_do() {
    let folder = std::env::temp_dir();
    let python = Path::new("a-python-that-is-not-there");
    let reason = vtk::version(python, &folder.join("vtk_mappers.py")).expect_err("there is no such program");
    let words = vtk::absent(python, &reason);
    for part in ["SKIPPED", "a-python-that-is-not-there", "-m venv", "pip install vtk", "--python"] {
        assert!(words.contains(part), "{part}: {words}");
    }
}

/// Nothing that a Python without VTK does fails the task.
#[test]
fn a_machine_without_vtk_is_no_failure() {
    let output = std::env::temp_dir().join(format!("tetrascope-peers-{}", std::process::id()));
    let args =
        Args { python: "a-python-that-is-not-there".into(), output: Some(output.clone()), case: None, files: true };
    run(&args).expect("it is skipped");
    fs::remove_dir_all(output).expect("the folder was made");
}

#[test]
fn jobs_hold_every_number_of_the_scene() {
    let camera = Camera {
        eye: glam::DVec3::new(1.0, 2.0, 3.5),
        target: glam::DVec3::ZERO,
        up: glam::DVec3::Y,
        projection: tetrascope::Projection::Perspective { fov_y: 0.5 },
    };
    let points = [glam::DVec3::ZERO, glam::DVec3::X, glam::DVec3::Y, glam::DVec3::Z];
    let volume = volume_of(&points, &[[0, 1, 2, 3]], &[0.0, 1.0, 2.0, 3.0]);
    let scene = scene_of(&camera, [30, 20], &[[0.0, 0.1, 0.2, 0.3]], &[[0.0, 0.0], [3.0, 7.5]]);
    assert_eq!(job::untranslatable(&scene), None);
    let field = volume.field(None).expect("it has one");
    let completed = scene.complete(&field.facts).expect("all is there").scene;
    let json = job::common(&completed, true);
    assert_eq!(json["camera"]["eye"], serde_json::json!([1.0, 2.0, 3.5]));
    assert_eq!(json["camera"]["projection"], "perspective");
    assert!((json["camera"]["fov_y"].as_f64().expect("a number") - 0.5_f64.to_degrees()).abs() < 1e-12);
    assert_eq!(json["size"], serde_json::json!([30, 20]));
    assert_eq!(json["extinction"], serde_json::json!([[0.0, 0.0], [3.0, 7.5]]));
    assert_eq!(json["color"], serde_json::json!([[0.0, 0.1, 0.2, 0.3]]));
    assert_eq!(json["merged"], true);

    let mut other = scene;
    other.optics.model = OpticalModel::Absorption;
    assert!(job::untranslatable(&other).is_some());
}

#[test]
fn pictures_are_floats_in_fours() {
    let bytes: Vec<u8> = [0.5_f32, 0.25, 1.0, 0.0, 1.0, 2.0, 3.0, 4.0].iter().flat_map(|f| f.to_ne_bytes()).collect();
    assert_eq!(vtk::pixels(&bytes), Some(vec![[0.5, 0.25, 1.0, 0.0], [1.0, 2.0, 3.0, 4.0]]));
    assert_eq!(vtk::pixels(&bytes[1..]), None);
}

#[test]
fn the_table_has_a_row_a_case_and_says_crashes() {
    let rows = [row("control", 0.001, Ok(0.003)), row("cells-of-no-volume", 0.25, Err("crash, signal 11"))];
    let table = table::table(&rows);
    let bars: Vec<_> = table.lines().map(|line| line.matches('|').count()).collect();
    assert_eq!(bars, [5; 4], "{table}");
    assert!(table.contains("| crash, signal 11 |"), "{table}");
    assert!(table.contains("max 0.250 0 0 0<br>RMS 0.250 0 0 0<br>100 % off"), "{table}");
}

#[test]
fn faults_are_confirmed_by_figures_alone() {
    let seen = [row("off-center-diagonals", 0.25, Ok(0.0)), row("cells-of-no-volume", 0.0, Err("crash, signal 11"))];
    let text = faults::sentences(&seen);
    assert_eq!(text.matches(" Confirmed on ").count(), 2, "{text}");
    let unseen = [row("off-center-diagonals", 0.01, Ok(0.0)), row("cells-of-no-volume", 0.0, Ok(0.0))];
    let text = faults::sentences(&unseen);
    assert_eq!(text.matches(" Not confirmed on ").count(), 2, "{text}");
    assert_eq!(faults::sentences(&[row("control", 0.9, Ok(0.9))]), "");
}

#[test]
fn faults_name_scenes_that_are_there() {
    let names: Vec<_> = peers::all().iter().map(|peer| peer.name).collect();
    for scene in faults::scenes() {
        assert!(names.contains(&scene), "{scene}");
    }
    assert_eq!(subjects().first().map(|subject| subject.name.clone()), Some(peers::CONTROL.to_owned()));
}

#[test]
fn documents_keep_what_others_wrote() {
    let new = table::in_document(None, "one\n");
    assert!(new.starts_with("# Hard cases\n\n## What VTK draws\n"), "{new}");
    let changed = table::in_document(Some(&format!("{new}\n## More\n")), "two\n");
    assert!(changed.contains("two") && !changed.contains("one") && changed.ends_with("\n## More\n"), "{changed}");
    let added = table::in_document(Some("# Hard cases\n\ntext\n"), "one\n");
    assert!(added.starts_with("# Hard cases\n\ntext\n\n## What VTK draws\n"), "{added}");
}
