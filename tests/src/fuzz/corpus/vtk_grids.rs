//! VTK's grids in XML, and files that name others.

use fastrand::Rng;

use super::super::Target;
use super::vtu::{Values, VtuWriter, piece, writer};

/// Points of a whole grid along x, y and z.
const SIZE: [i32; 3] = [4, 3, 2];

/// Pieces that tile the grid: one, or two that share a layer of points.
fn extents(rng: &mut Rng) -> Vec<[i32; 6]> {
    let [x, y, z] = SIZE.map(|n| n - 1);
    if rng.bool() { vec![[0, x, 0, y, 0, z]] } else { vec![[0, 1, 0, y, 0, z], [1, x, 0, y, 0, z]] }
}

fn words<T: ToString>(values: &[T]) -> String {
    values.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
}

fn grid_piece(w: &mut VtuWriter, target: Target, extent: [i32; 6], rng: &mut Rng) -> String {
    let length = |axis: usize| (extent[2 * axis + 1] - extent[2 * axis] + 1) as usize;
    let points = length(0) * length(1) * length(2);
    let cells = (length(0) - 1) * (length(1) - 1) * (length(2) - 1);
    let s = w.array("s", 1, &Values::F32((0..points).map(|_| rng.f32()).collect()));
    let v = w.array("v", 3, &Values::F64((0..3 * points).map(|_| rng.f64()).collect()));
    let c = w.array("c", 1, &Values::I32((0..cells as i32).collect()));
    let marks = if rng.bool() {
        w.array("vtkGhostType", 1, &Values::U8((0..cells).map(|_| 32 * u8::from(rng.u8(..6) == 0)).collect()))
    } else {
        String::new()
    };
    let along = |axis: usize, w: &mut VtuWriter| {
        let places = (extent[2 * axis]..=extent[2 * axis + 1]).map(|n| f64::from(n * n)).collect();
        w.array("", 1, &Values::F64(places))
    };
    let geometry = match target {
        Target::Vtr => format!("<Coordinates>\n{}{}{}</Coordinates>\n", along(0, w), along(1, w), along(2, w)),
        Target::Vts => {
            let [x, y, z] = [0, 1, 2].map(|axis| extent[2 * axis]..=extent[2 * axis + 1]);
            let row = |k: i32, j: i32| x.clone().flat_map(move |i| [i as f32, j as f32 + 0.1 * i as f32, k as f32]);
            let all = z.flat_map(|k| y.clone().flat_map(move |j| row(k, j)).collect::<Vec<_>>());
            format!("<Points>\n{}</Points>\n", w.array("Points", 3, &Values::F32(all.collect())))
        }
        _ => String::new(),
    };
    format!(
        "<Piece Extent=\"{}\">\n<PointData Scalars=\"s\">\n{s}{v}</PointData>\n<CellData>\n{c}{marks}</CellData>\n{geometry}</Piece>\n",
        words(&extent)
    )
}

pub(super) fn grid(target: Target, rng: &mut Rng) -> Vec<u8> {
    let extents = extents(rng);
    let mut writer = writer(rng);
    let pieces: String = extents.iter().map(|&extent| grid_piece(&mut writer, target, extent, rng)).collect();
    let [x, y, z] = SIZE.map(|n| n - 1);
    let whole = format!("WholeExtent=\"0 {x} 0 {y} 0 {z}\"");
    match target {
        Target::Vtr => writer.file_of("RectilinearGrid", &whole, &pieces),
        Target::Vts => writer.file_of("StructuredGrid", &whole, &pieces),
        _ => {
            let turned = ["", " Direction=\"0 1 0 -1 0 0 0 0 1\""][rng.usize(..2)];
            let attributes = format!("{whole} Origin=\"1 2 3\" Spacing=\"0.5 1 2\"{turned}");
            writer.file_of("ImageData", &attributes, &pieces)
        }
    }
}

/// Files that lie beside those that name them, the same in every run.
pub(super) fn companions() -> Vec<(&'static str, Vec<u8>)> {
    let mut rng = Rng::with_seed(0);
    let mut unstructured = || {
        let mut writer = writer(&mut rng);
        let piece = piece(&mut writer, &mut rng);
        writer.file(&piece)
    };
    let (first, second) = (unstructured(), unstructured());
    let mut rng = Rng::with_seed(1);
    let mut image = |extent: [i32; 6]| {
        let mut writer = writer(&mut rng);
        let piece = grid_piece(&mut writer, Target::Vti, extent, &mut rng);
        writer.file_of("ImageData", &format!("WholeExtent=\"{}\"", words(&extent)), &piece)
    };
    vec![
        ("part0.vtu", first),
        ("part1.vtu", second),
        ("part0.vti", image([0, 1, 0, 2, 0, 1])),
        ("part1.vti", image([1, 3, 0, 2, 0, 1])),
    ]
}

/// A file that names some of the [`companions`].
pub(super) fn naming(rng: &mut Rng) -> Vec<u8> {
    let xml = |kind: &str, attributes: &str, inside: &str| {
        format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\">\n<{kind} {attributes}>\n{inside}</{kind}>\n</VTKFile>\n"
        )
    };
    let text = match rng.u8(..5) {
        0 => xml(
            "PUnstructuredGrid",
            "GhostLevel=\"0\"",
            "<PPointData Scalars=\"s\">\n<PDataArray type=\"Float32\" Name=\"s\"/>\n</PPointData>\n<PPoints>\n\
             <PDataArray type=\"Float32\" NumberOfComponents=\"3\"/>\n</PPoints>\n<Piece Source=\"part0.vtu\"/>\n<Piece Source=\"part1.vtu\"/>\n",
        ),
        1 => xml(
            "PImageData",
            "WholeExtent=\"0 3 0 2 0 1\" GhostLevel=\"0\" Origin=\"0 0 0\" Spacing=\"1 1 1\"",
            "<PPointData>\n<PDataArray type=\"Float32\" Name=\"s\"/>\n</PPointData>\n\
             <Piece Extent=\"0 1 0 2 0 1\" Source=\"part0.vti\"/>\n<Piece Extent=\"1 3 0 2 0 1\" Source=\"part1.vti\"/>\n",
        ),
        2 => xml(
            "Collection",
            "",
            "<DataSet timestep=\"0\" group=\"\" part=\"0\" file=\"part0.vtu\"/>\n\
             <DataSet timestep=\"0.5\" group=\"\" part=\"0\" file=\"part0.vtu\"/>\n<DataSet timestep=\"0.5\" part=\"1\" file=\"part1.vtu\"/>\n",
        ),
        3 => xml(
            "vtkMultiBlockDataSet",
            "",
            "<Block index=\"0\" name=\"a\">\n<DataSet index=\"0\" file=\"part0.vtu\"/>\n</Block>\n<DataSet index=\"1\" file=\"part1.vti\"/>\n",
        ),
        _ => "{\n\"file-series-version\" : \"1.0\",\n\"files\" : [\n{ \"name\" : \"part0.vtu\", \"time\" : 0 },\n\
              { \"name\" : \"part1.vtu\", \"time\" : 1.5 }\n]\n}\n"
            .to_owned(),
    };
    text.into_bytes()
}
