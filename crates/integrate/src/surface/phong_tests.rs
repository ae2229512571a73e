//! Light on surfaces: known answers, directions without one, refusals.

use proptest::prelude::*;

use super::*;

const PHONG: Phong = Phong { ambient: 0.1, diffuse: 0.7, specular: 0.4, shininess: 20.0 };

#[test]
fn a_surface_that_faces_eye_and_light_shows_everything() {
    let z = [0.0, 0.0, 1.0];
    for gradient in [[0.0, 0.0, 3.0], [0.0, 0.0, -3.0]] {
        let [body, highlight] = PHONG.intensities(gradient, z, z);
        assert!((body - 0.8).abs() < 1e-15 && (highlight - 0.4).abs() < 1e-15, "{body} {highlight}");
        let shaded = PHONG.shade([0.5, 0.0, 2.0], gradient, z, z);
        for (got, known) in shaded.into_iter().zip([0.8, 0.4, 2.0]) {
            assert!((got - known).abs() < 1e-15, "{shaded:?}");
        }
    }
}

#[test]
fn angles_are_known() {
    // The normal is along z, the eye 60 degrees to the one side, the light 60 and 30 degrees to the other.
    let (sine, cosine) = (0.75f64.sqrt(), 0.5);
    let eye = [-sine, 0.0, cosine];
    let [body, highlight] = PHONG.intensities([0.0, 0.0, 1.0], eye, [sine, 0.0, cosine]);
    assert!((body - (0.1 + 0.7 * 0.5)).abs() < 1e-15 && (highlight - 0.4).abs() < 1e-14, "the mirror's angle");
    let [body, highlight] = PHONG.intensities([0.0, 0.0, 1.0], eye, [cosine, 0.0, sine]);
    assert!((body - (0.1 + 0.7 * sine)).abs() < 1e-15);
    assert!((highlight - 0.4 * sine.powi(20)).abs() < 1e-15, "30 degrees beside it");
}

#[test]
fn light_from_behind_leaves_the_ambient_part() {
    let (eye, behind) = ([0.0, 0.0, 1.0], [0.0, 0.6, -0.8]);
    for gradient in [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]] {
        assert_eq!(PHONG.intensities(gradient, eye, behind), [0.1, 0.0]);
    }
    // In the surface's plane neither body nor highlight, whatever the sharpness.
    let soft = Phong { shininess: 0.0, ..PHONG };
    assert_eq!(soft.intensities([0.0, 0.0, 1.0], eye, [1.0, 0.0, 0.0]), [0.1, 0.0]);
    assert_eq!(soft.intensities([0.0, 0.0, 1.0], eye, [0.0, 0.6, 0.8])[1], 0.4);
}

#[test]
fn gradients_without_a_direction_leave_the_ambient_part() {
    let z = [0.0, 0.0, 1.0];
    for odd in [0.0, -0.0, f64::NAN, f64::INFINITY] {
        assert_eq!(PHONG.shade([2.0, 1.0, 0.0], [odd; 3], z, z), [0.2, 0.1, 0.0], "{odd}");
        assert_eq!(PHONG.intensities([odd, 0.0, 0.0], z, z), [0.1, 0.0], "{odd}");
    }
}

#[test]
fn coefficients_are_checked() {
    assert_eq!(PHONG.check(), Ok(()));
    assert_eq!(Phong { ambient: 0.0, diffuse: 0.0, specular: 0.0, shininess: 0.0 }.check(), Ok(()));
    for bad in [-0.5, f64::NAN, f64::INFINITY] {
        let refusals = [
            ("ambient", Phong { ambient: bad, ..PHONG }),
            ("diffuse", Phong { diffuse: bad, ..PHONG }),
            ("specular", Phong { specular: bad, ..PHONG }),
            ("shininess", Phong { shininess: bad, ..PHONG }),
        ];
        for (component, phong) in refusals {
            let message = phong.check().unwrap_err().to_string();
            assert_eq!(message, format!("{component} is {bad}; give a finite number, zero or more"));
        }
    }
}

prop_compose! {
    /// A vector of length 1.
    fn direction()(z in -1.0..=1.0f64, angle in 0.0..6.3f64) -> [f64; 3] {
        let radius = (1.0 - z * z).max(0.0).sqrt();
        let length = (radius * radius + z * z).sqrt();
        [radius * angle.cos() / length, radius * angle.sin() / length, z / length]
    }
}

proptest! {
    /// Powers of two scale without rounding.
    #[test]
    fn only_the_direction_of_the_gradient_counts(
        gradient in direction(),
        eye in direction(),
        light in direction(),
        exponent in -900..900i32,
    ) {
        let expected = PHONG.intensities(gradient, eye, light);
        let factor = f64::powi(2.0, exponent);
        prop_assert_eq!(PHONG.intensities(gradient.map(|g| g * factor), eye, light), expected);
        prop_assert_eq!(PHONG.intensities(gradient.map(|g| g * -factor), eye, light), expected);
    }

    /// Exchanging eye and light on the same side of the surface keeps the mirror's angle; rounding of the two cosines
    /// counts `shininess` times in the highlight.
    #[test]
    fn intensities_are_bounded_and_highlights_symmetric(
        gradient in direction(),
        eye in direction(),
        light in direction(),
    ) {
        let [body, highlight] = PHONG.intensities(gradient, eye, light);
        prop_assert!((0.1..=0.8 + 1e-15).contains(&body) && (0.0..=0.4).contains(&highlight));
        let [eye_cosine, light_cosine] = [dot(gradient, eye), dot(gradient, light)];
        if eye_cosine * light_cosine > 1e-9 {
            let [_, mirrored] = PHONG.intensities(gradient, light, eye);
            prop_assert!((highlight - mirrored).abs() < 20.0 * 0.4 * 2e-15);
        }
    }
}
