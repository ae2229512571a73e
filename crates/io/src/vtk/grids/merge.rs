//! From the pieces of a grid to one dataset: where they tile a box, the grid of that box.

use glam::DVec3;
use tetrascope_mesh::{Cells, DataArray, Dataset, StructuredBlock, UnstructuredCells};

use super::super::join::join;
use super::super::tuples::{Run, blank, copy_runs, copy_tuples, kept};
use super::boxes::{Place, box_of, runs, taken_runs};
use super::extent::Extent;
use super::ghosts::WHY;
use super::hexahedra::push_hexahedra;
use super::{Geometry, GridPiece, is_same_lattice};

/// Points of the box around all pieces, for each point of these. Pieces that overlap or leave gaps are no tiling, and where there is much of
/// either the box would be larger than the files are.
const BOX_POINTS_A_POINT: usize = 4;

/// Whether a cell of a grid is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum State {
    /// No piece has it.
    Missing,
    /// Each piece that has it marks it to be left out.
    LeftOut,
    Drawn,
}

/// A grid whose cells are known one by one.
struct Grid {
    piece: GridPiece,
    /// One a cell, or none where all are drawn.
    states: Vec<State>,
}

/// Puts the pieces of one grid together. The error says what does not fit.
pub(in crate::vtk) fn assemble(mut pieces: Vec<GridPiece>, warnings: &mut Vec<String>) -> Result<Dataset, String> {
    if pieces.is_empty() {
        return Ok(Dataset { cells: Cells::Structured(Vec::new()), ..Dataset::default() });
    }
    if pieces.len() == 1 {
        let grids = pieces.drain(..).map(Grid::of_piece);
        return Ok(grids.map(|grid| grid.finish(warnings)).next().unwrap_or_default());
    }
    let total: usize = pieces.iter().map(|piece| piece.extent.point_count()).sum();
    let around = Extent::around(pieces.iter().map(|piece| piece.extent))
        .filter(|around| around.point_count() <= total.saturating_mul(BOX_POINTS_A_POINT));
    match around.filter(|_| are_on_one_lattice(&pieces)) {
        Some(around) => Ok(Grid::merged(pieces, around, warnings).finish(warnings)),
        None => {
            warnings.push(format!(
                "the {} pieces do not tile one grid; each is a grid of its own, and their cells need not meet face to face",
                pieces.len()
            ));
            let parts = pieces.into_iter().map(|piece| Grid::of_piece(piece).finish(warnings)).collect();
            join(parts, warnings)
        }
    }
}

fn are_on_one_lattice(pieces: &[GridPiece]) -> bool {
    pieces.windows(2).all(|pair| match (&pair[0].geometry, &pair[1].geometry) {
        (Geometry::Image(a), Geometry::Image(b)) => is_same_lattice(a, b),
        (Geometry::Rectilinear(_), Geometry::Rectilinear(_)) | (Geometry::Structured(_), Geometry::Structured(_)) => {
            true
        }
        _ => false,
    })
}

impl Grid {
    fn of_piece(piece: GridPiece) -> Self {
        let states = piece.left_out_cells.iter().map(|&out| if out { State::LeftOut } else { State::Drawn }).collect();
        Self { piece, states }
    }

