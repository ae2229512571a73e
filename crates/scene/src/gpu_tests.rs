//! The GPU in scenes: what may be asked of it, what is dropped with a word, and what it cannot do.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use glam::DVec3;
use tetrascope_integrate::{Integration, OpticalModel, TransferFunction};
use tetrascope_order::CycleRemedy;
use tetrascope_view::{Camera, Projection, View};

use crate::{
    Backend, Choice, Completed, GpuOptions, GpuPath, MeshFacts, Plan, PlanError, SceneError, SceneFile, TargetBits,
};

fn complete(text: &str) -> Result<Completed, SceneError> {
    let facts = MeshFacts { lowest: DVec3::ZERO, highest: DVec3::ONE, scalar_range: (0.0, 1.0) };
    SceneFile::parse(&format!("[mesh]\npath = \"m\"\n[quality]\n{text}"), "a.toml".as_ref()).unwrap().complete(&facts)
}

fn completed(text: &str) -> Completed {
    complete(text).unwrap()
}

#[test]
fn names_are_read_and_written() {
    for backend in Backend::ALL {
        assert_eq!(backend.to_string().parse(), Ok(backend));
    }
    for path in GpuPath::ALL {
        assert_eq!(path.to_string().parse(), Ok(path));
    }
    let message = "vulkan".parse::<Backend>().unwrap_err().to_string();
    assert_eq!(message, "there is no back end named \"vulkan\"; there are cpu, gpu and reference");
    let message = "mesh".parse::<GpuPath>().unwrap_err().to_string();
    assert_eq!(message, "there is no path named \"mesh\" on a GPU; there are triangles and compute");
    assert_eq!(TargetBits::ALL.map(TargetBits::bits), [16, 32]);
    assert_eq!(
        [8, 16, 24, 32].map(TargetBits::of),
        [None, Some(TargetBits::Sixteen), None, Some(TargetBits::ThirtyTwo)]
    );
}

#[test]
fn the_cpu_draws_where_nothing_is_said() {
    let scene = completed("");
    assert_eq!(scene.scene.plan().unwrap().backend, Backend::Cpu);
    assert!(!scene.leaves_backend_open());
    assert!(scene.file.to_toml().unwrap().contains("backend = \"cpu\""));
}

#[test]
fn a_plan_has_what_is_asked_of_the_gpu() {
    for (text, gpu) in [
        ("", GpuOptions::default()),
        ("gpu_path = \"auto\"", GpuOptions::default()),
        ("gpu_path = \"compute\"", GpuOptions { path: Some(GpuPath::Compute), ..GpuOptions::default() }),
        (
            "gpu_path = \"triangles\"\ntarget_bits = 16\nadapter = \"llvmpipe\"",
            GpuOptions {
                path: Some(GpuPath::Triangles),
                target_bits: Some(TargetBits::Sixteen),
                adapter: Some("llvmpipe".to_owned()),
            },
        ),
    ] {
        let once = completed(&format!("backend = \"gpu\"\n{text}"));
        let plan = once.scene.plan().unwrap();
        assert_eq!((plan.backend, &plan.gpu), (Backend::Gpu, &gpu));
        assert_eq!(once.warnings, Vec::<String>::new());
        // What is written leads to the same plan.
        let written = once.file.to_toml().unwrap();
        let facts = MeshFacts { lowest: DVec3::ZERO, highest: DVec3::ONE, scalar_range: (0.0, 1.0) };
        let again = SceneFile::parse(&written, "a.toml".as_ref()).unwrap().complete(&facts).unwrap();
        assert_eq!((&again.file, again.scene.plan().unwrap().gpu), (&once.file, gpu), "{written}");
    }
}

#[test]
fn what_no_gpu_is_asked_for_is_dropped_with_a_warning() {
    for backend in ["cpu", "reference"] {
        for (key, value) in [("gpu_path", "\"auto\""), ("target_bits", "32"), ("adapter", "\"0\"")] {
            let scene = completed(&format!("backend = \"{backend}\"\n{key} = {value}"));
            assert_eq!(scene.warnings, [format!("quality.{key} has no effect: the back end is {backend}, not gpu")]);
            assert!(!scene.file.to_toml().unwrap().contains(key));
            assert_eq!(scene.scene.plan().unwrap().gpu, GpuOptions::default());
        }
    }
    let compute = completed("backend = \"gpu\"\ngpu_path = \"compute\"\ntarget_bits = 16");
    assert_eq!(
        compute.warnings,
        ["quality.target_bits has no effect: the path compute blends in 32 bits, in no target"]
    );
    let error = complete("backend = \"gpu\"\ntarget_bits = 24").unwrap_err().to_string();
    assert_eq!(error, "quality.target_bits is 24; give 16 or 32");
}

