//! The program `tetrascope`.
fn main() {}
