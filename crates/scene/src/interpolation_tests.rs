//! Ways to segments in scenes: what may be asked, what is refused by name, what is said and written.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use glam::DVec3;
use tetrascope_integrate::{Integration, OpticalModel, TransferFunction};
use tetrascope_view::{Camera, Projection, View};

use crate::{Backend, Choice, Completed, Interpolation, MeshFacts, Plan, PlanError, SceneError, SceneFile};

const FACTS: MeshFacts = MeshFacts { lowest: DVec3::ZERO, highest: DVec3::ONE, scalar_range: (0.0, 1.0) };

fn complete(text: &str) -> Result<Completed, SceneError> {
    SceneFile::parse(&format!("[mesh]\npath = \"m\"\n{text}"), "a.toml".as_ref()).unwrap().complete(&FACTS)
}

fn completed(text: &str) -> Completed {
    complete(&format!("[quality]\n{text}")).unwrap()
}

/// The decisions on it.
fn said(completed: &Completed) -> Vec<String> {
    completed.decisions.iter().filter(|d| d.subject == "interpolation").map(ToString::to_string).collect()
}

#[test]
fn names_are_read_and_written() {
    for way in Interpolation::ALL {
        assert_eq!(way.to_string().parse(), Ok(way));
        let scene = completed(&format!("interpolation = \"{way}\""));
        assert_eq!(scene.scene.plan().unwrap().interpolation, way);
        assert_eq!(said(&scene), [format!("interpolation: {way} (asked for)")]);
        let written = scene.file.to_toml().unwrap();
        assert!(written.contains(&format!("interpolation = \"{way}\"")), "{written}");
        let again = SceneFile::parse(&written, "a.toml".as_ref()).unwrap().complete(&FACTS).unwrap();
        assert_eq!((again.scene.interpolation, &again.file), (Some(way), &scene.file));
    }
    let message = "linear".parse::<Interpolation>().unwrap_err().to_string();
    assert_eq!(message, "there is no interpolation named \"linear\"; there are exact, perspective and screen");
}

#[test]
fn nothing_asked_is_exact_and_goes_without_a_word() {
    for text in ["", "interpolation = \"auto\""] {
        let scene = completed(text);
        assert_eq!(scene.scene.plan().unwrap().interpolation, Interpolation::Exact);
        assert_eq!(scene.file.quality.interpolation, Choice::Named(Interpolation::Exact));
        assert_eq!(said(&scene), Vec::<String>::new());
    }
}

#[test]
fn without_perspective_all_are_exact() {
    for way in ["perspective", "screen"] {
        for backend in ["cpu", "gpu", "reference"] {
            let text = format!(
                "[camera]\nprojection = \"orthographic\"\n[quality]\ninterpolation = \"{way}\"\nbackend = \"{backend}\""
            );
            let scene = complete(&text).unwrap();
            assert_eq!(scene.scene.plan().unwrap().interpolation, Interpolation::Exact);
            assert_eq!(
                said(&scene),
                ["interpolation: exact (there is no perspective to correct: all ways give the same)"]
            );
            assert!(scene.file.to_toml().unwrap().contains("interpolation = \"exact\""));
        }
    }
}

#[test]
fn fans_of_colors_have_their_own() {
    for way in ["perspective", "screen"] {
        let text = format!("[quality]\nintegration = \"vertex\"\ninterpolation = \"{way}\"");
        let error = complete(&text).unwrap_err();
        assert!(matches!(error, SceneError::Conflict { key: "quality.interpolation", .. }), "{error:?}");
        assert_eq!(
            error.to_string(),
            format!(
                "quality.interpolation = \"{way}\" is a way to segments, and quality.integration = \"vertex\" interpolates colors in a way of \
                 its own; use quality.interpolation = \"exact\" or another integration, such as \"exact\""
            )
        );
    }
    assert!(complete("[quality]\nintegration = \"vertex\"\ninterpolation = \"exact\"").is_ok());
    // Without perspective there is one way alone.
    let orthographic =
        "[camera]\nprojection = \"orthographic\"\n[quality]\nintegration = \"vertex\"\ninterpolation = \"screen\"";
    assert!(complete(orthographic).is_ok());
}

#[test]
fn the_cpu_alone_draws_them() {
    let gpu = "[quality]\ninterpolation = \"screen\"\nbackend = ";
    let error = complete(&format!("{gpu}\"gpu\"")).unwrap_err();
    assert_eq!(
        error.to_string(),
        "quality.interpolation = \"screen\" is drawn on the back end \"cpu\" alone; use quality.backend = \"cpu\" or \
         quality.interpolation = \"exact\""
    );
    // The back end that is left open is then the CPU.
    let open = complete(&format!("{gpu}\"auto\"")).unwrap();
    assert_eq!(open.scene.why_not_on_gpu(), Some(error));
    assert_eq!(completed("interpolation = \"exact\"\nbackend = \"auto\"").scene.why_not_on_gpu(), None);
}

#[test]
fn the_reference_has_its_own() {
    let scene = completed("interpolation = \"screen\"\nbackend = \"reference\"");
    assert_eq!(said(&scene), ["interpolation: exact (the reference clips every ray)"]);
    // As with orders, the scene keeps what another back end would draw.
    assert_eq!(scene.file.quality.interpolation, Choice::Named(Interpolation::Screen));
    assert_eq!(scene.file.quality.backend, Choice::Named(Backend::Reference));
}

/// Plans that no scene led to are refused in words too.
#[test]
fn plans_are_checked() {
    let camera =
        Camera { eye: DVec3::Z, target: DVec3::ZERO, up: DVec3::Y, projection: Projection::Perspective { fov_y: 1.0 } };
    let transfer = TransferFunction::new(&[[0.0, 1.0, 1.0, 1.0]], &[[0.0, 1.0]]).unwrap();
    let plain = Plan::new(View::new(&camera, 8, 8).unwrap(), transfer, OpticalModel::DensityEmitter);
    for interpolation in [Interpolation::Perspective, Interpolation::Screen] {
        for integration in Integration::ALL {
            let plan = Plan { integration, interpolation, ..plain.clone() };
            let on_fans = PlanError::FanWithInterpolation { interpolation };
            assert_eq!(plan.check(), if integration.needs_fan() { Err(on_fans) } else { Ok(()) });
            assert_eq!(plan.check_on_gpu(), Err(PlanError::InterpolationOnGpu { interpolation }));
        }
        for error in
            [PlanError::FanWithInterpolation { interpolation }, PlanError::InterpolationOnGpu { interpolation }]
        {
            let text = error.to_string();
            assert!(text.contains(interpolation.name()) && text.contains("; use ") && !text.contains("  "), "{text}");
        }
    }
}
