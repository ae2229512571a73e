//! The study in a folder.

use std::path::{Path, PathBuf};

use tetrascope::{make_folder, write_files};

use crate::{Error, Figure, Study, chart_svg, csv, html, json};

impl Study {
    /// Names of the devices that drew, each once.
    pub fn devices(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for name in self.outcomes.iter().filter_map(|outcome| outcome.device.as_deref()) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names
    }

    /// Writes `study.csv`, `study.json`, `study.svg` and `study.html` into a folder, which is made if it is not there; gives their paths.
    ///
    /// All four are complete before the first replaces one of an earlier study: should there be no room for one, the earlier study stays as it
    /// was.
    ///
    /// # Errors
    /// [`Error::Tetrascope`] if the folder cannot be made or a file not written.
    pub fn write(&self, folder: &Path) -> Result<Vec<PathBuf>, Error> {
        make_folder(folder)?;
        let files = [
            ("study.csv", csv(self)),
            ("study.json", format!("{:#}\n", json(self))),
            ("study.svg", chart_svg(self, Figure::Largest)),
            ("study.html", html(self)),
        ]
        .map(|(name, text)| (folder.join(name), text));
        write_files(files.iter().map(|(path, text)| (path.as_path(), text.as_bytes())))?;
        Ok(files.map(|(path, _)| path).to_vec())
    }
}
