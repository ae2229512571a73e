//! What tells of the points of a grid: DIMENSIONS, ORIGIN, SPACING, coordinates, BLANKING.

use glam::DVec3;
use tetrascope_mesh::{DataArray, Dataset};

use super::super::DAMAGED;
use super::super::grids::budget::Budget;
use super::super::grids::extent::Extent;
use super::super::grids::ghosts::{hidden_points, left_out_cells};
use super::super::grids::{GRID_LIMIT, Geometry, GridPiece, Lattice, merge, spend_points};
use super::super::xml::Kind;
use super::lexer::{LegacyType, Lexer};
use crate::IoError;

/// What the lines of a grid say.
#[derive(Default)]
pub(super) struct Lines {
    extent: Option<Extent>,
    lattice: Lattice,
    coordinates: [Option<Vec<f64>>; 3],
    /// 0 for points that are hidden, as VTK before version 3 wrote it.
    blanking: Option<Vec<f64>>,
}

impl Lines {
    /// Reads the line, and the numbers behind it; `false`, and nothing read, where the keyword is none of these.
    pub(super) fn read(&mut self, lexer: &mut Lexer<'_>, keyword: &str) -> Result<bool, IoError> {
        match keyword {
            "DIMENSIONS" => {
                let dims = [lexer.count("DIMENSIONS")?, lexer.count("DIMENSIONS")?, lexer.count("DIMENSIONS")?];
                self.extent = Some(Extent::of_dims(dims).map_err(|problem| lexer.invalid(problem))?);
            }
            "EXTENT" => {
                let mut text = String::new();
                for _ in 0..6 {
                    text = text + lexer.word().unwrap_or_default() + " ";
                }
                let extent = Extent::parse(&text).map_err(|problem| lexer.invalid(format!("EXTENT: {problem}")))?;
                self.extent = Some(extent);
            }
            "ORIGIN" => self.lattice.origin = three(lexer, keyword)?,
            // Files of version 1 call it so.
            "SPACING" | "ASPECT_RATIO" => self.lattice.spacing = three(lexer, keyword)?,
            "X_COORDINATES" => self.coordinates[0] = Some(typed(lexer, keyword)?),
            "Y_COORDINATES" => self.coordinates[1] = Some(typed(lexer, keyword)?),
            "Z_COORDINATES" => self.coordinates[2] = Some(typed(lexer, keyword)?),
            "BLANKING" => self.blanking = Some(typed(lexer, keyword)?),
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// The numbers of points along each direction.
    pub(super) fn extent(&self, lexer: &Lexer<'_>) -> Result<Extent, IoError> {
        self.extent.ok_or_else(|| lexer.invalid("the file ends without DIMENSIONS"))
    }
}

fn three(lexer: &mut Lexer<'_>, keyword: &str) -> Result<[f64; 3], IoError> {
    let mut numbers = [0.0; 3];
    for number in &mut numbers {
        let word = lexer.word().unwrap_or_default();
        *number = word.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| {
            let word: String = word.chars().take(40).collect();
            lexer.invalid(format!("\"{word}\" of {keyword} is not a finite number"))
        })?;
    }
    Ok(numbers)
}

fn typed(lexer: &mut Lexer<'_>, keyword: &str) -> Result<Vec<f64>, IoError> {
    let count = lexer.count(keyword)?;
    let kind: Option<LegacyType> = lexer.scalar_type()?;
    let Some(kind) = kind else { return Err(lexer.invalid(format!("{keyword} cannot be text"))) };
    lexer.line();
    Ok(lexer.numbers(kind, count, keyword)?.to_f64())
}

/// The grid that the lines, the points and the arrays of points and of cells make.
pub(super) fn build_grid(
    lexer: &Lexer<'_>,
    kind: Kind,
    lines: Lines,
    points: Option<Vec<DVec3>>,
    (mut point_arrays, mut cell_arrays): (Vec<DataArray>, Vec<DataArray>),
    warnings: &mut Vec<String>,
) -> Result<Dataset, IoError> {
    let extent = lines.extent(lexer)?;
    let broken = |place: &str, problem: String| lexer.source.invalid(place, problem, DAMAGED);
    let budget = Budget::new(GRID_LIMIT);
    budget.grant(lexer.source.bytes.len());
    let spend = || spend_points(&budget, &extent).map_err(|problem| broken("DIMENSIONS", problem));
    let expect = |place: &str, found: usize, expected: usize| {
        if found == expected {
            return Ok(());
        }
        Err(broken(place, format!("it has {found} numbers, where DIMENSIONS make it {expected}")))
    };
    let geometry = match kind {
        Kind::Image => {
            spend()?;
            Geometry::Image(lines.lattice)
        }
        Kind::Rectilinear => {
            let mut coordinates = [const { Vec::new() }; 3];
            let names = ["X_COORDINATES", "Y_COORDINATES", "Z_COORDINATES"];
            for (axis, own) in lines.coordinates.into_iter().enumerate() {
                let own = own.ok_or_else(|| broken(names[axis], "the section is missing".to_owned()))?;
                expect(names[axis], own.len(), extent.dims[axis])?;
                coordinates[axis] = own;
            }
            spend()?;
            Geometry::Rectilinear(coordinates)
        }
        Kind::Structured | Kind::Unstructured => {
            let points = points.ok_or_else(|| broken("POINTS", "the section is missing".to_owned()))?;
            expect("POINTS", 3 * points.len(), 3 * extent.point_count())?;
            Geometry::Structured(points)
        }
    };
    let mut hidden_points = hidden_points(&mut point_arrays);
    if let Some(blanking) = lines.blanking {
        expect("BLANKING", blanking.len(), extent.point_count())?;
        if blanking.contains(&0.0) {
            hidden_points = blanking.iter().map(|&visible| visible == 0.0).collect();
        }
    }
    let left_out_cells = left_out_cells(&mut cell_arrays);
    let piece = GridPiece { extent, geometry, point_arrays, cell_arrays, hidden_points, left_out_cells };
    let pieces = if extent.is_empty() { Vec::new() } else { vec![piece] };
    merge::assemble(pieces, warnings).map_err(|problem| broken("the whole file", problem))
}
