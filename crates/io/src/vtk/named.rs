//! The arrays of points or of cells, under names that are neither empty nor repeated.

use std::collections::{HashMap, HashSet};

use tetrascope_mesh::{ArrayValues, DataArray};

/// Arrays in the order of the file.
#[derive(Debug, Default)]
pub(crate) struct NamedArrays {
    arrays: Vec<DataArray>,
    taken: HashSet<String>,
    /// The number to try next behind a prefix. Starting anew each time would take time with the square of the names' number.
    next: HashMap<String, usize>,
}

impl NamedArrays {
    /// Adds an array. An empty name becomes `unnamed1`, `unnamed2` and so on, a repeated name gets `_2`, `_3` behind it, and control
    /// characters, which can make a terminal do anything, become `_`; `warnings` says so.
    ///
    /// - `owner`: "point" or "cell", for the warning
    pub(crate) fn add(
        &mut self,
        owner: &str,
        name: &str,
        components: usize,
        values: ArrayValues,
        warnings: &mut Vec<String>,
    ) {
        let shown = name.replace(char::is_control, "_");
        if shown != name {
            warnings.push(format!("the name of a {owner} array has control characters; it is called `{shown}` here"));
        }
        let name = shown.as_str();
        let given = if name.trim().is_empty() {
            let given = self.free_name("unnamed", 1);
            warnings.push(format!("a {owner} array has no name; it is called `{given}` here"));
            given
        } else if self.taken.contains(name) {
            let given = self.free_name(&format!("{name}_"), 2);
            warnings.push(format!("two {owner} arrays are named `{name}`; the later one is called `{given}` here"));
            given
        } else {
            name.to_owned()
        };
        self.taken.insert(given.clone());
        self.arrays.push(DataArray { name: given, components, values });
    }

    /// All arrays.
    pub(crate) fn into_arrays(self) -> Vec<DataArray> {
        self.arrays
    }

    fn free_name(&mut self, prefix: &str, first: usize) -> String {
        let next = self.next.entry(prefix.to_owned()).or_insert(first);
        loop {
            let name = format!("{prefix}{next}");
            *next += 1;
            if !self.taken.contains(&name) {
                return name;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_and_empty_names() {
        let mut arrays = NamedArrays::default();
        let mut warnings = Vec::new();
        for name in ["s", "", "s", "s_2", " ", "s", "\u{1b}]0;x\u{7}"] {
            arrays.add("point", name, 1, ArrayValues::F32(vec![]), &mut warnings);
        }
        let names: Vec<String> = arrays.into_arrays().into_iter().map(|a| a.name).collect();
        assert_eq!(names, ["s", "unnamed1", "s_2", "s_2_2", "unnamed2", "s_3", "_]0;x_"]);
        assert_eq!(warnings.len(), 6);
    }
}
