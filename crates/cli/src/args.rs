//! What the command line may say.

mod values;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use tetrascope::{
    Backend, Choice, CycleRemedy, GpuPath, Integration, Interpolation, IsosurfaceSection, LengthAxisName, OpacityName,
    OpticalModel, OrderMethod, Shading,
};

use crate::colormaps::ColormapsArgs;
use crate::convert::ConvertArgs;
use crate::info::InfoArgs;
use crate::read_args::ReadArgs;
use values::{
    Points, color_points, extinction_points, isosurface, length_axis, opacity, range, shading, size, table_size,
    target_bits, wanted_error,
};
pub(crate) use values::{fraction, number, vector};

/// Draws unstructured meshes as volumes.
#[derive(Debug, Parser)]
#[command(
    name = "tetrascope",
    version,
    about = "Draws unstructured meshes as volumes, by projecting their tetrahedra.",
    long_about = "Draws unstructured meshes as volumes, by projecting their tetrahedra.\n\n\
                  Without a command it draws a small built-in sample to tetrascope.png.",
    after_help = TOP_EXAMPLES,
    args_conflicts_with_subcommands = true
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

const TOP_EXAMPLES: &str = "\
Examples:
  tetrascope                               draw the built-in sample
  tetrascope info case.vtu                 what is in a file
  tetrascope convert case.exo case.vtu     the same mesh for other programs
  tetrascope colormaps                     which color maps have names
  tetrascope devices                       which graphics cards there are
  tetrascope check case.vtu                which visibility orders are right for it
  tetrascope study case.vtu                what accuracy costs in time
  tetrascope render case.vtu               draw it, with defaults that fit any scale
  tetrascope render scene.toml -o a.png    draw what a scene file says
  tetrascope plan scene.toml               what that would take, and why
  tetrascope compare a.exr b.exr           how far two pictures are apart
  tetrascope animate case.pvd -o frames    a picture for each time step

Exit codes: 0 good, 1 wrong input or no room (disk, memory), 2 wrong usage, 3 pictures differ by more than a threshold, 130 interrupted by
Ctrl-C, 143 by the system's request to end, 129 by a closed terminal. Files are written whole or not at all, and what they replace stays
until then; a second Ctrl-C ends at once.";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Draw a mesh or a scene to a picture.
    Render(Box<RenderArgs>),
    /// Say what is in a mesh file and what is wrong with it.
    Info(InfoArgs),
    /// Write a mesh file of any format that is read as a .vtu file, or the tetrahedra that are drawn.
    Convert(ConvertArgs),
    /// List the color maps and opacity curves that have names, with swatches.
    Colormaps(ColormapsArgs),
    /// List the graphics cards, and say which of them `--backend auto` draws with.
    Devices(DevicesArgs),
    /// Say which visibility orders are right for a mesh, and where and by how much the others are wrong.
    Check(Box<CheckArgs>),
    /// Say what would be done for a picture and what is left out, with reasons and cost; nothing is drawn.
    Plan(Box<PlanArgs>),
    /// Say how far two pictures are apart.
    Compare(CompareArgs),
    /// Draw a scene with every method, and show what accuracy costs in time.
    Study(Box<StudyArgs>),
    /// Draw the time steps of a mesh, or a turn around it, as numbered pictures with one scale for all.
    Animate(Box<crate::animate::AnimateArgs>),
}

const RENDER_EXAMPLES: &str = "\
Examples:
  tetrascope render case.vtu -o case.png
  tetrascope render case.vtu --field Velocity:mag --eye 3,-4,2 --up 0,0,1 --size 1280x720
  tetrascope render grid.xyz solution.q --field Density -o density.png -o density.exr
  tetrascope render case.e --time 0.5 --cmap plasma --range 300,900 --opacity sigmoid
  tetrascope render case.foam --field p --cells --cmap my-colors.json
  tetrascope render neghip.raw --raw 64x64x64:uint8
  tetrascope render case.vtu --color \"0:0,0,1; 0.5:1,1,1; 1:1,0,0\" --extinction \"0:0; 0.4:0; 0.5:9; 0.6:0\"
  tetrascope render case.vtu --isosurface 0.5:1,0.8,0.2 --isosurface 0.8:0.2,0.5,1,0.4 --shading smooth
  tetrascope render case.vtu --write-scene case.toml     keep all numbers, to be edited
  tetrascope render case.toml                            the same picture again
  tetrascope render case.vtu --max-error 1e-4 --verify   as fast as that error allows, and what it was

