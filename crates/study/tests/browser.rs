//! The page in a real browser: its points are there, and one that the mouse is over says what it is.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

mod chromium;

use std::time::Duration;

use chromium::Chromium;
use serde_json::Value;
use tetrascope::{SceneFile, Silent, Volume};
use tetrascope_study::{Figure, Options, Study};

#[test]
fn points_of_the_page_tell_their_settings() {
    let folder = tempfile::tempdir().unwrap();
    let Some(mut browser) = Chromium::start(folder.path()) else { return };
    let study = small_study();
    study.write(folder.path()).unwrap();
    let json: Value =
        serde_json::from_str(&std::fs::read_to_string(folder.path().join("study.json")).unwrap()).unwrap();
    let settings = json["settings"].as_array().unwrap();
    assert!(settings.len() > 10, "{} settings", settings.len());

    browser.open(&folder.path().join("study.html"));
    for figure in Figure::ALL {
        let count =
            browser.number(&format!("document.querySelectorAll('[data-figure={}] .point').length", figure.key()));
        assert_eq!(count as usize, settings.len(), "{figure:?}");
    }
    assert_eq!(browser.number("document.querySelectorAll('.view:not([hidden])').length"), 1.0);
    assert_eq!(browser.number("document.querySelectorAll('tbody tr').length") as usize, settings.len());

    let [index, x, y] = free_point(&mut browser);
    assert_eq!(browser.text("document.getElementById('tip').hidden ? 'no tip' : 'tip'"), "no tip");
    browser.mouse("mouseMoved", x, y);
    let tip = browser.wait_for("const tip = document.getElementById('tip'); tip.hidden ? '' : tip.innerText");
    let setting = &settings[index as usize];
    assert_eq!(tip.lines().next().unwrap(), setting["name"].as_str().unwrap());
    assert!(tip.contains("ms a frame") && tip.contains("largest error"), "{tip}");

    // A click shows its pictures, and no other's.
    browser.mouse("mousePressed", x, y);
    browser.mouse("mouseReleased", x, y);
    let shown = "all('.detail:not([hidden])').map(one => one.dataset.index).join()";
    assert_eq!(browser.wait_for(&format!("{shown} === '{index}' ? 'shown' : ''")), "shown");
    let images = format!("all('.detail[data-index=\"{index}\"] img').filter(one => one.naturalWidth > 0).length");
    assert_eq!(browser.number(&images), 2.0);

    browser.mouse("mouseMoved", 2.0, 2.0);
    assert_eq!(browser.wait_for("document.getElementById('tip').hidden ? 'gone' : ''"), "gone");
    // Another point than the one that the click gave the focus to.
    browser.number("all('.view:not([hidden]) .point:not(:focus)').at(-1).focus(), 0");
    let focused = browser.wait_for("const t = document.getElementById('tip'); t.hidden ? '' : t.innerText");
    assert!(settings.iter().any(|one| focused.starts_with(one["name"].as_str().unwrap())), "{focused}");

    browser.number("document.querySelector('input[value=rms]').click(), 0");
    let figure = "all('.view:not([hidden])').map(one => one.dataset.figure).join()";
    assert_eq!(browser.wait_for(&format!("{figure} === 'rms' ? 'rms' : ''")), "rms");
    check_sorting(&mut browser);

    let loaded = "performance.getEntriesByType('resource').filter(one => !one.name.startsWith('data:')).length";
    assert_eq!(browser.number(loaded), 0.0, "the page loads something");
    assert_eq!(browser.exceptions(), Vec::<String>::new());
}

/// A heading that is clicked puts its column in order, clicked again in the other.
fn check_sorting(browser: &mut Chromium) {
    let values = "all('tbody tr').map(row => Number(row.children[2].dataset.value))";
    let is_sorted =
        |sign| format!("{values}.every((v, i, all) => i === 0 || {sign} * (v - all[i - 1]) >= 0) ? 'sorted' : ''");
    for sign in [1, -1] {
        browser.number("document.querySelectorAll('thead th button')[2].click(), 0");
        assert_eq!(browser.wait_for(&is_sorted(sign)), "sorted", "{sign}");
    }
}

/// A point that no other one covers: its index, and where its middle is in the window.
fn free_point(browser: &mut Chromium) -> [f64; 3] {
    let found = browser.text(
        "const found = all('.view:not([hidden]) .point').map(point => { \
           const box = point.querySelector('.mark').getBoundingClientRect(); \
           const [x, y] = [box.x + box.width / 2, box.y + box.height / 2]; \
           return { point, x, y }; \
         }).find(({ point, x, y }) => point.contains(document.elementFromPoint(x, y))); \
         found ? [found.point.dataset.index, found.x, found.y].join() : ''",
    );
    let numbers: Vec<f64> = found.split(',').map(|number| number.parse().unwrap()).collect();
    numbers.try_into().expect("a point that can be seen")
}

fn small_study() -> Study {
    let mut scene = SceneFile::of_mesh(tetrascope::SAMPLE);
    (scene.image.width, scene.image.height) = (32, 32);
    let volume = Volume::sample().unwrap();
    let field = volume.field(None).unwrap();
    let start = field.plan(&mut scene.complete(&field.facts).unwrap()).unwrap();
    let options = Options { is_quick: true, frames: Some(1), uses_gpu: false, ..Options::default() };
    Study::run(&field, &start, &options, &Silent).unwrap()
}

/// How long something may take that a page does at once, on a machine that is busy.
const PATIENCE: Duration = Duration::from_secs(30);
