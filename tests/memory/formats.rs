//! The formats besides VTK's unstructured grids and PLOT3D: small files that would be large, and work that grows with the file.

use std::io::Write;

use tetrascope_tests::fuzz::corpus::{Compressor, Encoding, Values, VtuWriter, openfoam};
use tetrascope_tests::fuzz::{Target, input, most_allocated};

use crate::bombs::End::{Read, Refused};
use crate::bombs::read;
use crate::growth::{check, many};
use crate::{alone, counted};

/// Counts that no file of some hundred bytes can hold.
const HUGE: [&str; 4] = ["4294967295", "99999999999", "9223372036854775807", "18446744073709551615"];

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn nrrd(fields: &str, data: &[u8]) -> Vec<u8> {
    [format!("NRRD0005\n{fields}\n\n").as_bytes(), data].concat()
}

#[test]
fn declared_counts_of_grids_reserve_nothing() {
    let _alone = alone();
    for n in HUGE {
        for extent in [format!("0 {n} 0 1 0 1"), format!("-{n} {n} 0 {n} 0 {n}"), "0 99999 0 99999 0 99999".to_owned()]
        {
            for (kind, name) in [("ImageData", "a.vti"), ("RectilinearGrid", "a.vtr"), ("StructuredGrid", "a.vts")] {
                let piece = format!("<Piece Extent=\"{extent}\"></Piece>");
                let file =
                    VtuWriter::new(Encoding::Text, None).file_of(kind, &format!("WholeExtent=\"{extent}\""), &piece);
                read(name, &file, Refused(&[name]), 1 << 20);
            }
        }
        for kind in ["STRUCTURED_POINTS", "STRUCTURED_GRID", "RECTILINEAR_GRID"] {
            let text =
                format!("# vtk DataFile Version 3.0\nt\nBINARY\nDATASET {kind}\nDIMENSIONS {n} 2 2\nPOINTS 4 float\n");
            read("grid.vtk", text.as_bytes(), Refused(&["grid.vtk"]), 1 << 20);
        }
        let fields = format!("type: uint8\ndimension: 3\nsizes: {n} 2 2\nencoding: raw");
        read("declared.nrrd", &nrrd(&fields, &[0; 64]), Refused(&["declared.nrrd"]), 1 << 20);
    }
}

/// A volume of zeros in a thousandth of its bytes.
#[test]
fn compressed_volumes_of_zeros_are_not_followed() {
    let _alone = alone();
    let zeros = gzip(&vec![0; 64 << 20]);
    let fields = "type: uint8\ndimension: 3\nsizes: 1024 256 256\nencoding: gzip";
    read(
        "zeros.nrrd",
        &nrrd(fields, &zeros),
        Refused(&["zeros.nrrd", "may stand for, compressed, 8347008 at most"]),
        32 << 20,
    );
    read("zeros_1024x256x256_uint8.raw", &zeros, Refused(&["zeros_1024x256x256_uint8.raw"]), 32 << 20);
    // Declares less than it holds.
    let fields = "type: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: gzip";
    read("more.nrrd", &nrrd(fields, &zeros), Read, 8 << 20);
    let mut writer = VtuWriter::new(Encoding::AppendedRaw, Some(Compressor::Zlib));
    writer.block = 1 << 20;
    let s = writer.array("s", 1, &Values::U8(vec![0; 64 << 20]));
    let extent = "0 1023 0 255 0 255";
    let piece = format!("<Piece Extent=\"{extent}\"><PointData>{s}</PointData></Piece>");
    let file = writer.file_of("ImageData", &format!("WholeExtent=\"{extent}\""), &piece);
    let most = most_allocated(Target::Vti, file.len());
    read("zeros.vti", &file, Refused(&["zeros.vti", "limit"]), most);
}

