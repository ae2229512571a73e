//! The soak test's own tests: some of its scenes in every change, and that it finds what is wrong.

use glam::DVec3;
use tetrascope::integrate::OpticalModel;
use tetrascope::{Choice, Integration, Rendered, SceneFile, VolumeField};
use tetrascope_tests::hard::volume_of;
use tetrascope_tests::soak::{Case, Fault, Tally, draw, judge, read_case, reduce, write_case};
use tetrascope_tests::ways::Way;

/// Scenes of seeds that no soak begins with.
const SEEDS: std::ops::Range<u64> = 1_000_000..1_000_060;

#[test]
fn soak_of_some_scenes_is_clean() {
    let ways = Way::here("soak_of_some_scenes_is_clean");
    let (mut tally, mut failures) = (Tally::default(), Vec::new());
    for seed in SEEDS {
        let case = Case::of(seed);
        // On software a GPU's programs take longer to compile than all the rest.
        let judged = judge(&case, if seed % 6 == 0 { &ways } else { &Way::CPU }, &draw);
        failures.extend(judged.failures.iter().map(|failure| format!("{}: {failure}", case.describe())));
        tally.add(&case, &judged);
    }
    println!("{tally}");
    assert!(failures.is_empty(), "{failures:#?}");
    // Of many seeds 83 % show something; of so few it may be some less.
    assert!(tally.share_shown() > 0.7, "{tally}");
}

#[test]
fn soak_gives_the_same_scene_for_the_same_seed() {
    for seed in 0..20 {
        let [a, b] = [Case::of(seed), Case::of(seed)];
        assert_eq!(a.describe(), b.describe());
        assert_eq!(a.tets.points, b.tets.points);
        assert_eq!(a.scene, b.scene);
    }
    assert_ne!(Case::of(1).tets.points, Case::of(2).tets.points);
}

/// A fast renderer that is wrong as soon as a mesh has a scalar above a number, and in one pixel alone.
fn planted(way: Way, field: &VolumeField<'_>, plan: &tetrascope::Plan) -> Result<Rendered, tetrascope::Error> {
    let mut rendered = draw(way, field, plan)?;
    let has_it = field.on_mesh.scalars.iter().any(|scalar| *scalar > PLANTED);
    if way == Way::Cpu && has_it {
        let pixels = rendered.image.pixels_mut();
        let middle = pixels.len() / 2;
        pixels[middle][3] = if pixels[middle][3] > 0.5 { 0.25 } else { 0.75 };
    }
    Ok(rendered)
}

/// Above all scalars but a few.
const PLANTED: f64 = 0.9;

#[test]
fn soak_finds_a_planted_fault_and_reduces_it() {
    // The first of enough cells, drawn by all and compared in its light.
    let case = (0..200)
        .map(Case::of)
        .find(|case| {
            let [_, high] = case.scalar_range();
            let judged = judge(case, &Way::CPU, &draw);
            (PLANTED..2.0 * PLANTED).contains(&high)
                && case.tets.cells.len() > 30
                && judged.agreement == "light"
                && judged.failures.is_empty()
        })
        .unwrap();
    let judged = judge(&case, &Way::CPU, &planted);
    let failure = judged.failures.iter().find(|failure| failure.fault == Fault::Differs).unwrap();
    assert_eq!(failure.way, Way::Cpu);
    let reduced = reduce(&case, failure, &planted);
    println!("{} -> {} in {} tries", case.describe(), reduced.case.describe(), reduced.tries);
    assert_eq!(reduced.case.tets.cells.len(), 1, "{}", reduced.case.describe());
    assert_eq!(reduced.failure.fault, Fault::Differs);

    let folder = std::env::temp_dir().join(format!("tetrascope-soak-{}", std::process::id()));
    let written = write_case(&folder, &reduced.case, std::slice::from_ref(&reduced.failure)).unwrap();
    let text = std::fs::read_to_string(&written.text).unwrap();
    assert!(text.contains("--backend reference") && text.contains("cpu differs at"), "{text}");
    let read = read_case(&written.scene, case.seed).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(judge(&read, &Way::CPU, &planted).failures.iter().any(|failure| failure.fault == Fault::Differs));
    assert!(judge(&read, &Way::CPU, &draw).failures.is_empty());
}

/// Found by seed 438: a corner that lies nearly in the plane of the eye makes a triangle of the fan as narrow as rounding, over which a
/// color was continued to 1e15.
#[test]
fn soak_438_fans_have_no_color_beyond_their_corners() {
    let points = [
        [0.005115353088709695, 1.2408723540708724, -0.5218645205606098],
        [0.013936803922283914, 0.17343654725965602, 1.1365995219626155],
        [-1.291039082284943, -0.2623977248374499, -0.27658356019031244],
        [0.002112226856877397, 0.18483977597484685, 1.1440018679009603],
    ]
    .map(DVec3::from);
    let volume = volume_of(&points, &[[0, 2, 1, 3]], &[-0.307, 0.122, -0.796, 0.97]);
    let mut scene = SceneFile::of_mesh("in memory");
    (scene.image.width, scene.image.height) = (8, 8);
    scene.camera.eye = Some([0.02876450721952284, 1.2180658966404905, -0.5366692124372998]);
    scene.camera.target = Some([-0.2660769616210248, 0.1300356100881993, 0.07419360364313832]);
    scene.camera.up = Some([-0.23017380324552716, -0.9751808922309748, 0.611147825195528]);
    scene.camera.fov_y = Some(40.39241719801015);
    scene.optics.model = OpticalModel::DensityEmitter;
    scene.transfer.color = Some(vec![[-0.992, 0.189, 0.601, 0.000159], [1.0, 0.407, 0.805, 0.836]]);
    scene.transfer.extinction = Some(vec![[-0.688, 1.77]]);
    scene.quality.integration = Choice::Named(Integration::Vertex);
    let image = Way::Cpu.draw(&volume, &scene).unwrap().image;
    assert!(image.pixels().iter().any(|pixel| pixel[3] > 0.01));
    for pixel in image.pixels() {
        for (channel, brightest) in pixel.iter().zip([0.407, 0.805, 0.836]) {
            assert!(*channel <= pixel[3] * brightest * 1.0001, "{pixel:?}");
        }
    }
}
