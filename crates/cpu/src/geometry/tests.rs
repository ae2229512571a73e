//! A ray meets exactly one of the cells that share a face, an edge or a vertex; spans are those of plain intersection.

use glam::DVec3;
use proptest::prelude::*;
use tetrascope_view::{Camera, Projection, View};

use tetrascope_mesh::ascending;

use super::*;

fn point(size: f64) -> impl Strategy<Value = DVec3> {
    [-size..size, -size..size, -size..size].prop_map(DVec3::from)
}

fn volume([a, b, c, d]: [DVec3; 4]) -> f64 {
    (b - a).dot((c - a).cross(d - a))
}

/// Depths where the line `z (u, w, 1)` enters and leaves, by intersecting it with each face's plane and testing the point.
fn plain_span(corners: [DVec3; 4], u: f64, w: f64) -> Option<[f64; 2]> {
    let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
    for m in 0..4 {
        let [p, q, r] = [1, 2, 3].map(|i| corners[(m + i) % 4]);
        let mut normal = (q - p).cross(r - p);
        if normal.dot(corners[m] - p) > 0.0 {
            normal = -normal;
        }
        let speed = normal.dot(DVec3::new(u, w, 1.0));
        let depth = normal.dot(p) / speed;
        if speed > 0.0 { leave = leave.min(depth) } else { enter = enter.max(depth) }
    }
    (enter < leave).then_some([enter, leave])
}

fn clip(corners: [DVec3; 4], scalars: [f64; 4]) -> Option<ClipCell> {
    ClipCell::new(&corners, &scalars, volume(corners) > 0.0)
}

proptest! {
    #[test]
    fn span_is_that_of_plain_intersection(
        corners in [point(1.0), point(1.0), point(1.0), point(1.0)],
        away in 0.0..20.0_f64, u in -1.0..1.0_f64, w in -1.0..1.0_f64,
    ) {
        let corners = corners.map(|c| c + DVec3::Z * away);
        prop_assume!(volume(corners).abs() > 1e-3);
        let (u, w) = (u / (1.0 + away), w / (1.0 + away));
        let scalars = corners.map(|c| 2.0 * c.x - c.y + 0.5 * c.z);
        let ours = clip(corners, scalars).unwrap().span(true, u, w);
        let plain = plain_span(corners, u, w);
        prop_assert_eq!(ours.is_some(), plain.is_some());
        if let (Some(ours), Some(plain)) = (ours, plain) {
            for (end, depth) in plain.into_iter().enumerate() {
                prop_assert!((ours.depth[end] - depth).abs() < 1e-9 * (1.0 + away));
                let scalar = (2.0 * u - w + 0.5) * depth;
                prop_assert!((ours.scalar[end] - scalar).abs() < 1e-8 * (1.0 + away), "{} {}", ours.scalar[end], scalar);
            }
        }
    }

    /// Splitting a cell at a point inside, on a face, on an edge: the parts' chords add up, whatever the ray runs through.
    #[test]
    fn chords_of_parts_add_up(
        corners in [point(1.0), point(1.0), point(1.0), point(1.0)],
        shares in [0..4_i32, 0..4_i32, 0..4_i32, 1..4_i32],
        target in [0..3_i32, 0..3_i32, 0..3_i32, 0..3_i32],
        is_perspective: bool,
    ) {
        // Coordinates on a coarse lattice make exact coincidences common.
        let snap = |p: DVec3| (p * 4.0).round() / 4.0 + DVec3::Z * 4.0;
        let corners = corners.map(snap);
        prop_assume!(volume(corners) != 0.0);
        let blend = |weights: [i32; 4]| {
            let sum: i32 = weights.iter().sum();
            corners.iter().zip(weights).map(|(&c, k)| c * f64::from(k)).sum::<DVec3>() / f64::from(sum)
        };
        let middle = blend(shares);
        prop_assume!(target.iter().any(|&k| k > 0));
        let through = blend(target);
        let (u, w) = if is_perspective { (through.x / through.z, through.y / through.z) } else { (through.x, through.y) };

        let scalars = [0.0; 4];
        let length = |cell: Option<ClipCell>| {
            cell.and_then(|c| c.span(is_perspective, u, w)).map_or(0.0, |s| s.depth[1] - s.depth[0])
        };
        let whole = length(clip(corners, scalars));
        let mut parts = 0.0;
        for m in 0..4 {
            // The vertices in ascending order: the middle is the fifth.
            let mut part: Vec<DVec3> = (0..4).filter(|&i| i != m).map(|i| corners[i]).collect();
            part.push(middle);
            let part = [part[0], part[1], part[2], part[3]];
            // Exact volumes decide at load which parts exist.
            if volume(part).abs() > 1e-12 {
                parts += length(clip(part, scalars));
            }
        }
        prop_assert!((whole - parts).abs() < 1e-9, "whole {} parts {}", whole, parts);
    }

    #[test]
    fn pixel_box_holds_every_covered_pixel(
        corners in [point(2.0), point(2.0), point(2.0), point(2.0)], away in -1.0..6.0_f64, is_perspective: bool,
    ) {
        let camera = Camera {
            eye: DVec3::new(0.0, 0.0, away),
            target: DVec3::new(0.0, 0.0, away - 1.0),
            up: DVec3::Y,
            projection: if is_perspective {
                Projection::Perspective { fov_y: 1.2 }
            } else {
                Projection::Orthographic { height: 3.0 }
            },
        };
        let space = PixelSpace::new(&View::new(&camera, 23, 17).unwrap(), 1.0);
        prop_assume!(volume(corners) > 1e-3);
        let mut points = Points::default();
        points.project(&space, &corners, &[0.0; 4]);
        let outline = points.pixel_box(&space, [0, 1, 2, 3]);
        let corners = points.corners([0, 1, 2, 3]);
        let cell = clip(corners, [0.0; 4]).unwrap();
        for y in 0..17 {
            for x in 0..23 {
                let (u, w) = (PixelSpace::center(x, 23), PixelSpace::center(y, 17));
                if cell.span(is_perspective, u, w).is_some() {
                    let [x0, x1, y0, y1] = outline.expect("covered, but said to be outside");
                    prop_assert!((x0..=x1).contains(&x) && (y0..=y1).contains(&y));
                    let around = ([u - 0.5, u + 0.5], [w - 0.5, w + 0.5]);
                    prop_assert!(!is_perspective || !is_outside_rectangle(&corners, around.0, around.1));
                }
            }
        }
    }
}

