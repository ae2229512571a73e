//! The table of the data's description, as rows.

/// One file, or several that are one.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    /// Paths below the data folder.
    pub(crate) files: Vec<String>,
    pub(crate) shape: Shape,
    pub(crate) points: usize,
    pub(crate) cells: usize,
    /// As the description counts, with five tetrahedra a hexahedron and second-order cells by their corners; none where it has no rule.
    pub(crate) tetrahedra: Option<usize>,
    /// As VTK's filter cuts, where the description says so.
    pub(crate) by_vtk: Option<usize>,
    /// Of each grid of the file.
    pub(crate) arrays: Vec<Vec<Array>>,
}

/// Grids by their numbers of points, or cells by the description's words for them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Shape {
    Grids(Vec<[usize; 3]>),
    Cells(Vec<(usize, String)>),
}

#[derive(Clone, Debug)]
pub(crate) struct Array {
    /// Whether it lives at the points.
    pub(crate) of_points: bool,
    /// None for the samples of a raw volume, which have no name.
    pub(crate) name: Option<String>,
    /// In this project's words: `Float32`.
    pub(crate) kind: String,
    pub(crate) components: usize,
    /// Of all components, of what is finite, to six digits.
    pub(crate) range: [f64; 2],
    pub(crate) not_finite: usize,
}

/// All rows of the table of files.
///
/// # Panics
/// Where a row is not as all others are: then this test reads less than it says.
pub(crate) fn rows(readme: &str) -> Vec<Row> {
    let table = readme.split("\n## ").find(|part| part.starts_with("Files\n")).expect("a chapter of files");
    let lines: Vec<Vec<&str>> = table
        .lines()
        .filter(|line| line.starts_with("| `"))
        .map(|line| line.trim_matches('|').split(" | ").map(str::trim).collect())
        .collect();
    let mut rows: Vec<Row> = lines.iter().map(|columns| row(columns)).collect();
    // What another row's arrays stand for.
    for (at, columns) in lines.iter().enumerate() {
        if let Some(other) = columns[8].strip_prefix("as ") {
            let other = rows.iter().position(|row| row.files[0].ends_with(other)).expect("the row that is meant");
            rows[at].arrays = rows[other].arrays.clone();
        }
    }
    rows
}

fn row(columns: &[&str]) -> Row {
    let [file, _, _, _, shape, points, cells, tetrahedra, arrays, _] = columns else { panic!("{columns:?}") };
    Row {
        files: files(file),
        shape: self::shape(shape),
        points: number(points),
        cells: number(cells.split(" (").next().unwrap()),
        tetrahedra: tetrahedra.split(" (").next().filter(|text| text.starts_with(char::is_numeric)).map(number),
        by_vtk: tetrahedra.split_once("(VTK filter: ").map(|(_, text)| number(text.trim_end_matches(')'))),
        arrays: self::arrays(arrays),
    }
}

fn number(text: &str) -> usize {
    text.replace(',', "").parse().unwrap_or_else(|_| panic!("`{text}` is no number"))
}

/// `a/b.vtu`, or `a/b.1` … `b.93` (93 files).
fn files(text: &str) -> Vec<String> {
    let names: Vec<&str> = text.split('`').skip(1).step_by(2).collect();
    let [first, last] = names[..] else { return vec![names[0].to_owned()] };
    let (stem, from) = first.rsplit_once('.').unwrap();
    let (_, to) = last.rsplit_once('.').unwrap();
    let files: Vec<String> = (number(from)..=number(to)).map(|n| format!("{stem}.{n}")).collect();
    assert!(text.contains(&format!("({} files)", files.len())), "{text}");
    files
}

/// `8x12x12 + 8x12x12`, `64x64 each, 64x64x93 together`, or `2 hex, 1 tet in 2 blocks, 2 time steps`.
fn shape(text: &str) -> Shape {
    let text = text.rsplit_once("each, ").map_or(text, |(_, together)| together.trim_end_matches(" together"));
    let dims =
        |grid: &str| <[usize; 3]>::try_from(grid.split('x').map(|n| n.parse().ok()).collect::<Option<Vec<_>>>()?).ok();
    if let Some(grids) = text.split(" + ").map(dims).collect() {
        return Shape::Grids(grids);
    }
    let cells = text.split(", ").filter(|part| !part.ends_with(" time steps")).map(|part| {
        let (count, word) = part.split_once(' ').unwrap_or_else(|| panic!("`{part}` is no count of cells"));
        (number(count), word.split(" in ").next().unwrap().to_owned())
    });
    Shape::Cells(cells.collect())
}

fn arrays(text: &str) -> Vec<Vec<Array>> {
    if matches!(text, "none" | "grid only") || text.starts_with("as ") {
        return vec![Vec::new()];
    }
    let text = text.trim_end_matches(" (ranges at the last step)");
    text.split(". Next grid: ").map(|grid| grid.split("; ").map(array).collect()).collect()
}

/// `cell a name, with a comma (float32 x3): -1 .. 2 (7 not finite)`, or `uint8: 0 .. 255`.
fn array(text: &str) -> Array {
    let (head, range) = text.rsplit_once(": ").unwrap_or_else(|| panic!("`{text}` is no array"));
    let (owner_and_name, kind) = match head.strip_suffix(')') {
        Some(head) => head.rsplit_once(" (").unwrap(),
        None => ("", head),
    };
    let (owner, name) = owner_and_name.split_once(' ').map_or(("point", None), |(owner, name)| (owner, Some(name)));
    assert!(["point", "cell"].contains(&owner), "{text}");
    let (kind, components) = kind.split_once(" x").map_or((kind, 1), |(kind, count)| (kind, number(count)));
    let kind = kind.replace("uint", "UInt").replace("float", "Float");
    let kind = kind.strip_prefix("int").map_or(kind.clone(), |bits| format!("Int{bits}"));
    let (range, rest) = range.split_once(" (").unwrap_or((range, ""));
    let (low, high) = range.split_once(" .. ").unwrap_or_else(|| panic!("`{range}` is no range"));
    Array {
        of_points: owner == "point",
        name: name.map(str::to_owned),
        kind,
        components,
        range: [low, high].map(|word| word.parse().unwrap_or_else(|_| panic!("`{word}` is no number"))),
        not_finite: rest.strip_suffix(" not finite)").map_or(0, number),
    }
}
