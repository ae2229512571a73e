//! Transfer functions and the integral of a ray through one cell.
