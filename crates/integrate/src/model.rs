//! Optical models and their names in scene files.

use core::fmt;
use core::str::FromStr;

use crate::NameError;
use crate::method::quoted;

/// What a volume does to light: the equation for the radiance `I` along a ray, towards the eye.
///
/// `rho` is the extinction, `kappa` the color of the transfer function, both functions of the scalar.
///
/// Sources: [Williams 1992] for [`OpticalModel::DensityEmitter`], [Wilhelms 1991] for
/// [`OpticalModel::Emitter`]; [Max 1995] has all four side by side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum OpticalModel {
    /// `dI/dt = rho (kappa - I)`: particles of color `kappa`, as dense as they absorb. An opaque cell shows `kappa`.
    #[default]
    DensityEmitter,
    /// `dI/dt = kappa - rho I`: `kappa` is radiance added per length, whatever is absorbed. What adds no extinction
    /// still glows.
    Emitter,
    /// `dI/dt = -rho I`: attenuates only; the color is ignored.
    Absorption,
    /// `dI/dt = kappa`: glows only; the extinction is ignored and the opacity stays 0.
    Emission,
}

impl OpticalModel {
    /// All models, in the order of the scene file's contract.
    pub const ALL: [Self; 4] = [Self::DensityEmitter, Self::Emitter, Self::Absorption, Self::Emission];

    /// The name in a scene file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::DensityEmitter => "density-emitter",
            Self::Emitter => "emitter",
            Self::Absorption => "absorption",
            Self::Emission => "emission",
        }
    }

    /// Whether the extinction has any influence on the picture.
    pub const fn needs_extinction(self) -> bool {
        !matches!(self, Self::Emission)
    }

    /// Whether the color has any influence on the picture.
    pub const fn needs_emission(self) -> bool {
        !matches!(self, Self::Absorption)
    }

    /// Whether the color is radiance per length, so that a change of the unit of length changes it too.
    pub const fn color_is_per_length(self) -> bool {
        matches!(self, Self::Emitter | Self::Emission)
    }

    /// Whether a place without extinction adds nothing: then a cell of zero extinction can be left out.
    pub const fn is_dark_without_extinction(self) -> bool {
        matches!(self, Self::DensityEmitter | Self::Absorption)
    }

    /// Whether cells may be composed in any order: opacities alone and emissions alone commute, both together do not.
    pub const fn is_commutative(self) -> bool {
        matches!(self, Self::Absorption | Self::Emission)
    }
}

impl fmt::Display for OpticalModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for OpticalModel {
    type Err = NameError;

    fn from_str(name: &str) -> Result<Self, NameError> {
        Self::ALL.into_iter().find(|model| model.name() == name).ok_or_else(|| NameError::Unknown {
            what: "optical model",
            name: name.to_owned(),
            known: quoted(Self::ALL.map(Self::name)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_go_to_text_and_back() {
        for model in OpticalModel::ALL {
            assert_eq!(model.to_string().parse(), Ok(model));
        }
        assert!("fog".parse::<OpticalModel>().unwrap_err().to_string().contains("\"density-emitter\""));
    }

    #[test]
    fn an_order_is_needed_where_light_is_both_added_and_lost() {
        for model in OpticalModel::ALL {
            assert_eq!(model.is_commutative(), !(model.needs_emission() && model.needs_extinction()));
        }
    }
}