    /// All pieces in the box around them.
    fn merged(pieces: Vec<GridPiece>, around: Extent, warnings: &mut Vec<String>) -> Self {
        let point_runs: Vec<_> = pieces
            .iter()
            .map(|piece| {
                let from = Place { dims: piece.extent.dims, at: [0; 3] };
                runs(piece.extent.dims, from, Place { dims: around.dims, at: piece.extent.within(&around) })
            })
            .collect();
        let cell_runs: Vec<_> = pieces
            .iter()
            .map(|piece| {
                let from = Place { dims: piece.extent.cell_dims(), at: [0; 3] };
                let to = Place { dims: around.cell_dims(), at: piece.extent.within(&around) };
                // A flat piece in a box that is not flat has no cells in common with it.
                if piece.extent.is_flat() == around.is_flat() { runs(from.dims, from, to) } else { Vec::new() }
            })
            .collect();
        // Where copies of a cell differ from it, as the number of the piece that has it does, the cell itself holds.
        let own_runs: Vec<_> = pieces
            .iter()
            .zip(&cell_runs)
            .map(|(piece, runs)| taken_runs(runs, |cell| piece.left_out_cells.get(cell) != Some(&true)))
            .collect();

        let mut states = vec![State::Missing; around.cell_count()];
        for (state, all) in [(State::LeftOut, &cell_runs), (State::Drawn, &own_runs)] {
            for &(_, to, length) in all.iter().flatten() {
                states.iter_mut().skip(to).take(length).for_each(|cell| *cell = (*cell).max(state));
            }
        }
        if states.iter().all(|&state| state == State::Drawn) {
            states = Vec::new();
        }
        let mut hidden = Vec::new();
        if pieces.iter().any(|piece| !piece.hidden_points.is_empty()) {
            hidden = vec![false; around.point_count()];
            for (piece, runs) in pieces.iter().zip(&point_runs) {
                copy_tuples(&mut hidden, &piece.hidden_points, 1, runs);
            }
        }
        let (mut geometries, mut of_points, mut of_cells) = (Vec::new(), Vec::new(), Vec::new());
        for piece in pieces {
            geometries.push((piece.extent, piece.geometry));
            of_points.push(piece.point_arrays);
            of_cells.push(piece.cell_arrays);
        }
        let point_arrays = merged_arrays("point", of_points, around.point_count(), &[&point_runs], warnings);
        let cell_arrays = merged_arrays("cell", of_cells, around.cell_count(), &[&cell_runs, &own_runs], warnings);
        let geometry = merged_geometry(geometries, &around, &point_runs);
        let piece = GridPiece {
            extent: around,
            geometry,
            point_arrays,
            cell_arrays,
            hidden_points: hidden,
            left_out_cells: Vec::new(),
        };
        Self { piece, states }
    }

    fn finish(self, warnings: &mut Vec<String>) -> Dataset {
        let Self { piece, states } = self;
        let GridPiece { extent, geometry, point_arrays, mut cell_arrays, hidden_points, .. } = piece;
        let points = geometry.points(&extent);
        let [i, j, k] = extent.dims;
        let is_flat = extent.is_flat();
        if is_flat {
            // Its cells are faces and lines, which a block does not count.
            cell_arrays.clear();
            warnings.push(format!("the grid of {i} x {j} x {k} points is flat: it has no cells with a volume"));
        }
        let block = StructuredBlock { dims: extent.dims, first_point: 0, hidden_points };
        let mut dataset = Dataset { points, cells: Cells::Structured(Vec::new()), point_arrays, cell_arrays };
        let is_drawn = |cell: usize| states.get(cell).is_none_or(|&state| state == State::Drawn);
        let left_out = states.iter().filter(|&&state| state == State::LeftOut).count();
        let missing = states.iter().filter(|&&state| state == State::Missing).count();
        if is_flat || left_out + missing == 0 {
            dataset.cells = Cells::Structured(vec![block]);
            return dataset;
        }
        let total = states.len();
        if left_out > 0 {
            warnings.push(format!("{left_out} of {total} cells are left out: {WHY}"));
        }
        if missing > 0 {
            warnings.push(format!("{missing} of {total} cells of the box around all pieces are in none of them"));
        }
        // Copies lie round a piece: what is left is a smaller grid.
        let cell_dims = extent.cell_dims();
        match box_of(cell_dims, is_drawn) {
            Some((at, length)) if length.iter().product::<usize>() == total - left_out - missing => {
                cropped(dataset, &block, at, length)
            }
            _ => {
                let mut cells = UnstructuredCells::default();
                push_hexahedra(&mut cells, &block, is_drawn);
                let keep: Vec<bool> = (0..total).map(is_drawn).collect();
                for array in &mut dataset.cell_arrays {
                    array.values = kept(&array.values, array.components, &keep);
                }
                dataset.cells = Cells::Unstructured(cells);
                warnings.push("what is left of the grid is read as hexahedra of their own".to_owned());
                dataset
            }
        }
    }
}

