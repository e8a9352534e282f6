//! The localizer `odometry`: leg odometry as it is, its height drawn to the floor in the map.

mod config;

use crate::part::LocalizerPart;
use geometry::{Map, Odometry, PlanarPose, Pose, Robot, wrap_angle};
use mapping::{FloorView, Surface};
use nalgebra::{Point3, UnitQuaternion, Vector3};
use segmentation::Planes;
use settings::{ConfigError, Table};
use settings::{Part, TableDescription, read};

use crate::localizer::{Estimate, Localizer, LocalizerError};
use proprioception::BodyState;

pub use config::OdometryLocalizerConfig;

/// How it is listed and made.
pub(crate) const PART: LocalizerPart = Part {
    name: "odometry",
    about: "legs' odometry from encoders, gyro and foot contact",
    source: Some("000, section IV"),
    tables: &[TableDescription::of::<OdometryLocalizerConfig>()],
    make: |needs| {
        let config = read(needs.tables, "odometry")?;
        Ok(Box::new(OdometryLocalizer::new(
            needs.start_or_origin(),
            needs.stance_m,
            config,
        )?))
    },
};

/// The localizer of section IV of 000: (x, y, yaw) by odometry, z_R filtered with Floor(x_R, y_R).
#[derive(Debug, Clone)]
pub struct OdometryLocalizer {
    config: OdometryLocalizerConfig,
    /// Distance from the middle between the feet, to each side, of the middles of the soles, m.
    sole_aside_m: f64,
    map_from_robot_at_start: Pose<Map, Robot>,
    map_from_odometry: Option<Pose<Map, Odometry>>,
}

impl OdometryLocalizer {
    /// Starts at a pose that is told, for a robot whose soles stand so far apart, m.
    pub fn new(
        map_from_robot_at_start: Pose<Map, Robot>,
        stance_m: f64,
        config: OdometryLocalizerConfig,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            config,
            sole_aside_m: 0.5 * stance_m,
            map_from_robot_at_start,
            map_from_odometry: None,
        })
    }

    /// The odometry frame in the map: at the first body state the robot is where it was told to start.
    fn map_from_odometry(&mut self, body: &BodyState) -> Pose<Map, Odometry> {
        let start = self.map_from_robot_at_start;
        *self
            .map_from_odometry
            .get_or_insert_with(|| start * body.odometry_from_robot.inverse())
    }
}

impl OdometryLocalizer {
    /// Turns the map's odometry frame about where the robot stands, rad: another heading at the same place.
    pub(crate) fn turn(&mut self, body: &BodyState, turn_rad: f64) {
        let map_from_odometry = self.map_from_odometry(body).inner;
        let place = (map_from_odometry * body.odometry_from_robot.inner).translation;
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn_rad);
        self.map_from_odometry = Some(Pose::wrap(
            place * turn * place.inverse() * map_from_odometry,
        ));
    }

    /// Moves and turns the map's odometry frame so that the robot is at this place with this heading; its height stays.
    pub(crate) fn place(&mut self, body: &BodyState, pose: &PlanarPose) {
        let map_from_robot = self.map_from_odometry(body) * body.odometry_from_robot;
        self.turn(body, wrap_angle(pose.yaw_rad - map_from_robot.yaw_rad()));
        let place = map_from_robot.origin().inner;
        let mut moved = self.map_from_odometry(body).inner;
        moved.translation.vector += Vector3::new(pose.x_m - place.x, pose.y_m - place.y, 0.0);
        self.map_from_odometry = Some(Pose::wrap(moved));
    }

    /// By how much the floor under the feet lies above the robot's frame in the map, m: the mean over the places under
    /// and between the soles, where all that are known show the robot's level. Beside an edge one of them may show
    /// another: then nothing is sure.
    fn floor_above_m(&self, map_from_robot: &Pose<Map, Robot>, view: &FloorView) -> Option<f64> {
        let (mut sum_m, mut count) = (0.0, 0.0);
        let aside_m = self.sole_aside_m;
        for y_m in [-aside_m, 0.0, aside_m] {
            let place = map_from_robot.inner * Point3::new(0.0, y_m, 0.0);
            if let Surface::Floor(floor_m) = view.at(place.x, place.y) {
                let above_m = f64::from(floor_m) - place.z;
                if above_m.abs() >= self.config.height_gate {
                    return None;
                }
                sum_m += above_m;
                count += 1.0;
            }
        }
        (count > 0.0).then(|| sum_m / count)
    }
}

