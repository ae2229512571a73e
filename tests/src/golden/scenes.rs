//! The list of golden scenes, and what the fast renderer is held to in each.

/// A scene of `tests/golden`.
#[derive(Clone, Copy, Debug)]
pub struct Golden {
    /// The scene file is `NAME.toml`.
    pub name: &'static str,
    /// How near the fast renderer comes.
    pub fast: Fast,
}

/// What the fast renderer is held to.
#[derive(Clone, Copy, Debug)]
pub enum Fast {
    /// Largest difference in any channel.
    Within(f64),
    /// A known defect: the picture is wrong by more than `beyond`, and a right one is news.
    Wrong {
        /// What the largest difference exceeds.
        beyond: f64,
        /// Where the defect comes from.
        why: &'static str,
    },
}

impl Fast {
    /// The difference from which on pixels are counted.
    pub fn limit(self) -> f64 {
        match self {
            Self::Within(limit) => limit,
            Self::Wrong { beyond, .. } => beyond,
        }
    }
}

/// What f32 arithmetic is allowed where nothing but rounding differs: a hundredth of a step of 8 bits holds 170 roundings
/// of a channel near 1.
const ROUNDING: Fast = Fast::Within(2e-5);

/// All scenes. Each tries something that the others do not; the files say what.
pub const SCENES: &[Golden] = &[
    Golden { name: "tetrahedron", fast: ROUNDING },
    Golden { name: "cube_steps", fast: ROUNDING },
    Golden { name: "cube_axis", fast: ROUNDING },
    Golden { name: "cube_inside", fast: ROUNDING },
    Golden { name: "mixed_emitter", fast: ROUNDING },
    Golden { name: "mixed_absorption", fast: ROUNDING },
    Golden { name: "mixed_emission", fast: ROUNDING },
    Golden { name: "mixed_average", fast: ROUNDING },
    Golden { name: "cycle", fast: ROUNDING },
    Golden { name: "rings", fast: ROUNDING },
    Golden { name: "rings_inside", fast: ROUNDING },
    Golden { name: "surfaces_flat", fast: ROUNDING },
    Golden { name: "surfaces_smooth", fast: ROUNDING },
    Golden { name: "surfaces_mixed", fast: ROUNDING },
    Golden { name: "surfaces_absorption", fast: ROUNDING },
    Golden { name: "surfaces_emission", fast: ROUNDING },
    Golden { name: "volume_lit", fast: ROUNDING },
    Golden { name: "partial", fast: ROUNDING },
    Golden { name: "cumulative", fast: ROUNDING },
    Golden { name: "table_3d", fast: ROUNDING },
    Golden { name: "table_2d", fast: ROUNDING },
];
