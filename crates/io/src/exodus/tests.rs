//! Small files made here: every form of NetCDF, every order of nodes, both layouts, what is missing and what is odd.

use glam::DVec3;
use netcdf_writer::{NcAttrValue, NcFileBuilder, NcWriteOptions};
use tetrascope_mesh::{CellKind, Cells, Dataset, TetMesh, UnstructuredCells, VertexId, decompose};

use super::EXODUS;
use crate::{IoError, Loaded, MeshReader, ReadOptions, Source, StepChoice};

/// One block: type, nodes an element, nodes from 1.
pub(super) type TestBlock<'a> = (&'a str, usize, &'a [i32]);

/// A value by point and time.
pub(super) type NodeValue = fn(DVec3, f64) -> f64;

/// What a file is made of.
#[derive(Clone, Default)]
pub(super) struct Parts<'a> {
    pub(super) points: Vec<DVec3>,
    pub(super) blocks: Vec<TestBlock<'a>>,
    pub(super) times: Vec<f64>,
    /// Node variables: their value is that of the function at the point and the time.
    pub(super) nodes: Vec<(&'a str, NodeValue)>,
    /// Element variables and the blocks that have them; the value is 100 variable + 10 block + number + time.
    pub(super) elements: Vec<(&'a str, &'a [usize])>,
    /// As Exodus 2 laid it out.
    pub(super) is_old: bool,
}

/// The bytes of a file.
pub(super) fn file(parts: &Parts<'_>, options: NcWriteOptions) -> Vec<u8> {
    let mut file = NcFileBuilder::new();
    let length = file.add_dimension("len_string", 33).unwrap();
    let time = file.add_unlimited_dimension("time_step").unwrap();
    let dims = file.add_dimension("num_dim", 3).unwrap();
    let nodes = file.add_dimension("num_nodes", parts.points.len() as u64).unwrap();
    let blocks = file.add_dimension("num_el_blk", parts.blocks.len() as u64).unwrap();
    let times = file.add_variable::<f64>("time_whole", &[time]).unwrap();
    file.write_variable(times, &parts.times).unwrap();
    let ids: Vec<i32> = (1..=parts.blocks.len() as i32).map(|number| 10 * number).collect();
    let id = file.add_variable::<i32>("eb_prop1", &[blocks]).unwrap();
    file.write_variable(id, &ids).unwrap();
    let axis = |axis: usize| parts.points.iter().map(move |point| point[axis]).collect::<Vec<f64>>();
    if parts.is_old {
        let coordinates = file.add_variable::<f64>("coord", &[dims, nodes]).unwrap();
        file.write_variable(coordinates, &[axis(0), axis(1), axis(2)].concat()).unwrap();
    } else {
        for (number, name) in ["coordx", "coordy", "coordz"].into_iter().enumerate() {
            let variable = file.add_variable::<f64>(name, &[nodes]).unwrap();
            file.write_variable(variable, &axis(number)).unwrap();
        }
    }
    let mut elements = Vec::new();
    for (index, &(name, size, connectivity)) in parts.blocks.iter().enumerate() {
        let number = index + 1;
        let count = (connectivity.len() / size) as u64;
        let own = file.add_dimension(format!("num_el_in_blk{number}"), count).unwrap();
        let per = file.add_dimension(format!("num_nod_per_el{number}"), size as u64).unwrap();
        let connect = file.add_variable::<i32>(format!("connect{number}"), &[own, per]).unwrap();
        file.add_variable_attribute(connect, "elem_type", NcAttrValue::Chars(name.to_owned())).unwrap();
        file.write_variable(connect, connectivity).unwrap();
        elements.push((own, count));
    }
    if !parts.nodes.is_empty() {
        let count = file.add_dimension("num_nod_var", parts.nodes.len() as u64).unwrap();
        let names = file.add_char_variable("name_nod_var", &[count, length]).unwrap();
        let texts: Vec<&str> = parts.nodes.iter().map(|node| node.0).collect();
        file.write_char_variable_strings(names, &texts).unwrap();
        let values =
            |value: fn(DVec3, f64) -> f64, time: f64| parts.points.iter().map(move |&point| value(point, time));
        if parts.is_old {
            let all = file.add_variable::<f64>("vals_nod_var", &[time, count, nodes]).unwrap();
            let each =
                parts.times.iter().flat_map(|&time| parts.nodes.iter().flat_map(move |node| values(node.1, time)));
            file.write_variable(all, &each.collect::<Vec<_>>()).unwrap();
        } else {
            for (index, &(_, value)) in parts.nodes.iter().enumerate() {
                let one = file.add_variable::<f64>(format!("vals_nod_var{}", index + 1), &[time, nodes]).unwrap();
                let each = parts.times.iter().flat_map(|&time| values(value, time));
                file.write_variable(one, &each.collect::<Vec<_>>()).unwrap();
            }
        }
    }
    if !parts.elements.is_empty() {
        let count = file.add_dimension("num_elem_var", parts.elements.len() as u64).unwrap();
        let names = file.add_char_variable("name_elem_var", &[count, length]).unwrap();
        let texts: Vec<&str> = parts.elements.iter().map(|element| element.0).collect();
        file.write_char_variable_strings(names, &texts).unwrap();
        for (index, &(_, blocks)) in parts.elements.iter().enumerate() {
            for &block in blocks {
                let (own, count) = elements[block - 1];
                let name = format!("vals_elem_var{}eb{block}", index + 1);
                let variable = file.add_variable::<f32>(name, &[time, own]).unwrap();
                let start = (100 * (index + 1) + 10 * block) as f32;
                let each = parts.times.iter().flat_map(|&time| (0..count).map(move |n| start + n as f32 + time as f32));
                file.write_variable(variable, &each.collect::<Vec<f32>>()).unwrap();
            }
        }
    }
    file.to_vec(options).unwrap().1
}

