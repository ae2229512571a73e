//! Classification by four cross products of projected points ([Marroquim 2006], section 3.1 and figure 3).
//!
//! The paper types in a table of 81 entries. Here it is generated. For projected points with their affine dependence
//! `Σ a[m] = 0`, `Σ a[m] p[m] = 0`, the tests are its coefficients: with each test's sign t in −1, 0, 1,
//! `a = (t4, −t3, t2, −t1)`, which are the signs of [`crate::SignedVolumes`] (the depths that divide them are positive).
//! Moving the negative terms to the other side says which convex hulls meet: that is Radon's partition, and the class.
//! Since the coefficients sum to 0, both signs occur or none does: 30 entries cannot happen, 1 is degenerate, and 50 are
//! left, 14 without a zero (classes 1 and 2), 24 with one (class 3) and 12 with two (class 4), as the paper counts them.

use glam::DVec2;
use robust::Coord;

use crate::class::{ProjectionClass, Sign, by_planes};
use crate::fan::Fan;

/// The digits test1 to test4 of the paper's Figure 3: 0, 1, 2 for a negative, zero and positive cross product.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Tests([u8; 4]);

/// What a combination of the four tests means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TableEntry {
    /// Four points that span an area.
    Valid {
        /// Class 1a to 4.
        class: ProjectionClass,
        /// The thick vertex and the corners around it.
        fan: Fan,
    },
    /// All points on one line: nothing to draw.
    Degenerate,
    /// No four points give this; rounding does.
    Impossible,
}

/// The meaning of every combination of tests, at [`Tests::code`].
pub static TRUTH_TABLE: [TableEntry; 81] = generate();

impl Tests {
    /// The four tests, each a rounded cross product.
    ///
    /// `points`: the corners of a positively oriented cell on the screen, **x to the right and y down** (pixels). With y up
    /// all tests change their signs, and the table would take the front of every cell for its back. The corners must lie in
    /// front of the eye. Points within 1e-15 of a line, relative to their size, may give signs that no points have.
    pub fn of(points: &[DVec2; 4]) -> Self {
        let [v0, v1, v2, v3] = *points;
        let vec1 = v1 - v0;
        let vec2 = v2 - v0;
        let vec3 = v3 - v0;
        let vec4 = v1 - v2;
        let vec5 = v1 - v3;
        Self([(vec1, vec2), (vec1, vec3), (vec2, vec3), (vec4, vec5)].map(|(u, v)| digit(u.x * v.y - u.y * v.x)))
    }

    /// The four tests without rounding; never an impossible combination.
    pub fn exact(points: &[DVec2; 4]) -> Self {
        let [v0, v1, v2, v3] = points.map(|p| Coord { x: p.x, y: p.y });
        Self([(v0, v1, v2), (v0, v1, v3), (v0, v2, v3), (v1, v2, v3)].map(|(a, b, c)| digit(robust::orient2d(a, b, c))))
    }

    /// The digits test1 to test4, each 0, 1 or 2.
    pub const fn digits(self) -> [u8; 4] {
        self.0
    }

    /// The index into [`TRUTH_TABLE`], 0 to 80: the digits as a ternary number, test1 first (the most significant).
    pub const fn code(self) -> usize {
        let [t1, t2, t3, t4] = self.0;
        27 * t1 as usize + 9 * t2 as usize + 3 * t3 as usize + t4 as usize
    }

    /// The tests of a code; of the remainder by 81 where it is larger.
    pub const fn from_code(code: usize) -> Self {
        Self([(code / 27 % 3) as u8, (code / 9 % 3) as u8, (code / 3 % 3) as u8, (code % 3) as u8])
    }

    /// The signs of the cell's volumes that the tests stand for.
    pub const fn signs(self) -> [Sign; 4] {
        let [t1, t2, t3, t4] = self.0;
        [sign(t4), sign(t3).negated(), sign(t2), sign(t1).negated()]
    }

    /// What the tests mean.
    pub fn entry(self) -> &'static TableEntry {
        &TRUTH_TABLE[self.code()]
    }
}

/// Equation (3) of the paper, whose `≤` and `≥` overlap with its `=`; they are read as `<` and `>`.
const fn digit(cross_z: f64) -> u8 {
    match Sign::of(cross_z) {
        Sign::Negative => 0,
        Sign::Zero => 1,
        Sign::Positive => 2,
    }
}

const fn sign(digit: u8) -> Sign {
    match digit {
        0 => Sign::Negative,
        1 => Sign::Zero,
        _ => Sign::Positive,
    }
}

const fn generate() -> [TableEntry; 81] {
    let mut table = [TableEntry::Impossible; 81];
    let mut code = 0;
    while code < 81 {
        let partition = by_planes(Tests::from_code(code).signs());
        table[code] = match (partition.plus.len(), partition.minus.len()) {
            (0, 0) => TableEntry::Degenerate,
            (0, _) | (_, 0) => TableEntry::Impossible,
            _ => TableEntry::Valid { class: partition.class, fan: partition.fan() },
        };
        code += 1;
    }
    table
}
