//! What every version and form of a small file gives.

use tetrascope_mesh::{CellKind, Cells, DataArray, UnstructuredCells, decompose};

use super::sections::Version;
use super::synthetic::{Mesh, Style, View, file, read, styles};
use crate::{Loaded, MeshReader, ReadOptions, StepChoice};

pub(super) fn cells(loaded: &Loaded) -> &UnstructuredCells {
    match &loaded.dataset.cells {
        Cells::Unstructured(cells) => cells,
        Cells::Structured(_) => panic!("structured cells"),
    }
}

fn at(step: usize) -> ReadOptions {
    ReadOptions { step: StepChoice::Number(step), ..ReadOptions::default() }
}

fn array<'a>(arrays: &'a [DataArray], name: &str) -> &'a DataArray {
    arrays.iter().find(|array| array.name == name).unwrap_or_else(|| panic!("no array {name} in {arrays:?}"))
}

/// A file with a tetrahedron, a prism and a triangle, whose numbers are neither small nor in order, and data of all kinds at two
/// steps.
pub(super) fn small() -> (Mesh, Vec<View>) {
    let places = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [1., 0., 1.], [0., 1., 1.], [0.25, 0.25, 2.]];
    let numbers = [70, 3, 1_000_000, 5, 12, 8, 2];
    let [a, b, c, d, e, f, g] = numbers;
    let mesh = Mesh {
        nodes: numbers.into_iter().zip(places).collect(),
        blocks: vec![
            (2, 4, 0, 2, vec![(11, vec![a, c, b])]),
            (3, 6, 9, 6, vec![(20, vec![a, b, c, d, e, f])]),
            (3, 7, 0, 4, vec![(15, vec![d, e, f, g])]),
        ],
    };
    let nodal = |step: i64, factor: f64| View {
        kind: "NodeData",
        name: "height of it",
        step,
        time: factor / 4.0,
        components: 1,
        tuples: mesh.nodes.iter().map(|&(number, place)| (number, None, vec![place[2] * factor])).collect(),
    };
    let vectors = View {
        kind: "ElementData",
        name: "flow",
        step: 1,
        time: 0.5,
        components: 3,
        tuples: vec![(15, None, vec![1.0, 2.0, 3.0]), (20, None, vec![4.0, 5.0, 6.0])],
    };
    let corners = View {
        kind: "ElementNodeData",
        name: "jump",
        step: 1,
        time: 0.5,
        components: 1,
        tuples: vec![(15, Some(4), vec![1.0, 2.0, 3.0, 4.0]), (20, Some(6), vec![9.0, 8.0, 7.0, 3.0, 2.0, 1.0])],
    };
    let views = vec![nodal(0, 1.0), nodal(1, 2.0), vectors, corners];
    (mesh, views)
}

const TEXT: Style = Style { version: Version::V41, binary: None };
const OLD_TEXT: Style = Style { version: Version::V2, binary: None };

#[test]
fn every_version_and_form() {
    let (mesh, views) = small();
    for style in styles() {
        let bytes = file(style, &mesh, &views);
        assert!(super::GMSH.recognizes(&bytes), "{style:?}");
        let loaded = read("all.msh", &bytes, &ReadOptions::default()).unwrap_or_else(|e| panic!("{style:?}: {e}"));
        let places: Vec<[f64; 3]> = loaded.dataset.points.iter().map(|p| p.to_array()).collect();
        assert_eq!(places, mesh.nodes.iter().map(|node| node.1).collect::<Vec<_>>(), "{style:?}");
        let rows = cells(&loaded);
        assert_eq!(rows.kinds, [CellKind::Flat, CellKind::Wedge, CellKind::Tetrahedron]);
        assert_eq!(rows.offsets, [0, 3, 9, 13]);
        assert_eq!(rows.connectivity, [0, 2, 1, 0, 1, 2, 3, 4, 5, 3, 4, 5, 6]);

        assert_eq!((loaded.times.as_slice(), loaded.step), (&[0.25, 0.5][..], 1), "{style:?}");
        let [height, jump] = loaded.dataset.point_arrays.as_slice() else { panic!("{style:?}") };
        assert_eq!((height.name.as_str(), height.components), ("height of it", 1));
        assert_eq!(height.component(0), [0.0, 0.0, 0.0, 2.0, 2.0, 2.0, 4.0]);
        // Three points have a value of either cell.
        assert_eq!((jump.name.as_str(), jump.component(0)), ("jump", vec![9.0, 8.0, 7.0, 2.0, 2.0, 2.0, 4.0]));
        let flow = array(&loaded.dataset.cell_arrays, "flow");
        assert_eq!((&flow.component(0)[1..], &flow.component(2)[1..]), (&[4.0, 1.0][..], &[6.0, 3.0][..]));
        assert!(flow.component(1)[0].is_nan(), "the triangle has no value");
        let tags = |name| array(&loaded.dataset.cell_arrays, name).component(0);
        assert_eq!((tags("gmsh:physical"), tags("gmsh:geometrical")), (vec![0.0, 9.0, 0.0], vec![4.0, 6.0, 7.0]));
        assert_eq!(array(&loaded.dataset.cell_arrays, "gmsh:physical").values.type_name(), "Int32");
        assert_eq!(
            loaded.format.contains("9 `the solid` (volumes)"),
            style.version != Version::V1,
            "{}",
            loaded.format
        );
        assert_eq!(loaded.format.contains("binary"), style.binary.is_some(), "{}", loaded.format);
        // The one about averages.
        assert_eq!(loaded.warnings.len(), 1, "{style:?}: {:?}", loaded.warnings);
        assert!(loaded.warnings[0].contains("averaged"), "{:?}", loaded.warnings);
        let counts = decompose(&loaded.dataset).unwrap().counts;
        assert_eq!((counts.tetrahedra, counts.inverted, counts.flat), (4, 0, 1));
    }
}

