//! The localizer `fast_slam`: leg odometry, corrected by rocks and poles that are mapped on the way (004, section 36.2.4 and reference 36.8).

mod config;
#[cfg(test)]
mod tests;

use geometry::{PlanarPose, wrap_angle};
use landmarks::{
    ExtractionConfig, FastSlam, FastSlamConfig, LandmarkReading, LandmarksConfig, OdometryStep,
    RangeBearing, standing_things,
};
use mapping::FloorView;
use nalgebra::Point3;
use proprioception::BodyState;
use segmentation::Planes;
use settings::{ConfigError, Part, Table, TableDescription, read};

use crate::localizer::{Estimate, Localizer, LocalizerError};
use crate::odometry::{OdometryLocalizer, OdometryLocalizerConfig};
use crate::part::LocalizerPart;

pub use config::FastSlamLocalizerConfig;

/// How it is listed and made.
pub(crate) const PART: LocalizerPart = Part {
    name: "fast_slam",
    about: "legs' odometry, corrected by rocks and poles that are mapped on the way",
    source: Some("004, section 36.2.4; Montemerlo et al. 2002 (ref 36.8)"),
    tables: &[
        TableDescription::of::<FastSlamLocalizerConfig>(),
        TableDescription::of::<OdometryLocalizerConfig>(),
    ],
    make: |needs| {
        let odometry = read(needs.tables, "odometry")?;
        let (start, stance_m) = (needs.start_or_origin(), needs.stance_m);
        let place = start.origin().inner;
        Ok(Box::new(FastSlamLocalizer::new(
            OdometryLocalizer::new(start, stance_m, odometry)?,
            &PlanarPose::new(place.x, place.y, start.yaw_rad()),
            read(needs.tables, "fast_slam")?,
        )?))
    },
};

/// Keeps heights as [`OdometryLocalizer`] does, and place and heading by [`FastSlam`].
#[derive(Debug, Clone)]
pub struct FastSlamLocalizer {
    config: FastSlamLocalizerConfig,
    odometry: OdometryLocalizer,
    slam: FastSlam,
    /// Where odometry was at the frame before, and when, ns.
    before: Option<(PlanarPose, u64)>,
}

impl FastSlamLocalizer {
    /// Begins where the robot is told to stand.
    pub fn new(
        odometry: OdometryLocalizer,
        start: &PlanarPose,
        config: FastSlamLocalizerConfig,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        let filter = FastSlamConfig {
            particles: config.particles,
            seed: config.seed,
            place_noise: config.place_noise,
            heading_noise: config.heading_noise,
            scale_noise: config.scale_noise,
            bearing_bias: config.camera_yaw,
            ..FastSlamConfig::default()
        };
        let readings = LandmarksConfig {
            range_noise: config.range_noise,
            bearing_noise: config.bearing_noise,
            reach: config.reach,
            apart: config.apart,
            named: false,
            ..LandmarksConfig::default()
        };
        Ok(Self {
            slam: FastSlam::new(start, filter, readings)?,
            odometry,
            config,
            before: None,
        })
    }

    /// Moves the guesses by what odometry says since the frame before.
    fn advance(&mut self, body: &BodyState) {
        let place = body.odometry_from_robot.origin().inner;
        let now = PlanarPose::new(place.x, place.y, body.odometry_from_robot.yaw_rad());
        if let Some((before, then_ns)) = self.before.replace((now, body.time_ns)) {
            let turn_rad = wrap_angle(now.yaw_rad - before.yaw_rad);
            // On the way the robot looks half as far round as in the end.
            let (sin, cos) = libm::sincos(before.yaw_rad + 0.5 * turn_rad);
            let (east_m, north_m) = (now.x_m - before.x_m, now.y_m - before.y_m);
            self.slam.advance(&OdometryStep {
                forward_m: cos * east_m + sin * north_m,
                left_m: cos * north_m - sin * east_m,
                turn_rad,
                passed_s: body.time_ns.saturating_sub(then_ns) as f64 * 1e-9,
            });
        }
    }

    /// Where rocks and poles are seen from the robot's origin.
    fn readings(&self, planes: &Planes) -> Vec<LandmarkReading> {
        let Some(camera) = planes.pinhole().filter(|_| planes.reliable) else {
            return Vec::new();
        };
        let half_px = camera.centre_px[0].min(camera.size_px[0] as f64 - camera.centre_px[0]);
        let extraction = ExtractionConfig {
            lowest: self.config.lowest,
            width: self.config.width,
            points: self.config.points,
            view: libm::atan(half_px / camera.focal_px[0]),
            ..ExtractionConfig::default()
        };
        let eye = planes.robot_from_camera.origin().inner;
        let [nearest_m, furthest_m] = self.config.reach;
        let upright = (planes.points_in_robot_m.iter())
            .zip(&planes.floor_height_m)
            .filter(|(_, floor_m)| floor_m.is_nan());
        let points_m: Vec<_> = upright
            .map(|(point, _)| {
                let [x_m, y_m, z_m] = point.map(f64::from);
                Point3::new(x_m - eye.x, y_m - eye.y, z_m)
            })
            .filter(|point| geometry::hypot(point.x, point.y) < furthest_m)
            .collect();
        let found = standing_things(&points_m, eye.z, &extraction).unwrap_or_default();
        let seen = found.iter().map(|thing| {
            let (x_m, y_m) = (thing.at_m.x + eye.x, thing.at_m.y + eye.y);
            RangeBearing {
                range_m: geometry::hypot(x_m, y_m),
                bearing_rad: libm::atan2(y_m, x_m),
            }
        });
        let near = seen.filter(|at| (nearest_m..=furthest_m).contains(&at.range_m));
        near.map(|at| LandmarkReading { at, name: None }).collect()
    }
}

impl Localizer for FastSlamLocalizer {
    fn correct(
        &mut self,
        body: &BodyState,
        planes: &Planes,
        view: &FloorView,
    ) -> Result<(), LocalizerError> {
        self.odometry.correct(body, planes, view)?;
        self.advance(body);
        let readings = self.readings(planes);
        if !readings.is_empty() {
            self.slam.see(&readings);
        }
        let (mean, _) = self.slam.belief();
        self.odometry.place(body, &mean);
        Ok(())
    }

    fn needs_unbroken_way(&self) -> bool {
        true
    }

    fn estimate(&mut self, body: &BodyState) -> Result<Estimate, LocalizerError> {
        self.odometry.estimate(body)
    }
}
