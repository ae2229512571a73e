//! What a mesh has, in the words of the script that reads it by VTK.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};
use tetrascope::{ArrayValues, CellKind, Cells, DataArray, Dataset, UnstructuredCells};

/// What is not as it was, in words; nothing if all is.
pub(super) fn differences(dataset: &Dataset, read: &Value) -> Vec<String> {
    if let Some(error) = read["error"].as_str() {
        return vec![error.to_owned()];
    }
    let Cells::Unstructured(cells) = &dataset.cells else { return vec!["it was read back as a grid".to_owned()] };
    let mut found = Vec::new();
    for (what, expected) in [("points", dataset.points.len()), ("cells", cells.kinds.len())] {
        if read[what] != json!(expected) {
            found.push(format!("{} {what}, not {expected}", read[what]));
        }
    }
    let types = types_of(cells);
    let flat: u64 = types.get(&None).copied().unwrap_or_default();
    let told = |number: u8| read["types"][number.to_string()].as_u64().unwrap_or_default();
    // Vertices, lines, triangles, quadrilaterals and empty cells are one kind here.
    if [0, 1, 3, 5, 9].into_iter().map(told).sum::<u64>() != flat {
        found.push(format!("types {}, where {flat} plain flat cells were written", read["types"]));
    }
    for (number, count) in types.iter().filter_map(|(number, count)| Some((number.as_ref()?, count))) {
        if told(*number) != *count {
            found.push(format!("{} cells of type {number}, not {count}", told(*number)));
        }
    }
    let expected = arrays_of(dataset, cells);
    let empty = Map::new();
    let given = read["arrays"].as_object().unwrap_or(&empty);
    for (name, expected) in &expected {
        match given.get(name) {
            Some(given) if is_same(given, expected) => {}
            Some(given) => found.push(format!("{name} is {given}, not {expected}")),
            None => found.push(format!("no {name}")),
        }
    }
    found.extend(given.keys().filter(|name| !expected.contains_key(*name)).map(|name| format!("{name} too many")));
    found
}

/// Whether the words on two arrays are the same. Ranges are for people: what reads JSON may round their last digit, and the sums have every bit.
fn is_same(given: &Value, expected: &Value) -> bool {
    ["type", "components", "count", "sum"].iter().all(|key| given[*key] == expected[*key])
}

/// Cells of a mesh that was read back.
pub(super) fn cell_count(dataset: &Dataset) -> usize {
    match &dataset.cells {
        Cells::Unstructured(cells) => cells.kinds.len(),
        Cells::Structured(blocks) => blocks.iter().map(tetrascope::StructuredBlock::cell_count).sum(),
    }
}

/// Cells of each of VTK's types, those of plain flat cells under no number.
fn types_of(cells: &UnstructuredCells) -> BTreeMap<Option<u8>, u64> {
    let mut types = BTreeMap::new();
    for kind in &cells.kinds {
        *types.entry(number_of(*kind)).or_default() += 1;
    }
    types
}

/// The numbers of VTK's public header `vtkCellType.h`, once more: a slip in the writer's would be in its reader, too.
fn number_of(kind: CellKind) -> Option<u8> {
    Some(match kind {
        CellKind::Flat => return None,
        CellKind::FlatOf(number) | CellKind::Other(number) => number,
        CellKind::Tetrahedron => 10,
        CellKind::Voxel => 11,
        CellKind::Hexahedron => 12,
        CellKind::Wedge => 13,
        CellKind::Pyramid => 14,
        CellKind::PentagonalPrism => 15,
        CellKind::HexagonalPrism => 16,
        CellKind::QuadraticTetrahedron => 24,
        CellKind::QuadraticHexahedron => 25,
        CellKind::QuadraticWedge => 26,
        CellKind::QuadraticPyramid => 27,
        CellKind::TriquadraticHexahedron => 29,
        CellKind::QuadraticLinearWedge => 31,
        CellKind::BiquadraticQuadraticWedge => 32,
        CellKind::BiquadraticQuadraticHexahedron => 33,
        CellKind::Polyhedron => 42,
    })
}

