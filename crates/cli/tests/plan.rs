//! `tetrascope plan` as a user runs it, and why pictures are blank, before and after.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use std::process::{Command, Output};

use serde_json::Value;

const SAMPLE: &str = "builtin:rings";

/// Runs the program in a folder of its own.
fn run(args: &[&str]) -> (Output, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("mesh.vtu"), MESH).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_tetrascope")).args(args).current_dir(folder.path()).output().unwrap();
    let files = std::fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
    let left = files.filter(|name| name != "mesh.vtu").collect();
    (output, left)
}

fn plan(args: &[&str]) -> Value {
    let (output, left) = run(&[&["plan"], args, &["--json"]].concat());
    assert_eq!(output.status.code(), Some(0), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    assert!(left.is_empty(), "nothing is written: {left:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Two tetrahedra, thin along z; a scalar from 0 to 4, and one that is 2.5 everywhere.
const MESH: &str = r#"<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="5" NumberOfCells="2">
<PointData>
<DataArray type="Float64" Name="s" format="ascii">0 1 2 3 4</DataArray>
<DataArray type="Float64" Name="flat" format="ascii">2.5 2.5 2.5 2.5 2.5</DataArray>
</PointData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0  1 0 0  0 1 0  0 0 0.01  1 1 0.01</DataArray></Points>
<Cells>
<DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3 1 2 3 4</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">4 8</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">10 10</DataArray>
</Cells></Piece></UnstructuredGrid></VTKFile>
"#;

fn effect<'a>(plan: &'a Value, name: &str) -> &'a Value {
    plan["effects"].as_array().unwrap().iter().find(|effect| effect["effect"] == name).unwrap()
}

#[test]
fn what_is_left_out_has_a_reason() {
    let plain = plan(&[SAMPLE, "--size", "64"]);
    for (name, is_done) in [
        ("emission", true),
        ("absorption", true),
        ("integration", true),
        ("pre-integration", false),
        ("isosurfaces", false),
        ("surfaces", false),
        ("lighting", false),
        ("order", true),
        ("sorting in pixels", false),
        ("perspective correction", true),
    ] {
        let effect = effect(&plain, name);
        assert_eq!(effect["is_done"], is_done, "{effect}");
        assert!(!effect["reason"].as_str().unwrap().is_empty(), "{effect}");
    }
    assert_eq!((&plain["table"], &plain["maps"]), (&Value::Null, &Value::Null));
    assert!(!plain["stages"].as_array().unwrap().iter().any(|stage| stage == "tabulate"));
    assert_eq!(plain["blank"], serde_json::json!([]));
    // A block of 24 hexahedra a side, five tetrahedra each.
    assert_eq!(plain["cells"]["all"], 5 * 24 * 24 * 24);
    assert_eq!(plain["mesh"]["points"], 25 * 25 * 25);

    let absorption = plan(&[SAMPLE, "--model", "absorption", "--orthographic", "4"]);
    for name in ["emission", "order", "perspective correction"] {
        assert_eq!(effect(&absorption, name)["is_done"], false, "{name}");
    }
}

#[test]
fn what_is_asked_for_has_its_cost() {
    let table = plan(&[SAMPLE, "--integration", "table-3d", "--table-size", "32"]);
    assert_eq!(
        (&table["table"]["entries"], &table["table"]["bytes"]),
        (&(32 * 32 * 32).into(), &(16 * 32 * 32 * 32).into())
    );
    assert_eq!(effect(&table, "pre-integration")["is_done"], true);
    let lit = plan(&[SAMPLE, "--isosurface", "0.1", "--shading", "smooth", "--extinction", "0:0"]);
    assert_eq!(effect(&lit, "lighting")["is_done"], true);
    // Nothing but the cells that the surface cuts.
    let [all, transparent] = ["all", "transparent"].map(|key| lit["cells"][key].as_u64().unwrap());
    assert!(transparent * 10 > all * 8 && transparent < all, "{transparent} of {all}");
    let text = String::from_utf8(run(&["plan", SAMPLE]).0.stdout).unwrap();
    for part in ["lighting", "left out", "tetrahedra", "estimate", "bytes", "MiB in all"] {
        assert!(text.contains(part), "{part} is not in:\n{text}");
    }
}

/// What is foreseen is what `render` reports: cells exactly, fragments within the error that is stated.
#[test]
fn the_plan_is_what_is_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let args = [SAMPLE, "--size", "128", "--extinction", "0:0; 0.2:0; 0.3:4", "--eye", "2,1,3"];
    let foreseen = plan(&args);
    let output = Command::new(env!("CARGO_BIN_EXE_tetrascope"))
        .arg("render")
        .args(args)
        .arg("--json")
        .current_dir(folder.path())
        .output()
        .unwrap();
    let drawn: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(foreseen["cells"]["transparent"], drawn["counts"]["transparent"]);
    let [estimate, error] = ["estimate", "standard_error"].map(|key| foreseen["fragments"][key].as_f64().unwrap());
    let fragments = drawn["counts"]["fragments"].as_f64().unwrap();
    // Opaque pixels end early, so fewer may be drawn; few are here.
    assert!(
        (fragments - estimate).abs() < 4.0 * error + 0.05 * fragments,
        "{fragments}, foreseen {estimate} ± {error}"
    );
}

/// Every reason, by both commands; a picture that shows something has none.
#[test]
fn blank_pictures_say_why_before_and_after() {
    for (options, parts) in [
        (
            &["--extinction", "7:0; 8:1", "--color", "7:1,1,1"][..],
            &["field goes from 0 to 4", "from 7 to 8, and the field lies outside of them"][..],
        ),
        (&["--extinction", "0:0; 4:0"], &["the extinction is 0", "from 0 to 4"]),
        (&["--extinction", "0:1e-4"], &["too small", "under one gray level"]),
        // Seen along the thin side a ray has a hundredth of a unit; across, it would show.
        (
            &["--extinction", "0:0.3", "--eye", "0.5,0.5,40", "--target", "0.5,0.5,0", "--fov", "2"],
            &["too small", "under one gray level"],
        ),
        (
            &["--field", "flat", "--extinction", "3:0; 4:1", "--color", "3:1,1,1"],
            &["the field is 2.5 everywhere", "from 3 to 4"],
        ),
        (&["--model", "emission", "--color", "0:0,0,0"], &["adds per length", "under one gray level"]),
        (&["--eye", "9,9,9", "--target", "50,50,50"], &["does not see the mesh", "behind it"]),
        (&["--extinction", "0:0", "--isosurface", "9"], &["meets no isosurface", "the extinction is 0"]),
    ] {
        for command in ["render", "plan"] {
            let (output, _) = run(&[&[command, "mesh.vtu", "--size", "32"], options].concat());
            let said = String::from_utf8(output.stderr).unwrap();
            assert_eq!(output.status.code(), Some(0), "{command} {options:?}: {said}");
            for part in ["blank", parts[0], parts[1]] {
                assert!(said.contains(part), "{command} {options:?}: \"{part}\" is not in {said}");
            }
        }
    }
    for options in [
        &[][..],
        &["--field", "flat"],
        &["--extinction", "0:0.3", "--eye", "40,0.5,0.005", "--target", "0.5,0.5,0.005", "--fov", "0.02"],
        &["--extinction", "0:0", "--isosurface", "2"],
    ] {
        for command in ["render", "plan"] {
            let (output, _) = run(&[&[command, "mesh.vtu", "--size", "32"], options].concat());
            let said = String::from_utf8(output.stderr).unwrap();
            assert!(output.status.success() && !said.contains("blank"), "{command} {options:?}: {said}");
        }
    }
}