#[test]
fn declared_counts_of_gmsh_reserve_nothing() {
    let _alone = alone();
    let elements = "$Elements\n1\n1 4 2 1 1 1 1 1 1\n$EndElements\n";
    for n in HUGE {
        for body in [
            format!("$Nodes\n{n}\n1 0 0 0\n$EndNodes\n{elements}"),
            format!("$Nodes\n2\n1 0 0 0\n2 1 0 0\n$EndNodes\n$Elements\n{n}\n1 4 2 1 1 1 2 1 2\n$EndElements\n"),
            format!("$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 4 {n} 1 1 1 1 1 1\n$EndElements\n"),
            format!(
                "$Nodes\n1\n1 0 0 0\n$EndNodes\n{elements}$NodeData\n1\n\"s\"\n1\n0\n4\n0\n1\n{n}\n0\n1 1\n$EndNodeData\n"
            ),
        ] {
            let file = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{body}");
            read("declared.msh", file.as_bytes(), Refused(&["declared.msh"]), 1 << 20);
        }
        let file = format!(
            "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 {n} 1 {n}\n3 1 0 {n}\n1\n0 0 0\n$EndNodes\n\
                            $Elements\n1 1 1 1\n3 1 4 1\n1 1 1 1 1\n$EndElements\n"
        );
        read("declared.msh", file.as_bytes(), Refused(&["declared.msh"]), 1 << 20);
    }
}

/// Every length in the header of a file of NetCDF or HDF5, one after the other, as large as it can be.
#[test]
fn declared_counts_of_netcdf_and_hdf5_reserve_nothing() {
    let _alone = alone();
    for target in [Target::Exodus, Target::ExodusHdf5, Target::Vtkhdf] {
        let sound = input(target, 0, 0);
        let name = format!("declared.{}", target.extension());
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(&name);
        let mut most = 0;
        for at in (0..sound.len() - 4).step_by(4) {
            let mut file = sound.clone();
            file[at..at + 4].copy_from_slice(&0x7fff_ffff_u32.to_be_bytes());
            std::fs::write(&path, &file).unwrap();
            let (allocated, _) = counted(|| tetrascope::read_mesh(&path, &tetrascope::ReadOptions::default()));
            most = most.max(allocated);
        }
        println!("{target}: {} bytes, at most {most} allocated", sound.len());
        assert!(most < 2 << 20, "{target}: {most}");
    }
}

#[test]
fn declared_counts_of_openfoam_reserve_nothing() {
    let _alone = alone();
    let sound = input(Target::Openfoam, 0, 0);
    for n in HUGE {
        for place in 0..openfoam::FILES.len() {
            let folder = tempfile::tempdir().unwrap();
            let case = folder.path().join("case");
            for (at, (name, file)) in openfoam::FILES.iter().zip(openfoam::files(&sound)).enumerate() {
                let path = case.join(name);
                std::fs::create_dir_all(path.parent().unwrap()).unwrap();
                let head = b"FoamFile\n{\n    version 2.0;\n    format ascii;\n    class labelList;\n}\n".to_vec();
                let file =
                    if at == place { [head, format!("{n}\n(\n0\n)\n").into_bytes()].concat() } else { file.to_vec() };
                std::fs::write(path, file).unwrap();
            }
            let (allocated, _) = counted(|| tetrascope::read_mesh(&case, &tetrascope::ReadOptions::default()));
            assert!(allocated < 1 << 20, "{} of {n}: {allocated}", openfoam::FILES[place]);
        }
    }
}

