//! The cases as sections of `docs/hard-cases.md`.

use std::fmt::Write as _;

use super::judge::Finding;
use super::{Group, HardCase};
use crate::ways::Way;

/// Between these marks the document is written by `cargo xtask hard-cases`.
pub const MARKS: [&str; 2] = ["<!-- cases:begin -->", "<!-- cases:end -->"];

/// The largest figures of a case by one way.
#[derive(Clone, Debug)]
pub struct CaseFigures {
    /// Who drew it.
    pub way: Way,
    /// Scenes that are held to limits.
    pub judged: usize,
    /// Scenes that are beyond the way, of which it is told that they are: see [`HardScene::beyond`](super::HardScene::beyond).
    pub beyond: usize,
    /// Scenes that it refuses.
    pub refused: usize,
    /// Why, in the words that the user reads but for the remedy; each once.
    pub reasons: Vec<String>,
    /// Chord, crack, light; chord and crack are `None` where no scene has them.
    pub largest: [Option<f64>; 3],
}

impl CaseFigures {
    /// Nothing yet.
    pub fn new(way: Way) -> Self {
        Self { way, judged: 0, beyond: 0, refused: 0, reasons: Vec::new(), largest: [None; 3] }
    }

    /// Takes a scene's figures.
    pub fn take(&mut self, found: &Finding, is_judged: bool) {
        if let Some(words) = &found.refused {
            self.refused += 1;
            let reason = words.split(';').next().unwrap_or(words);
            if !self.reasons.iter().any(|known| known == reason) {
                self.reasons.push(reason.to_owned());
            }
        } else if is_judged {
            self.judged += 1;
            for (largest, figure) in self.largest.iter_mut().zip([found.chord, found.crack, Some(found.light)]) {
                *largest = largest.map_or(figure, |so_far| Some(figure.map_or(so_far, |new| so_far.max(new))));
            }
        } else {
            self.beyond += 1;
        }
    }

    fn sentence(&self) -> String {
        let mut text = self.way.to_string();
        for (name, figure) in ["chord", "crack", "light"].into_iter().zip(self.largest) {
            if let Some(figure) = figure.filter(|_| self.judged > 0) {
                let _ =
                    write!(text, "{} {name} {figure:.0e}", if text.ends_with(char::is_alphabetic) { "" } else { "," });
            }
        }
        if self.beyond > 0 {
            let _ = write!(text, " ({} beyond it, told)", self.beyond);
        }
        if self.refused > 0 {
            let _ = write!(text, " ({} refused: \"{}\")", self.refused, self.reasons.join("\", \""));
        }
        text
    }
}

/// The heading of a group.
pub fn heading(group: Group) -> &'static str {
    match group {
        Group::Classification => "Classification",
        Group::Eye => "The eye",
        Group::Pixels => "Rays and pixels",
        Group::Optics => "Optics",
        Group::Numbers => "Coordinates and scalars",
        Group::Mesh => "The mesh",
        Group::Order => "Order",
    }
}

/// What the document says of a case, without its figures.
pub fn beginning(case: &HardCase) -> String {
    format!("### {name}\n\n![{name}](images/hard/{name}.png)\n\n{}\n", case.text, name = case.name)
}

/// All cases with their figures.
pub fn sections(cases: &[(HardCase, Vec<CaseFigures>)]) -> String {
    let mut text = String::new();
    let mut group = None;
    for (case, figures) in cases {
        if group != Some(case.group) {
            let _ = write!(text, "## {}\n\n", heading(case.group));
            group = Some(case.group);
        }
        let scenes = (case.scenes)().len();
        let sentences: Vec<String> = figures.iter().map(CaseFigures::sentence).collect();
        let plural = if scenes == 1 { "" } else { "s" };
        let _ = write!(text, "{}\n*{scenes} scene{plural}: {}.*\n\n", beginning(case), sentences.join("; "));
    }
    text
}