#[test]
fn steps_by_time_and_number() {
    let (mesh, views) = small();
    let bytes = file(TEXT, &mesh, &views);
    let first = read("a.msh", &bytes, &at(0)).unwrap();
    assert_eq!(array(&first.dataset.point_arrays, "height of it").component(0)[6], 2.0);
    // What has one step alone belongs to all.
    assert_eq!(first.dataset.cell_arrays.len(), 3);
    let near = ReadOptions { step: StepChoice::Time(0.3), ..ReadOptions::default() };
    assert_eq!(read("a.msh", &bytes, &near).unwrap().step, 0);
    let none = read("a.msh", &bytes, &at(2)).unwrap_err().to_string();
    assert!(none.contains("no step 2") && none.contains("a.msh"), "{none}");

    // Times that say nothing: the numbers of the steps do.
    let mut same = views;
    same.iter_mut().for_each(|view| view.time = 0.0);
    let bytes = file(TEXT, &mesh, &same);
    let loaded = read("a.msh", &bytes, &at(0)).unwrap();
    assert_eq!((loaded.times.as_slice(), loaded.step), (&[0.0, 0.0][..], 0));
    assert_eq!(array(&loaded.dataset.point_arrays, "height of it").component(0)[6], 2.0);

    // A view that has several steps, but not this one.
    let other = |step: i64| View { step, time: step as f64, name: "late", ..nodal(&mesh) };
    let with = [other(3), other(4), View { name: "early", ..other(0) }, View { name: "early", ..other(3) }];
    let loaded = read("a.msh", &file(TEXT, &mesh, &with), &ReadOptions::default()).unwrap();
    assert_eq!(loaded.times, [0.0, 3.0, 4.0]);
    assert_eq!(loaded.dataset.point_arrays.len(), 1);
    assert!(loaded.warnings.iter().any(|w| w.contains("`early`") && w.contains("left out")), "{:?}", loaded.warnings);
}

fn nodal(mesh: &Mesh) -> View {
    let tuples = mesh.nodes.iter().map(|&(number, place)| (number, None, vec![place[0]])).collect();
    View { kind: "NodeData", name: "x", step: 0, time: 0.0, components: 1, tuples }
}

#[test]
fn parts_of_a_partition_share_an_array() {
    let (mesh, _) = small();
    let half = |keep: fn(usize) -> bool| {
        let mut view = nodal(&mesh);
        let mut place = 0;
        view.tuples.retain(|_| {
            place += 1;
            keep(place - 1)
        });
        view
    };
    let loaded = read("p.msh", &file(TEXT, &mesh, &[half(|i| i < 3), half(|i| i >= 3)]), &at(0)).unwrap();
    assert_eq!(loaded.dataset.point_arrays.len(), 1);
    assert_eq!(array(&loaded.dataset.point_arrays, "x").component(0), [0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.25]);
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);

    let part = read("p.msh", &file(TEXT, &mesh, &[half(|i| i < 3)]), &at(0)).unwrap();
    assert!(array(&part.dataset.point_arrays, "x").component(0)[3].is_nan());
    assert!(part.warnings[0].contains("no value at 4 points"), "{:?}", part.warnings);
}