Control points are in the field's own units and in ascending order; between them color and extinction are linear. Two
points at one scalar make a step. Extinction is per world unit of length: 1 takes away 63 % of the light behind within one unit.
Isosurfaces stand in the volume; --extinction \"0:0\" leaves them alone in the picture.

Exit codes: 0 good, 1 wrong input or no room, 2 wrong usage, 130 interrupted. Files are written whole or not at all: interrupted, or with
a full disk, the old ones stay as they were. More memory than the machine has is refused before the work.";

/// What of a mesh file is shown.
#[derive(Debug, Default, Args)]
pub(crate) struct MeshArgs {
    /// Array to show: a name, or NAME:0, NAME:x, NAME:mag of a vector [default: the first scalar point array]
    #[arg(long, value_name = "NAME")]
    pub(crate) field: Option<String>,
    /// Draw a cell array as a constant in each cell, instead of averaging it onto the points
    #[arg(long)]
    pub(crate) cells: bool,
    #[command(flatten)]
    pub(crate) read: ReadArgs,
}

/// From where a mesh is seen.
#[derive(Debug, Default, Args)]
pub(crate) struct CameraArgs {
    /// Where the eye is, world coordinates [default: looks along -z and sees everything]
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true, help_heading = "Camera")]
    pub(crate) eye: Option<[f64; 3]>,
    /// What it looks at [default: the middle of the mesh]
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true, help_heading = "Camera")]
    pub(crate) target: Option<[f64; 3]>,
    /// Which direction is up in the picture [default: 0,1,0]
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true, help_heading = "Camera")]
    pub(crate) up: Option<[f64; 3]>,
    /// Perspective with this full vertical angle [default: 30]
    #[arg(long, value_name = "DEGREES", help_heading = "Camera")]
    pub(crate) fov: Option<f64>,
    /// Parallel rays, with this full height of the view in world units
    #[arg(long, value_name = "HEIGHT", conflicts_with = "fov", help_heading = "Camera")]
    pub(crate) orthographic: Option<f64>,
}

const CHECK_EXAMPLES: &str = "\
Examples:
  tetrascope check case.vtu
  tetrascope check case.vtu --view 3,-4,2 --view 0,0,9 --order mpvo --order centroid
  tetrascope check case.vtu --window 2 --window 6 --window 20    how much a k-buffer mends
  tetrascope check case.toml --heights --json
  tetrascope check case.vtu --map wrong.png        one picture an order: wrong-mpvo.png, ...

Pairs of tetrahedra are judged across the faces between them and across gaps of the mesh, without rounding; pixels by the picture
in which every pixel sorts what its ray meets. Exit codes: 0 good, 1 wrong input or no room, 2 wrong usage, 130 interrupted; an order that is
wrong is no error.";

