//! Depth frames held against time and the head's motion: a camera that is dead, blind or frozen.

use geometry::{Camera, Pose, Robot};
use settings::{POSITIVE, settings};

use crate::{Frame, SenseFault};

settings! {
    /// When depth frames cannot be right.
    pub struct FrameWatchConfig("navigation.frame_watch") {
        /// A picture that is the same to the bit although the camera has moved by this since, by the joints, is frozen.
        moved: f64 = 0.002, "m", POSITIVE;
        /// A picture that is the same to the bit although the camera has turned by this since, by the joints, is frozen.
        turned: f64 = 0.01, "rad", POSITIVE;
        /// A robot that gives up after so long without a good picture says that it is the camera.
        silent: f64 = 3.0, "s" of camera, POSITIVE;
    }
}

/// What is wrong with the newest picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Wrong {
    Frozen,
    Empty,
}

/// Watches the pictures. Claim: a picture that is the same to the bit while the camera moves was not taken.
#[derive(Debug, Clone)]
pub struct FrameWatch {
    config: FrameWatchConfig,
    last_m: Vec<f32>,
    /// Where the camera was when the last new picture was taken.
    taken: Option<Pose<Robot, Camera>>,
    wrong: Option<Wrong>,
    measured_share: Option<f64>,
    arrived_ns: Option<u64>,
    good_ns: Option<u64>,
    begin_ns: Option<u64>,
}

impl FrameWatch {
    /// Before the first picture.
    pub const fn new(config: FrameWatchConfig) -> Self {
        Self {
            config,
            last_m: Vec::new(),
            taken: None,
            wrong: None,
            measured_share: None,
            arrived_ns: None,
            good_ns: None,
            begin_ns: None,
        }
    }

    /// Takes note of the time, with or without a picture.
    pub fn pass(&mut self, time_ns: u64) {
        let _ = self.begin_ns.get_or_insert(time_ns);
    }

    /// Takes in a picture and where the joints say that the camera was. Whether it can be used: one that is frozen, or without depth, tells nothing.
    pub fn is_new(&mut self, frame: &Frame, robot_from_camera: &Pose<Robot, Camera>) -> bool {
        let same = self.last_m.len() == frame.depth_m.len()
            && (self.last_m.iter())
                .zip(&frame.depth_m)
                .all(|(before_m, now_m)| before_m.to_bits() == now_m.to_bits());
        let measured = (frame.depth_m.iter())
            .filter(|depth_m| depth_m.is_finite())
            .count();
        if !same || self.taken.is_none() {
            self.last_m.clone_from(&frame.depth_m);
            self.taken = Some(*robot_from_camera);
        }
        let moved = self.taken.is_some_and(|taken| {
            let motion = (taken.inverse() * *robot_from_camera).inner;
            motion.translation.vector.norm() > self.config.moved
                || motion.rotation.angle() > self.config.turned
        });
        self.wrong = if measured == 0 {
            Some(Wrong::Empty)
        } else if same && (moved || self.wrong == Some(Wrong::Frozen)) {
            Some(Wrong::Frozen)
        } else {
            None
        };
        if self.wrong.is_none() {
            self.good_ns = Some(frame.arrival_ns);
        }
        let share = measured as f64 / frame.depth_m.len().max(1) as f64;
        self.measured_share = (self.wrong != Some(Wrong::Frozen)).then_some(share);
        self.arrived_ns = Some(frame.arrival_ns);
        self.wrong.is_none()
    }

    /// Share of the newest picture's pixels that were measured; `None` where it was not taken anew, or has been missing for long.
    pub fn measured_share(&self, time_ns: u64) -> Option<f64> {
        let silent_s = time_ns.saturating_sub(self.arrived_ns?) as f64 * 1e-9;
        self.measured_share
            .filter(|_| silent_s < self.config.silent)
    }

    /// What is wrong with the camera, where it has given no good picture for long.
    pub fn fault(&self, time_ns: u64) -> Option<SenseFault> {
        let since_ns = self.good_ns.or(self.begin_ns)?;
        let silent_s = time_ns.saturating_sub(since_ns) as f64 * 1e-9;
        if silent_s < self.config.silent {
            return None;
        }
        let what = match self.wrong {
            Some(Wrong::Frozen) => {
                format!("gives the same picture, to the bit, for {silent_s:.0} s while it moves")
            }
            Some(Wrong::Empty) => format!("has measured no depth in any pixel for {silent_s:.0} s"),
            None => format!("has given no picture for {silent_s:.0} s"),
        };
        Some(SenseFault::new("the depth camera", what))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD_NS: u64 = 80_000_000;

    fn frame(number: u64, depth_m: f32) -> Frame {
        Frame {
            exposure_ns: number * PERIOD_NS,
            arrival_ns: number * PERIOD_NS,
            width: 2,
            height: 1,
            depth_m: vec![depth_m, f32::NAN],
        }
    }

    fn turned(number: u64) -> Pose<Robot, Camera> {
        Pose::from_yaw(0.0, 0.0, 0.5, 0.02 * number as f64)
    }

    fn watch() -> FrameWatch {
        let mut watch = FrameWatch::new(FrameWatchConfig::default());
        watch.pass(0);
        watch
    }

    #[test]
    fn pictures_that_differ_are_used_and_no_fault() {
        let mut watch = watch();
        for number in 0..100 {
            assert!(watch.is_new(&frame(number, 1.0 + 1e-6 * number as f32), &turned(number)));
            assert_eq!(watch.fault(number * PERIOD_NS), None);
        }
    }

    #[test]
    fn the_same_picture_from_a_camera_that_moves_is_frozen_and_none_from_one_that_rests() {
        let mut watch = watch();
        for number in 0..100 {
            assert!(watch.is_new(&frame(number, 1.0), &turned(0)));
        }
        assert_eq!(watch.fault(99 * PERIOD_NS), None);
        for number in 100..140 {
            assert!(!watch.is_new(&frame(number, 1.0), &turned(number - 99)));
        }
        // Nor is it taken anew where the camera comes back to where the picture was taken.
        assert!(!watch.is_new(&frame(140, 1.0), &turned(0)));
        let reason = watch.fault(140 * PERIOD_NS).unwrap().to_string();
        assert!(
            reason.starts_with("sensor: the depth camera gives the same picture"),
            "{reason}"
        );
        assert!(watch.is_new(&frame(141, 1.1), &turned(42)));
        assert_eq!(watch.fault(141 * PERIOD_NS), None);
    }

    #[test]
    fn a_camera_that_sees_nothing_or_is_silent_is_told() {
        let mut watch = watch();
        for number in 0..100 {
            assert!(!watch.is_new(&frame(number, f32::NAN), &turned(number)));
        }
        let reason = watch.fault(100 * PERIOD_NS).unwrap().to_string();
        assert!(reason.contains("no depth in any pixel"), "{reason}");
        let mut silent = FrameWatch::new(FrameWatchConfig::default());
        silent.pass(0);
        assert!(
            silent
                .fault(4_000_000_000)
                .unwrap()
                .what
                .contains("no picture for 4 s")
        );
        assert_eq!(silent.fault(1_000_000_000), None);
    }
}
