//! Visibility orders are right where they say so: judged by rays and by exact planes, on made meshes and on real ones.

mod generated;
mod hard;
mod rays;
mod real;
mod views;
