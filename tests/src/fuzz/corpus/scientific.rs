//! Exodus on NetCDF of every form, and VTKHDF.

use fastrand::Rng;
use hdf5_writer::{
    AttributeBuilder, DatasetBuilder, FILTER_DEFLATE, FilterDescription, H5WriteElement, Hdf5Builder, WriteOptions,
};
use netcdf_writer::{NcAttrValue, NcFileBuilder, NcWriteFormat, NcWriteOptions};

const MADE: &str = "the corpus makes sound files";

/// A hexahedron and a tetrahedron in two blocks, two steps, a variable of nodes and one of elements.
pub(super) fn exodus(is_hdf5: bool, rng: &mut Rng) -> Vec<u8> {
    let mut file = NcFileBuilder::new();
    let length = file.add_dimension("len_string", 33).expect(MADE);
    let time = file.add_unlimited_dimension("time_step").expect(MADE);
    let dims = file.add_dimension("num_dim", 3).expect(MADE);
    let nodes = file.add_dimension("num_nodes", 9).expect(MADE);
    let blocks = file.add_dimension("num_el_blk", 2).expect(MADE);
    let times = file.add_variable::<f64>("time_whole", &[time]).expect(MADE);
    file.write_variable(times, &[0.0, 0.5]).expect(MADE);
    let ids = file.add_variable::<i32>("eb_prop1", &[blocks]).expect(MADE);
    file.write_variable(ids, &[10, 20]).expect(MADE);
    let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1], [2, 0, 0]];
    let axis = |axis: usize| corners.map(|corner| f64::from(corner[axis])).to_vec();
    // As Exodus 2 had it, or a variable an axis.
    let is_old = rng.bool();
    if is_old {
        let all = file.add_variable::<f64>("coord", &[dims, nodes]).expect(MADE);
        file.write_variable(all, &[axis(0), axis(1), axis(2)].concat()).expect(MADE);
    } else {
        for (number, name) in ["coordx", "coordy", "coordz"].into_iter().enumerate() {
            let one = file.add_variable::<f64>(name, &[nodes]).expect(MADE);
            file.write_variable(one, &axis(number)).expect(MADE);
        }
    }
    let mut elements = Vec::new();
    for (number, kind, connectivity) in [(1, "HEX8", vec![1, 2, 3, 4, 5, 6, 7, 8]), (2, "TETRA", vec![2, 9, 3, 6])] {
        let own = file.add_dimension(format!("num_el_in_blk{number}"), 1).expect(MADE);
        let per = file.add_dimension(format!("num_nod_per_el{number}"), connectivity.len() as u64).expect(MADE);
        let connect = file.add_variable::<i32>(format!("connect{number}"), &[own, per]).expect(MADE);
        file.add_variable_attribute(connect, "elem_type", NcAttrValue::Chars(kind.to_owned())).expect(MADE);
        file.write_variable(connect, &connectivity).expect(MADE);
        elements.push(own);
    }
    let count = file.add_dimension("num_nod_var", 1).expect(MADE);
    let names = file.add_char_variable("name_nod_var", &[count, length]).expect(MADE);
    file.write_char_variable_strings(names, &["s"]).expect(MADE);
    let values: Vec<f64> = (0..18).map(|_| rng.f64()).collect();
    let variable = if is_old {
        file.add_variable::<f64>("vals_nod_var", &[time, count, nodes]).expect(MADE)
    } else {
        file.add_variable::<f64>("vals_nod_var1", &[time, nodes]).expect(MADE)
    };
    file.write_variable(variable, &values).expect(MADE);
    let count = file.add_dimension("num_elem_var", 1).expect(MADE);
    let names = file.add_char_variable("name_elem_var", &[count, length]).expect(MADE);
    file.write_char_variable_strings(names, &["e"]).expect(MADE);
    for (block, own) in elements.into_iter().enumerate().take(rng.usize(1..3)) {
        let name = format!("vals_elem_var1eb{}", block + 1);
        let variable = file.add_variable::<f32>(name, &[time, own]).expect(MADE);
        file.write_variable(variable, &[rng.f32(), 2.0]).expect(MADE);
    }
    let options = match rng.u8(..3) {
        _ if is_hdf5 => NcWriteOptions { format: NcWriteFormat::Nc4Classic },
        0 => NcWriteOptions::classic(),
        1 => NcWriteOptions::offset64(),
        _ => NcWriteOptions::cdf5(),
    };
    file.to_vec(options).expect(MADE).1
}

