//! Triangles against the classification on the CPU, and against rays cut in f64.

mod fans;
mod pictures;
mod scene;
