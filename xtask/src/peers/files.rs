//! Files of VTK's that we write, read by VTK: points, cells and every array must be there to the last bit.

mod digest;
mod meshes;

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::{fs, iter};

use serde_json::Value;
use tetrascope::{Dataset, ReadOptions, VtuEncoding, VtuOptions, decompose, read_mesh, write_vtu_with};

use crate::Failure;
use digest::differences;

/// What Python runs; its own words say how.
const SCRIPT: &str = include_str!("../../peers/vtk_reads.py");
/// Files that one process reads: its start takes a second, and a list of names has a limit.
const TOGETHER: usize = 64;

/// A file that was written, and what it must be read as.
struct Written {
    /// What it was made of, and how.
    name: String,
    path: PathBuf,
    dataset: Dataset,
}

/// Writes meshes of all kinds, and those of the shared folder if it is there, in all encodings and as tetrahedra; lets VTK read them, prints a table,
/// and fails if anything is not as it was.
pub(super) fn run(folder: &Path, python: &Path) -> Result<(), Failure> {
    let folder = folder.join("files");
    fs::create_dir_all(&folder)?;
    let script = folder.join("vtk_reads.py");
    fs::write(&script, SCRIPT)?;
    let mut files = Vec::new();
    for (name, dataset) in meshes::all() {
        write(&folder, &name, dataset, true, &mut files)?;
    }
    for (name, path) in shared_meshes()? {
        // Those that are damaged on purpose, and what is no mesh.
        let Ok(loaded) = read_mesh(&path, &ReadOptions::default()) else { continue };
        write(&folder, &name, loaded.dataset, false, &mut files)?;
    }
    println!("{:<58} {:>8} {:>8} {:>6}  VTK reads", "file written", "points", "cells", "arrays");
    let mut wrong = 0;
    for files in files.chunks(TOGETHER) {
        let read = read_by_vtk(python, &script, files)?;
        for (file, read) in files.iter().zip(read) {
            let found = differences(&file.dataset, &read);
            let (points, arrays) =
                (&file.dataset.points, file.dataset.point_arrays.len() + file.dataset.cell_arrays.len());
            let verdict =
                if found.is_empty() { "the same".to_owned() } else { format!("DIFFERENT: {}", found.join("; ")) };
            let cells = digest::cell_count(&file.dataset);
            println!("{:<58} {:>8} {cells:>8} {arrays:>6}  {verdict}", file.name, points.len());
            wrong += usize::from(!found.is_empty());
        }
    }
    if wrong > 0 {
        return Err(format!("{wrong} of {} files are not read by VTK as they were written", files.len()).into());
    }
    println!("all {} files are read by VTK as they were written", files.len());
    Ok(())
}

/// Writes a mesh in every way, and reads back what VTK must find.
fn write(folder: &Path, name: &str, dataset: Dataset, as_text: bool, files: &mut Vec<Written>) -> Result<(), Failure> {
    let tetrahedra = decompose(&dataset).ok().map(|cut| cut.to_dataset(&dataset));
    let encodings = [("raw", VtuEncoding::Raw), ("zlib", VtuEncoding::Zlib), ("text", VtuEncoding::Text)];
    let ways = encodings.into_iter().map(|(way, encoding)| (way, encoding, Some(&dataset)));
    let tetrahedra = iter::once(("tetrahedra", VtuEncoding::Raw, tetrahedra.as_ref()));
    for (way, encoding, dataset) in ways.chain(tetrahedra) {
        let Some(dataset) = dataset.filter(|_| as_text || encoding != VtuEncoding::Text) else { continue };
        let path = folder.join(format!("{}-{way}.vtu", name.replace(['/', '.', ' '], "_")));
        let options = VtuOptions { encoding, time: None };
        write_vtu_with(&path, dataset, &options)?;
        // Grids have become hexahedra, and hidden cells are gone. That this is what was written is for the tests of the crate.
        let dataset = read_mesh(&path, &ReadOptions::default())?.dataset;
        files.push(Written { name: format!("{name}, {way}"), path, dataset });
    }
    Ok(())
}

/// What VTK says of each file; a process that ends too early is an error that names the file.
fn read_by_vtk(python: &Path, script: &Path, files: &[Written]) -> Result<Vec<Value>, Failure> {
    let mut process = Command::new(python)
        .arg(script)
        .args(files.iter().map(|file| &file.path))
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()?;
    let mut read = Vec::new();
    if let Some(output) = process.stdout.take() {
        for line in BufReader::new(output).lines() {
            read.push(serde_json::from_str(&line?)?);
        }
    }
    let status = process.wait()?;
    match files.get(read.len()) {
        Some(file) => Err(format!("{}: VTK ended while it read it ({status})", file.path.display()).into()),
        None => Ok(read),
    }
}

/// All files of the shared folder that may be meshes, under their names there; none where it is not.
fn shared_meshes() -> Result<Vec<(String, PathBuf)>, Failure> {
    let Some(shared) = tetrascope_tests::shared::folder("VTK reads the meshes of the shared folder") else {
        return Ok(Vec::new());
    };
    let root = shared.join("data");
    let mut found = Vec::new();
    let mut folders = vec![root.clone()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(&root).unwrap_or(&path).display().to_string();
                found.push((name, path));
            }
        }
    }
    found.sort();
    Ok(found)
}