#[derive(Debug, Args)]
#[command(after_help = CHECK_EXAMPLES)]
pub(crate) struct CheckArgs {
    /// A scene file (.toml, .json), a mesh file, or a PLOT3D grid and its solution; builtin:rings is a sample
    #[arg(required = true, num_args = 1..=2, value_name = "INPUT")]
    pub(crate) input: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) mesh: MeshArgs,
    /// An order to judge; may be repeated [default: all but those by pixels, and power where no heights are known]
    #[arg(long, value_name = "NAME")]
    pub(crate) order: Vec<OrderMethod>,
    /// Cells that a pixel holds back for --order k-buffer, which joins the orders; may be repeated, a row for each
    /// [default: 6]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) window: Vec<u32>,
    /// Number of slabs for --order bucket; may be repeated, a row for each [default: 20]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) slabs: Vec<u32>,
    /// Look for the heights of --order power where the mesh is not Delaunay
    #[arg(long)]
    pub(crate) heights: bool,

    /// Seen from here towards the middle of the mesh, world coordinates; may be repeated, inside of the mesh too
    /// [default: the camera]
    #[arg(
        long,
        value_name = "X,Y,Z",
        value_parser = vector,
        allow_hyphen_values = true,
        conflicts_with_all = ["eye", "target", "orthographic"],
        help_heading = "Camera"
    )]
    pub(crate) view: Vec<[f64; 3]>,
    #[command(flatten)]
    pub(crate) camera: CameraArgs,

    /// Pixels: one side of a square, or WIDTHxHEIGHT [default: 512]
    #[arg(long, value_name = "SIZE", value_parser = size, help_heading = "Picture")]
    pub(crate) size: Option<(u32, u32)>,
    /// Picture (.png) of where pixels are wrong, black to white by the logarithm; with an order's name for each of several
    #[arg(long, value_name = "IMAGE", help_heading = "Report")]
    pub(crate) map: Option<PathBuf>,
    /// Number of threads [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), help_heading = "Method")]
    pub(crate) threads: Option<u16>,
    /// Report on standard output as one JSON object
    #[arg(long, help_heading = "Report")]
    pub(crate) json: bool,
}

const STUDY_EXAMPLES: &str = "\
Examples:
  tetrascope study case.toml --quick           an answer in seconds
  tetrascope study case.toml -o case-study     then open case-study/study.html in a browser
  tetrascope study grid.xyz solution.q --field Density --size 256
  tetrascope study case.vtu --adapter 0        on software that poses as a graphics card, too

Every setting is compared with the exact reference and timed over a small turn of the eye. A study is a measurement: leave the machine alone
meanwhile. Exit codes: 0 good, 1 wrong input or no room, 2 wrong usage, 130 interrupted. The four files replace an earlier study's all together,
at the end: interrupted, or with a full disk, that stays as it was.";

#[derive(Debug, Args)]
#[command(after_help = STUDY_EXAMPLES)]
pub(crate) struct StudyArgs {
    /// A scene file (.toml, .json), a mesh file, or a PLOT3D grid and its solution; builtin:rings is a sample
    #[arg(required = true, num_args = 1..=2, value_name = "INPUT")]
    pub(crate) input: Vec<PathBuf>,
    /// Folder for study.html, study.csv, study.json and study.svg; made if it is not there
    #[arg(short, long, value_name = "DIR", default_value = "study")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) mesh: MeshArgs,
    /// Fewer settings, 5 frames each, and a picture of at most 160 pixels a side
    #[arg(long)]
    pub(crate) quick: bool,

    #[command(flatten)]
    pub(crate) camera: CameraArgs,

    /// Pixels: one side of a square, or WIDTHxHEIGHT [default: 512]
    #[arg(long, value_name = "SIZE", value_parser = size, help_heading = "Picture")]
    pub(crate) size: Option<(u32, u32)>,
    /// Frames of each setting that are timed; an even number takes one more [default: 9, or 5 with --quick]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=999), help_heading = "Method")]
    pub(crate) frames: Option<u16>,
    /// Part of the name of a GPU's adapter, or its number as `tetrascope devices` lists it; software is studied only if it is asked for
    /// [default: a graphics card if there is one]
    #[arg(long, value_name = "NAME", help_heading = "Method")]
    pub(crate) adapter: Option<String>,
    /// Number of threads [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), help_heading = "Method")]
    pub(crate) threads: Option<u16>,
    /// Report on standard output as one JSON object: study.json, and the files written
    #[arg(long, help_heading = "Report")]
    pub(crate) json: bool,
}

/// A scene: a file of one or a mesh, and the options that go over what it says.
#[derive(Debug, Args)]
pub(crate) struct SceneArgs {
    /// A scene file (.toml, .json), a mesh file, or a PLOT3D grid and its solution; builtin:rings is a sample
    #[arg(required = true, num_args = 1..=2, value_name = "INPUT")]
    pub(crate) input: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) look: LookArgs,
}