#[test]
fn an_open_back_end_is_settled() {
    let text = "backend = \"auto\"\ngpu_path = \"triangles\"\ntarget_bits = 32\nadapter = \"amd\"";
    for backend in [Backend::Gpu, Backend::Cpu] {
        let mut scene = completed(text);
        assert!(scene.leaves_backend_open() && scene.leaves_order_open());
        // The CPU, which every machine has, as long as nobody has looked.
        assert_eq!(scene.scene.plan().unwrap().backend, Backend::Cpu);
        scene.settle_backend(backend, "it is there").unwrap();
        assert!(!scene.leaves_backend_open());
        let plan = scene.scene.plan().unwrap();
        assert_eq!((plan.backend, scene.file.quality.backend), (backend, Choice::Named(backend)));
        assert_eq!(plan.gpu.target_bits.is_some(), backend == Backend::Gpu);
        assert_eq!(scene.file.quality.adapter.is_some(), backend == Backend::Gpu);
        let said: Vec<String> =
            scene.decisions.iter().filter(|d| d.subject == "backend").map(ToString::to_string).collect();
        assert_eq!(said, [format!("backend: {backend} (it is there)")]);
        assert_eq!(scene.warnings, Vec::<String>::new());
    }
}

#[test]
fn the_gpu_draws_whole_cells() {
    let text = "cycles = \"cut\"\norder = \"bsp-xmpvo\"\nbackend = ";
    let error = complete(&format!("{text}\"gpu\"")).unwrap_err();
    assert!(matches!(error, SceneError::Conflict { key: "quality.cycles", .. }), "{error:?}");
    assert_eq!(
        error.to_string(),
        "quality.cycles = \"cut\" leaves pieces of cells, and the back end \"gpu\" draws whole ones; use quality.cycles = \
         \"per-pixel\" or quality.backend = \"cpu\""
    );
    let open = completed(&format!("{text}\"auto\""));
    assert_eq!(open.scene.why_not_on_gpu(), Some(error));
    assert_eq!(completed(&format!("{text}\"cpu\"")).scene.plan().unwrap().cycles, CycleRemedy::Cut);
    assert_eq!(completed("cycles = \"report\"\nbackend = \"auto\"").scene.why_not_on_gpu(), None);
}

#[test]
fn fans_go_with_triangles() {
    let vertex = completed("integration = \"vertex\"\nbackend = \"gpu\"");
    let plan = vertex.scene.plan().unwrap();
    assert_eq!(plan.gpu.path, Some(GpuPath::Triangles));
    assert!(vertex.decisions.iter().any(|d| d.subject == "path"), "{:?}", vertex.decisions);
    let error = complete("integration = \"vertex\"\nbackend = \"gpu\"\ngpu_path = \"compute\"").unwrap_err();
    assert!(matches!(error, SceneError::Conflict { key: "quality.integration", .. }), "{error:?}");
    let text = error.to_string();
    assert!(text.contains("quality.gpu_path = \"triangles\""), "{text}");

    let mut open = completed("integration = \"vertex\"\nbackend = \"auto\"");
    assert_eq!(open.scene.why_not_on_gpu(), None);
    assert!(open.decisions.iter().all(|d| d.subject != "path"));
    open.settle_backend(Backend::Gpu, "it is there").unwrap();
    assert_eq!(open.decisions.iter().filter(|d| d.subject == "path").count(), 1);
    let compute = completed("integration = \"vertex\"\nbackend = \"auto\"\ngpu_path = \"compute\"");
    assert_eq!(compute.scene.why_not_on_gpu(), Some(error));
}

/// Plans that no scene led to are refused in words too.
#[test]
fn plans_for_the_gpu_are_checked() {
    let camera =
        Camera { eye: DVec3::Z, target: DVec3::ZERO, up: DVec3::Y, projection: Projection::Perspective { fov_y: 1.0 } };
    let transfer = TransferFunction::new(&[[0.0, 1.0, 1.0, 1.0]], &[[0.0, 1.0]]).unwrap();
    let mut plan = Plan::new(View::new(&camera, 8, 8).unwrap(), transfer, OpticalModel::DensityEmitter);
    assert_eq!(plan.check_on_gpu(), Ok(()));
    plan.cycles = CycleRemedy::Cut;
    assert_eq!((plan.check(), plan.check_on_gpu()), (Ok(()), Err(PlanError::CutOnGpu)));
    plan.cycles = CycleRemedy::PerPixel;
    plan.integration = Integration::Vertex;
    assert_eq!(plan.check_on_gpu(), Ok(()));
    plan.gpu.path = Some(GpuPath::Compute);
    assert_eq!((plan.check(), plan.check_on_gpu()), (Ok(()), Err(PlanError::FanOnComputePath)));
    for error in [PlanError::CutOnGpu, PlanError::FanOnComputePath] {
        let text = error.to_string();
        assert!(text.contains("\"gpu\"") && text.contains("; use ") && !text.contains("  "), "{text}");
    }
}

#[test]
fn another_back_end_forgets_what_was_asked_of_the_gpu() {
    let text = "[mesh]\npath = \"m\"\n[quality]\nbackend = \"gpu\"\ngpu_path = \"triangles\"\ntarget_bits = 16\nadapter = \"0\"";
    for (backend, is_kept) in [
        (Choice::Auto, true),
        (Choice::Named(Backend::Gpu), true),
        (Choice::Named(Backend::Cpu), false),
        (Choice::Named(Backend::Reference), false),
    ] {
        let mut quality = SceneFile::parse(text, "a.toml".as_ref()).unwrap().quality;
        quality.replace_backend(backend);
        assert_eq!(quality.backend, backend);
        let kept = [quality.gpu_path.is_some(), quality.target_bits.is_some(), quality.adapter.is_some()];
        assert_eq!(kept, [is_kept; 3]);
    }
}