#[test]
fn work_on_other_formats_grows_with_the_file() {
    let _alone = alone();
    let nodes = |n: usize| many(n, |i| format!("{} {} {} {}\n", i + 1, i % 7, i % 5, i % 3));
    let mesh = |n: usize, elements: &str, more: &str| {
        format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{n}\n{}$EndNodes\n$Elements\n{elements}$EndElements\n{more}",
            nodes(n)
        )
        .into_bytes()
    };
    let one = "1\n1 4 2 1 1 1 2 3 4\n";
    check("nodes.msh", 1000, |n| mesh(n, one, ""));
    check("elements.msh", 1000, |n| {
        mesh(4, &format!("{n}\n{}", many(n, |i| format!("{} 4 2 1 1 1 2 3 4\n", i + 1))), "")
    });
    check("groups.msh", 1000, |n| {
        mesh(4, &format!("{n}\n{}", many(n, |i| format!("{} 4 2 {i} {i} 1 2 3 4\n", i + 1))), "")
    });
    let view = |name: &str, step: usize| {
        format!("$NodeData\n1\n\"{name}\"\n1\n{step}\n4\n{step}\n1\n1\n0\n1 0.5\n$EndNodeData\n")
    };
    check("views.msh", 300, |n| mesh(4, one, &many(n, |i| view(&format!("s{i}"), 0))));
    check("steps.msh", 300, |n| mesh(4, one, &many(n, |i| view("s", i))));
    check("sections.msh", 1000, |n| mesh(4, one, &"$Else\n$EndElse\n".repeat(n)));
    check("comments.nrrd", 2000, |n| {
        nrrd(&format!("{}type: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw", "# a\n".repeat(n)), &[0; 8])
    });
    check("keys.nrrd", 2000, |n| {
        nrrd(
            &format!("{}type: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw", many(n, |i| format!("k{i}:=v\n"))),
            &[0; 8],
        )
    });
    check("samples.nrrd", 4000, |n| {
        nrrd(&format!("type: uint8\ndimension: 3\nsizes: {n} 2 2\nencoding: text"), "7 ".repeat(4 * n).as_bytes())
    });
    let image = |pieces: &str, n: usize| {
        VtuWriter::new(Encoding::Text, None).file_of("ImageData", &format!("WholeExtent=\"0 {n} 0 1 0 1\""), pieces)
    };
    check("pieces.vti", 300, |n| image(&many(n, |i| format!("<Piece Extent=\"{i} {} 0 1 0 1\"/>", i + 1)), n));
    let named = |n: usize| {
        let sets = many(n, |i| format!("<DataSet timestep=\"{i}\" file=\"a{i}.vtu\"/>"));
        format!("<VTKFile type=\"Collection\"><Collection>{sets}</Collection></VTKFile>").into_bytes()
    };
    check("sets.pvd", 1000, named);
}

#[test]
fn work_on_presets_grows_with_the_file() {
    let _alone = alone();
    let cost = |file: &[u8]| counted(|| tetrascope_colors::read_presets("made", file).is_ok()).0 as f64;
    let points = |n: usize| many(n, |i| format!("{i},0.5,0.5,0.5,"));
    let json = |n: usize| format!("[{{\"Name\":\"a\",\"RGBPoints\":[{}{n},1,1,1]}}]", points(n)).into_bytes();
    let presets = |n: usize| {
        format!("[{}{{\"Name\":\"a\",\"RGBPoints\":[0,0,0,0,1,1,1,1]}}]", "{\"Name\":\"a\"},".repeat(n)).into_bytes()
    };
    let xml = |n: usize| {
        let points = many(n, |i| format!("<Point x=\"{i}\" o=\"1\" r=\"0\" g=\"1\" b=\"0\"/>"));
        format!("<ColorMaps><ColorMap name=\"a\" space=\"RGB\">{points}</ColorMap></ColorMaps>").into_bytes()
    };
    let sizes =
        [("points", json(1000), json(4000)), ("presets", presets(1000), presets(4000)), ("XML", xml(1000), xml(4000))];
    for (name, small, large) in sizes {
        let (less, more) = (cost(&small), cost(&large));
        println!("presets, {name}: {} and {} bytes, {less} and {more} allocated", small.len(), large.len());
        assert!(more < 10.0 * less, "{name}: {less} and {more}");
        assert!(more < 64.0 * large.len() as f64, "{name}: {more} for {}", large.len());
    }
}