/// Entities of a partitioned mesh are parts of others, whose tags a user knows.
#[test]
fn parts_of_entities() {
    let (mesh, _) = small();
    let text = String::from_utf8(file(TEXT, &mesh, &[])).unwrap();
    let parts = "$PartitionedEntities\n2\n1\n30 1\n0 0 0 2\n6 3 60 1 1 0 0 0 1 1 1 2 9 8 1 -5\n\
        7 3 60 2 1 2 0 0 0 1 1 1 1 9 0\n$EndPartitionedEntities\n$Nodes";
    let loaded = read("p.msh", text.replace("$Nodes\n2 7", &format!("{parts}\n2 7")).as_bytes(), &at(0)).unwrap();
    let tags = |name| array(&loaded.dataset.cell_arrays, name).component(0);
    assert_eq!((tags("gmsh:physical"), tags("gmsh:geometrical")), (vec![0.0, 9.0, 9.0], vec![4.0, 60.0, 60.0]));
    assert!(loaded.warnings[0].contains("several physical groups"), "{:?}", loaded.warnings);
}

/// As Gmsh appends views: the whole mesh with each of them.
#[test]
fn a_mesh_that_is_repeated_counts_once() {
    let (mesh, views) = small();
    for style in styles().into_iter().filter(|style| style.version != Version::V1) {
        let whole = file(style, &mesh, &views);
        let twice = [file(style, &mesh, &[]), whole.clone()].concat();
        let (one, two) = (read("a.msh", &whole, &at(1)).unwrap(), read("a.msh", &twice, &at(1)).unwrap());
        assert_eq!(one.dataset.points, two.dataset.points);
        assert_eq!(cells(&one).connectivity, cells(&two).connectivity, "{style:?}");
        assert_eq!(one.warnings, two.warnings);
        // The same mesh in another form.
        let mixed = read("a.msh", &[file(OLD_TEXT, &mesh, &[]), whole].concat(), &at(1)).unwrap();
        assert_eq!((mixed.dataset.points.len(), cells(&mixed).kinds.len()), (7, 3), "{style:?}");
        assert_eq!(mixed.dataset.point_arrays.len(), 2);
    }
}

/// Version 2 writes an element once for each of its physical groups.
#[test]
fn elements_of_several_groups_are_drawn_once() {
    let (mut mesh, views) = small();
    let mut again = mesh.blocks[2].clone();
    (again.2, again.4[0].0) = (5, 16);
    mesh.blocks.push(again);
    let loaded = read("g.msh", &file(OLD_TEXT, &mesh, &views), &at(1)).unwrap();
    assert_eq!(cells(&loaded).kinds.len(), 3);
    assert!(loaded.warnings[0].contains("1 elements repeat"), "{:?}", loaded.warnings);
}

#[test]
fn texts_of_other_programs() {
    let (mesh, views) = small();
    let text = String::from_utf8(file(OLD_TEXT, &mesh, &views)).unwrap();
    let reference = read("a.msh", text.as_bytes(), &at(1)).unwrap();
    for (name, other) in [
        ("line ends of Windows", text.replace('\n', "\r\n")),
        ("a byte-order mark", format!("\u{feff}{text}")),
        ("version 2", text.replace("2.2 0 8", "2 0 8")),
        ("exponents of Fortran", text.replace("0.25 0.25 2.0", "2.5D-1 2.5d-01 0.2D1")),
        ("words between sections", text.replace("$Nodes\n7", "hello\n\n$EndNothing\n$Nodes\n7")),
    ] {
        let loaded = read("a.msh", other.as_bytes(), &at(1)).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(super::GMSH.recognizes(other.as_bytes()), "{name}");
        assert_eq!(loaded.dataset.points, reference.dataset.points, "{name}");
        assert_eq!(loaded.warnings, reference.warnings, "{name}");
        assert_eq!(loaded.dataset.point_arrays[0].name, "height of it");
    }
    let unknown = text.replace("$Elements\n", "$Strange\n1 2 3\n$EndStrange\n$Elements\n");
    assert!(read("a.msh", unknown.as_bytes(), &at(1)).unwrap().warnings[0].contains("$Strange"));
    let beyond = text.replace("$EndNodes", "99 1 2 3\n$EndNodes");
    assert!(read("a.msh", beyond.as_bytes(), &at(1)).unwrap().warnings[0].contains("more than it declares"));
    let parametric = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$ParametricNodes\n5\n1 0 0 0 0 1\n2 1 0 0 1 1 0.5\n\
        3 0 1 0 2 1 0.5 0.5\n4 0 0 1 3 1\n9 5 5 5 3 1\n$EndParametricNodes\n$Elements\n1\n1 4 0 1 2 3 4\n$EndElements\n";
    let loaded = read("a.msh", parametric.as_bytes(), &at(0)).unwrap();
    assert_eq!((loaded.dataset.points.len(), decompose(&loaded.dataset).unwrap().counts.tetrahedra), (5, 1));
    assert!(loaded.dataset.cell_arrays.is_empty() && loaded.times.is_empty());
}
