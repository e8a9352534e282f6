//! The head: turns the camera to where the command looks.

use behaviour::Gaze;
use nalgebra::Vector3;
use robot::{Body, LinkPoses};

use crate::{error::WalkError, targets::JointTargets};

/// A small turn of a joint, rad: only to which side it turns the camera is asked.
const SMALL_RAD: f64 = 0.01;

/// Moves pan and tilt with limited speed; what no joint turns stays as it is.
#[derive(Debug, Clone)]
pub struct HeadControl {
    joints: [Option<usize>; 2],
    ranges_rad: [[f64; 2]; 2],
    signs: [f64; 2],
    down_at_zero_rad: f64,
    speed_radps: f64,
    angles_rad: [f64; 2],
}

impl HeadControl {
    /// Learns from the kinematics how the head's joints turn the camera when all other joints are as in the upright stance.
    pub fn new(body: &Body, speed_radps: f64) -> Result<Self, WalkError> {
        let description = body.description();
        let names = [&description.head.pan, &description.head.tilt];
        let mut joints = [None; 2];
        let mut ranges_rad = [[0.0; 2]; 2];
        for (slot, name) in names.into_iter().enumerate() {
            let Some(name) = name else { continue };
            let joint = body.joint("head", name)?;
            joints[slot] = Some(joint);
            ranges_rad[slot] = body.hinge(joint).map_or([0.0; 2], |(_, joint)| joint.range);
        }
        let mut poses = LinkPoses::default();
        let mut look = |pan: f64, tilt: f64| -> Result<Vector3<f64>, WalkError> {
            let mut angles = description.stand.clone();
            for (joint, angle) in joints.into_iter().zip([pan, tilt]) {
                if let Some(joint) = joint {
                    angles[joint] = angle;
                }
            }
            body.pose_links(&angles, &mut poses)?;
            Ok(body.torso_from_camera(&poses).inner.rotation * Vector3::z())
        };
        let down = |axis: Vector3<f64>| -libm::atan2(axis.z, geometry::hypot(axis.x, axis.y));
        let (straight, panned, tilted) = (
            look(0.0, 0.0)?,
            look(SMALL_RAD, 0.0)?,
            look(0.0, SMALL_RAD)?,
        );
        let left = libm::atan2(panned.y, panned.x) - libm::atan2(straight.y, straight.x);
        let angles_rad = joints.map(|joint| joint.map_or(0.0, |joint| description.stand[joint]));
        Ok(Self {
            joints,
            ranges_rad,
            signs: [left.signum(), (down(tilted) - down(straight)).signum()],
            down_at_zero_rad: down(straight),
            speed_radps,
            angles_rad,
        })
    }

    /// Turns towards `gaze` for `passed_s`; writes angles and speeds of both joints.
    pub fn turn(&mut self, gaze: &Gaze, passed_s: f64, targets: &mut JointTargets) {
        let wanted = [
            gaze.pan_rad * self.signs[0],
            (gaze.down_rad - self.down_at_zero_rad) * self.signs[1],
        ];
        let most = self.speed_radps * passed_s;
        for (slot, wanted) in wanted.into_iter().enumerate() {
            let [low, high] = self.ranges_rad[slot];
            let before = self.angles_rad[slot];
            let goal = if wanted.is_finite() {
                wanted.clamp(low, high)
            } else {
                before
            };
            self.angles_rad[slot] = before + (goal - before).clamp(-most, most);
            let Some(joint) = self.joints[slot] else {
                continue;
            };
            targets.positions_rad[joint] = self.angles_rad[slot];
            targets.velocities_radps[joint] = (self.angles_rad[slot] - before) / passed_s;
        }
    }

    /// The joints that pan and tilt, by the joint order, where there are any.
    pub const fn joints(&self) -> [Option<usize>; 2] {
        self.joints
    }

    /// Where it was told to look at the last tick.
    pub fn gaze(&self) -> Gaze {
        Gaze {
            pan_rad: self.angles_rad[0] * self.signs[0],
            down_rad: self.angles_rad[1] * self.signs[1] + self.down_at_zero_rad,
        }
    }
}