pub(super) fn read(bytes: Vec<u8>, step: StepChoice) -> Result<Loaded, IoError> {
    let options = ReadOptions { step, ..ReadOptions::default() };
    EXODUS.read(&Source { path: "made.exo".into(), bytes, options })
}

fn cells(dataset: &Dataset) -> &UnstructuredCells {
    match &dataset.cells {
        Cells::Unstructured(cells) => cells,
        Cells::Structured(_) => panic!("structured cells"),
    }
}

/// A tetrahedron and a hexahedron that share no node, with a vector, a scalar, and an element variable for one of them.
pub(super) fn two_blocks<'a>(is_old: bool) -> Parts<'a> {
    let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
    let corner = |corner: [i32; 3]| DVec3::from_array(corner.map(f64::from));
    let apart = corners[..3].iter().chain(&corners[4..5]).map(|&c| corner(c) + DVec3::X * 3.0);
    Parts {
        points: corners.iter().map(|&c| corner(c)).chain(apart).collect(),
        blocks: vec![("HEX", 8, &[1, 2, 3, 4, 5, 6, 7, 8]), ("TETRA4", 4, &[9, 10, 11, 12])],
        times: vec![0.0, 0.5, 2.0],
        nodes: vec![
            ("p", |point, time| point.x + time),
            ("v_x", |point, _| point.x),
            ("v_y", |point, _| point.y),
            ("v_z", |point, time| point.z * time),
        ],
        elements: vec![("both", &[1, 2]), ("second", &[2])],
        is_old,
    }
}

#[test]
fn all_forms_of_netcdf_and_both_layouts() {
    let forms = [
        (NcWriteOptions::classic(), "CDF-1"),
        (NcWriteOptions::offset64(), "CDF-2"),
        (NcWriteOptions::cdf5(), "CDF-5"),
        (NcWriteOptions { format: netcdf_writer::NcWriteFormat::Nc4Classic }, "NetCDF-4"),
    ];
    for (options, form) in forms {
        for is_old in [false, true] {
            let bytes = file(&two_blocks(is_old), options);
            assert!(EXODUS.recognizes(&bytes));
            for (step, time) in [(0, 0.0), (1, 0.5), (2, 2.0)] {
                let loaded =
                    read(bytes.clone(), StepChoice::Time(time)).unwrap_or_else(|error| panic!("{form}: {error}"));
                assert!(loaded.format.contains(form), "{}", loaded.format);
                assert_eq!((loaded.times.as_slice(), loaded.step), (&[0.0, 0.5, 2.0][..], step));
                check_two_blocks(&loaded, time);
            }
        }
    }
}

