//! How far heights reach: for each mesh, whether one key a cell orders it, and what it took to find out.
//!
//! `cargo run --release -p tetrascope --example heights -- MESH [MESH ...]`; a PLOT3D grid is named alone. Prints the rows of
//! a Markdown table: interior faces out of order with `|p|²` and with the heights found, the time to find them, and what is
//! proven; for those out of reach, faces that are folded, with which no heights exist.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program speaks to its user")]

use std::path::Path;
use std::time::Instant;

use tetrascope::mesh::FaceAdjacency;
use tetrascope::order::{Budget, Cells, Heights, MeshVisibility};
use tetrascope::{ReadOptions, Volume};

fn main() {
    println!("| mesh | tetrahedra | wrong with \\|p\\|² | wrong | folded | found by | seconds | faces | across gaps |");
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for argument in std::env::args().skip(1) {
        let path = Path::new(&argument);
        let volume = match Volume::load(path, &ReadOptions::default()) {
            Ok(volume) => volume,
            Err(error) => {
                eprintln!("{argument}: {error}");
                continue;
            }
        };
        let cells = Cells::from(&volume.decomposition.mesh);
        let adjacency = FaceAdjacency::new(cells.tetrahedra);
        let start = Instant::now();
        let heights = Heights::solve(cells, &adjacency, Budget::default());
        let seconds = start.elapsed().as_secs_f64();
        let share = |count: usize| format!("{:.3} %", 100.0 * count as f64 / heights.faces.max(1) as f64);
        let (at_first, left, source) = (share(heights.violated_at_first), share(heights.violated), heights.source);
        let certificate = MeshVisibility::with_heights(heights.values).quick_certificate(cells);
        let faces = if certificate.is_exact() { "proven" } else { "no" };
        let gaps = match certificate.gaps {
            Some(0) => "proven".to_owned(),
            Some(count) => format!("{count} cells open"),
            None => "no".to_owned(),
        };
        let name = path.file_name().map_or(argument.as_str().into(), |name| name.to_string_lossy());
        println!(
            "| {name} | {} | {at_first} | {left} | {} | {source:?} | {seconds:.1} | {faces} | {gaps} |",
            cells.tetrahedra.len(),
            certificate.folded,
        );
    }
}
