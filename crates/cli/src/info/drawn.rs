//! What is known of a file, in lines for people.

use tetrascope::mesh::MeshReport;
use tetrascope::short;

use super::histogram::Histogram;
use super::{Facts, MARGIN};
use crate::kinds::{kinds, name_of};

/// Lines of a histogram.
const ROWS: usize = 6;

impl Facts {
    /// A screen of text; `width` columns are there beside the subjects.
    pub(super) fn lines(&self, width: usize, is_log: bool) -> Vec<String> {
        let mut lines = Lines::default();
        lines.say("file", &self.path.display().to_string());
        lines.say("format", &self.loaded.format);
        self.steps(&mut lines);
        lines.say("points", &self.loaded.dataset.points.len().to_string());
        let kinds = kinds(&self.loaded.dataset);
        lines.say("cells", &kinds.values().sum::<usize>().to_string());
        for (kind, count) in &kinds {
            lines.say("", &format!("{count:>10}  {}", name_of(*kind)));
        }
        if let Ok(report) = &self.report {
            lines.mesh(report);
        }
        if self.arrays.is_empty() {
            lines.say("arrays", "none: there is no scalar to draw");
        }
        for (index, array) in self.arrays.iter().enumerate() {
            lines.say(if index == 0 { "arrays" } else { "" }, &format!("{array}, {}", array.type_name));
        }
        match &self.histogram {
            None => {}
            Some(Err(problem)) => lines.say("histogram", &format!("none: {problem}")),
            Some(Ok(histogram)) => lines.histogram(histogram, width, is_log),
        }
        let findings = self.report.as_ref().map_or(Vec::new(), MeshReport::findings);
        let odd: Vec<&String> = self.loaded.warnings.iter().chain(&findings).collect();
        if odd.is_empty() && self.report.is_ok() {
            lines.say("findings", "none: the mesh is sound");
        }
        for (index, finding) in odd.into_iter().enumerate() {
            lines.say(if index == 0 { "findings" } else { "" }, finding);
        }
        lines.0
    }

    fn steps(&self, lines: &mut Lines) {
        let times = &self.loaded.times;
        let Some(time) = times.get(self.loaded.step) else { return };
        let step = self.loaded.step;
        match times.as_slice() {
            [_] => lines.say("step", &format!("the only one, time {}", short(*time))),
            [first, .., last] => lines.say(
                "steps",
                &format!(
                    "{} from time {} to {}; read: step {step}, time {}",
                    times.len(),
                    short(*first),
                    short(*last),
                    short(*time)
                ),
            ),
            [] => {}
        }
    }
}

/// Lines that begin with their subject, in a column of its own.
#[derive(Default)]
struct Lines(Vec<String>);

impl Lines {
    fn say(&mut self, subject: &str, text: &str) {
        self.0.push(format!("{subject:<MARGIN$}{text}").trim_end().to_owned());
    }

    fn mesh(&mut self, report: &MeshReport) {
        let counts = &report.decomposition;
        let without_volume = match counts.no_volume {
            0 => String::new(),
            n => format!(", of which {n} have no volume"),
        };
        self.say("tetrahedra", &format!("{}{without_volume}; {} to draw", counts.tetrahedra, report.tetrahedra));
        if let Some((low, high)) = report.bounds_world {
            for (axis, low, high) in [("x", low.x, high.x), ("y", low.y, high.y), ("z", low.z, high.z)] {
                self.say(if axis == "x" { "bounds" } else { "" }, &format!("{axis} {} to {}", short(low), short(high)));
            }
        }
        self.say("volume", &short(report.volume_world));
        self.say("boundary", &format!("{} faces, {} connected parts", report.boundary_faces, report.connected_parts));
    }

    fn histogram(&mut self, histogram: &Histogram, width: usize, is_log: bool) {
        let Histogram { name, association, range, counts, non_finite } = histogram;
        let Some((low, high)) = range else {
            let all = if *non_finite == 0 {
                "there is no value".to_owned()
            } else {
                format!("none of {non_finite} values is finite")
            };
            self.say("histogram", &format!("of {name}: {all}"));
            return;
        };
        let total = histogram.total();
        let mut said = format!("of {name}: {total} {association}{}", if total == 1 { "" } else { "s" });
        if counts.len() > 1 {
            let most = counts.iter().max().copied().unwrap_or_default();
            said.push_str(&format!(" in {} bins of at most {most}", counts.len()));
        }
        if histogram.bins_a_column(width) > 1 {
            said.push_str(&format!(", {} in a column", histogram.bins_a_column(width)));
        }
        if is_log {
            said.push_str(", drawn by logarithm");
        }
        if *non_finite > 0 {
            said.push_str(&format!("; {non_finite} more not finite"));
        }
        self.say("histogram", &said);
        if counts.len() == 1 {
            self.say("", &format!("all are {}", short(*low)));
            return;
        }
        histogram.draw(width, ROWS, is_log).iter().for_each(|row| self.say("", row));
        let (low, high) = (short(*low), short(*high));
        let between = histogram.drawn_width(width).saturating_sub(low.chars().count() + high.chars().count()).max(1);
        self.say("", &format!("{low}{:between$}{high}", ""));
    }
}
