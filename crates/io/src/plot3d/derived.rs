//! The arrays of a solution: what the file stores, and what follows from it.

use tetrascope_mesh::DataArray;

use super::blocks::{Block, Real};

/// Ratio of specific heats that the derived quantities assume: air.
const GAMMA: f64 = 1.4;

/// Arrays over the points of all grids, one grid after another, and what was odd about them.
///
/// Stored: Density ρ, Momentum m (3 components), StagnationEnergy e (per volume). Derived, with γ = 1.4 and the
/// quantities nondimensional as PLOT3D has them: Pressure p = (γ − 1)(e − |m|² / 2ρ), Velocity m / ρ, Temperature p / ρ
/// (the gas constant is 1). Where ρ is 0 the three are NaN. All have the file's float type; arithmetic is in f64.
/// Source: [Walatka 1990], scalar functions for perfect gases; the names are those of VTK's reader.
pub(super) fn solution_arrays<T: Real>(blocks: &[Block<T>], warnings: &mut Vec<String>) -> Vec<DataArray> {
    let total = blocks.iter().map(|block| block.values.len() / 5).sum();
    let scalar = || Vec::<T>::with_capacity(total);
    let vector = || Vec::<T>::with_capacity(3 * total);
    let (mut density, mut momentum, mut energy) = (scalar(), vector(), scalar());
    let (mut pressure, mut velocity, mut temperature) = (scalar(), vector(), scalar());
    let (mut voids, mut negative) = (0_usize, 0_usize);

    for block in blocks {
        let points = block.values.len() / 5;
        let value = |quantity: usize, point: usize| block.values[quantity * points + point];
        for point in 0..points {
            let stored = [0, 1, 2, 3, 4].map(|quantity| value(quantity, point));
            let [rho, mx, my, mz, e] = stored.map(Into::<f64>::into);
            density.push(stored[0]);
            momentum.extend_from_slice(&stored[1..4]);
            energy.push(stored[4]);

            // 0 / 0 would give NaN too, but m / 0 would give infinity.
            let per_density = if rho == 0.0 { f64::NAN } else { 1.0 / rho };
            let p = (GAMMA - 1.0) * (e - 0.5 * (mx * mx + my * my + mz * mz) * per_density);
            pressure.push(T::from_f64(p));
            velocity.extend([mx, my, mz].map(|m| T::from_f64(m * per_density)));
            temperature.push(T::from_f64(p * per_density));
            voids += usize::from(rho == 0.0);
            negative += usize::from(p < 0.0);
        }
    }

    if voids > 0 {
        warnings.push(format!(
            "density is 0 at {voids} of {total} points: Pressure, Velocity and Temperature are NaN there"
        ));
    }
    if negative > 0 {
        warnings.push(format!(
            "Pressure, derived with gamma {GAMMA}, is negative at {negative} of {total} points; \
             the solution may not store the total energy that the formula takes"
        ));
    }
    let array =
        |name: &str, components, values| DataArray { name: name.to_owned(), components, values: T::array(values) };
    vec![
        array("Density", 1, density),
        array("Momentum", 3, momentum),
        array("StagnationEnergy", 1, energy),
        array("Pressure", 1, pressure),
        array("Velocity", 3, velocity),
        array("Temperature", 1, temperature),
    ]
}
