//! What the ground taught about the camera's pose, kept from frame to frame.
//!
//! The error comes from encoders with constant offsets in trunk and neck and from the camera's mount. Part of it turns
//! with the head, part does not. So the correction has two halves, and a linear filter shares every measurement between
//! them:
//!
//! `robot_from_camera = turn(body half) * robot_from_camera by the joints * turn(head half)`, then shifted.
//!
//! The body half turns about the robot's x and y. The head half turns about the camera's x (pitch, as the neck's tilt
//! joint does at any pan and tilt) and z (roll). Turns about the vertical leave the ground as it is and stay unknown.
//!
//! The camera's place is wrong in halves, too: the trunk's turn carries it along, and it sits elsewhere in the head. What
//! lies ahead or above in the head turns into height as the head tilts, and so the ground tells it, and with it how far
//! ahead the camera really is: by that much every edge would be seen too near or too far. What is to the side stays unknown.

pub(crate) mod tuning;

use geometry::{Camera, Pose, Robot};
use nalgebra::{
    Isometry3, Matrix3, Rotation3, RowSVector, SMatrix, SVector, Translation3, UnitQuaternion,
    Vector2, Vector3,
};

use tuning::CorrectionTuning;

/// Numbers of the state: body half about x, y, head half about the camera's x, z, rad; height; ahead and above in the camera's
/// axes, m.
const STATES: usize = 7;
const HEIGHT: usize = 4;
const AHEAD: usize = 5;
const ABOVE: usize = 6;
type TrackState = SVector<f64, STATES>;

/// The filtered correction.
#[derive(Debug, Clone, Default)]
pub(crate) struct Correction {
    tuning: CorrectionTuning,
    state: TrackState,
    covariance: SMatrix<f64, STATES, STATES>,
    // The direction that was looked in last, and the frames since it is that.
    axis: Vector3<f64>,
    alike: u32,
    /// What the last prediction added to the camera's height, m.
    pub(crate) raised_m: f64,
    // Frames without any evidence, and frames without evidence of the height.
    missed: Option<u32>,
    missed_height: u32,
    found: u32,
    // Finds from afar in a row that contradicted a young track.
    contradicted: u32,
    /// Whether what is near the feet told the track, or bore it out.
    pub(crate) near: bool,
}

impl Correction {
    /// A correction that nothing is known of yet.
    pub(crate) fn new(tuning: CorrectionTuning) -> Self {
        let sigmas = TrackState::from([
            tuning.body_roll,
            tuning.body_pitch,
            tuning.head,
            tuning.head,
            tuning.height,
            tuning.place,
            tuning.place,
        ]);
        Self {
            tuning,
            covariance: SMatrix::from_diagonal(&sigmas.component_mul(&sigmas)),
            ..Self::default()
        }
    }

    /// Forgets all that was seen.
    fn forget(&mut self) {
        *self = Self::new(self.tuning.clone());
    }

    /// Whether the ground is tracked, not searched.
    pub(crate) const fn is_settled(&self) -> bool {
        self.missed.is_some() && self.found >= self.tuning.settled
    }

    /// Whether so much ground was found that what is tilted against it is no floor.
    pub(crate) const fn is_seasoned(&self) -> bool {
        self.found >= self.tuning.seasoned
    }

    /// Whether the correction may be trusted: settled, and confirmed not longer ago than these frames, in any way and in height.
    pub(crate) fn holds(&self, frames: u32, height_frames: u32) -> bool {
        self.is_settled()
            && self.missed.is_some_and(|missed| missed <= frames)
            && self.missed_height <= height_frames
    }

    /// The camera's pose by the joints with what is known put right.
    pub(crate) fn predict(&mut self, by_joints: &Pose<Robot, Camera>) -> Pose<Robot, Camera> {
        let turn = Vector3::new(self.state[0], self.state[1], 0.0);
        let head = Rotation3::new(Vector3::new(self.state[2], 0.0, self.state[3]));
        let rotation = UnitQuaternion::from_scaled_axis(turn)
            * by_joints.inner.rotation
            * UnitQuaternion::from_rotation_matrix(&head);
        let by_joints_m = by_joints.inner.translation.vector;
        let on_the_trunk = Vector3::z() * (self.tuning.trunk * by_joints_m.z);
        let in_the_head = Vector3::new(0.0, -self.state[ABOVE], self.state[AHEAD]);
        let shift_m =
            turn.cross(&on_the_trunk) + rotation * in_the_head + Vector3::z() * self.state[HEIGHT];
        self.raised_m = shift_m.z;
        Pose::wrap(Isometry3::from_parts(
            Translation3::from(by_joints_m + shift_m),
            rotation,
        ))
    }