#[test]
fn pixel_space_agrees_with_the_rays_of_the_view() {
    let camera = Camera {
        eye: DVec3::new(1.0, 2.0, 3.0),
        target: DVec3::new(-2.0, 0.5, 1.0),
        up: DVec3::new(0.1, 1.0, 0.2),
        projection: Projection::Perspective { fov_y: 0.9 },
    };
    for projection in [camera.projection, Projection::Orthographic { height: 2.5 }] {
        let view = View::new(&Camera { projection, ..camera }, 31, 20).unwrap();
        let space = PixelSpace::new(&view, 1.0);
        for (x, y) in [(0, 0), (30, 0), (7, 19)] {
            let ray = view.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let (u, w) = (PixelSpace::center(x, 31), PixelSpace::center(y, 20));
            for t in [0.5, 4.0] {
                let at = space.transform(ray.origin + ray.direction * t);
                let expected = if view.is_perspective { DVec3::new(u, w, 1.0) * at.z } else { DVec3::new(u, w, at.z) };
                assert!((at - expected).length() < 1e-11, "{at} {expected}");
                let length = at.z * space.ray_stretch(u, w);
                assert!((length - ray.direction.length() * t).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn ascending_says_whether_the_order_was_odd() {
    assert_eq!(ascending([3, 5, 7, 9]), ([3, 5, 7, 9], true));
    assert_eq!(ascending([5, 3, 7, 9]), ([3, 5, 7, 9], false));
    assert_eq!(ascending([9, 3, 5, 7]), ([3, 5, 7, 9], false));
    assert_eq!(ascending([5, 3, 9, 7]), ([3, 5, 7, 9], true));
}
