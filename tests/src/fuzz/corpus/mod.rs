//! Sound files of every kind, small, with something of everything that their format can hold.

mod gmsh;
pub mod openfoam;
mod pictures;
mod plot3d;
mod presets;
mod samples;
mod scenes;
mod scientific;
mod vtk;
mod vtk_grids;
mod vtu;

use fastrand::Rng;

use super::Target;

pub use pictures::{exr, exr_header, exr_of, png, png_chunks};
pub use samples::word_and_samples;
pub use vtu::{Compressor, Encoding, Values, VtuWriter};

/// A file of a target, which its reader takes.
pub fn file(target: Target, rng: &mut Rng) -> Vec<u8> {
    match target {
        Target::VtuText | Target::VtuBase64 | Target::VtuRaw | Target::VtuCompressed => vtu::file(target, rng),
        Target::VtkText => vtk::text(rng),
        Target::VtkBinary => vtk::binary(rng),
        Target::VtkGrid => vtk::grid(rng),
        Target::Vti | Target::Vtr | Target::Vts => vtk_grids::grid(target, rng),
        Target::VtkNaming => vtk_grids::naming(rng),
        Target::MshText => gmsh::file(false, rng),
        Target::MshBinary => gmsh::file(true, rng),
        Target::Nrrd => samples::nrrd(rng),
        Target::Raw => samples::raw(rng),
        Target::Exodus => scientific::exodus(false, rng),
        Target::ExodusHdf5 => scientific::exodus(true, rng),
        Target::Vtkhdf => scientific::vtkhdf(rng),
        Target::Openfoam => openfoam::case(rng),
        Target::Plot3dGrid => plot3d::grid(rng),
        Target::Plot3dSolution => plot3d::pair(rng),
        Target::PresetJson => presets::json(rng),
        Target::PresetXml => presets::xml(rng),
        Target::Heights => heights(rng),
        Target::Png => png(rng),
        Target::Exr => exr(rng),
        Target::SceneToml => scenes::toml(rng),
        Target::SceneJson => scenes::json(rng),
    }
}

/// Files that lie beside those that name them.
pub fn companions() -> Vec<(&'static str, Vec<u8>)> {
    let mut all = vtk_grids::companions();
    all.push((samples::COMPANION, samples::companion()));
    all
}

/// The bytes of a file of heights.
fn heights(rng: &mut Rng) -> Vec<u8> {
    let count = rng.u32(1..20);
    let mut bytes = b"TETRASCOPE-HEIGHTS\n\x01".to_vec();
    bytes.extend(count.to_le_bytes());
    (0..count).for_each(|_| bytes.extend((rng.f64() - 0.5).to_le_bytes()));
    bytes
}

/// Grid and solution of one input: the first eight bytes are the grid's length. Whatever the bytes are, two files come out.
pub fn split(pair: &[u8]) -> (&[u8], &[u8]) {
    let Some((length, rest)) = pair.split_first_chunk() else { return (pair, &[]) };
    let length = usize::try_from(u64::from_le_bytes(*length)).unwrap_or(usize::MAX);
    rest.split_at(length.min(rest.len()))
}

/// The other way round.
pub fn joined(grid: &[u8], solution: &[u8]) -> Vec<u8> {
    [&(grid.len() as u64).to_le_bytes(), grid, solution].concat()
}