/// What goes over what a scene says.
#[derive(Debug, Args)]
pub(crate) struct LookArgs {
    #[command(flatten)]
    pub(crate) mesh: MeshArgs,

    #[command(flatten)]
    pub(crate) camera: CameraArgs,

    /// Pixels: one side of a square, or WIDTHxHEIGHT [default: 512]
    #[arg(long, value_name = "SIZE", value_parser = size, help_heading = "Picture")]
    pub(crate) size: Option<(u32, u32)>,
    /// Linear RGB behind the volume in a .png [default: 0,0,0]
    #[arg(long, value_name = "R,G,B", value_parser = vector, help_heading = "Picture")]
    pub(crate) background: Option<[f64; 3]>,
    /// Optical model: density-emitter, emitter, absorption, emission
    #[arg(long, value_name = "NAME", help_heading = "Picture")]
    pub(crate) model: Option<OpticalModel>,
    /// Color control points "scalar:r,g,b; ...", linear RGB [default: viridis over the field's range]
    #[arg(long, value_name = "POINTS", value_parser = color_points, allow_hyphen_values = true, help_heading = "Picture")]
    pub(crate) color: Option<Points<4>>,
    /// Extinction control points "scalar:extinction; ..." [default: 0 to 8 over the mesh's diagonal]
    #[arg(long, value_name = "POINTS", value_parser = extinction_points, allow_hyphen_values = true, help_heading = "Picture")]
    pub(crate) extinction: Option<Points<2>>,
    /// Color map: a name that `tetrascope colormaps` lists, _r at its end turns it round, or a file that ParaView saved (.json, .xml),
    /// with FILE:NAME for one of several in it [default: viridis]
    #[arg(long, value_name = "NAME|FILE", conflicts_with = "color", help_heading = "Picture")]
    pub(crate) cmap: Option<String>,
    /// Scalars of the ends of color map and opacity; those beyond have what is at the end [default: the field's range]
    #[arg(long, value_name = "LOW,HIGH", value_parser = range, allow_hyphen_values = true, help_heading = "Picture")]
    pub(crate) range: Option<[f64; 2]>,
    /// Opacity by control points "scalar:opacity; ...", 0 to 1, or by a name, over the range: linear, sigmoid, sigmoid_5, geom, foreground
    /// and others, with _r turned round. The extinction is opacity over --opacity-length
    #[arg(
        long,
        value_name = "NAME|POINTS",
        value_parser = opacity,
        allow_hyphen_values = true,
        conflicts_with = "extinction",
        help_heading = "Picture"
    )]
    pub(crate) opacity: Option<OpacityName>,
    /// The length that opacity is for, world units: at opacity 1, it takes away 63 % of the light [default: an eighth of the mesh's diagonal]
    #[arg(long, value_name = "LENGTH", value_parser = number, conflicts_with = "extinction", help_heading = "Picture")]
    pub(crate) opacity_length: Option<f64>,
    /// Surface of one value in the volume, besides those of the scene: linear RGB and opacity 0 to 1; may be repeated
    /// [default: 0.9,0.9,0.9,1]
    #[arg(
        long,
        value_name = "VALUE[:R,G,B[,OPACITY]]",
        value_parser = isosurface,
        allow_hyphen_values = true,
        help_heading = "Picture"
    )]
    pub(crate) isosurface: Vec<IsosurfaceSection>,
    /// How light falls on those: none, flat, smooth [default: none]
    #[arg(long, value_name = "NAME", value_parser = shading, requires = "isosurface", help_heading = "Picture")]
    pub(crate) shading: Option<Shading>,

    /// auto, or how a ray's way through a cell becomes a color: exact, table-3d, table-2d, partial, cumulative,
    /// opacity-2d, average, vertex
    #[arg(long, value_name = "NAME", help_heading = "Method")]
    pub(crate) integration: Option<Choice<Integration>>,
    /// auto, or how a ray's ends in a cell and the length between are found at a pixel in perspective: exact, perspective, screen
    #[arg(long, value_name = "NAME", help_heading = "Method")]
    pub(crate) interpolation: Option<Choice<Interpolation>>,
    /// Samples along each axis of the table of table-3d or table-2d [default: 64 or 256]
    #[arg(long, value_name = "N", value_parser = table_size(), help_heading = "Method")]
    pub(crate) table_size: Option<u32>,
    /// Spacing of the lengths in the table of table-3d: linear, logarithmic [default: linear]
    #[arg(long, value_name = "NAME", value_parser = length_axis, help_heading = "Method")]
    pub(crate) length_axis: Option<LengthAxisName>,
    /// auto, or in which order cells are blended: power, mpvo, bsp-xmpvo, per-pixel, k-buffer, centroid, bucket, none
    #[arg(long, value_name = "NAME", help_heading = "Method")]
    pub(crate) order: Option<Choice<OrderMethod>>,
    /// What is done about cells that hide one another in rings, for --order mpvo and bsp-xmpvo: per-pixel, cut, report
    /// [default: per-pixel]
    #[arg(long, value_name = "NAME", help_heading = "Method")]
    pub(crate) cycles: Option<CycleRemedy>,
    /// Cells that a pixel holds back for --order k-buffer [default: 6]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), help_heading = "Method")]
    pub(crate) window: Option<u32>,
    /// Keep what --order power finds in a file beside the mesh (MESH.heights) and read it from there
    #[arg(long, help_heading = "Method")]
    pub(crate) keep_heights: bool,
    /// Number of slabs for --order bucket [default: 20]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), help_heading = "Method")]
    pub(crate) slabs: Option<u32>,
    /// The largest error wanted in a channel, 0 to 1: a number, or a fraction such as 1/255; auto takes the integration that
    /// is expected to meet it in the least time [default: 0.00392, of which auto trades 1e-4]
    #[arg(long, value_name = "ERROR", value_parser = wanted_error, help_heading = "Method")]
    pub(crate) max_error: Option<f64>,
    /// auto, cpu, gpu, or reference (64-bit, every ray against every cell: slow) [default: cpu]
    #[arg(long, value_name = "NAME", help_heading = "Method")]
    pub(crate) backend: Option<Choice<Backend>>,
    /// How a GPU makes pixels of cells, for --backend gpu and auto: auto, triangles, compute
    #[arg(long, value_name = "NAME", help_heading = "Method")]
    pub(crate) gpu_path: Option<Choice<GpuPath>>,
    /// Bits of a channel that triangles are blended into, 16 or 32, for --gpu-path triangles [default: 32 where the
    /// adapter blends them]
    #[arg(long, value_name = "BITS", value_parser = target_bits, help_heading = "Method")]
    pub(crate) target_bits: Option<u32>,
    /// Part of the name of the GPU's adapter, or its number as `tetrascope devices` lists it [default: the fastest kind]
    #[arg(long, value_name = "NAME", help_heading = "Method")]
    pub(crate) adapter: Option<String>,
    /// Number of threads [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), help_heading = "Method")]
    pub(crate) threads: Option<u16>,
}