fn check_two_blocks(loaded: &Loaded, time: f64) {
    let dataset = &loaded.dataset;
    assert_eq!(cells(dataset).kinds, [CellKind::Hexahedron, CellKind::Tetrahedron]);
    assert_eq!(cells(dataset).connectivity, (0..12).collect::<Vec<u32>>());
    let [p, v] = dataset.point_arrays.as_slice() else { panic!("{:?}", dataset.point_arrays) };
    assert_eq!((p.name.as_str(), v.name.as_str(), v.components), ("p", "v_", 3));
    for (index, point) in dataset.points.iter().enumerate() {
        assert_eq!(p.values.to_f64()[index], point.x + time);
        assert_eq!(v.values.to_f64()[3 * index..3 * index + 3], [point.x, point.y, point.z * time]);
    }
    let [both, second, id] = dataset.cell_arrays.as_slice() else { panic!("{:?}", dataset.cell_arrays) };
    assert_eq!((both.name.as_str(), both.values.type_name()), ("both", "Float32"));
    assert_eq!(both.values.to_f64(), [110.0 + time, 120.0 + time]);
    let values = second.values.to_f64();
    assert!(values[0].is_nan() && values[1] == 220.0 + time && second.values.type_name() == "Float32");
    assert_eq!((id.name.as_str(), id.values.to_f64()), ("ObjectId", vec![10.0, 20.0]));
    assert_eq!(loaded.warnings.len(), 1, "{:?}", loaded.warnings);
    assert!(loaded.warnings[0].contains("`second`"), "{:?}", loaded.warnings);
}

/// The volume of all tetrahedra in world units.
fn volume_of(mesh: &TetMesh) -> f64 {
    let six_fold = |corners: &[VertexId; 4]| {
        let [a, b, c, d] = corners.map(|corner| mesh.frame().to_world(mesh.positions()[corner.index()]));
        (b - a).cross(c - a).dot(d - a)
    };
    mesh.tetrahedra().iter().map(six_fold).sum::<f64>().abs() / 6.0
}

/// The nodes of a second-order element where they belong by the format's definition: corners, then means of corners.
fn nodes_of(corners: &[[f64; 3]], means: &[&[usize]]) -> Vec<DVec3> {
    let corners: Vec<DVec3> = corners.iter().map(|&corner| DVec3::from_array(corner)).collect();
    let mean = |of: &&[usize]| of.iter().map(|&corner| corners[corner]).sum::<DVec3>() / of.len() as f64;
    let means: Vec<DVec3> = means.iter().map(mean).collect();
    corners.into_iter().chain(means).collect()
}

const HEXAHEDRON: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [2.0, 0.0, 0.0],
    [2.0, 3.0, 0.0],
    [0.0, 3.0, 0.0],
    [0.0, 0.0, 5.0],
    [2.0, 0.0, 5.0],
    [2.0, 3.0, 5.0],
    [0.0, 3.0, 5.0],
];
const HEXAHEDRON_MEANS: [&[usize]; 19] = [
    &[0, 1],
    &[1, 2],
    &[2, 3],
    &[3, 0],
    &[0, 4],
    &[1, 5],
    &[2, 6],
    &[3, 7],
    &[4, 5],
    &[5, 6],
    &[6, 7],
    &[7, 4],
    &[0, 1, 2, 3, 4, 5, 6, 7],
    &[0, 1, 2, 3],
    &[4, 5, 6, 7],
    &[0, 3, 4, 7],
    &[1, 2, 5, 6],
    &[0, 1, 4, 5],
    &[2, 3, 6, 7],
];
const WEDGE: [[f64; 3]; 6] =
    [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 5.0], [2.0, 0.0, 5.0], [0.0, 3.0, 5.0]];
const WEDGE_MEANS: [&[usize]; 12] = [
    &[0, 1],
    &[1, 2],
    &[2, 0],
    &[0, 3],
    &[1, 4],
    &[2, 5],
    &[3, 4],
    &[4, 5],
    &[5, 3],
    &[0, 1, 3, 4],
    &[1, 2, 4, 5],
    &[2, 0, 5, 3],
];
const PYRAMID: [[f64; 3]; 5] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 3.0, 0.0], [0.0, 3.0, 0.0], [1.0, 1.0, 5.0]];
const PYRAMID_MEANS: [&[usize]; 8] = [&[0, 1], &[1, 2], &[2, 3], &[3, 0], &[0, 4], &[1, 4], &[2, 4], &[3, 4]];
const TETRAHEDRON_MEANS: [&[usize]; 6] = [&[0, 1], &[1, 2], &[2, 0], &[0, 3], &[1, 3], &[2, 3]];

