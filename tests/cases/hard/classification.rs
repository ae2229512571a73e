//! Hard cases of classification.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};
use tetrascope::classify::{TRUTH_TABLE, TableEntry, Tests, Viewpoint, exact_signs, project};
use tetrascope_tests::hard::{cells_of_the_table, impossible_cells, named};
use tetrascope_tests::ways::Way;

use super::check;

#[test]
fn hard_vertex_on_an_edge() {
    check("vertex-on-an-edge");
}

#[test]
fn hard_vertex_on_a_vertex() {
    check("vertex-on-a-vertex");
}

#[test]
fn hard_four_corners_on_a_line() {
    check("four-corners-on-a-line");
}

#[test]
fn hard_slivers() {
    check("slivers");
}

#[test]
fn hard_needles() {
    check("needles");
}

#[test]
fn hard_caps() {
    check("caps");
}

#[test]
fn hard_coincident_points() {
    check("coincident-points");
}

#[test]
fn hard_inverted_cells() {
    check("inverted-cells");
}

/// A cell given inside out is the same cell: every bit of the pictures is.
#[test]
fn hard_inverted_cells_draw_the_same_bits() {
    let scenes = (named("inverted-cells").unwrap().scenes)();
    let upright = scenes.last().unwrap();
    for way in Way::here("inverted cells") {
        let expected = way.draw(&upright.volume, &upright.scene).unwrap().image;
        for hard in &scenes {
            let drawn = way.draw(&hard.volume, &hard.scene).unwrap().image;
            assert_eq!(drawn, expected, "{}, {way}", hard.place);
        }
    }
}

#[test]
fn hard_entries_of_the_table() {
    check("entries-of-the-table");
}

/// What a view straight down sees of corners: y runs down on the screen.
fn on_screen(corners: &[DVec3; 4]) -> [DVec2; 4] {
    corners.map(|p| DVec2::new(p.x, -p.y))
}

#[test]
fn hard_entries_of_the_table_are_all_drawn() {
    let drawn: BTreeSet<usize> = cells_of_the_table()
        .iter()
        .map(|(code, corners)| {
            let tests = Tests::of(&on_screen(corners));
            assert_eq!(tests.code(), *code);
            let shown = project(corners, &[0.0; 4], [0, 1, 2, 3], Viewpoint::Direction(DVec3::NEG_Z));
            assert_eq!(*tests.entry(), TableEntry::Valid { class: shown.class, fan: shown.fan });
            *code
        })
        .collect();
    assert_eq!(drawn.len(), 50);
}

#[test]
fn hard_impossible_entries() {
    check("impossible-entries");
}

/// Rounding reaches entries that no points have; without rounding the same points have none of them, and their cells draw nothing wrong.
#[test]
fn hard_impossible_entries_come_from_rounding_alone() {
    let cells = impossible_cells();
    println!("impossible entries that rounding reaches: {} of 30", cells.len());
    assert!(cells.len() >= 20, "{}", cells.len());
    for (code, corners) in cells {
        let screen = on_screen(&corners);
        assert_eq!(*Tests::of(&screen).entry(), TableEntry::Impossible);
        assert_ne!(*Tests::exact(&screen).entry(), TableEntry::Impossible, "entry {code}");
        let down = Viewpoint::Direction(DVec3::NEG_Z);
        let exact = exact_signs(&corners, down);
        assert_ne!(TRUTH_TABLE[Tests::exact(&screen).code()], TableEntry::Impossible);
        assert_eq!(exact, Tests::exact(&screen).signs(), "entry {code}");
        let shown = project(&corners, &[0.0; 4], [0, 1, 2, 3], down);
        assert_eq!(shown.thick.is_some(), !shown.fan.as_slice().is_empty(), "entry {code}");
    }
}

#[test]
fn hard_thick_vertex_between_parallel_edges() {
    check("thick-vertex-between-parallel-edges");
}

#[test]
fn hard_crossing_at_the_ends() {
    check("crossing-at-the-ends");
}
