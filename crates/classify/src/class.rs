//! Classification by the signs of the face planes ([Shirley 1990], section 2.2 and figure 3).

use crate::fan::{Fan, FanVertex};

/// The sign of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Sign {
    /// Below zero.
    Negative,
    /// Zero.
    Zero,
    /// Above zero.
    Positive,
}

impl Sign {
    /// The sign of a float; NaN has none and gives [`Sign::Zero`].
    pub const fn of(value: f64) -> Self {
        if value > 0.0 {
            Self::Positive
        } else if value < 0.0 {
            Self::Negative
        } else {
            Self::Zero
        }
    }

    /// −1, 0 or 1.
    pub const fn value(self) -> i32 {
        match self {
            Self::Negative => -1,
            Self::Zero => 0,
            Self::Positive => 1,
        }
    }

    /// The opposite sign.
    #[must_use]
    pub const fn negated(self) -> Self {
        match self {
            Self::Negative => Self::Positive,
            Self::Zero => Self::Zero,
            Self::Positive => Self::Negative,
        }
    }
}

/// How a cell's silhouette looks; names of [Shirley 1990], figure 3.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ProjectionClass {
    /// A triangle with the nearest corner inside: three faces seen, one not.
    OneA,
    /// A triangle with the farthest corner inside: one face seen, three not.
    OneB,
    /// A quadrangle: two faces seen, two not.
    Two,
    /// A triangle with the nearest corner on an edge: two faces seen, one not, one edge-on.
    ThreeA,
    /// A triangle with the farthest corner on an edge: one face seen, two not, one edge-on.
    ThreeB,
    /// A triangle of which one corner is two: one face seen, one not, two edge-on.
    Four,
    /// The eye is in the cell or on its boundary: the cell surrounds the view and has no silhouette.
    EyeInside,
    /// The projection is a line or a point, or the cell has no positive volume: draws nothing.
    Degenerate,
}

impl ProjectionClass {
    /// Triangles of the fan: 3, 4, 2, 1, and 0 where there is no silhouette.
    pub const fn triangle_count(self) -> usize {
        match self {
            Self::OneA | Self::OneB => 3,
            Self::Two => 4,
            Self::ThreeA | Self::ThreeB => 2,
            Self::Four => 1,
            Self::EyeInside | Self::Degenerate => 0,
        }
    }
}

/// Some of a cell's corners, ascending.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Corners {
    corners: [usize; 4],
    count: usize,
}

impl Corners {
    const EMPTY: Self = Self { corners: [0; 4], count: 0 };

    /// The corners, ascending.
    pub fn as_slice(&self) -> &[usize] {
        &self.corners[..self.count]
    }

    /// How many.
    pub const fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none.
    pub const fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The first; 0 where there is none.
    pub(crate) const fn first(&self) -> usize {
        self.corners[0]
    }

    const fn push(&mut self, corner: usize) {
        self.corners[self.count] = corner;
        self.count += 1;
    }
}

/// A cell's class and its corners by the sign of their volumes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Classified {
    /// The class.
    pub class: ProjectionClass,
    /// P: corners whose opposite faces are turned away from the eye. They span the front end of the thickest chord.
    pub plus: Corners,
    /// N: corners whose opposite faces are turned to the eye. They span the back end.
    pub minus: Corners,
    /// Corners whose opposite faces are seen edge-on.
    pub zero: Corners,
}