impl Localizer for OdometryLocalizer {
    fn correct(
        &mut self,
        body: &BodyState,
        _planes: &Planes,
        view: &FloorView,
    ) -> Result<(), LocalizerError> {
        let map_from_odometry = self.map_from_odometry(body);
        if !body.stands_level {
            return Ok(());
        }
        let map_from_robot = map_from_odometry * body.odometry_from_robot;
        if let Some(error_m) = self.floor_above_m(&map_from_robot, view) {
            let mut corrected = map_from_odometry.inner;
            corrected.translation.vector.z += self.config.height_gain * error_m;
            self.map_from_odometry = Some(Pose::wrap(corrected));
        }
        Ok(())
    }

    fn needs_unbroken_way(&self) -> bool {
        true
    }

    fn estimate(&mut self, body: &BodyState) -> Result<Estimate, LocalizerError> {
        let map_from_odometry = self.map_from_odometry(body);
        Ok(Estimate {
            time_ns: body.time_ns,
            map_from_robot: map_from_odometry * body.odometry_from_robot,
            map_from_odometry,
            lost: false,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::{Grid, Lattice};
    use proptest::prelude::*;
    use testkit::state_at;

    fn view(surface: Surface) -> FloorView {
        FloorView::new(
            Lattice {
                origin_m: [-2.0, -2.0],
                cell_m: 0.04,
            },
            Grid::filled(100, 100, surface),
            1,
        )
    }

    const STANCE_M: f64 = 0.08;

    fn localizer(start: Pose<Map, Robot>) -> OdometryLocalizer {
        OdometryLocalizer::new(start, STANCE_M, OdometryLocalizerConfig::default()).unwrap()
    }

    proptest! {
        #[test]
        fn the_first_estimate_is_the_start(x in -3.0..3.0f64, y in -3.0..3.0f64, yaw in -3.0..3.0f64) {
            let start = Pose::from_yaw(x, y, 0.12, yaw);
            let mut body = state_at(0);
            body.odometry_from_robot = Pose::from_yaw(0.1, -0.2, 0.0, 0.3);
            let estimate = localizer(start).estimate(&body).unwrap();
            prop_assert!((estimate.map_from_robot.inner.translation.vector - start.inner.translation.vector).norm() < 1e-12);
            prop_assert!((estimate.map_from_robot.yaw_rad() - yaw).abs() < 1e-9);
        }

        #[test]
        fn the_height_is_drawn_to_the_floor_of_its_level_only(error_m in -0.03..0.03f64) {
            let mut localizer = localizer(Pose::identity());
            let view = view(Surface::Floor(error_m as f32));
            for _ in 0..100 {
                localizer.correct(&state_at(0), &Planes::new(0), &view).unwrap();
            }
            let height_m = localizer.estimate(&state_at(0)).unwrap().map_from_robot.origin().inner.z;
            let expected_m = if error_m.abs() < 0.012 { error_m } else { 0.0 };
            prop_assert!((height_m - expected_m).abs() < 1e-5);
        }
    }

    #[test]
    fn beside_an_edge_or_with_the_feet_on_two_levels_the_height_stays() {
        let height_m = |level: bool, beside_m: f32| {
            let mut localizer = localizer(Pose::identity());
            let mut view = view(Surface::Floor(0.01));
            let cell = view.lattice.cell_at(0.0, 0.04);
            *view.cells.get_mut(cell).unwrap() = Surface::Floor(beside_m);
            let mut body = state_at(0);
            body.stands_level = level;
            for _ in 0..100 {
                localizer.correct(&body, &Planes::new(0), &view).unwrap();
            }
            let estimate = localizer.estimate(&body).unwrap();
            estimate.map_from_robot.origin().inner.z
        };
        assert!((height_m(true, 0.01) - 0.01).abs() < 1e-5);
        assert_eq!(height_m(true, -0.015), 0.0);
        assert_eq!(height_m(false, 0.01), 0.0);
    }

    #[test]
    fn an_unknown_floor_changes_nothing() {
        let mut localizer = localizer(Pose::identity());
        for surface in [Surface::Unknown, Surface::Obstacle(0.005)] {
            localizer
                .correct(&state_at(0), &Planes::new(0), &view(surface))
                .unwrap();
        }
        let estimate = localizer.estimate(&state_at(0)).unwrap();
        assert_eq!(estimate.map_from_robot.origin().inner.z, 0.0);
    }

    #[test]
    fn a_gain_above_one_is_refused() {
        let config = OdometryLocalizerConfig {
            height_gain: 1.5,
            ..OdometryLocalizerConfig::default()
        };
        let message = OdometryLocalizer::new(Pose::identity(), STANCE_M, config)
            .unwrap_err()
            .to_string();
        assert_eq!(
            message,
            "navigation.odometry.height_gain must be from 0 to 1, got 1.5"
        );
    }
}