/// Every element's pieces fill it, right side out, which they do not if a node is in a wrong place.
#[test]
fn nodes_are_in_the_order_of_the_format() {
    let tetrahedron = [WEDGE[0], WEDGE[1], WEDGE[2], WEDGE[3]];
    for (name, nodes, kind, volume) in [
        ("TETRA10", nodes_of(&tetrahedron, &TETRAHEDRON_MEANS), CellKind::QuadraticTetrahedron, 5.0),
        ("HEX8", nodes_of(&HEXAHEDRON, &[]), CellKind::Hexahedron, 30.0),
        ("HEX20", nodes_of(&HEXAHEDRON, &HEXAHEDRON_MEANS[..12]), CellKind::QuadraticHexahedron, 30.0),
        ("HEX27", nodes_of(&HEXAHEDRON, &HEXAHEDRON_MEANS), CellKind::TriquadraticHexahedron, 30.0),
        ("WEDGE6", nodes_of(&WEDGE, &[]), CellKind::Wedge, 15.0),
        ("WEDGE15", nodes_of(&WEDGE, &WEDGE_MEANS[..9]), CellKind::QuadraticWedge, 15.0),
        ("WEDGE18", nodes_of(&WEDGE, &WEDGE_MEANS), CellKind::BiquadraticQuadraticWedge, 15.0),
        ("PYRAMID5", nodes_of(&PYRAMID, &[]), CellKind::Pyramid, 10.0),
        ("PYRAMID13", nodes_of(&PYRAMID, &PYRAMID_MEANS), CellKind::QuadraticPyramid, 10.0),
    ] {
        let numbers: Vec<i32> = (1..=nodes.len() as i32).collect();
        let parts = Parts { blocks: vec![(name, nodes.len(), &numbers)], points: nodes, ..Parts::default() };
        let loaded = read(file(&parts, NcWriteOptions::classic()), StepChoice::Last).unwrap();
        assert_eq!(cells(&loaded.dataset).kinds, [kind], "{name}");
        assert!(loaded.warnings.is_empty(), "{name}: {:?}", loaded.warnings);
        let cut = decompose(&loaded.dataset).unwrap();
        assert_eq!((cut.counts.inverted, cut.counts.no_volume), (0, 0), "{name}");
        let found = volume_of(&cut.mesh);
        assert!((found - volume).abs() < 1e-9, "{name}: {found}, not {volume}");
    }
}

#[test]
fn odd_elements_are_kept_and_told_of() {
    let points = nodes_of(&HEXAHEDRON, &HEXAHEDRON_MEANS[..12]);
    let numbers: Vec<i32> = (1..=20).collect();
    let blocks = vec![
        ("HEX16", 16, &numbers[..16]),
        ("SUPER", 3, &numbers[..6]),
        ("SHELL4", 4, &numbers[..4]),
        ("TETRA", 4, &[1, 2, 4, 5]),
    ];
    let parts = Parts { points, blocks, ..Parts::default() };
    let loaded = read(file(&parts, NcWriteOptions::classic()), StepChoice::Last).unwrap();
    use CellKind::{Flat, FlatOf, Hexahedron, Tetrahedron};
    assert_eq!(cells(&loaded.dataset).kinds, [Hexahedron, FlatOf(2), FlatOf(2), Flat, Tetrahedron]);
    assert_eq!(loaded.dataset.cell_arrays[0].values.to_f64(), [10.0, 20.0, 20.0, 30.0, 40.0]);
    assert!(loaded.warnings[0].contains("2 elements are of the type `SUPER`"), "{:?}", loaded.warnings);
    assert!(loaded.warnings[1].contains("`HEX16` have 16 nodes"), "{:?}", loaded.warnings);
}

