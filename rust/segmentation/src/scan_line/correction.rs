//! What the ground taught about the camera's pose, kept from frame to frame.
//!
//! The error comes from encoders with constant offsets in trunk and neck and from the camera's mount. Part of it turns
//! with the head, part does not. So the correction has two halves, and a linear filter shares every measurement between
//! them:
//!
//! `robot_from_camera = turn(body half) * robot_from_camera by the joints * turn(head half)`, then shifted in height.
//!
//! The body half turns about the robot's x and y. The head half turns about the camera's x (pitch, as the neck's tilt
//! joint does at any pan and tilt) and z (roll). Turns about the vertical leave the ground as it is and stay unknown.

use geometry::{Camera, Pose, Robot};
use nalgebra::{
    Isometry3, Matrix2, Matrix2x4, Matrix4, Rotation3, Translation3, UnitQuaternion, Vector2,
    Vector3, Vector4,
};

/// What is believed of each half before anything was seen: sigma, rad. The neck's joint errs more than the trunk's.
const BODY_HALF_RAD: f64 = 0.035;
const HEAD_HALF_RAD: f64 = 0.09;
/// What is believed of the height before anything was seen: sigma, m.
const HEIGHT_M: f64 = 0.008;
/// How far the halves may wander from frame to frame: sigma, rad, and of the height, m.
const WANDER_RAD: f64 = 0.0003;
const WANDER_M: f64 = 0.0005;
/// How far one frame's attitude is off the filtered one while walking: sigma, rad, and of the height, m.
const SWAY_RAD: f64 = 0.01;
const SWAY_M: f64 = 0.003;
/// Frames with ground after which a track is settled. Before that the ground is searched as widely as at first, for the
/// attitude settles in these frames, too, and a first find may be a bad one.
const SETTLED: u32 = 8;
/// Frames without ground after which a track that has not settled is given up.
const YOUNG_MISSES: u32 = 3;

/// The filtered correction.
#[derive(Debug, Clone)]
pub(super) struct Correction {
    // Body half about x, y; head half about the camera's x, z; rad.
    halves: Vector4<f64>,
    covariance: Matrix4<f64>,
    height_m: f64,
    height_variance: f64,
    // Frames without any evidence, and frames without evidence of the height.
    missed: Option<u32>,
    missed_height: u32,
    found: u32,
}

impl Correction {
    /// Nothing known.
    pub(super) fn new() -> Self {
        let (body, head) = (BODY_HALF_RAD.powi(2), HEAD_HALF_RAD.powi(2));
        Self {
            halves: Vector4::zeros(),
            covariance: Matrix4::from_diagonal(&Vector4::new(body, body, head, head)),
            height_m: 0.0,
            height_variance: HEIGHT_M.powi(2),
            missed: None,
            missed_height: 0,
            found: 0,
        }
    }

    /// Whether the ground is tracked, not searched.
    pub(super) const fn is_settled(&self) -> bool {
        self.missed.is_some() && self.found >= SETTLED
    }

    /// Whether it may be trusted: settled, and confirmed not longer ago than these frames, in any way and in height.
    pub(super) fn holds(&self, frames: u32, height_frames: u32) -> bool {
        self.is_settled()
            && self.missed.is_some_and(|missed| missed <= frames)
            && self.missed_height <= height_frames
    }

    /// The height correction, m.
    pub(super) const fn height_m(&self) -> f64 {
        self.height_m
    }

    /// The camera's pose by the joints with what is known put right.
    pub(super) fn predict(&self, by_joints: &Pose<Robot, Camera>) -> Pose<Robot, Camera> {
        let body = Rotation3::new(Vector3::new(self.halves.x, self.halves.y, 0.0));
        let head = Rotation3::new(Vector3::new(self.halves.z, 0.0, self.halves.w));
        let rotation = UnitQuaternion::from_rotation_matrix(&body)
            * by_joints.inner.rotation
            * UnitQuaternion::from_rotation_matrix(&head);
        let mut position = by_joints.inner.translation.vector;
        position.z += self.height_m;
        Pose::wrap(Isometry3::from_parts(
            Translation3::from(position),
            rotation,
        ))
    }

    /// Takes in what a found ground says: a further turn about the robot's x and y (rad) and a rise (m) of the predicted
    /// camera.
    pub(super) fn found(
        &mut self,
        predicted: &Pose<Robot, Camera>,
        turn_rad: &Vector2<f64>,
        rise_m: f64,
    ) {
        self.turned(predicted, turn_rad);
        self.height_variance += WANDER_M.powi(2);
        let gain = self.height_variance / (self.height_variance + SWAY_M.powi(2));
        self.height_m += gain * rise_m;
        self.height_variance *= 1.0 - gain;
        self.missed = Some(0);
        self.missed_height = 0;
        self.found = self.found.saturating_add(1);
    }

    /// Takes in that surfaces were level as predicted, but of unknown height. Their tilt is not learned: low steps that
    /// are taken for one surface would turn the track into the slope of the stairs little by little.
    pub(super) fn confirmed(&mut self) {
        self.height_variance += WANDER_M.powi(2);
        self.missed = Some(0);
        self.missed_height = self.missed_height.saturating_add(1);
    }

