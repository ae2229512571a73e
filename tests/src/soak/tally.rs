//! Counts over all cases of a run.

use std::collections::BTreeMap;
use std::fmt;

use super::{Case, Judged};
use crate::ways::Way;

/// What a run came to.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Cases.
    pub scenes: usize,
    /// Pictures, those for the number of threads included.
    pub pictures: usize,
    /// Cases with something wrong.
    pub failed: usize,
    /// Cases with nothing to see.
    pub blank: usize,
    /// Cases that nobody drew.
    pub not_drawn: usize,
    /// Pixels that were right only for a scene a rounding away.
    pub at_edges: usize,
    kinds: [BTreeMap<String, usize>; 6],
    refusals: BTreeMap<String, usize>,
    /// For every way the largest difference in parts of its limit, the difference and the seed.
    worst: BTreeMap<String, (f64, f64, u64)>,
}

impl Tally {
    /// Counts a case.
    pub fn add(&mut self, case: &Case, judged: &Judged) {
        self.scenes += 1;
        self.pictures += judged.pictures;
        self.failed += usize::from(!judged.failures.is_empty());
        self.at_edges += judged.at_edges;
        if judged.refusals.iter().any(|(way, _)| *way == Way::Reference) {
            self.not_drawn += 1;
        } else {
            self.blank += usize::from(judged.is_blank);
        }
        let mut count = |list: usize, what: &str| *self.kinds[list].entry(what.to_owned()).or_default() += 1;
        count(0, case.mesh_kind);
        case.changes.iter().for_each(|change| count(1, change));
        count(2, case.view_kind);
        count(3, case.transfer_kind);
        count(4, case.scene.optics.model.name());
        count(5, judged.agreement);
        for (way, words) in &judged.refusals {
            *self.refusals.entry(format!("{way}: {}", without_numbers(words))).or_default() += 1;
        }
        for margin in &judged.margins {
            let share = margin.difference / margin.limit;
            let worst = self.worst.entry(margin.way.to_string()).or_default();
            if share > worst.0 {
                *worst = (share, margin.difference, case.seed);
            }
        }
    }

    /// Share of the drawn scenes that show something.
    pub fn share_shown(&self) -> f64 {
        let drawn = self.scenes - self.not_drawn;
        (drawn - self.blank) as f64 / drawn.max(1) as f64
    }
}

/// A message without what differs from scene to scene.
fn without_numbers(words: &str) -> String {
    let mut text = String::new();
    for c in words.chars() {
        let c = if c.is_ascii_digit() { '#' } else { c };
        if c != '#' || !text.ends_with('#') {
            text.push(c);
        }
    }
    text
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} scenes, {} pictures, {} failed; {} were not drawn by anybody, of the others {:.0} % show something; {} pixels were at edges",
            self.scenes,
            self.pictures,
            self.failed,
            self.not_drawn,
            100.0 * self.share_shown(),
            self.at_edges
        )?;
        let titles = ["meshes", "changes and fields", "views", "transfer functions", "models", "compared"];
        for (title, counts) in titles.iter().zip(&self.kinds) {
            let counts: Vec<String> = counts.iter().map(|(kind, count)| format!("{kind} {count}")).collect();
            writeln!(f, "{title}: {}", counts.join(", "))?;
        }
        for (way, (share, difference, seed)) in &self.worst {
            writeln!(
                f,
                "nearest to its limit, {way}: {difference:.2e}, {share:.2} of what is allowed, in seed {seed}"
            )?;
        }
        for (words, count) in &self.refusals {
            writeln!(f, "refused {count} times, {words}")?;
        }
        Ok(())
    }
}