/// A file of VTKHDF under construction.
struct Made {
    file: Hdf5Builder,
    is_compressed: bool,
}

impl Made {
    fn data<T: H5WriteElement>(mut self, name: &str, shape: &[u64], values: &[T]) -> Self {
        let mut dataset = DatasetBuilder::typed_data(format!("VTKHDF/{name}"), shape, values).expect(MADE);
        if self.is_compressed {
            let deflate = FilterDescription { id: FILTER_DEFLATE, name: None, client_data: vec![5] };
            dataset = dataset.max_shape(shape.to_vec()).chunked(shape.to_vec()).filter(deflate);
        }
        self.file = self.file.dataset(dataset);
        self
    }

    fn list(self, name: &str, values: &[i64]) -> Self {
        self.data(name, &[values.len() as u64], values)
    }

    fn attribute<T: H5WriteElement>(mut self, group: &str, name: &str, values: &[T]) -> Self {
        self.file = self.file.group_attribute(group, AttributeBuilder::vector(name, values).expect(MADE));
        self
    }
}

/// A grid in two parts, one with steps, or an image.
pub(super) fn vtkhdf(rng: &mut Rng) -> Vec<u8> {
    let is_image = rng.u8(..3) == 0;
    let kind = if is_image { "ImageData" } else { "UnstructuredGrid" };
    let file = Hdf5Builder::new()
        .group_attribute("VTKHDF", AttributeBuilder::fixed_string("Type", kind))
        .group_attribute("VTKHDF", AttributeBuilder::vector("Version", &[2_i64, 3]).expect(MADE));
    let made = Made { file, is_compressed: rng.bool() };
    let made = if is_image {
        let s: Vec<f32> = (0..24).map(|_| rng.f32()).collect();
        made.attribute("VTKHDF", "WholeExtent", &[1_i64, 4, 0, 2, 0, 1])
            .attribute("VTKHDF", "Origin", &[1.0, 2.0, 3.0])
            .attribute("VTKHDF", "Spacing", &[0.5, 1.0, 2.0])
            .attribute("VTKHDF", "Direction", &[0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0])
            .data("PointData/s", &[2, 3, 4], &s)
            .data("CellData/c", &[1, 2, 3], &[0.0_f64, 1.0, 2.0, 3.0, 4.0, 5.0])
    } else {
        grid(made, rng)
    };
    made.file.into_plan().expect(MADE).encode(WriteOptions::default()).expect(MADE)
}

fn grid(made: Made, rng: &mut Rng) -> Made {
    let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1], [2, 0, 0]];
    let points: Vec<f32> = corners.as_flattened().iter().map(|&x| x as f32).collect();
    let s: Vec<f64> = (0..18).map(|_| rng.f64()).collect();
    let made = made
        .list("NumberOfPoints", &[9, 9])
        .list("NumberOfCells", &[2, 2])
        .list("NumberOfConnectivityIds", &[12, 12])
        .data("Points", &[18, 3], &points.repeat(2))
        .list("Connectivity", &[0, 1, 2, 3, 4, 5, 6, 7, 1, 8, 2, 5].repeat(2))
        .list("Offsets", &[0, 8, 12].repeat(2))
        .data("Types", &[4], &[12_u8, 10].repeat(2))
        .data("PointData/s", &[18], &s)
        .data("CellData/c", &[4], &[7_i32, 8, 9, 10]);
    if rng.bool() {
        return made;
    }
    made.attribute("VTKHDF/Steps", "NSteps", &[2_i64])
        .data("Steps/Values", &[2], &[0.0_f32, 0.5])
        .list("Steps/NumberOfParts", &[1, 1])
        .list("Steps/PartOffsets", &[0, 1])
        .list("Steps/PointOffsets", &[0, 9])
        .list("Steps/CellOffsets", &[0, 2])
        .list("Steps/ConnectivityIdOffsets", &[0, 12])
        .list("Steps/PointDataOffsets/s", &[0, 9])
        .list("Steps/CellDataOffsets/c", &[0, 2])
}
