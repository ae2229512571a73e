//! Where this project reads otherwise than the description counts, each with its reason.

/// Files that are not read by themselves: each goes with another one, whose row has all that there is.
pub(crate) const WITH_OTHERS: &[(&str, &str)] = &[
    // PLOT3D: the solution has no points of its own.
    ("plot3d/annulus_fortran_le_iblank.q", "plot3d/annulus_fortran_le_iblank.xyz"),
    ("plot3d/bluntfinq.bin", "plot3d/bluntfinxyz.bin"),
    ("plot3d/combq.bin", "plot3d/combxyz.bin"),
    ("plot3d/multi-ascii.q", "plot3d/multi-ascii.xyz"),
    ("plot3d/multi-bin-C.q", "plot3d/multi-bin-C.xyz"),
    ("plot3d/multi-bin.q", "plot3d/multi-bin.xyz"),
    ("plot3d/postq.bin", "plot3d/postxyz.bin"),
    // One slice of an image each, which only the header of all of them knows the size of.
    ("volume/headsq/quarter.1", "volume/headsq/quarter.nhdr"),
];

/// Arrays that are called otherwise here: file, name in the description (none of samples that have none), name here.
pub(crate) const NAMES: &[(&str, Option<&str>, &str)] = &[
    // Samples have no name in NRRD; this is the one by which ParaView calls them, whatever they were made from.
    ("volume/headsq_quarter_gzip.nrrd", Some("ImageScalars"), "ImageFile"),
];

/// Arrays of another type here: file, name (none for all of the file), type here.
pub(crate) const TYPES: &[(&str, Option<&str>, &str)] = &[
    // The file's own type; VTK's reader widens it.
    ("exodus/disk_out_ref.ex2", None, "Float32"),
    ("exodus/edgeFaceElem.exii", Some("Luigi PISTILLI"), "Int32"),
    ("exodus/edgeFaceElem.exii", Some("Benito STEFANELLI"), "Int32"),
    // Text says nothing of a type; VTK's reader narrows it.
    ("plot3d/multi-ascii.q", None, "Float64"),
    // Slices have no type of their own: the description takes them for unsigned, their header does not.
    ("volume/headsq/quarter.1", None, "Int16"),
];

/// Arrays that the description does not have: start of the file's path, names.
pub(crate) const MORE_ARRAYS: &[(&str, &[&str])] = &[
    // Computed from the solution.
    ("plot3d/", &["Pressure", "Velocity", "Temperature"]),
    // Of the grid, which the row of a solution leaves to the grid's own.
    ("plot3d/annulus_fortran_le_iblank.q", &["IBlank"]),
    ("plot3d/postq.bin", &["IBlank"]),
    // Which block or group a cell is of.
    ("gmsh/", &["gmsh:physical", "gmsh:geometrical"]),
    ("exodus/", &["ObjectId"]),
    // A variable that one of the two blocks has.
    ("exodus/edgeFaceElem.exii", &["EPSTRN"]),
];

/// Tetrahedra without volume, which are left out when all is cut.
pub(crate) const NO_VOLUME: &[(&str, usize)] = &[
    // Two lines of the grid coincide near the wall.
    ("plot3d/bluntfinxyz.bin", 77),
    ("plot3d/bluntfinq.bin", 77),
    // The inner pentagons of 12 prisms and the inner hexagons of 30 are one point: each prism is a pyramid, of three tetrahedra or four.
    ("vtk/PentaHexa.vtk", 12 * 6 + 30 * 8),
];

/// What is warned of: end of the file's path, words. All others are read without a warning.
pub(crate) const WARNINGS: &[(&str, &[&str])] = &[
    // A grid is read alone where its row is checked.
    (".xyz", &["a PLOT3D grid alone"]),
    ("xyz.bin", &["a PLOT3D grid alone"]),
    ("bluntfinq.bin", &["484 zero bytes"]),
    ("combq.bin", &["is negative at 43783 of 47025 points"]),
    ("postq.bin", &["is negative at 20 of 109744 points"]),
    ("edgeFaceElem.exii", &["`EPSTRN` is not there for all element blocks"]),
    ("headsq/quarter.nhdr", &["left-handed"]),
    ("headsq/quarter.1", &["left-handed"]),
    ("_uint8.raw", &["taken from the file's name"]),
    ("notch_stress.vtk", &["2192 cells have more points than their kind has"]),
];
