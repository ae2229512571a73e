//! The ways to integrate a segment, their names in scene files, and what each of them needs.

use core::fmt;
use core::str::FromStr;

use crate::{MethodError, NameError, OpticalModel};

/// How the light of a segment is computed from the scalars at its ends and its length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Integration {
    /// Color and opacity at the vertices of the projected cell, interpolated between: [`crate::thick_vertex`].
    Vertex,
    /// The transfer function at the mean scalar: [`crate::average`].
    Average,
    /// Exact opacity of a linear extinction, the mean of the colors at both ends: [`crate::opacity_2d`].
    Opacity2d,
    /// Linear color and extinction between the ends, by the psi table: [`crate::partial`].
    Partial,
    /// Running integrals over the scalar: [`crate::RunningIntegrals`].
    Cumulative,
    /// A table over both scalars, linear in the length: [`crate::Table2d`].
    Table2d,
    /// A table over both scalars and the length: [`crate::Table3d`].
    Table3d,
    /// The closed form for each piece of the transfer function: [`crate::exact`].
    #[default]
    Exact,
}

impl Integration {
    /// All ways.
    pub const ALL: [Self; 8] = [
        Self::Vertex,
        Self::Average,
        Self::Opacity2d,
        Self::Partial,
        Self::Cumulative,
        Self::Table2d,
        Self::Table3d,
        Self::Exact,
    ];

    /// The name in a scene file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Vertex => "vertex",
            Self::Average => "average",
            Self::Opacity2d => "opacity-2d",
            Self::Partial => "partial",
            Self::Cumulative => "cumulative",
            Self::Table2d => "table-2d",
            Self::Table3d => "table-3d",
            Self::Exact => "exact",
        }
    }

    /// Whether the derivation covers an optical model.
    ///
    /// Only [`Integration::Partial`] with [`OpticalModel::Emitter`] is not: [Moreland 2004] integrates color times
    /// extinction, for which one function of the two end depths is enough; color apart from extinction needs a second.
    pub const fn covers(self, model: OpticalModel) -> bool {
        !matches!((self, model), (Self::Partial, OpticalModel::Emitter))
    }

    /// The same as [`Integration::covers`], as an error that names the ways that do.
    ///
    /// # Errors
    /// [`MethodError::ModelNotCovered`].
    pub fn check(self, model: OpticalModel) -> Result<(), MethodError> {
        if self.covers(model) {
            return Ok(());
        }
        let others: Vec<_> = Self::ALL.into_iter().filter(|other| other.covers(model)).map(Self::name).collect();
        Err(MethodError::ModelNotCovered { integration: self, model, alternatives: quoted(others) })
    }

    /// Whether it is defined on a fan of triangles and not along a ray.
    pub const fn needs_fan(self) -> bool {
        matches!(self, Self::Vertex)
    }

    /// Whether it looks the light up in a table made from the transfer function.
    pub const fn needs_table(self) -> bool {
        matches!(self, Self::Table2d | Self::Table3d)
    }
}

impl fmt::Display for Integration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Integration {
    type Err = NameError;

    /// `auto` is no way to integrate but a wish to have one chosen: whoever chooses takes it out before.
    fn from_str(name: &str) -> Result<Self, NameError> {
        Self::ALL.into_iter().find(|integration| integration.name() == name).ok_or_else(|| NameError::Unknown {
            what: "integration",
            name: name.to_owned(),
            known: quoted(Self::ALL.map(Self::name)),
        })
    }
}

pub(crate) fn quoted(names: impl IntoIterator<Item = &'static str>) -> String {
    names.into_iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_go_to_text_and_back() {
        for integration in Integration::ALL {
            assert_eq!(integration.to_string().parse(), Ok(integration));
        }
        let message = "exakt".parse::<Integration>().unwrap_err().to_string();
        assert!(message.starts_with("unknown integration \"exakt\"") && message.contains("\"table-3d\""), "{message}");
    }

    #[test]
    fn what_is_not_covered_names_alternatives() {
        let message = Integration::Partial.check(OpticalModel::Emitter).unwrap_err().to_string();
        assert!(message.contains("\"partial\"") && message.contains("\"emitter\""), "{message}");
        assert!(message.contains("\"exact\"") && !message.contains("use one of \"partial\""), "{message}");
        for model in OpticalModel::ALL {
            assert_eq!(Integration::Exact.check(model), Ok(()));
        }
    }
}