    /// Takes in what a found ground says: a further turn about the robot's x and y (rad) and a rise (m) of the predicted
    /// camera. A young track that it contradicts is given up; but what is `near` the feet is the ground, and a find from further
    /// away that contradicts that may be the slope of stairs and is left out.
    pub(crate) fn found(
        &mut self,
        predicted: &Pose<Robot, Camera>,
        turn_rad: &Vector2<f64>,
        rise_m: f64,
        near: bool,
    ) {
        self.wander();
        let axes = predicted.inner.rotation.to_rotation_matrix();
        let (pitch, roll) = (axes * Vector3::x(), axes * Vector3::z());
        let about_x = RowSVector::from([1.0, 0.0, pitch.x, roll.x, 0.0, 0.0, 0.0]);
        let about_y = RowSVector::from([0.0, 1.0, pitch.y, roll.y, 0.0, 0.0, 0.0]);
        let above = -axes[(2, 1)];
        let rises = RowSVector::from([0.0, 0.0, 0.0, 0.0, 1.0, axes[(2, 2)], above]);
        // Tilt and height of one frame err together, so that the floor in the picture is right: its height is measured.
        let away_m = self.middle_of_picture_m(&predicted.inner.translation.vector, &roll);
        let floor_rises = rises + about_x * away_m.y - about_y * away_m.x;
        let floor_rise_m = rise_m + turn_rad.x * away_m.y - turn_rad.y * away_m.x;
        let apart_rad = if near == self.near {
            self.tuning.contradicting_tilt
        } else {
            self.tuning.contradicting_near
        };
        let contradicts =
            turn_rad.norm() > apart_rad || floor_rise_m.abs() > self.tuning.contradicting_height;
        if contradicts && self.found > 0 && !self.is_settled() {
            if near || !self.near {
                self.forget();
            } else {
                // Time after time it is the young track that is wrong.
                self.contradicted += 1;
                if self.contradicted > self.tuning.young_contradictions {
                    self.forget();
                }
            }
            return;
        }
        self.near |= near;
        let measures = SMatrix::<f64, 3, STATES>::from_rows(&[about_x, about_y, floor_rises]);
        let measured = Vector3::new(turn_rad.x, turn_rad.y, floor_rise_m);
        let (sway_rad, sway_m) = (self.tuning.sway, self.tuning.height_sway);
        let noise = Vector3::new(sway_rad.powi(2), sway_rad.powi(2), sway_m.powi(2));
        let noise = noise * f64::from(self.count_alike(&roll));
        let innovation =
            measures * self.covariance * measures.transpose() + Matrix3::from_diagonal(&noise);
        if let Some(inverse) = innovation.try_inverse() {
            let gain = self.covariance * measures.transpose() * inverse;
            self.state += gain * measured;
            self.covariance -= gain * measures * self.covariance;
            self.covariance = (self.covariance + self.covariance.transpose()) / 2.0;
        }
        self.missed = Some(0);
        self.contradicted = 0;
        self.missed_height = 0;
        self.found = self.found.saturating_add(1);
    }

    /// Takes in that a ground that was found slopes near the feet: a track that was found from afar alone is given up.
    pub(crate) fn doubt_afar(&mut self) {
        if !self.near {
            self.forget();
        }
    }

    /// Takes in that surfaces were level as predicted, but of unknown height. Their tilt is not learned: low steps that
    /// are taken for one surface would turn the track into the slope of the stairs little by little.
    pub(crate) fn confirmed(&mut self) {
        self.covariance[(HEIGHT, HEIGHT)] += self.tuning.height_wander.powi(2);
        self.missed = Some(0);
        self.missed_height = self.missed_height.saturating_add(1);
    }

    /// Takes in that a frame showed nothing level; after `forget_frames` of them (a few for a young track) it is searched anew,
    /// from nothing.
    pub(crate) fn missed_one(&mut self, forget_frames: u32) {
        self.wander();
        self.missed_height = self.missed_height.saturating_add(1);
        if self.is_settled() {
            self.missed_of(forget_frames);
        } else {
            self.missed_of(self.tuning.young_misses);
        }
    }

    fn missed_of(&mut self, patience: u32) {
        match self.missed {
            Some(missed) if missed < patience => self.missed = Some(missed + 1),
            Some(_) => self.forget(),
            None => {}
        }
    }

    /// Frames in a row that looked in the direction `axis`.
    fn count_alike(&mut self, axis: &Vector3<f64>) -> u32 {
        if self.axis.dot(axis) > self.tuning.other_direction {
            self.alike = self.alike.saturating_add(1);
        } else {
            (self.axis, self.alike) = (*axis, 1);
        }
        self.alike
    }

    /// A frame later what is known is a little less sure.
    fn wander(&mut self) {
        let head_rad = self.tuning.wander;
        let body_rad = if self.is_seasoned() {
            head_rad
        } else {
            self.tuning.settling_wander
        };
        let wander_rad = [body_rad, body_rad, head_rad, head_rad];
        for (angle, wander_rad) in wander_rad.into_iter().enumerate() {
            self.covariance[(angle, angle)] += wander_rad.powi(2);
        }
        self.covariance[(HEIGHT, HEIGHT)] += self.tuning.height_wander.powi(2);
    }

    /// Where the camera's axis meets the floor, from below the camera, m. An axis that hardly falls meets it beyond what counts.
    fn middle_of_picture_m(&self, camera_m: &Vector3<f64>, axis: &Vector3<f64>) -> Vector2<f64> {
        let level = axis.xy();
        let away_m = (camera_m.z * level.norm() / (-axis.z).max(1e-3)).min(self.tuning.farthest);
        level.try_normalize(1e-6).unwrap_or_default() * away_m
    }
}

#[cfg(test)]
mod tests;