fn arrays_of(dataset: &Dataset, cells: &UnstructuredCells) -> BTreeMap<String, Value> {
    let mut arrays = BTreeMap::new();
    let integers = |numbers: Vec<i64>| told(&ArrayValues::I64(numbers), 1);
    arrays.insert("connectivity".to_owned(), integers(cells.connectivity.iter().map(|&point| point.into()).collect()));
    arrays.insert("offsets".to_owned(), integers(cells.offsets.iter().map(|&end| end as i64).collect()));
    let positions: Vec<f64> = dataset.points.iter().flat_map(glam::DVec3::to_array).collect();
    let is_single = positions.iter().all(|&x| f64::from(x as f32).to_bits() == x.to_bits());
    let positions = if is_single {
        ArrayValues::F32(positions.iter().map(|&x| x as f32).collect())
    } else {
        ArrayValues::F64(positions)
    };
    arrays.insert("positions".to_owned(), told(&positions, 3));
    if !cells.polyhedra.is_empty() {
        let faces = || cells.polyhedra.iter().flatten();
        let mut end = 0;
        let ends = faces().map(|face| {
            end += face.len() as i64;
            end
        });
        arrays.insert("face offsets".to_owned(), integers(std::iter::once(0).chain(ends).collect()));
        arrays.insert("face points".to_owned(), integers(faces().flatten().map(|&point| point.into()).collect()));
    }
    for (owner, given) in [("point", &dataset.point_arrays), ("cell", &dataset.cell_arrays)] {
        for DataArray { name, components, values } in given {
            arrays.insert(format!("{owner} array {name}"), told(values, *components));
        }
    }
    arrays
}

/// An array as the script tells of it.
fn told(values: &ArrayValues, components: usize) -> Value {
    let words: Vec<u64> = match values {
        ArrayValues::F32(numbers) => numbers.iter().map(|x| x.to_bits().into()).collect(),
        ArrayValues::F64(numbers) => numbers.iter().map(|x| x.to_bits()).collect(),
        ArrayValues::I8(numbers) => numbers.iter().map(|&x| i64::from(x).cast_unsigned()).collect(),
        ArrayValues::I16(numbers) => numbers.iter().map(|&x| i64::from(x).cast_unsigned()).collect(),
        ArrayValues::I32(numbers) => numbers.iter().map(|&x| i64::from(x).cast_unsigned()).collect(),
        ArrayValues::I64(numbers) => numbers.iter().map(|&x| x.cast_unsigned()).collect(),
        ArrayValues::U8(numbers) => numbers.iter().map(|&x| x.into()).collect(),
        ArrayValues::U16(numbers) => numbers.iter().map(|&x| x.into()).collect(),
        ArrayValues::U32(numbers) => numbers.iter().map(|&x| x.into()).collect(),
        ArrayValues::U64(numbers) => numbers.clone(),
    };
    let weighted = words.iter().zip((1_u64..).step_by(2)).map(|(word, weight)| word.wrapping_mul(weight));
    let sum = weighted.fold(0, u64::wrapping_add);
    let finite = values.to_f64().into_iter().filter(|x| x.is_finite());
    let range = finite.fold(None, |range: Option<[f64; 2]>, x| {
        let [low, high] = range.unwrap_or([x, x]);
        Some([low.min(x), high.max(x)])
    });
    json!({ "type": values.type_name().to_lowercase(), "components": components, "count": words.len(), "range": range,
        "sum": format!("{sum:016x}") })
}

#[cfg(test)]
mod tests {
    use super::super::meshes;
    use super::*;

    #[test]
    fn sums_are_those_of_the_script() {
        // 7 + 3 * (2^64 - 1) + 5 * 2, modulo 2^64.
        let integers = told(&ArrayValues::I8(vec![7, -1, 2]), 1);
        assert_eq!((&integers["sum"], &integers["type"]), (&json!("000000000000000e"), &json!("int8")));
        let floats = told(&ArrayValues::F32(vec![1.0, f32::INFINITY]), 2);
        assert_eq!(floats["sum"], format!("{:016x}", 0x3f80_0000_u64 + 3 * 0x7f80_0000));
        assert_eq!((&floats["range"], &floats["components"]), (&json!([1.0, 1.0]), &json!(2)));
    }

    #[test]
    fn whatever_is_not_as_it_was_is_told() {
        let (_, dataset) = meshes::all().swap_remove(1);
        let Cells::Unstructured(cells) = &dataset.cells else { panic!("a grid") };
        let types: Map<String, Value> =
            [("42".to_owned(), json!(3)), ("10".to_owned(), json!(1))].into_iter().collect();
        let good = json!({ "points": 27, "cells": 4, "types": types, "arrays": arrays_of(&dataset, cells) });
        assert_eq!(differences(&dataset, &good), Vec::<String>::new());
        for (pointer, other, word) in [
            ("/points", json!(26), "26 points, not 27"),
            ("/types/10", json!(0), "0 cells of type 10, not 1"),
            ("/types/9", json!(1), "plain flat cells"),
            ("/arrays/positions/sum", json!("0"), "positions is"),
            ("/arrays/face offsets", Value::Null, "face offsets is null"),
            ("/arrays/cell array a < b/type", json!("int32"), "cell array a < b is"),
        ] {
            let mut bad = good.clone();
            match bad.pointer_mut(pointer) {
                Some(place) => *place = other,
                None => bad["types"]["9"] = other,
            }
            let found = differences(&dataset, &bad);
            assert!(found.len() == 1 && found[0].contains(word), "{pointer}: {found:?}");
        }
        assert_eq!(differences(&dataset, &json!({ "error": "VTK has an error" })), ["VTK has an error"]);
    }
}
