//! OpenFOAM's cases: all files of one in one input.

use fastrand::Rng;

/// Files of a case, in the order in which they stand in an input.
pub const FILES: [&str; 7] = [
    "constant/polyMesh/points",
    "constant/polyMesh/faces",
    "constant/polyMesh/owner",
    "constant/polyMesh/neighbour",
    "constant/polyMesh/boundary",
    "1/p",
    "1/U",
];

/// How a file is written.
#[derive(Clone, Copy)]
struct Style {
    binary: bool,
    wide: bool,
}

impl Style {
    fn head(self, class: &str) -> Vec<u8> {
        let (format, arch) = match (self.binary, self.wide) {
            (false, _) => ("ascii", String::new()),
            (true, wide) => {
                ("binary", format!("    arch        \"LSB;label={};scalar=64\";\n", if wide { 64 } else { 32 }))
            }
        };
        format!("/* a banner */\nFoamFile\n{{\n    version     2.0;\n    format      {format};\n{arch}    class       {class};\n}}\n// * //\n\n").into_bytes()
    }

    fn list(self, count: usize, words: &[String], bytes: Vec<u8>) -> Vec<u8> {
        if self.binary {
            [format!("\n{count}\n(").into_bytes(), bytes, b")\n".to_vec()].concat()
        } else {
            format!("{count}\n(\n{}\n)\n", words.join("\n")).into_bytes()
        }
    }

    fn labels(self, values: &[i32]) -> Vec<u8> {
        let words: Vec<String> = values.iter().map(ToString::to_string).collect();
        let bytes = values.iter().flat_map(|&value| {
            if self.wide { i64::from(value).to_le_bytes().to_vec() } else { value.to_le_bytes().to_vec() }
        });
        self.list(values.len(), &words, bytes.collect())
    }

    fn tuples(self, values: &[f64], components: usize) -> Vec<u8> {
        let word = |tuple: &[f64]| {
            let words: Vec<String> = tuple.iter().map(ToString::to_string).collect();
            if components == 1 { words.concat() } else { format!("({})", words.join(" ")) }
        };
        let words: Vec<String> = values.chunks(components).map(word).collect();
        self.list(words.len(), &words, values.iter().flat_map(|value| value.to_le_bytes()).collect())
    }

    fn faces(self, faces: &[[i32; 4]]) -> Vec<u8> {
        if self.binary {
            let starts: Vec<i32> = (0..=faces.len() as i32).map(|face| 4 * face).collect();
            return [self.head("faceCompactList"), self.labels(&starts), self.labels(faces.as_flattened())].concat();
        }
        let words: Vec<String> = faces.iter().map(|[a, b, c, d]| format!("4({a} {b} {c} {d})")).collect();
        [self.head("faceList"), self.list(faces.len(), &words, Vec::new())].concat()
    }
}

/// Two cubes side by side, with a scalar in cells and a vector at points or in cells.
pub(super) fn case(rng: &mut Rng) -> Vec<u8> {
    let style = Style { binary: rng.bool(), wide: rng.bool() };
    let points: Vec<f64> = (0..12).flat_map(|n| [n % 3, n / 3 % 2, n / 6].map(f64::from)).collect();
    let at = |i: i32, j: i32, k: i32| 6 * k + 3 * j + i;
    // The one between both cells first; normals from its owner, or outward.
    let mut faces = vec![
        [at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)],
        [at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)],
        [at(2, 0, 0), at(2, 1, 0), at(2, 1, 1), at(2, 0, 1)],
    ];
    let mut owners = vec![0, 0, 1];
    for x in 0..2 {
        faces.push([at(x, 0, 0), at(x, 1, 0), at(x + 1, 1, 0), at(x + 1, 0, 0)]);
        faces.push([at(x, 0, 1), at(x + 1, 0, 1), at(x + 1, 1, 1), at(x, 1, 1)]);
        faces.push([at(x, 0, 0), at(x + 1, 0, 0), at(x + 1, 0, 1), at(x, 0, 1)]);
        faces.push([at(x, 1, 0), at(x, 1, 1), at(x + 1, 1, 1), at(x + 1, 1, 0)]);
        owners.extend([x; 4]);
    }
    let boundary = "1\n(\n    walls\n    {\n        type wall;\n        nFaces 10;\n        startFace 1;\n    }\n)\n";
    let end = b";\n\nboundaryField\n{\n    walls { type zeroGradient; }\n}\n";
    let field = |class: &str, list: &str, values: Vec<u8>| {
        let start = format!("dimensions      [0 1 -1 0 0 0 0];\n\ninternalField   nonuniform List<{list}> \n");
        [style.head(class), start.into_bytes(), values, end.to_vec()].concat()
    };
    let vector = match rng.u8(..3) {
        0 => field("pointVectorField", "vector", style.tuples(&vec![0.5; 36], 3)),
        1 => field("volVectorField", "vector", style.tuples(&[rng.f64(), 1.0, 2.0, 3.0, 4.0, 5.0], 3)),
        _ => [style.head("volVectorField"), b"u 1;\ninternalField uniform ($u 2 3);\n".to_vec()].concat(),
    };
    let text = Style { binary: false, ..style };
    let files = [
        [style.head("vectorField"), style.tuples(&points, 3)].concat(),
        style.faces(&faces),
        [style.head("labelList"), style.labels(&owners)].concat(),
        [style.head("labelList"), style.labels(&[1])].concat(),
        [text.head("polyBoundaryMesh"), boundary.as_bytes().to_vec()].concat(),
        field("volScalarField", "scalar", style.tuples(&[rng.f64(), 2.0], 1)),
        vector,
    ];
    joined(&files)
}

/// The files of one input: each behind its length. Whatever the bytes are, as many come out as a case has.
pub fn files(case: &[u8]) -> Vec<&[u8]> {
    let mut rest = case;
    FILES
        .iter()
        .map(|_| {
            let Some((length, behind)) = rest.split_first_chunk() else { return &[][..] };
            let length = usize::try_from(u64::from_le_bytes(*length)).unwrap_or(usize::MAX);
            let (file, more) = behind.split_at(length.min(behind.len()));
            rest = more;
            file
        })
        .collect()
}

/// The other way round.
pub fn joined<T: AsRef<[u8]>>(files: &[T]) -> Vec<u8> {
    let of = |file: &T| [&(file.as_ref().len() as u64).to_le_bytes(), file.as_ref()].concat();
    files.iter().flat_map(of).collect()
}