#[derive(Debug, Args)]
#[command(after_help = RENDER_EXAMPLES)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Picture to write: .png (8-bit sRGB over the background) or .exr (32-bit linear, premultiplied); may be repeated
    /// [default: tetrascope.png]
    #[arg(short, long = "output", value_name = "IMAGE")]
    pub(crate) output: Vec<PathBuf>,

    /// Write a scene file (.toml, .json) with every default as a number
    #[arg(long, value_name = "FILE", help_heading = "Report")]
    pub(crate) write_scene: Option<PathBuf>,
    /// Draw the reference as well, every ray against every cell in 64 bits, and say what the error was
    #[arg(long, conflicts_with = "quiet", help_heading = "Report")]
    pub(crate) verify: bool,
    /// Write the error of every pixel, by drawing the reference: .exr (the absolute error of each channel, linear) or .png (black up to
    /// 1e-5, white from 1 on, by the logarithm)
    #[arg(long, value_name = "IMAGE", help_heading = "Report")]
    pub(crate) error_map: Option<PathBuf>,
    /// Report on standard output as one JSON object
    #[arg(long, help_heading = "Report")]
    pub(crate) json: bool,
    /// Report also what memory of the device is used for, how long each stage took on it, and with which pipelines
    #[arg(long, conflicts_with = "quiet", help_heading = "Report")]
    pub(crate) explain: bool,
    /// Report nothing but warnings and errors
    #[arg(short, long, conflicts_with = "json", help_heading = "Report")]
    pub(crate) quiet: bool,
}