    fn turned(&mut self, predicted: &Pose<Robot, Camera>, turn_rad: &Vector2<f64>) {
        let axes = predicted.inner.rotation.to_rotation_matrix();
        let (pitch, roll) = (axes * Vector3::x(), axes * Vector3::z());
        let measures = Matrix2x4::new(1.0, 0.0, pitch.x, roll.x, 0.0, 1.0, pitch.y, roll.y);
        self.covariance += Matrix4::identity() * WANDER_RAD.powi(2);
        let innovation = measures * self.covariance * measures.transpose()
            + Matrix2::identity() * SWAY_RAD.powi(2);
        if let Some(inverse) = innovation.try_inverse() {
            let gain = self.covariance * measures.transpose() * inverse;
            self.halves += gain * turn_rad;
            self.covariance -= gain * measures * self.covariance;
            self.covariance = (self.covariance + self.covariance.transpose()) / 2.0;
        }
    }

    /// Takes in that a frame showed nothing level; after `forget_frames` of them (a few for a young track) it is searched anew,
    /// from nothing.
    pub(super) fn missed_one(&mut self, forget_frames: u32) {
        self.covariance += Matrix4::identity() * WANDER_RAD.powi(2);
        self.height_variance += WANDER_M.powi(2);
        self.missed_height = self.missed_height.saturating_add(1);
        let patience = if self.is_settled() {
            forget_frames
        } else {
            YOUNG_MISSES
        };
        match self.missed {
            Some(missed) if missed < patience => self.missed = Some(missed + 1),
            Some(_) => *self = Self::new(),
            None => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn looking(pan: f64, tilt: f64) -> Pose<Robot, Camera> {
        let optical = Rotation3::from_matrix_unchecked(nalgebra::Matrix3::new(
            0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0,
        ));
        let rotation = Rotation3::from_axis_angle(&Vector3::z_axis(), pan)
            * Rotation3::from_axis_angle(&Vector3::y_axis(), tilt)
            * optical;
        Pose::wrap(Isometry3::from_parts(
            Translation3::new(0.04, 0.0, 0.5),
            UnitQuaternion::from_rotation_matrix(&rotation),
        ))
    }

    fn tilt_between(predicted: &Pose<Robot, Camera>, truth: &Pose<Robot, Camera>) -> Vector2<f64> {
        let turn = (truth.inner.rotation * predicted.inner.rotation.inverse()).scaled_axis();
        Vector2::new(turn.x, turn.y)
    }

    #[test]
    fn an_error_of_the_head_is_right_at_every_gaze_after_it_was_learned_at_two() {
        let error = UnitQuaternion::new(Vector3::new(0.11, 0.0, -0.09));
        let truth = |pan, tilt| {
            let by_joints = looking(pan, tilt);
            Pose::wrap(Isometry3::from_parts(
                by_joints.inner.translation,
                by_joints.inner.rotation * error,
            ))
        };
        let mut correction = Correction::new();
        let gazes = [(0.0, 0.7), (0.5, 0.7), (-0.5, 0.9), (0.0, 0.7), (1.0, 0.6)];
        for gaze in gazes.iter().flat_map(|gaze| [gaze; 10]) {
            let predicted = correction.predict(&looking(gaze.0, gaze.1));
            let turn = tilt_between(&predicted, &truth(gaze.0, gaze.1));
            correction.found(&predicted, &turn, 0.0);
        }
        for gaze in [(-1.2, 0.7), (1.2, 0.5), (0.3, 0.3)] {
            let predicted = correction.predict(&looking(gaze.0, gaze.1));
            let left = tilt_between(&predicted, &truth(gaze.0, gaze.1)).norm();
            assert!(left < 0.02, "{gaze:?}: {left}");
        }
    }

    #[test]
    fn learned_at_one_gaze_it_stays_within_the_tracking_gate_at_others() {
        for (pitch, roll) in [(0.12, 0.12), (-0.12, 0.12), (0.12, -0.12)] {
            let error = UnitQuaternion::new(Vector3::new(pitch, 0.0, roll));
            let truth = |pan: f64| {
                let by_joints = looking(pan, 0.7).inner;
                Pose::wrap(Isometry3::from_parts(
                    by_joints.translation,
                    by_joints.rotation * error,
                ))
            };
            let mut correction = Correction::new();
            for _ in 0..10 {
                let predicted = correction.predict(&looking(0.0, 0.7));
                let turn = tilt_between(&predicted, &truth(0.0));
                correction.found(&predicted, &turn, 0.0);
            }
            let predicted = correction.predict(&looking(1.0, 0.7));
            assert!(tilt_between(&predicted, &truth(1.0)).norm() < 0.044);
        }
    }

    #[test]
    fn it_forgets_after_so_many_frames_without_ground() {
        let mut correction = Correction::new();
        for _ in 0..SETTLED {
            assert!(!correction.is_settled());
            correction.found(&looking(0.0, 0.7), &Vector2::new(0.05, 0.0), 0.004);
        }
        assert!(correction.is_settled());
        for _ in 0..10 {
            correction.missed_one(10);
        }
        assert!(correction.is_settled() && !correction.holds(9, 20));
        correction.missed_one(10);
        assert!(!correction.is_settled());
        assert_eq!(correction.height_m(), 0.0);
    }
}
