//! Hostile files of chance: whatever is done to a file, it is read, or refused in words that name it, its fault and a remedy.
//!
//! A [`Target`] is a reader and the kind of files that it is given. [`input`] makes the file of a seed and a number: a sound one from the
//! [`corpus`], damaged by [`mutate`](mod@mutate), which knows enough of each format that the damage lies behind the first check.
//! [`Judge`] has it read and says what must not be. [`reduce()`] makes a failing file small. The tests take some hundred files of each
//! target, `cargo xtask fuzz` as many as there is time for.

pub mod corpus;
mod judge;
pub mod mutate;
mod promises;
mod reduce;

use std::fmt;
use std::str::FromStr;

use fastrand::Rng;

pub use judge::{Judge, Verdict, most_allocated};
pub use promises::check_whole;
pub use reduce::reduce;

/// A reader, and the kind of files that it is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    /// VTK's XML files with numbers as text.
    VtuText,
    /// The same with base64 inside the elements or behind them.
    VtuBase64,
    /// The same with raw bytes behind the elements.
    VtuRaw,
    /// The same compressed by zlib, LZ4 or LZMA, in base64 or raw.
    VtuCompressed,
    /// VTK's legacy files as text, versions 2.0 to 5.1.
    VtkText,
    /// The same with binary numbers.
    VtkBinary,
    /// VTK's legacy files of grids that are not unstructured, as text and binary.
    VtkGrid,
    /// VTK's XML files of images, in every encoding.
    Vti,
    /// The same of rectilinear grids.
    Vtr,
    /// The same of structured grids.
    Vts,
    /// VTK's files that name others: parallel files, collections, blocks and series.
    VtkNaming,
    /// Gmsh's files as text, versions 2.2 and 4.1.
    MshText,
    /// The same with binary numbers.
    MshBinary,
    /// NRRD in every encoding, attached and detached.
    Nrrd,
    /// Raw volumes, with the word that says what they hold.
    Raw,
    /// Exodus on NetCDF-3.
    Exodus,
    /// Exodus on NetCDF-4, which is HDF5.
    ExodusHdf5,
    /// VTKHDF: unstructured grids and images.
    Vtkhdf,
    /// OpenFOAM's cases: mesh and fields, text and binary.
    Openfoam,
    /// PLOT3D's grids of every layout.
    Plot3dGrid,
    /// Grids with their solutions.
    Plot3dSolution,
    /// ParaView's presets of colors as JSON.
    PresetJson,
    /// The same as XML.
    PresetXml,
    /// Heights of the power order.
    Heights,
    /// PNG pictures of every kind.
    Png,
    /// OpenEXR pictures.
    Exr,
    /// Scene files.
    SceneToml,
    /// Scene files as JSON.
    SceneJson,
}

impl Target {
    /// Every one.
    pub const ALL: [Self; 28] = [
        Self::VtuText,
        Self::VtuBase64,
        Self::VtuRaw,
        Self::VtuCompressed,
        Self::VtkText,
        Self::VtkBinary,
        Self::VtkGrid,
        Self::Vti,
        Self::Vtr,
        Self::Vts,
        Self::VtkNaming,
        Self::MshText,
        Self::MshBinary,
        Self::Nrrd,
        Self::Raw,
        Self::Exodus,
        Self::ExodusHdf5,
        Self::Vtkhdf,
        Self::Openfoam,
        Self::Plot3dGrid,
        Self::Plot3dSolution,
        Self::PresetJson,
        Self::PresetXml,
        Self::Heights,
        Self::Png,
        Self::Exr,
        Self::SceneToml,
        Self::SceneJson,
    ];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::VtuText => "vtu-text",
            Self::VtuBase64 => "vtu-base64",
            Self::VtuRaw => "vtu-raw",
            Self::VtuCompressed => "vtu-compressed",
            Self::VtkText => "vtk-text",
            Self::VtkBinary => "vtk-binary",
            Self::VtkGrid => "vtk-grid",
            Self::Vti => "vti",
            Self::Vtr => "vtr",
            Self::Vts => "vts",
            Self::VtkNaming => "vtk-naming",
            Self::MshText => "msh-text",
            Self::MshBinary => "msh-binary",
            Self::Nrrd => "nrrd",
            Self::Raw => "raw",
            Self::Exodus => "exodus",
            Self::ExodusHdf5 => "exodus-hdf5",
            Self::Vtkhdf => "vtkhdf",
            Self::Openfoam => "openfoam",
            Self::Plot3dGrid => "plot3d-grid",
            Self::Plot3dSolution => "plot3d-solution",
            Self::PresetJson => "preset-json",
            Self::PresetXml => "preset-xml",
            Self::Heights => "heights",
            Self::Png => "png",
            Self::Exr => "exr",
            Self::SceneToml => "scene-toml",
            Self::SceneJson => "scene-json",
        }
    }

    /// The extension of its files.
    pub fn extension(self) -> &'static str {
        match self {
            Self::VtuText | Self::VtuBase64 | Self::VtuRaw | Self::VtuCompressed => "vtu",
            Self::VtkText | Self::VtkBinary | Self::VtkGrid => "vtk",
            Self::Vti => "vti",
            Self::Vtr => "vtr",
            Self::Vts => "vts",
            // Whatever they are: the content decides.
            Self::VtkNaming => "pvd",
            Self::MshText | Self::MshBinary => "msh",
            Self::Nrrd => "nrrd",
            // The word and the samples in one: see `corpus::word_and_samples`.
            Self::Raw => "raw",
            Self::Exodus | Self::ExodusHdf5 => "exo",
            Self::Vtkhdf => "vtkhdf",
            // All files of a case in one: see `corpus::openfoam`.
            Self::Openfoam => "foam",
            Self::PresetXml => "xml",
            Self::Plot3dGrid => "xyz",
            // A grid and a solution in one: see `corpus::split`.
            Self::Plot3dSolution => "xyzq",
            Self::Heights => "heights",
            Self::Png => "png",
            Self::Exr => "exr",
            Self::SceneToml => "toml",
            Self::SceneJson | Self::PresetJson => "json",
        }
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Target {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|target| target.name() == name).ok_or_else(|| {
            let known: Vec<_> = Self::ALL.iter().map(|target| target.name()).collect();
            format!("there is no target {name}; there are {}", known.join(", "))
        })
    }
}

/// The file of a number; the same for the same seed, target and number on every machine.
///
/// Number 0 and every 64th are sound files, so that a reader that refuses everything is found out.
pub fn input(target: Target, seed: u64, number: u64) -> Vec<u8> {
    let place = Target::ALL.iter().position(|&other| other == target).unwrap_or_default() as u64;
    let mut rng = Rng::with_seed(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ (place << 48) ^ number);
    let file = corpus::file(target, &mut rng);
    if is_sound(number) { file } else { mutate::damaged(target, file, &mut rng) }
}

/// Whether [`input`] leaves the file of a number as it is.
pub fn is_sound(number: u64) -> bool {
    number.is_multiple_of(64)
}
