//! What the command line says of a mesh file besides its name, and the mesh that it names.

use std::path::Path;

use clap::Args;
use tetrascope::{Loaded, RawVolume, ReadOptions, StepChoice, Volume, is_builtin, read_mesh};

use crate::Failure;
use crate::args::number;
use crate::progress::Bar;

/// Which step of a file is read, and what a raw volume is.
#[derive(Debug, Default, Args)]
pub(crate) struct ReadArgs {
    /// Time step to read, counted from 0 [default: the last one]
    #[arg(long, value_name = "N", conflicts_with = "time", help_heading = "Input")]
    pub(crate) step: Option<usize>,
    /// Time whose nearest step is read
    #[arg(long, value_name = "TIME", value_parser = number, allow_hyphen_values = true, help_heading = "Input")]
    pub(crate) time: Option<f64>,
    /// The file is samples and nothing else: their number along x, y and z and their type, as in 64x64x64:uint8 or
    /// 64x64x93:int16:big:spacing=3.2,3.2,1.5:origin=0,0,0:components=1:skip=512
    #[arg(long, value_name = "SIZE:TYPE", help_heading = "Input")]
    pub(crate) raw: Option<RawVolume>,
}

impl ReadArgs {
    /// Reads a mesh file, or makes a built-in mesh.
    pub(crate) fn read(&self, path: &Path, solution: Option<&Path>, bar: &Bar) -> Result<Loaded, Failure> {
        if is_builtin(path) {
            let volume = Volume::load(path, &ReadOptions::default())?;
            return Ok(Loaded::without_time(volume.dataset, volume.format, volume.warnings));
        }
        let step = match (self.step, self.time) {
            (Some(number), _) => StepChoice::Number(number),
            (None, Some(time)) => StepChoice::Time(time),
            (None, None) => StepChoice::Last,
        };
        let progress = bar.reading();
        let options = ReadOptions { solution: solution.map(Path::to_owned), step, raw: self.raw, progress };
        Ok(read_mesh(path, &options).map_err(tetrascope::Error::Io)?)
    }
}