/// Classifies by the signs of [`crate::SignedVolumes`].
///
/// Both signs occur unless the eye is in the closed cell (perspective, a positive sign and no negative one:
/// [`ProjectionClass::EyeInside`]) or all are zero ([`ProjectionClass::Degenerate`]). Rounding on nearly degenerate cells
/// can give what geometry cannot: no positive sign but negative ones counts as degenerate, and so does
/// [`ProjectionClass::EyeInside`] in an orthographic view, which this function cannot see and [`crate::project`] does.
/// What is lost then has no area but for rounding.
pub const fn by_planes(signs: [Sign; 4]) -> Classified {
    let (mut plus, mut minus, mut zero) = (Corners::EMPTY, Corners::EMPTY, Corners::EMPTY);
    let mut corner = 0;
    while corner < 4 {
        match signs[corner] {
            Sign::Positive => plus.push(corner),
            Sign::Negative => minus.push(corner),
            Sign::Zero => zero.push(corner),
        }
        corner += 1;
    }
    let class = match (plus.len(), minus.len()) {
        (1, 3) => ProjectionClass::OneA,
        (3, 1) => ProjectionClass::OneB,
        (2, 2) => ProjectionClass::Two,
        (1, 2) => ProjectionClass::ThreeA,
        (2, 1) => ProjectionClass::ThreeB,
        (1, 1) => ProjectionClass::Four,
        (1.., 0) => ProjectionClass::EyeInside,
        _ => ProjectionClass::Degenerate,
    };
    Classified { class, plus, minus, zero }
}

impl Classified {
    /// The corner in which the thick vertex lies on the screen: the lone-signed one; class 4: the nearer of the two.
    ///
    /// `None` for class 2, whose thick vertex is a new point, and where there is no silhouette.
    pub const fn thick_corner(&self) -> Option<usize> {
        match self.class {
            ProjectionClass::OneA | ProjectionClass::ThreeA | ProjectionClass::Four => Some(self.plus.first()),
            ProjectionClass::OneB | ProjectionClass::ThreeB => Some(self.minus.first()),
            _ => None,
        }
    }

    /// The fan of the class, its thick vertex first; triangles counterclockwise on the screen.
    ///
    /// Class 1: T; j, k, l, j. Class 2: T; P0, N0, P1, N1, P0. Class 3: T; p, z, q with p, q the pair of one sign. Class 4:
    /// T; z0, z1. Rings may run the other way round, to turn counterclockwise.
    pub const fn fan(&self) -> Fan {
        let (p, n, z) = (&self.plus.corners, &self.minus.corners, &self.zero.corners);
        // The ring, and three corners that turn as the ring does.
        let (ring, count, turn) = match self.class {
            ProjectionClass::OneA => ([n[0], n[1], n[2], n[0], 0], 4, [n[0], n[1], n[2]]),
            ProjectionClass::OneB => ([p[0], p[1], p[2], p[0], 0], 4, [p[0], p[1], p[2]]),
            ProjectionClass::Two => ([p[0], n[0], p[1], n[1], p[0]], 5, [p[0], n[0], p[1]]),
            ProjectionClass::ThreeA => ([n[0], z[0], n[1], 0, 0], 3, [n[0], z[0], n[1]]),
            ProjectionClass::ThreeB => ([p[0], z[0], p[1], 0, 0], 3, [p[0], z[0], p[1]]),
            ProjectionClass::Four => ([z[0], z[1], 0, 0, 0], 2, [p[0], z[0], z[1]]),
            ProjectionClass::EyeInside | ProjectionClass::Degenerate => return Fan::EMPTY,
        };
        let is_reversed = self.turns_clockwise(turn);
        let mut vertices = [FanVertex::Thick; 6];
        let mut i = 0;
        while i < count {
            vertices[i + 1] = FanVertex::Corner(if is_reversed { ring[count - 1 - i] } else { ring[i] });
            i += 1;
        }
        Fan::new(vertices, count + 1)
    }

    /// Whether three corners run clockwise as the eye sees them; the opposite face must not be edge-on.
    const fn turns_clockwise(&self, [i, j, k]: [usize; 3]) -> bool {
        let missing = 6 - i - j - k;
        // Ascending corners run clockwise for a positive volume where the missing corner is even (the order in `FACES`).
        let swaps = (i > j) as usize + (j > k) as usize + (i > k) as usize + missing;
        let mut is_positive = false;
        let mut at = 0;
        while at < self.plus.count {
            is_positive |= self.plus.corners[at] == missing;
            at += 1;
        }
        is_positive == swaps.is_multiple_of(2)
    }
}
