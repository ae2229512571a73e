//! Order, ranks and refusals of sets of isosurfaces.

use super::*;

fn surface(value: f64) -> Isosurface {
    Isosurface { value, color: [0.1; 3], back_color: [0.2; 3], opacity: 0.5, shading: SurfaceShading::None }
}

fn values(surfaces: &Isosurfaces) -> Vec<f64> {
    surfaces.as_slice().iter().map(|surface| surface.value).collect()
}

#[test]
fn surfaces_ascend_and_equal_ones_stay_in_order() {
    let given = [3.0, -1.0, 3.0, 0.5].map(surface);
    let mut given = given.to_vec();
    given[2].opacity = 0.25;
    let surfaces = Isosurfaces::new(given).unwrap();
    assert_eq!(values(&surfaces), [-1.0, 0.5, 3.0, 3.0]);
    assert_eq!([surfaces.as_slice()[2].opacity, surfaces.as_slice()[3].opacity], [0.5, 0.25]);
    assert!(!surfaces.is_empty() && Isosurfaces::default().is_empty());
}

#[test]
fn ranks_count_the_surfaces_that_are_not_above() {
    let surfaces = Isosurfaces::new([-1.0, 0.5, 3.0, 3.0].map(surface).to_vec()).unwrap();
    for (scalar, rank) in [(-2.0, 0), (-1.0, 1), (0.0, 1), (0.5, 2), (3.0f64.next_down(), 2), (3.0, 4), (1e300, 4)] {
        assert_eq!(surfaces.rank(scalar), rank, "{scalar}");
    }
    // Half-open: the lower end is not crossed, the upper one is, in either order.
    for (first, second, range) in [(-1.0, 0.5, 1..2), (0.5, -1.0, 1..2), (0.5, 0.5, 2..2), (-9.0, 9.0, 0..4)] {
        assert_eq!(surfaces.between(first, second), range, "{first} {second}");
    }
}

#[test]
fn zeros_of_both_signs_are_one_value() {
    for zero in [0.0, -0.0] {
        let surfaces = Isosurfaces::new(vec![surface(zero)]).unwrap();
        assert_eq!((surfaces.rank(0.0), surfaces.rank(-0.0), surfaces.rank(-1e-300)), (1, 1, 0));
    }
}

#[test]
fn refusals_name_the_surface_and_what_is_wrong() {
    let refusal = |change: fn(&mut Isosurface)| {
        let mut given = [2.0, 1.0].map(surface).to_vec();
        change(&mut given[1]);
        Isosurfaces::new(given).unwrap_err().to_string()
    };
    assert_eq!(refusal(|s| s.value = f64::NAN), "isosurface 1: value is NaN; give a finite number");
    assert_eq!(refusal(|s| s.value = f64::INFINITY), "isosurface 1: value is inf; give a finite number");
    assert_eq!(refusal(|s| s.opacity = 1.5), "isosurface 1: opacity is 1.5; give a number from 0 to 1");
    assert_eq!(refusal(|s| s.opacity = f64::NAN), "isosurface 1: opacity is NaN; give a number from 0 to 1");
    assert_eq!(refusal(|s| s.color[2] = -0.5), "isosurface 1: color is -0.5; give finite numbers, zero or more");
    let expected = "isosurface 1: back_color is NaN; give finite numbers, zero or more";
    assert_eq!(refusal(|s| s.back_color[0] = f64::NAN), expected);
}

#[test]
fn a_set_is_as_demanding_as_its_most_demanding_surface() {
    let shaded = |shading| Isosurface { shading, ..surface(0.0) };
    let surfaces = Isosurfaces::new([SurfaceShading::Flat, SurfaceShading::None].map(shaded).to_vec()).unwrap();
    assert_eq!(surfaces.shading(), SurfaceShading::Flat);
    assert_eq!(Isosurfaces::default().shading(), SurfaceShading::None);
    assert!(!surfaces.are_opaque());
    assert!(Isosurfaces::new(vec![Isosurface { opacity: 1.0, ..surface(0.0) }]).unwrap().are_opaque());
}

#[test]
fn another_unit_of_the_scalar_moves_the_values_alone() {
    let surfaces = Isosurfaces::new([-1.0, 0.5].map(surface).to_vec()).unwrap();
    let scaled = surfaces.with_scalars_scaled(4.0);
    assert_eq!(values(&scaled), [-4.0, 2.0]);
    assert_eq!(scaled.with_scalars_scaled(0.25), surfaces);
    let huge = Isosurfaces::new(vec![surface(1e308)]).unwrap().with_scalars_scaled(1e10);
    assert_eq!(values(&huge), [f64::MAX], "finite, as all values are");
}
