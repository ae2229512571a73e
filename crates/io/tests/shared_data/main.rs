//! Every file of the shared data that is not hostile, against what the data's own description says of it.

#![expect(clippy::unwrap_used, clippy::panic, clippy::print_stderr, reason = "a test that cannot go on fails here")]

mod encodings;
mod exceptions;
mod fields;
mod readme;
#[path = "../../src/shared.rs"]
mod shared;
mod table;
mod volumes;

use std::path::Path;

use tetrascope_io::{Loaded, ReadOptions, read_mesh};
use tetrascope_mesh::{DataArray, Dataset};

/// Reads a file of the data folder; nothing where the folder is absent.
fn load(name: &str) -> Option<Loaded> {
    Some(load_with(&shared::shared(&format!("data/{name}"))?, &ReadOptions::default()))
}

fn load_with(path: &Path, options: &ReadOptions) -> Loaded {
    read_mesh(path, options).unwrap_or_else(|error| panic!("{error}"))
}

fn point_array<'a>(dataset: &'a Dataset, name: &str) -> &'a DataArray {
    dataset.point_arrays.iter().find(|array| array.name == name).unwrap_or_else(|| panic!("no point array {name}"))
}

fn cell_array<'a>(dataset: &'a Dataset, name: &str) -> &'a DataArray {
    dataset.cell_arrays.iter().find(|array| array.name == name).unwrap_or_else(|| panic!("no cell array {name}"))
}
