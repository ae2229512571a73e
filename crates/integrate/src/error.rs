//! What can be wrong with a transfer function or with the name of a method.

use thiserror::Error;

use crate::{Integration, OpticalModel};

/// Why control points do not make a transfer function.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum TransferFunctionError {
    /// A list without a control point has no value anywhere.
    #[error("the {list} list is empty; give at least one control point")]
    Empty {
        /// Which list: `"color"` or `"extinction"`.
        list: &'static str,
    },
    /// A scalar lies below the one before it.
    #[error(
        "{list} entry {index}: scalar {scalar} lies below {previous} of the entry before; sort the entries by scalar"
    )]
    NotSorted {
        /// Which list.
        list: &'static str,
        /// Index of the entry, from 0.
        index: usize,
        /// Its scalar.
        scalar: f64,
        /// The scalar before it.
        previous: f64,
    },
    /// A scalar or a value is infinite or not a number.
    #[error("{list} entry {index}: {component} is {value}; give a finite number")]
    NotFinite {
        /// Which list.
        list: &'static str,
        /// Index of the entry, from 0.
        index: usize,
        /// `"scalar"`, `"red"`, `"green"`, `"blue"` or `"extinction"`.
        component: &'static str,
        /// What was given.
        value: f64,
    },
    /// Light and extinction are not negative.
    #[error("{list} entry {index}: {component} is {value}; give zero or more")]
    Negative {
        /// Which list.
        list: &'static str,
        /// Index of the entry, from 0.
        index: usize,
        /// `"red"`, `"green"`, `"blue"` or `"extinction"`.
        component: &'static str,
        /// What was given.
        value: f64,
    },
}

/// Why a text names no optical model or no way to integrate.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum NameError {
    /// No method goes by this name.
    #[error("unknown {what} \"{name}\"; use one of {known}")]
    Unknown {
        /// What was looked for.
        what: &'static str,
        /// The name that was given.
        name: String,
        /// The names that are there.
        known: String,
    },
}

/// Why a way to integrate cannot be used.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MethodError {
    /// The method's derivation does not hold for the optical model.
    #[error(
        "integration \"{integration}\" has no meaning with the optical model \"{model}\"; use one of {alternatives}"
    )]
    ModelNotCovered {
        /// The method.
        integration: Integration,
        /// The model.
        model: OpticalModel,
        /// The methods that do, quoted.
        alternatives: String,
    },
    /// A fan of triangles is needed, and there is only a ray.
    #[error("integration \"vertex\" is defined on a fan of triangles and has no meaning along a single ray")]
    NeedsFan,
    /// A table's size is out of range.
    #[error("a table with {size} {what} is not possible; give {least} to {most}")]
    TableSize {
        /// What is counted: `"scalars"` or `"lengths"`.
        what: &'static str,
        /// The number given.
        size: u32,
        /// The least number.
        least: u32,
        /// The largest number.
        most: u32,
    },
    /// What a table has to cover is not possible.
    #[error("a table over a {what} of {value} is not possible; {expected}")]
    TableDomain {
        /// `"lowest scalar"`, `"highest scalar"`, `"range of scalars"`, `"mean length"` or `"longest chord"`.
        what: &'static str,
        /// What was given.
        value: f64,
        /// What is possible.
        expected: &'static str,
    },
    /// A table does not fit into the memory.
    #[error("no memory for a table of {bytes} bytes; give fewer samples")]
    TableMemory {
        /// Size of its entries.
        bytes: usize,
    },
    /// A method with a table was not told how large it is.
    #[error("integration \"{integration}\" looks the light up; give the size of its table and what it has to cover")]
    NoTable {
        /// The method.
        integration: Integration,
    },
}
