//! The arrays behind POINT_DATA and CELL_DATA, and what is passed over.

use tetrascope_mesh::ArrayValues;

use super::super::scalars::ScalarType;
use super::grid::Attributes;
use super::lexer::{LegacyType, Lexer};
use crate::IoError;

/// Reads the section that `keyword` starts; its arrays go to `target`, or nowhere where they belong to the whole file.
pub(super) fn read(
    lexer: &mut Lexer<'_>,
    keyword: &str,
    target: Option<&mut Attributes>,
    warnings: &mut Vec<String>,
) -> Result<(), IoError> {
    if keyword == "FIELD" {
        return read_field(lexer, target, warnings);
    }
    if keyword == "LOOKUP_TABLE" {
        return skip_lookup_table(lexer);
    }
    let Some(target) = target else {
        return Err(lexer.invalid(format!("\"{keyword}\" is not a section of such a dataset, or stands too early")));
    };
    let fixed = match keyword {
        "VECTORS" | "NORMALS" => 3,
        "TENSORS" => 9,
        "TENSORS6" => 6,
        "GLOBAL_IDS" | "PEDIGREE_IDS" | "EDGE_FLAGS" => 1,
        "SCALARS" | "TEXTURE_COORDINATES" | "COLOR_SCALARS" => 0,
        _ => return Err(lexer.invalid(format!("\"{keyword}\" is not a section of such a dataset"))),
    };
    let name = lexer.name()?;
    let (components, kind) = match keyword {
        "COLOR_SCALARS" => {
            let components = lexer.count("the number of components")?;
            lexer.line();
            let values = read_colors(lexer, tuples(target, lexer)?, components, &name)?;
            target.arrays.add(target.owner, &name, components, values, warnings);
            return Ok(());
        }
        "TEXTURE_COORDINATES" => {
            let components = lexer.count("the number of components")?;
            let kind = lexer.scalar_type()?;
            lexer.line();
            (components, kind)
        }
        "SCALARS" => {
            let kind = lexer.scalar_type()?;
            // The number of components may stand behind the type, on the same line.
            let rest = String::from_utf8_lossy(lexer.line());
            let components = match rest.split_ascii_whitespace().next() {
                None => 1,
                Some(word) => word
                    .parse()
                    .map_err(|_| lexer.invalid(format!("`{name}` has \"{word}\" components, not a count")))?,
            };
            // The table is named but need not be given anywhere.
            if lexer.accept("LOOKUP_TABLE") {
                lexer.line();
            }
            (components, kind)
        }
        _ => {
            let kind = lexer.scalar_type()?;
            lexer.line();
            (fixed, kind)
        }
    };
    let tuples = tuples(target, lexer)?;
    let Some(kind) = kind else { return Err(lexer.invalid(format!("`{name}` of {keyword} cannot be text"))) };
    let values = lexer.numbers(kind, product(lexer, tuples, components, &name)?, &format!("`{name}`"))?;
    target.arrays.add(target.owner, &name, components, values, warnings);
    Ok(())
}

/// Passes over a block of metadata, which ends with an empty line or the file.
pub(super) fn skip_metadata(lexer: &mut Lexer<'_>) {
    lexer.line();
    while !lexer.is_used_up() && !lexer.line().trim_ascii().is_empty() {}
}

fn tuples(target: &Attributes, lexer: &Lexer<'_>) -> Result<usize, IoError> {
    target.declared.ok_or_else(|| lexer.invalid("an array stands before POINT_DATA and CELL_DATA"))
}

fn product(lexer: &Lexer<'_>, tuples: usize, components: usize, name: &str) -> Result<usize, IoError> {
    if components == 0 {
        return Err(lexer.invalid(format!("`{name}` has 0 components, where at least 1 is needed")));
    }
    tuples
        .checked_mul(components)
        .ok_or_else(|| lexer.invalid(format!("`{name}` declares {tuples} tuples of {components} components")))
}

/// Colors: bytes in binary files, in text numbers from 0 to 1 that are brought to bytes, so that both give the same.
fn read_colors(lexer: &mut Lexer<'_>, tuples: usize, components: usize, name: &str) -> Result<ArrayValues, IoError> {
    let count = product(lexer, tuples, components, name)?;
    let kind = if lexer.is_binary { ScalarType::U8 } else { ScalarType::F32 };
    let values = lexer.numbers(LegacyType::Plain(kind), count, &format!("`{name}`"))?;
    Ok(match values {
        ArrayValues::F32(parts) => {
            ArrayValues::U8(parts.iter().map(|part| (part.clamp(0.0, 1.0) * 255.0).round() as u8).collect())
        }
        bytes => bytes,
    })
}

/// A table of colors: four components an entry. It plays no part in what is drawn here.
fn skip_lookup_table(lexer: &mut Lexer<'_>) -> Result<(), IoError> {
    let name = lexer.name()?;
    let size = lexer.count("the size of a LOOKUP_TABLE")?;
    lexer.line();
    read_colors(lexer, size, 4, &name).map(drop)
}

fn read_field(
    lexer: &mut Lexer<'_>,
    mut target: Option<&mut Attributes>,
    warnings: &mut Vec<String>,
) -> Result<(), IoError> {
    lexer.name()?;
    let count = lexer.count("the number of arrays of FIELD")?;
    for _ in 0..count {
        while lexer.accept("METADATA") {
            skip_metadata(lexer);
        }
        let name = lexer.name()?;
        // VTK's sign for an array that is not there; neither sizes nor values follow.
        if name == "NULL_ARRAY" {
            continue;
        }
        let components = lexer.count("the number of components")?;
        let tuples = lexer.count("the number of tuples")?;
        let kind = lexer.scalar_type()?;
        lexer.line();
        // Arrays without tuples may say 0 components as well.
        let size = tuples
            .checked_mul(components)
            .ok_or_else(|| lexer.invalid(format!("`{name}` declares {tuples} tuples of {components} components")))?;
        let Some(kind) = kind else {
            skip_strings(lexer, size, &name)?;
            warnings.push(format!("the field array `{name}` is left out: it holds text"));
            continue;
        };
        let values = lexer.numbers(kind, size, &format!("`{name}`"))?;
        let Some(target) = target.as_deref_mut() else { continue };
        let expected = target.declared.unwrap_or(0);
        if tuples != expected {
            return Err(lexer.invalid(format!(
                "the {} array `{name}` has {tuples} tuples, where {expected} were expected",
                target.owner
            )));
        }
        if components == 0 {
            warnings.push(format!("the {} array `{name}` is left out: it has no components", target.owner));
            continue;
        }
        target.arrays.add(target.owner, &name, components, values, warnings);
    }
    Ok(())
}

/// Text: a line each in text files. In binary ones the two highest bits of the first byte tell how long the length is:
/// 3 for one byte, 2 for two, 1 for four, 0 for eight; the other bits and bytes are the length.
fn skip_strings(lexer: &mut Lexer<'_>, count: usize, name: &str) -> Result<(), IoError> {
    let what = format!("`{name}`");
    for _ in 0..count {
        if lexer.is_used_up() {
            return Err(lexer.invalid(format!("{what}: the file ends among its {count} texts")));
        }
        if !lexer.is_binary {
            lexer.line();
            continue;
        }
        let first = lexer.block(Some(1), &what)?[0];
        let more = [7, 3, 1, 0][usize::from(first >> 6)];
        let length = lexer
            .block(Some(more), &what)?
            .iter()
            .fold(u64::from(first & 0x3f), |length, &byte| length << 8 | u64::from(byte));
        lexer.block(usize::try_from(length).ok(), &what)?;
    }
    Ok(())
}
