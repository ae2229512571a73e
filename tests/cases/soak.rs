//! The soak test's own tests: some of its scenes in every change, and that it finds what is wrong.

use tetrascope::{Rendered, VolumeField};
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
    assert!(tally.share_shown() > 0.8, "{tally}");
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

/// A fast renderer that is wrong as soon as a mesh has a cell at its lowest point, and in one pixel alone.
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

/// Above all scalars of the seed but a few.
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
