//! Vectors that a file keeps as one variable a component.
//!
//! The rule is that of `vtkExodusIIReader`, so that arrays have the names that users know from ParaView: variables that follow each
//! other, whose names are the same but for a last X, Y and Z (or X and Y alone), are one vector of the name that is left.

/// One array: its name, and which variables are its components.
#[derive(Debug, PartialEq)]
pub(super) struct Joined {
    pub(super) name: String,
    pub(super) variables: std::ops::Range<usize>,
}

/// Joins variables by their names; `alike(a, b)` says whether two of them can be components of one array.
pub(super) fn join(names: &[String], alike: impl Fn(usize, usize) -> bool) -> Vec<Joined> {
    let mut arrays = Vec::new();
    let mut first = 0;
    while let Some(name) = names.get(first) {
        let prefix = component(name, 'X').filter(|prefix| !prefix.is_empty());
        let follows = |offset: usize, letter: char| {
            let other = names.get(first + offset).and_then(|name| component(name, letter));
            prefix.is_some() && other == prefix && alike(first, first + offset)
        };
        let count = match (follows(1, 'Y'), follows(2, 'Z')) {
            (true, true) => 3,
            (true, false) => 2,
            _ => 1,
        };
        let name = if count > 1 { prefix.unwrap_or(name) } else { name };
        arrays.push(Joined { name: name.to_owned(), variables: first..first + count });
        first += count;
    }
    arrays
}

/// A name without its last letter, if it is this one, in either case.
fn component(name: &str, letter: char) -> Option<&str> {
    let prefix = name.strip_suffix(letter);
    prefix.or_else(|| name.strip_suffix(letter.to_ascii_lowercase()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joined(names: &[&str]) -> Vec<(String, usize)> {
        let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        join(&names, |_, _| true).into_iter().map(|array| (array.name, array.variables.len())).collect()
    }

    /// What VTK 9.7.2 makes of the same names.
    #[test]
    fn vectors_are_those_of_vtk() {
        let each = |names: &[(&str, usize)]| -> Vec<(String, usize)> {
            names.iter().map(|&(name, count)| (name.to_owned(), count)).collect()
        };
        assert_eq!(joined(&["VX", "VY", "VZ"]), each(&[("V", 3)]));
        assert_eq!(joined(&["p", "vel_x", "vel_y", "vel_z", "q"]), each(&[("p", 1), ("vel_", 3), ("q", 1)]));
        assert_eq!(joined(&["vX", "vy", "vZ"]), each(&[("v", 3)]));
        assert_eq!(joined(&["A_X", "A_Y"]), each(&[("A_", 2)]));
        assert_eq!(joined(&["DX", "DY", "DX2"]), each(&[("D", 2), ("DX2", 1)]));
        assert_eq!(joined(&["B_x", "B_z", "B_y"]), each(&[("B_x", 1), ("B_z", 1), ("B_y", 1)]));
        assert_eq!(joined(&["x", "y", "z"]), each(&[("x", 1), ("y", 1), ("z", 1)]));
        assert_eq!(joined(&["s_x", "t_y", "u_z"]), each(&[("s_x", 1), ("t_y", 1), ("u_z", 1)]));
        assert_eq!(joined(&["a_xx", "a_xy", "a_xz"]), each(&[("a_x", 3)]));
        assert_eq!(joined(&["é", "éX", "éY"]), each(&[("é", 1), ("é", 2)]));
        assert_eq!(joined(&[]), each(&[]));
    }

    #[test]
    fn what_is_not_alike_stays_apart() {
        let names = ["VX", "VY", "VZ"].map(str::to_owned);
        let arrays = join(&names, |a, b| (a, b) != (0, 2));
        let lengths: Vec<usize> = arrays.iter().map(|array| array.variables.len()).collect();
        assert_eq!(lengths, [2, 1]);
    }
}
