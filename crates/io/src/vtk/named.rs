//! The arrays of points or of cells, under names that are neither empty nor repeated.

use std::collections::HashSet;

use tetrascope_mesh::{ArrayValues, DataArray};

/// Arrays in the order of the file.
#[derive(Debug, Default)]
pub(super) struct NamedArrays {
    arrays: Vec<DataArray>,
    taken: HashSet<String>,
}

impl NamedArrays {
    /// Adds an array. An empty name becomes `unnamed1`, `unnamed2` and so on, a repeated name gets `_2`, `_3` behind it,
    /// and `warnings` says so.
    ///
    /// - `owner`: "point" or "cell", for the warning
    pub(super) fn add(
        &mut self,
        owner: &str,
        name: &str,
        components: usize,
        values: ArrayValues,
        warnings: &mut Vec<String>,
    ) {
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
    pub(super) fn into_arrays(self) -> Vec<DataArray> {
        self.arrays
    }

    fn free_name(&self, prefix: &str, first: usize) -> String {
        // Starting at the count keeps a file of many equal names from taking time with the square of their number.
        let of_prefix = |n: usize| format!("{prefix}{n}");
        let first = if self.taken.contains(&of_prefix(first)) && self.arrays.len() > 1000 {
            first + self.arrays.len()
        } else {
            first
        };
        (first..).map(of_prefix).find(|name| !self.taken.contains(name)).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_and_empty_names() {
        let mut arrays = NamedArrays::default();
        let mut warnings = Vec::new();
        for name in ["s", "", "s", "s_2", " ", "s"] {
            arrays.add("point", name, 1, ArrayValues::F32(vec![]), &mut warnings);
        }
        let names: Vec<String> = arrays.into_arrays().into_iter().map(|a| a.name).collect();
        assert_eq!(names, ["s", "unnamed1", "s_2", "s_2_2", "unnamed2", "s_3"]);
        assert_eq!(warnings.len(), 5);
    }
}
