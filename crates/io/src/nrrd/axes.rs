//! What the axes of an array are: three of space, perhaps one of steps, and components.

use super::{
    geometry::Directions,
    header::{Header, MEND},
};
use crate::{IoError, Source};

/// What an axis runs along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// Points in space.
    Space,
    /// Time, or whatever is shown one after another.
    Step,
    /// Numbers of one sample.
    Component,
}

/// Samples along every axis, fastest first, and what it is.
#[derive(Debug)]
pub(super) struct Axes {
    pub(super) sizes: Vec<usize>,
    pub(super) roles: Vec<Role>,
}

/// Most components that an axis is taken to have whose kind the header does not tell: a 3 x 3 matrix.
const MOST_UNTOLD_COMPONENTS: usize = 9;

impl Axes {
    /// Finds out what each axis is, by its direction in space, else by its kind, else by its place and size, with a warning.
    pub(super) fn new(
        source: &Source,
        header: &Header<'_>,
        directions: Option<&Directions>,
        warnings: &mut Vec<String>,
    ) -> Result<Self, IoError> {
        let sizes = header.sizes(source)?;
        let kinds = header.words(source, "kinds", sizes.len())?;
        let told = |axis: usize| {
            let kind = kinds.as_ref().and_then(|kinds| kinds.get(axis)).map(|kind| kind.to_ascii_lowercase());
            by_header(kind.as_deref(), directions.map(|all| all.of_axis(axis)), axis > 0)
        };
        let mut roles: Vec<Option<Role>> = (0..sizes.len()).map(told).collect();
        guess(&mut roles, &sizes, warnings);
        let mut roles: Vec<Role> = roles.into_iter().map(|role| role.unwrap_or(Role::Space)).collect();

        let of_space = |roles: &[Role]| roles.iter().filter(|&&role| role == Role::Space).count();
        // Four domains without a word on time: simulations write their steps so.
        if of_space(&roles) == 4
            && let Some(last) = roles.iter_mut().rev().find(|role| **role == Role::Space)
        {
            *last = Role::Step;
            warnings.push("the header has four axes of space; the slowest of them was taken for steps".to_owned());
        }
        let size = sizes.iter().map(usize::to_string).collect::<Vec<_>>().join("x");
        if of_space(&roles) != 3 {
            let what = format!("an NRRD array of {size} samples with {} axes of space", of_space(&roles));
            return Err(source.unsupported(what, "only those with three have a volume"));
        }
        keep_one_step(&mut roles);
        if sizes.iter().try_fold(1, |product: usize, &size| product.checked_mul(size)).is_none() {
            let problem = format!("{size} samples are more than can be counted");
            return Err(source.invalid("the field `sizes`", problem, MEND));
        }
        Ok(Self { sizes, roles })
    }

    /// All samples; the product was checked.
    pub(super) fn sample_count(&self) -> usize {
        self.sizes.iter().product()
    }

    /// The axes of a role, fastest first.
    pub(super) fn of(&self, role: Role) -> impl Iterator<Item = usize> {
        self.roles.iter().enumerate().filter(move |&(_, &found)| found == role).map(|(axis, _)| axis)
    }

    /// The axis of steps.
    pub(super) fn step_axis(&self) -> Option<usize> {
        self.of(Role::Step).next()
    }

    /// Product of the sizes of all axes of a role.
    pub(super) fn count(&self, role: Role) -> usize {
        self.of(role).filter_map(|axis| self.sizes.get(axis)).product()
    }

    /// Samples along the axes of space.
    pub(super) fn dims(&self) -> [usize; 3] {
        let mut dims = [1; 3];
        for (dim, axis) in dims.iter_mut().zip(self.of(Role::Space)) {
            *dim = self.sizes.get(axis).copied().unwrap_or(1);
        }
        dims
    }

    /// Samples between neighbors along each axis.
    pub(super) fn strides(&self) -> Vec<usize> {
        let next = |product: &mut usize, &size: &usize| {
            let stride = *product;
            *product *= size;
            Some(stride)
        };
        self.sizes.iter().scan(1, next).collect()
    }
}

/// What kind and direction say; `None` where they say nothing.
///
/// - `direction`: outside, whether the header gives directions; inside, whether this axis has one in space
/// - `slower`: whether it is not the fastest axis, beside which samples of one point stand
fn by_header(kind: Option<&str>, direction: Option<bool>, slower: bool) -> Option<Role> {
    let role = match kind {
        Some("time") => Some(Role::Step),
        Some("domain" | "space") if direction == Some(false) => Some(Role::Step),
        Some("domain" | "space") => Some(Role::Space),
        // A list beside the samples is one of their components, a list of volumes is looked at one by one.
        Some("list") if slower => Some(Role::Step),
        None | Some("none" | "???") => None,
        Some(_) => Some(Role::Component),
    };
    match (role, direction) {
        (None, Some(true)) => Some(Role::Space),
        (None, Some(false)) => Some(if slower { Role::Step } else { Role::Component }),
        _ => role,
    }
}

/// Gives roles to axes of which the header says nothing: as many are of space as are missing to three.
fn guess(roles: &mut [Option<Role>], sizes: &[usize], warnings: &mut Vec<String>) {
    let missing = 3_usize.saturating_sub(roles.iter().filter(|role| **role == Some(Role::Space)).count());
    let untold = roles.iter().filter(|role| role.is_none()).count();
    if untold <= missing {
        return;
    }
    let first_is_small = sizes.first().is_some_and(|&size| size <= MOST_UNTOLD_COMPONENTS);
    let components_first = first_is_small && roles.first() == Some(&None);
    let mut left = untold - missing;
    if components_first && let Some(role) = roles.first_mut() {
        *role = Some(Role::Component);
        left -= 1;
        warnings.push("the header does not say what its axes are; the fastest was taken for components".to_owned());
    }
    if left > 0 {
        warnings.push("the header does not say what its axes are; the slowest was taken for steps".to_owned());
    }
    for role in roles.iter_mut().rev().filter(|role| role.is_none()).take(left) {
        *role = Some(Role::Step);
    }
}

/// Leaves one axis of steps, the slowest that has any: the others are components.
fn keep_one_step(roles: &mut [Role]) {
    let last = roles.iter().rposition(|&role| role == Role::Step);
    for (axis, role) in roles.iter_mut().enumerate() {
        if *role == Role::Step && Some(axis) != last {
            *role = Role::Component;
        }
    }
}
