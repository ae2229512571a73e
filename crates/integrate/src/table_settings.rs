//! How large tables are, and over what.

use crate::{Integration, MethodError};

/// Samples of a pre-integration table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TableSettings {
    /// Samples along each of the two scalar axes, both ends of the range included: 2 to 1024.
    pub scalars: u32,
    /// Samples along the axis of chord lengths, of three-dimensional tables: 2 to 1024.
    pub lengths: u32,
    /// How those are spaced.
    pub length_axis: LengthAxis,
}

/// How samples are spaced along the axis of chord lengths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LengthAxis {
    /// Evenly from 0 to the longest chord.
    #[default]
    Linear,
    /// As many in every octave, over the ten octaves below the longest chord; evenly from 0 to where those begin.
    ///
    /// Node 0 is length 0, node 1 is `max / 1024`, the last node is `max`. Between node 1 and the last, the axis is
    /// even in `exponent + mantissa` of `x = length / max = 2^exponent (1 + mantissa)`, with `mantissa` from 0 to 1.
    /// That is the logarithm to base 2, made piecewise linear between the powers of two (it differs by up to 0.086),
    /// and nothing but the bits of a float read as an integer, so that a look-up needs no logarithm.
    ///
    /// With two samples it is the linear axis.
    ///
    /// Source: [Kraus 2004] for a logarithmic axis.
    Logarithmic,
}

/// What a table has to cover.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableDomain {
    /// Lowest and highest scalar; finite, the second not below the first.
    pub scalars: [f64; 2],
    /// Mean chord length of all segments: positive and finite.
    pub mean_length: f64,
    /// Longest chord: positive and finite, not below the mean.
    pub max_length: f64,
}

impl TableSettings {
    /// The least number of samples along an axis.
    pub const LEAST: u32 = 2;
    /// The largest number along an axis: a three-dimensional table of it takes 16 GiB.
    pub const MOST: u32 = 1024;

    /// The sizes of [Röttger 2000], figures 3 and 4: 64 along each axis of a three-dimensional table, 256 of a
    /// two-dimensional one; `None` for methods without a table.
    pub const fn of(integration: Integration) -> Option<Self> {
        let scalars = match integration {
            Integration::Table2d => 256,
            Integration::Table3d => 64,
            _ => return None,
        };
        Some(Self { scalars, lengths: 64, length_axis: LengthAxis::Linear })
    }

    /// Whether all sizes are in range.
    ///
    /// # Errors
    /// [`MethodError::TableSize`].
    pub fn check(&self) -> Result<(), MethodError> {
        for (what, size) in [("scalars", self.scalars), ("lengths", self.lengths)] {
            if !(Self::LEAST..=Self::MOST).contains(&size) {
                return Err(MethodError::TableSize { what, size, least: Self::LEAST, most: Self::MOST });
            }
        }
        Ok(())
    }
}

impl TableDomain {
    /// Whether a table can cover it.
    ///
    /// # Errors
    /// [`MethodError::TableDomain`].
    pub fn check(&self) -> Result<(), MethodError> {
        let refuse = |what, value, expected| Err(MethodError::TableDomain { what, value, expected });
        let [lo, hi] = self.scalars;
        for (what, scalar) in [("lowest scalar", lo), ("highest scalar", hi)] {
            if !scalar.is_finite() {
                return refuse(what, scalar, "give a finite number");
            }
        }
        let width = hi - lo;
        if !(0.0..=f64::MAX).contains(&width) {
            return refuse("range of scalars", width, "give two scalars of which the second is not below the first");
        }
        if !(self.mean_length > 0.0 && self.mean_length.is_finite()) {
            return refuse("mean length", self.mean_length, "give a positive finite length");
        }
        if !(self.max_length >= self.mean_length && self.max_length.is_finite()) {
            return refuse("longest chord", self.max_length, "give a finite length not below the mean");
        }
        Ok(())
    }
}
