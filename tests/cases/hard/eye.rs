//! Hard cases of the eye.

use tetrascope_tests::hard::towards_parallel_scenes;
use tetrascope_tests::pictures::largest;
use tetrascope_tests::ways::Way;

use super::check;

#[test]
fn hard_eye_in_the_plane_of_a_face() {
    check("eye-in-the-plane-of-a-face");
}

#[test]
fn hard_eye_on_an_edge() {
    check("eye-on-an-edge");
}

#[test]
fn hard_eye_on_a_vertex() {
    check("eye-on-a-vertex");
}

#[test]
fn hard_eye_in_a_cell() {
    check("eye-in-a-cell");
}

#[test]
fn hard_eye_near_a_face() {
    check("eye-near-a-face");
}

#[test]
fn hard_cells_across_the_plane_of_the_eye() {
    check("cells-across-the-plane-of-the-eye");
}

#[test]
fn hard_angle_of_one_degree() {
    check("angle-of-one-degree");
}

#[test]
fn hard_angle_of_170_degrees() {
    check("angle-of-170-degrees");
}

#[test]
fn hard_parallel_as_the_limit_of_perspective() {
    check("parallel-as-the-limit-of-perspective");
}

/// Rays from a distance d differ from parallel ones by a slope of 1/d at most: so do the pictures, down to what f32 resolves.
#[test]
fn hard_parallel_is_reached_as_one_over_distance() {
    let (volume, mut scenes) = towards_parallel_scenes();
    let (_, parallel) = scenes.pop().unwrap();
    for way in Way::here("towards parallel") {
        let expected = way.draw(&volume, &parallel).unwrap().image;
        let mut last = f64::INFINITY;
        for (distance, scene) in &scenes {
            let difference = largest(&way.draw(&volume, scene).unwrap().image, &expected, 0..4);
            println!(
                "towards parallel, {way}, from {distance:e}: {difference:.1e}, times distance {:.2}",
                difference * distance
            );
            // The largest difference is where a ray comes to meet another cell; a share of the steepest change times 1/d.
            assert!(difference <= 4.0 / distance + 1e-5, "{way}, from {distance:e}: {difference:e}");
            assert!(difference <= 0.2 * last + 1e-5, "{way}, from {distance:e}: {difference:e} after {last:e}");
            last = difference;
        }
        assert!(last <= 1e-5, "{way}: {last:e}");
    }
}
