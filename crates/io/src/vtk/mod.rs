//! The readers of VTK files: legacy and XML unstructured grids.
