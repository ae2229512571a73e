//! Triangles against the classification on the CPU, and against rays cut in f64.

use tetrascope_shaders::{Constant, Program};
