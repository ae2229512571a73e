//! The stages on the device.

use tetrascope_shaders::Program;
use tetrascope_shaders::layout::{Frame, GROUP};

use crate::Gpu;
use crate::kernel::Kernel;
use crate::testing::{checked, contents};

/// What the device says of a cell and a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Told {
    /// From the first corner's.
    pub(super) scalar: [f32; 2],
    pub(super) length: f32,
    pub(super) covered: bool,
    pub(super) depth: [f32; 2],
    pub(super) outline: [f32; 4],
    pub(super) entry_count: u32,
    pub(super) may_show: bool,
}

impl Told {
    fn of([a, b, c, d]: [[f32; 4]; 4]) -> Self {
        for number in [a, b, c, d].as_flattened() {
            assert!(number.is_finite(), "{a:?} {b:?} {c:?} {d:?}");
        }
        Self {
            scalar: [a[0], a[1]],
            length: a[2],
            covered: a[3] != 0.0,
            depth: [b[0], b[1]],
            outline: c,
            entry_count: d[0] as u32,
            may_show: d[1] != 0.0,
        }
    }
}

/// Projects vertices.
pub(super) fn project(gpu: &Gpu, frame: &Frame, vertices: &[[i32; 4]]) -> Vec<[i32; 4]> {
    checked(gpu, || {
        let program = Program::compose("cell/project.wgsl", &[], &[]).unwrap();
        let kernel = Kernel::new(gpu, &program, "project");
        let points = gpu.storage("points", size_of_val(vertices) as u64);
        let group = kernel.bind(
            gpu,
            &[
                ("frame", gpu.uniform_of("frame", frame).as_entire_binding()),
                ("vertices", gpu.storage_of("vertices", vertices).as_entire_binding()),
                ("points", points.as_entire_binding()),
            ],
        );
        let mut encoder = gpu.encoder("project");
        kernel.run_alone(&mut encoder, &group, (vertices.len() as u32).div_ceil(GROUP));
        contents(gpu, encoder, &points, vertices.len())
    })
}

/// Sets up a cell and samples a pixel for each of `asked`: cell, column, row, 0.
pub(super) fn sample(
    gpu: &Gpu,
    frame: &Frame,
    points: &[[i32; 4]],
    cells: &[[u32; 4]],
    asked: &[[i32; 4]],
) -> Vec<Told> {
    checked(gpu, || {
        let program = Program::compose("test/cell_sample.wgsl", &[("pieces", "test/pieces.wgsl")], &[]).unwrap();
        let kernel = Kernel::new(gpu, &program, "sample_cells");
        let told = gpu.storage("told", 64 * asked.len() as u64);
        let group = kernel.bind(
            gpu,
            &[
                ("frame", gpu.uniform_of("frame", frame).as_entire_binding()),
                ("points", gpu.storage_of("points", points).as_entire_binding()),
                ("cells", gpu.storage_of("cells", cells).as_entire_binding()),
                ("asked", gpu.storage_of("asked", asked).as_entire_binding()),
                ("told", told.as_entire_binding()),
            ],
        );
        let mut encoder = gpu.encoder("sample");
        kernel.run_alone(&mut encoder, &group, (asked.len() as u32).div_ceil(GROUP));
        contents::<[[f32; 4]; 4]>(gpu, encoder, &told, asked.len()).into_iter().map(Told::of).collect()
    })
}

/// What the device says of a cell's class.
#[derive(Clone, Debug)]
pub(super) struct ToldClass {
    pub(super) volumes: [f32; 4],
    /// From the first corner's.
    pub(super) scalars: [f32; 2],
    pub(super) screen: [f32; 2],
    pub(super) length: f32,
    pub(super) class: usize,
    pub(super) ring: Vec<usize>,
    pub(super) corner: usize,
}

/// Classifies cells.
pub(super) fn classify(gpu: &Gpu, frame: &Frame, points: &[[i32; 4]], cells: &[[u32; 4]]) -> Vec<ToldClass> {
    let told = checked(gpu, || {
        let program = Program::compose("test/cell_classify.wgsl", &[], &[]).unwrap();
        let kernel = Kernel::new(gpu, &program, "classify_cells");
        let told = gpu.storage("told", 64 * cells.len() as u64);
        let group = kernel.bind(
            gpu,
            &[
                ("frame", gpu.uniform_of("frame", frame).as_entire_binding()),
                ("points", gpu.storage_of("points", points).as_entire_binding()),
                ("cells", gpu.storage_of("cells", cells).as_entire_binding()),
                ("told", told.as_entire_binding()),
            ],
        );
        let mut encoder = gpu.encoder("classify");
        kernel.run_alone(&mut encoder, &group, (cells.len() as u32).div_ceil(GROUP));
        contents::<[[f32; 4]; 4]>(gpu, encoder, &told, cells.len())
    });
    let told = told.into_iter().map(|[a, b, c, d]| ToldClass {
        volumes: a,
        scalars: [b[0], b[1]],
        screen: [b[2], b[3]],
        length: c[0],
        class: d[0] as usize,
        ring: (0..d[2] as usize).map(|index| (d[1] as usize >> (4 * index)) & 15).collect(),
        corner: d[3] as usize,
    });
    told.collect()
}
