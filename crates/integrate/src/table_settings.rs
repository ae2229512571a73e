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