const DEVICES_NOTE: &str = "\
`tetrascope render --adapter` takes a part of a name or a number from this list. Exit codes: 0 also where there is none, 2 wrong usage.";

#[derive(Debug, Args)]
#[command(after_help = DEVICES_NOTE)]
pub(crate) struct DevicesArgs {
    /// Report on standard output as one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

const PLAN_EXAMPLES: &str = "\
Examples:
  tetrascope plan case.vtu
  tetrascope plan scene.toml --integration table-3d --json
  tetrascope plan case.vtu --extinction \"0:0; 0.4:0; 0.5:9; 0.6:0\"    how many cells show anything

It takes what `render` takes. Cells and entries of tables are counted exactly, fragments are estimated and say so; memory is exact
unless it says at most, at least or about. With --backend gpu and auto the device is asked what it can.
Exit codes: 0 good, also for a picture that would be blank or refused for want of memory, 1 wrong input, 2 wrong usage, 130 interrupted.";

#[derive(Debug, Args)]
#[command(after_help = PLAN_EXAMPLES)]
pub(crate) struct PlanArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Report on standard output as one JSON object
    #[arg(long, help_heading = "Report")]
    pub(crate) json: bool,
}

const COMPARE_EXAMPLES: &str = "\
Examples:
  tetrascope compare fast.exr exact.exr
  tetrascope compare a.png b.png --threshold 1/255 -o difference.png
  tetrascope compare a.exr b.exr --figure rms --threshold 1e-4 --json

Two .exr are compared in linear floats, all four channels; two .png by their encoded values, 0 to 1. One of each: the .exr is laid over
the background and encoded to 8-bit sRGB as `render` writes a .png, and then both are compared as that. The content decides, not the name.

Exit codes: 0 good, 1 wrong input (pictures of different sizes, too), 2 wrong usage, 3 the figure is above the threshold.";

/// What is compared with a threshold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Figure {
    /// The largest error of any channel of any pixel
    Largest,
    /// The root of the mean square over all channels
    Rms,
    /// What 999 of 1000 pixels do not exceed
    #[value(name = "p99.9")]
    Percentile,
}

#[derive(Debug, Args)]
#[command(after_help = COMPARE_EXAMPLES)]
pub(crate) struct CompareArgs {
    /// A picture: .png or .exr
    #[arg(value_name = "A")]
    pub(crate) picture: PathBuf,
    /// What it is compared with: .png or .exr, of the same size
    #[arg(value_name = "B")]
    pub(crate) other: PathBuf,
    /// Picture of the difference: .png (the worst channel of every pixel, black up to 1e-5 and to white at 1 by the logarithm) or
    /// .exr (absolute differences of all channels)
    #[arg(short, long, value_name = "IMAGE")]
    pub(crate) output: Option<PathBuf>,
    /// Exit with 3 if the figure is above this: a number, or a fraction such as 1/255
    #[arg(long, value_name = "T", value_parser = fraction, allow_hyphen_values = true)]
    pub(crate) threshold: Option<f64>,
    /// Which figure is held against the threshold
    #[arg(long, value_name = "NAME", value_enum, default_value = "largest", requires = "threshold")]
    pub(crate) figure: Figure,
    /// Linear RGB behind an .exr that is compared with a .png [default: 0,0,0]
    #[arg(long, value_name = "R,G,B", value_parser = vector)]
    pub(crate) background: Option<[f64; 3]>,
    /// Report on standard output as one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

#[cfg(test)]
mod tests;
