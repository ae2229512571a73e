//! The study in a folder.

use std::path::{Path, PathBuf};

use tetrascope::{IoError, make_folder, write_bytes};

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
    /// Each file is written whole or not at all, and replaces one of an earlier study.
    ///
    /// # Errors
    /// [`Error::Tetrascope`] if the folder cannot be made or a file not written.
    pub fn write(&self, folder: &Path) -> Result<Vec<PathBuf>, Error> {
        make_folder(folder)?;
        // All texts are made before the first is written.
        let files = [
            ("study.csv", csv(self)),
            ("study.json", format!("{:#}\n", json(self))),
            ("study.svg", chart_svg(self, Figure::Largest)),
            ("study.html", html(self)),
        ];
        let write = |(name, text): (&str, String)| {
            let path = folder.join(name);
            write_bytes(&path, text.as_bytes())?;
            Ok(path)
        };
        files.into_iter().map(write).collect::<Result<_, IoError>>().map_err(Error::from)
    }
}