/// A box of cells out of a grid, as a grid.
fn cropped(dataset: Dataset, block: &StructuredBlock, at: [usize; 3], length: [usize; 3]) -> Dataset {
    let dims = length.map(|n| n + 1);
    let whole = |dims| Place { dims, at: [0; 3] };
    let point_runs = runs(dims, Place { dims: block.dims, at }, whole(dims));
    let cell_runs = runs(length, Place { dims: block.dims.map(|n| n - 1), at }, whole(length));
    let point_count = dims.iter().product();
    let mut points = vec![DVec3::NAN; point_count];
    copy_tuples(&mut points, &dataset.points, 1, &point_runs);
    let mut hidden_points = Vec::new();
    if !block.hidden_points.is_empty() {
        hidden_points = vec![false; point_count];
        copy_tuples(&mut hidden_points, &block.hidden_points, 1, &point_runs);
    }
    let crop = |arrays: Vec<DataArray>, count: usize, runs: &[Run]| {
        let crop = |array: DataArray| {
            let mut values = blank(&array.values, count * array.components);
            copy_runs(&mut values, &array.values, array.components, runs);
            DataArray { values, ..array }
        };
        arrays.into_iter().map(crop).collect()
    };
    Dataset {
        points,
        cells: Cells::Structured(vec![StructuredBlock { dims, first_point: 0, hidden_points }]),
        point_arrays: crop(dataset.point_arrays, point_count, &point_runs),
        cell_arrays: crop(dataset.cell_arrays, length.iter().product(), &cell_runs),
    }
}

/// Each array that all pieces have, written run by run into one of `count` tuples; later runs hold.
fn merged_arrays(
    owner: &str,
    mut pieces: Vec<Vec<DataArray>>,
    count: usize,
    passes: &[&[Vec<Run>]],
    warnings: &mut Vec<String>,
) -> Vec<DataArray> {
    let Some((first, others)) = pieces.split_first_mut() else { return Vec::new() };
    let mut merged = Vec::new();
    for array in first.drain(..) {
        let DataArray { name, components, values } = array;
        let same = |other: &&mut Vec<DataArray>| {
            let fits = |own: &DataArray| {
                own.name == name && own.components == components && own.values.type_name() == values.type_name()
            };
            other.iter().any(fits)
        };
        if others.iter_mut().filter(same).count() < others.len() {
            warnings.push(format!(
                "the {owner} array `{name}` is left out: not all pieces have it with the same type and components"
            ));
            continue;
        }
        let own: Vec<_> = others
            .iter_mut()
            .filter_map(|arrays| {
                let at = arrays.iter().position(|own| own.name == name)?;
                Some(arrays.swap_remove(at).values)
            })
            .collect();
        let mut all = blank(&values, count * components);
        for pass in passes {
            for (values, runs) in std::iter::once(&values).chain(&own).zip(*pass) {
                copy_runs(&mut all, values, components, runs);
            }
        }
        merged.push(DataArray { name, components, values: all });
    }
    let mut rest: Vec<&str> = others.iter().flatten().map(|array| array.name.as_str()).collect();
    rest.sort_unstable();
    rest.dedup();
    for name in rest.into_iter().filter(|name| merged.iter().all(|array| array.name != *name)) {
        warnings.push(format!("the {owner} array `{name}` is left out: not all pieces have it"));
    }
    merged
}

fn merged_geometry(pieces: Vec<(Extent, Geometry)>, around: &Extent, point_runs: &[Vec<Run>]) -> Geometry {
    let mut points = Vec::new();
    let mut coordinates = around.dims.map(|_| Vec::new());
    for ((extent, geometry), runs) in pieces.into_iter().zip(point_runs) {
        match geometry {
            Geometry::Image(lattice) => return Geometry::Image(lattice),
            Geometry::Rectilinear(own) => {
                let at = extent.within(around);
                for (axis, own) in own.iter().enumerate() {
                    // A number that no piece has belongs to no cell.
                    coordinates[axis].resize(around.dims[axis], f64::NAN);
                    copy_tuples(&mut coordinates[axis], own, 1, &[(0, at[axis], own.len())]);
                }
            }
            Geometry::Structured(own) => {
                points.resize(around.point_count(), DVec3::NAN);
                copy_tuples(&mut points, &own, 1, runs);
            }
        }
    }
    if points.is_empty() { Geometry::Rectilinear(coordinates) } else { Geometry::Structured(points) }
}
