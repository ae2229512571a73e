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
        let mut constant = None;
        for (distance, scene) in &scenes {
            let image = way.draw(&volume, scene).unwrap().image;
            let differences = image.pixels().iter().zip(expected.pixels()).flat_map(|(a, b)| {
                a.iter().zip(b).map(|(a, b)| (f64::from(*a) - f64::from(*b)).abs()).collect::<Vec<_>>()
            });
            let mean = differences.sum::<f64>() / (4 * image.pixels().len()) as f64;
            let largest = largest(&image, &expected, 0..4);
            println!(
                "towards parallel, {way}, from {distance:e}: mean {mean:.1e}, times distance {:.3}, largest {largest:.1e}",
                mean * distance
            );
            if (1e2..=1e4).contains(distance) {
                let constant = *constant.get_or_insert(mean * distance);
                let share = mean * distance / constant;
                assert!((0.7..1.4).contains(&share), "{way}, from {distance:e}: {mean:e}, {share} of what it was");
            }
            assert!(*distance < 1e7 || largest <= 1e-5, "{way}, from {distance:e}: {largest:e}");
        }
    }
}
