//! A keyframe: what stood out of the floor at some time, seen from where the robot then was.

use geometry::{PlanarPose, angle_between};

use super::align::{Turn, TurnGuess, align};
use super::config::MatchingConfig;
use super::profile::UprightBeam;
use super::surfaces::UprightSurfaces;

/// Where the robot is: by its legs, and as believed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Viewpoint {
    /// Heading by odometry, rad.
    pub(super) odometry_yaw_rad: f64,
    /// Pose in the map.
    pub(super) map_from_robot: PlanarPose,
}

/// A frame to come back to, made of a few of the camera's.
#[derive(Debug, Clone)]
pub(super) struct Keyframe {
    stand: Viewpoint,
    surfaces: UprightSurfaces,
    frames: usize,
    refusals: u32,
}

impl Keyframe {
    /// An empty one, seen from where the robot is now.
    pub(super) fn new(stand: Viewpoint, config: &MatchingConfig) -> Self {
        Self {
            stand,
            surfaces: UprightSurfaces::new(config.cell, &config.tuning.surfaces),
            frames: 0,
            refusals: 0,
        }
    }

    /// Whether it has all its frames: from then on it stays as it is, so that nothing is ever matched with itself.
    pub(super) const fn is_whole(&self, config: &MatchingConfig) -> bool {
        self.frames >= config.frames
    }

    /// Whether what it shows seems to be gone.
    pub(super) const fn is_refuted(&self, config: &MatchingConfig) -> bool {
        self.refusals >= config.refusals
    }

    /// How far away it was drawn, m.
    pub(super) fn distance_m(&self, stand: &Viewpoint) -> f64 {
        self.stand.map_from_robot.distance_m(&stand.map_from_robot)
    }

    /// Takes in a frame; the heading since its first one is odometry's.
    pub(super) fn add(&mut self, beams: &[UprightBeam], stand: &Viewpoint) {
        let from_robot = self.place_of(stand, 0.0);
        for beam in beams {
            let (x_m, y_m) = from_robot.apply(beam.place_m.x, beam.place_m.y);
            self.surfaces.add(nalgebra::Vector2::new(x_m, y_m));
        }
        self.frames += 1;
    }

    /// Compares a frame with it; `since` is the believed growth of the odometry's error since then, rad, and its variance.
    pub(super) fn compare(
        &self,
        beams: &[UprightBeam],
        stand: &Viewpoint,
        since: (f64, f64),
        config: &MatchingConfig,
    ) -> Option<Turn> {
        if !self.is_whole(config) || self.distance_m(stand) > config.distance {
            return None;
        }
        let (error_rad, variance_rad2) = since;
        let guess = TurnGuess {
            keyframe_from_robot: self.place_of(stand, error_rad),
            heading_sd_rad: variance_rad2
                .sqrt()
                .max(config.tuning.alignment.least_guess),
            offset_sd_m: config.offset,
            least_beams: config.least_beams,
        };
        align(beams, &self.surfaces, &guess, &config.tuning.alignment)
    }

    /// Takes note of whether a comparison was believed.
    pub(super) fn judge(&mut self, believed: bool) {
        self.refusals = if believed { 0 } else { self.refusals + 1 };
    }

    fn place_of(&self, stand: &Viewpoint, error_rad: f64) -> PlanarPose {
        let seen = self.stand.map_from_robot.relative(&stand.map_from_robot);
        let turned_rad = angle_between(self.stand.odometry_yaw_rad, stand.odometry_yaw_rad);
        PlanarPose::new(seen.x_m, seen.y_m, turned_rad + error_rad)
    }
}
