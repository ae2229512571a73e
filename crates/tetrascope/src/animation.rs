//! What changes from frame to frame: the time step, and the side from which it is seen.

use glam::{DQuat, DVec3};
use tetrascope_scene::{CameraSection, SceneError};

use crate::Error;

/// One frame of an animation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Which of the time steps that are shown, from 0.
    pub step: usize,
    /// How far the camera has turned, degrees.
    pub turned: f64,
}

/// Frames when nothing but the camera moves and their number is not said: 4 seconds at 24 frames a second.
const FRAMES_OF_A_TURN: usize = 96;

/// The frames of an animation of so many time steps.
///
/// - `frames`: how many; one a time step if nothing is said, and 96 of one time step. Steps are spread over the frames evenly.
/// - `turn`: degrees that the camera turns in all; once around one time step if nothing is said, and not at all with several. The frame
///   after the last would be the one that has turned by all of it, so that a full turn repeats without a stop.
pub fn frames_of(steps: usize, frames: Option<usize>, turn: Option<f64>) -> Vec<Frame> {
    let (usual_frames, usual_turn) = if steps > 1 { (steps, 0.0) } else { (FRAMES_OF_A_TURN, 360.0) };
    let (count, turn) = (frames.unwrap_or(usual_frames), turn.unwrap_or(usual_turn));
    (0..count)
        .map(|frame| Frame {
            // Steps and frames are counts of files and pictures: their product is far from any limit.
            step: frame * steps / count,
            turned: turn * frame as f64 / count as f64,
        })
        .collect()
}

/// A camera that has turned around its target.
///
/// - `camera`: with eye, target and up
/// - `axis`: the direction that it turns around, counterclockwise if it points at whoever looks; the camera's up direction if nothing is said
///
/// # Errors
/// [`Error::Scene`] for a camera that leaves any of them open, and for an axis that is none.
pub fn turned_camera(camera: &CameraSection, axis: Option<[f64; 3]>, degrees: f64) -> Result<CameraSection, Error> {
    let (Some(eye), Some(target), Some(up)) = (camera.eye, camera.target, camera.up) else {
        return Err(Error::Scene(SceneError::Value {
            key: "camera".to_owned(),
            value: "left open".to_owned(),
            expected: "a camera that turns needs an eye, a target and an up direction".to_owned(),
        }));
    };
    let along = DVec3::from(axis.unwrap_or(up));
    let Some(along) = along.try_normalize() else {
        return Err(Error::Scene(SceneError::Value {
            key: if axis.is_some() { "the axis" } else { "camera.up" }.to_owned(),
            value: format!("{along}"),
            expected: "give a direction other than 0, 0, 0".to_owned(),
        }));
    };
    if degrees == 0.0 {
        // Not a bit is lost where nothing turns.
        return Ok(camera.clone());
    }
    let rotation = DQuat::from_axis_angle(along, degrees.to_radians());
    let [eye, target, up] = [eye, target, up].map(DVec3::from);
    Ok(CameraSection {
        eye: Some((target + rotation * (eye - target)).to_array()),
        up: Some((rotation * up).to_array()),
        ..camera.clone()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_and_turns_are_spread_over_the_frames() {
        let steps = |frames: &[Frame]| frames.iter().map(|frame| frame.step).collect::<Vec<_>>();
        assert_eq!(steps(&frames_of(3, None, None)), [0, 1, 2]);
        assert_eq!(steps(&frames_of(3, Some(6), None)), [0, 0, 1, 1, 2, 2]);
        assert_eq!(steps(&frames_of(6, Some(3), None)), [0, 2, 4]);
        assert!(frames_of(3, None, None).iter().all(|frame| frame.turned == 0.0));
        let once = frames_of(1, None, None);
        assert_eq!((once.len(), once[0].turned, once[24].turned), (96, 0.0, 90.0));
        assert_eq!(frames_of(2, Some(4), Some(-180.0))[3], Frame { step: 1, turned: -135.0 });
        assert!(frames_of(5, Some(0), None).is_empty());
    }

    #[test]
    fn a_camera_turns_around_its_target() {
        let camera = CameraSection {
            eye: Some([1.0, 2.0, 13.0]),
            target: Some([1.0, 2.0, 3.0]),
            up: Some([0.0, 2.0, 0.0]),
            fov_y: Some(40.0),
            ..CameraSection::default()
        };
        let turned = turned_camera(&camera, None, 90.0).unwrap();
        let eye = DVec3::from(turned.eye.unwrap());
        assert!((eye - DVec3::new(11.0, 2.0, 3.0)).length() < 1e-12, "{eye}");
        assert_eq!((turned.target, turned.fov_y), (camera.target, camera.fov_y));
        let over = turned_camera(&camera, Some([5.0, 0.0, 0.0]), 90.0).unwrap();
        assert!((DVec3::from(over.eye.unwrap()) - DVec3::new(1.0, -8.0, 3.0)).length() < 1e-12);
        assert!((DVec3::from(over.up.unwrap()) - DVec3::new(0.0, 0.0, 2.0)).length() < 1e-12);
        assert_eq!(turned_camera(&camera, None, 0.0).unwrap(), camera);
        assert!(turned_camera(&camera, Some([0.0; 3]), 1.0).is_err());
        assert!(turned_camera(&CameraSection::default(), None, 1.0).is_err());
    }
}
