//! Constants that both languages know: written here, emitted in front of every program.

use std::fmt::Write;

use tetrascope_integrate::series::{EXP_HALF_F32, EXP_M1_F32, EXP_TERMS, SERIES_F32, SERIES_F32_TERMS, TAU_MAX_F32};

/// The value of a constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Constant {
    /// `f32`; finite.
    F32(f32),
    /// `u32`.
    U32(u32),
    /// `i32`.
    I32(i32),
    /// `bool`.
    Bool(bool),
}

impl Constant {
    fn declaration(self, name: &str) -> String {
        match self {
            // As hexadecimal floats would be exact too; nine digits are.
            Self::F32(value) => format!("const {name}: f32 = {value:e}f;\n"),
            Self::U32(value) => format!("const {name}: u32 = {value}u;\n"),
            Self::I32(value) => format!("const {name}: i32 = {value}i;\n"),
            Self::Bool(value) => format!("const {name}: bool = {value};\n"),
        }
    }
}

/// The beginning of every program.
pub(crate) fn prelude(constants: &[(&str, Constant)]) -> String {
    let mut text = String::new();
    for (name, value) in crate::layout::CONSTANTS.iter().chain(constants) {
        text.push_str(&value.declaration(name));
    }
    array(&mut text, "EXP_M1", &EXP_M1_F32);
    array(&mut text, "EXP_HALF", &EXP_HALF_F32);
    let _ = writeln!(text, "const EXP_TERMS: u32 = {EXP_TERMS}u;");
    for (row, (coefficients, terms)) in SERIES_F32.iter().zip(SERIES_F32_TERMS).enumerate() {
        array(&mut text, &format!("SERIES_{row}"), &coefficients[..terms]);
    }
    text.push_str(&Constant::F32(TAU_MAX_F32).declaration("TAU_MAX"));
    text
}

fn array(text: &mut String, name: &str, values: &[f32]) {
    let values: Vec<String> = values.iter().map(|value| format!("{value:e}f")).collect();
    let _ = writeln!(text, "const {name} = array<f32, {}>({});", values.len(), values.join(", "));
}
