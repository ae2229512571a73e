//! The GPU back end through the facade, where there is a device.

mod facade;
mod pictures;