/// Two cubes side by side, as elements that name eleven faces.
pub(super) fn polyhedra() -> Vec<u8> {
    let point = |n: i32| DVec3::new(f64::from(n % 3), f64::from(n / 3 % 2), f64::from(n / 6));
    let points: Vec<DVec3> = (0..12).map(point).collect();
    let at = |x: i32, y: i32, z: i32| 6 * z + 3 * y + x + 1;
    let mut faces: Vec<[i32; 4]> = (0..3).map(|x| [at(x, 0, 0), at(x, 1, 0), at(x, 1, 1), at(x, 0, 1)]).collect();
    for x in 0..2 {
        faces.push([at(x, 0, 0), at(x + 1, 0, 0), at(x + 1, 0, 1), at(x, 0, 1)]);
        faces.push([at(x, 1, 0), at(x + 1, 1, 0), at(x + 1, 1, 1), at(x, 1, 1)]);
        faces.push([at(x, 0, 0), at(x + 1, 0, 0), at(x + 1, 1, 0), at(x, 1, 0)]);
        faces.push([at(x, 0, 1), at(x + 1, 0, 1), at(x + 1, 1, 1), at(x, 1, 1)]);
    }
    let mut file = NcFileBuilder::new();
    file.add_dimension("num_dim", 3).unwrap();
    let nodes = file.add_dimension("num_nodes", 12).unwrap();
    for (axis, name) in ["coordx", "coordy", "coordz"].into_iter().enumerate() {
        let variable = file.add_variable::<f64>(name, &[nodes]).unwrap();
        file.write_variable(variable, &points.iter().map(|point| point[axis]).collect::<Vec<_>>()).unwrap();
    }
    let mut add = |name: &str, dimension: &str, values: &[i32], element_type: Option<&str>| {
        let dimension = file.add_dimension(dimension, values.len() as u64).unwrap();
        let variable = file.add_variable::<i32>(name, &[dimension]).unwrap();
        if let Some(text) = element_type {
            file.add_variable_attribute(variable, "elem_type", NcAttrValue::Chars(text.to_owned())).unwrap();
        }
        file.write_variable(variable, values).unwrap();
    };
    add("fbconn1", "num_nod_per_fa1", faces.as_flattened(), Some("nsided"));
    add("fbepecnt1", "num_fa_in_blk1", &[4; 11], None);
    add("facconn1", "num_fac_per_el1", &[1, 2, 4, 5, 6, 7, 2, 3, 8, 9, 10, 11], Some("NFACED"));
    add("ebepecnt1", "num_el_in_blk1", &[6, 6], None);
    file.to_vec(NcWriteOptions::classic()).unwrap().1
}

#[test]
fn polyhedra_by_their_faces() {
    let loaded = read(polyhedra(), StepChoice::Last).unwrap();
    let cells = cells(&loaded.dataset);
    assert_eq!(cells.kinds, [CellKind::Polyhedron; 2]);
    assert_eq!(cells.polyhedra[0].len(), 6);
    assert_eq!(cells.connectivity[..8], [0, 1, 3, 4, 6, 7, 9, 10]);
    let cut = decompose(&loaded.dataset).unwrap();
    let volume = volume_of(&cut.mesh);
    assert!((volume - 2.0).abs() < 1e-12, "{volume}");
}

#[test]
fn what_is_wrong_is_named() {
    let message = |bytes: Vec<u8>| read(bytes, StepChoice::Last).unwrap_err().to_string();
    let mut parts = two_blocks(false);
    parts.blocks[1].2 = &[9, 10, 11, 13];
    let text = message(file(&parts, NcWriteOptions::classic()));
    assert!(text.contains("made.exo: element block 20, cell 0: it names point 12, but there are 12 points"), "{text}");
    parts.blocks[1].2 = &[9, 10, 11, 0];
    let text = message(file(&parts, NcWriteOptions::classic()));
    assert!(text.contains("it names point -1"), "{text}");
    let mut other = NcFileBuilder::new();
    let x = other.add_dimension("x", 3).unwrap();
    let t = other.add_variable::<f64>("t", &[x]).unwrap();
    other.write_variable(t, &[1.0, 2.0, 3.0]).unwrap();
    let text = message(other.to_vec(NcWriteOptions::classic()).unwrap().1);
    assert!(text.contains("NetCDF-3 (CDF-1) that is not Exodus"), "{text}");
    let whole = file(&two_blocks(false), NcWriteOptions::offset64());
    assert!(message(whole[..whole.len() / 2].to_vec()).contains("made.exo: "));
}
