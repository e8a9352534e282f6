//! The localizer `monte_carlo`: the torso's pose in six dimensions, in a volume that is known beforehand (002, III.C).

mod beams;
mod belief;
mod camera;
mod config;
mod directions;
mod doubt;
mod filter;
mod fit;
mod gauss;
mod ground;
mod guesses;
mod motion;
mod novelty;
mod observation;
mod particle;
mod random;
mod resampling;
mod search;
mod static_map;
#[cfg(test)]
mod tests;
mod tracking;
mod tuning;
mod weights;
#[cfg(test)]
mod world;

use crate::part::LocalizerPart;
use settings::{MakeError, Part, TableDescription, read};
use std::sync::Arc;

use geometry::{Map, Odometry, Pose, Robot};
use known_map::StandingRoom;
use mapping::FloorView;
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use robot::Extent;
use segmentation::Planes;
use settings::{ConfigError, Table};

pub use belief::Belief;
pub use camera::{CameraEstimate, CameraLocalizer};
pub use config::{MonteCarloConfig, RangeModel};
pub use particle::TorsoPose;
pub use static_map::StaticMap;

use crate::localizer::{Estimate, Guess, Localizer, LocalizerError};
use beams::Beams;
use motion::{BodyReading, TorsoMotion};
use observation::SeenFrame;
use proprioception::BodyState;
use search::PlaceSearch;
use tracking::Tracking;

/// How it is listed and made.
pub(crate) const PART: LocalizerPart = Part {
    name: "monte_carlo",
    about: "particles in six dimensions against a static map",
    source: Some("Maier, Hornung and Bennewitz 2012 (002, section III.C)"),
    tables: &[TableDescription::of::<MonteCarloConfig>()],
    make: |needs| {
        let config = read(needs.tables, "monte_carlo")?;
        let told = needs.known_map.ok_or_else(|| {
            MakeError::Text(
                "navigation.localizer: monte_carlo has to be told a static map".to_owned(),
            )
        })?;
        let map = Arc::new(StaticMap::new(
            told,
            room(&needs.body.description().body),
            &config,
        )?);
        Ok(Box::new(MonteCarloLocalizer::new(
            map,
            needs.start,
            config,
        )?))
    },
};

/// What the robot needs to stand somewhere, asked voxel by voxel of the map: it may stand beside a wall, turned as its body is narrowest.
fn room(body: &Extent) -> StandingRoom {
    let sides_m = [body.depth, body.width].into_iter().flatten();
    let radius_m = sides_m.map(|side_m| 0.5 * side_m);
    StandingRoom {
        radius_m: radius_m.fold(body.radius, f64::min),
        height_m: body.height,
    }
}

/// Monte Carlo localization in a static map: tracks from a start that is told, finds the place where none is, and finds it again
/// where frames stop to fit.
#[derive(Debug, Clone)]
pub struct MonteCarloLocalizer {
    config: MonteCarloConfig,
    map: Arc<StaticMap>,
    map_from_robot_at_start: Option<Pose<Map, Robot>>,
    /// Around the place where the robot knows to be.
    tracking: Option<Tracking>,
    /// Everywhere, where it does not know, or doubts.
    search: Option<PlaceSearch>,
    beams: Beams,
    observation: SeenFrame,
    /// Frames that were used.
    step: u64,
    last: Option<BodyReading>,
    map_from_odometry: Option<Pose<Map, Odometry>>,
}

impl MonteCarloLocalizer {
    /// Starts at a pose that is told, or anywhere on the map.
    pub fn new(
        map: Arc<StaticMap>,
        map_from_robot_at_start: Option<Pose<Map, Robot>>,
        config: MonteCarloConfig,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            config,
            map,
            map_from_robot_at_start,
            tracking: None,
            search: None,
            beams: Beams::default(),
            observation: SeenFrame::default(),
            step: 0,
            last: None,
            map_from_odometry: None,
        })
    }

    /// What the guesses said together at the last frame that was used: those that track, or those of the search where none do.
    pub fn belief(&self) -> Option<&Belief> {
        match (&self.tracking, &self.search) {
            (Some(tracking), _) => tracking.belief(),
            (None, Some(search)) => search.likely(),
            (None, None) => None,
        }
    }

    /// Whether enough happened since the last frame that was used: frames of a robot that stands err alike.
    fn is_due(&self, before: &BodyReading, now: &BodyReading) -> bool {
        let (travelled_m, turned_rad) = now.seen_since(before);
        let waited_s = now.time_ns.saturating_sub(before.time_ns) as f64 * 1e-9;
        let [way_m, turn_rad, wait_s] = self.config.update_after;
        travelled_m > way_m || turned_rad > turn_rad || waited_s > wait_s
    }

    fn start(&mut self, reading: &BodyReading) {
        self.tracking = self.map_from_robot_at_start.map(|start| {
            let map_from_torso = start.inner * reading.torso_from_robot.inverse();
            Tracking::from(&map_from_torso, &self.config)
        });
    }

    /// Looks for the robot everywhere while it may be elsewhere than it believes, and takes the place that was found.
    fn look_elsewhere(
        &mut self,
        since: Option<(&BodyReading, &TorsoMotion)>,
        reading: &BodyReading,
    ) {
        let doubted = (self.tracking.as_ref()).is_none_or(Tracking::is_doubted);
        if !doubted && self.search.is_none() {
            return;
        }
        let search = (self.search).get_or_insert_with(|| {
            PlaceSearch::anywhere(&self.config, &self.map, reading, self.step)
        });
        let news = since.map_or(1.0, |(before, _)| {
            search::news(before, reading, &self.config)
        });
        let motion = since.map(|(_, motion)| motion);
        search.update(
            (motion, news),
            (&self.observation, &self.beams, reading),
            (&self.map, self.tracking.as_ref().and_then(Tracking::belief)),
            self.step,
        );
        if search.is_better() {
            if let Some(search) = self.search.take_if(|search| search.is_thorough()) {
                self.tracking = Some(Tracking::in_place_of(search, &self.config));
            }
        } else if (self.tracking.as_ref()).is_some_and(|tracking| tracking.outlives(search)) {
            self.search = None;
        }
    }

    /// Takes in a frame and what the body says of itself at it; whether it was used.
    fn take(&mut self, reading: BodyReading, planes: &Planes) -> bool {
        let before = self.last;
        let motion = match &before {
            Some(before) if !self.is_due(before, &reading) => return false,
            Some(before) => Some(TorsoMotion::between(before, &reading, &self.config)),
            None => {
                self.start(&reading);
                None
            }
        };
        self.last = Some(reading);
        self.step += 1;
        self.beams
            .draw(planes, &reading.torso_from_robot, &self.config, self.step);
        self.observation
            .set((&self.beams, 0.0), &reading, &self.map, &self.config);
        if let Some(tracking) = &mut self.tracking {
            tracking.update(motion.as_ref(), &mut self.observation, &self.map, self.step);
        }
        self.look_elsewhere(before.as_ref().zip(motion.as_ref()), &reading);
        true
    }

    /// Whether the estimate is not to be acted on.
    fn is_lost(&self) -> bool {
        let Some(tracking) = &self.tracking else {
            return self.step > 0 || self.map_from_robot_at_start.is_none();
        };
        let elsewhere = self.search.as_ref().is_some_and(PlaceSearch::is_contest);
        elsewhere || tracking.is_lost()
    }
}

impl Localizer for MonteCarloLocalizer {
    fn correct(
        &mut self,
        body: &BodyState,
        planes: &Planes,
        _view: &FloorView,
    ) -> Result<(), LocalizerError> {
        let reading = BodyReading::of(body, &planes.robot_from_camera.inner);
        if !self.take(reading, planes) {
            return Ok(());
        }
        if let Some(belief) = self.belief() {
            let found = upright(&belief.torso, &reading.odometry_from_torso);
            let robot = &body.odometry_from_robot;
            self.map_from_odometry = Some(match &self.map_from_odometry {
                Some(before) => follow(before, &found, robot, &self.config),
                None => found,
            });
        }
        Ok(())
    }

    fn estimate(&mut self, body: &BodyState) -> Result<Estimate, LocalizerError> {
        let start = self.map_from_robot_at_start.unwrap_or_else(Pose::identity);
        let map_from_odometry = *self
            .map_from_odometry
            .get_or_insert_with(|| start * body.odometry_from_robot.inverse());
        Ok(Estimate {
            time_ns: body.time_ns,
            map_from_robot: map_from_odometry * body.odometry_from_robot,
            map_from_odometry,
            lost: self.is_lost(),
        })
    }

    fn guesses(&self) -> Vec<Guess> {
        let tracking = self.tracking.iter().flat_map(Tracking::particles);
        let search = self.search.iter().flat_map(PlaceSearch::particles);
        // Those of the search count where there are no others.
        let share = if self.tracking.is_some() { 0.0 } else { 1.0 };
        (tracking.map(|particle| (particle, 1.0)))
            .chain(search.map(|particle| (particle, share)))
            .map(|(particle, share)| Guess {
                place_m: particle.pose.place_m,
                yaw_rad: particle.pose.yaw_rad,
                weight: share * particle.weight,
            })
            .collect()
    }
}

/// The odometry frame in the map after a frame said where it is: by a share of what exceeds a dead band, all at once where the robot
/// is elsewhere. Within the band legs know better than voxels do what happens from frame to frame, and maps and footholds that
/// follow every guess would smear.
fn follow(
    before: &Pose<Map, Odometry>,
    found: &Pose<Map, Odometry>,
    odometry_from_robot: &Pose<Odometry, Robot>,
    config: &MonteCarloConfig,
) -> Pose<Map, Odometry> {
    let [from, to] = [before, found].map(|frame| *frame * *odometry_from_robot);
    let off_m = to.origin().inner - from.origin().inner;
    let turn_rad = geometry::wrap_angle(to.yaw_rad() - from.yaw_rad());
    let [far_m, far_rad] = config.cluster;
    if off_m.norm() > far_m || turn_rad.abs() > far_rad {
        return *found;
    }
    let share = config.follow_share;
    let [place_m, height_m, heading_rad] = config.follow_bands;
    let level_m = off_m.xy().norm();
    let level_share = share * (level_m - place_m).max(0.0) / level_m.max(f64::MIN_POSITIVE);
    let beyond = |off: f64, band: f64| off - off.clamp(-band, band);
    let at = from.origin().inner;
    let map_from_robot: Pose<Map, Robot> = Pose::from_yaw(
        at.x + level_share * off_m.x,
        at.y + level_share * off_m.y,
        at.z + share * beyond(off_m.z, height_m),
        from.yaw_rad() + share * beyond(turn_rad, heading_rad),
    );
    map_from_robot * odometry_from_robot.inverse()
}

/// The odometry frame in the map, so that the torso's place and heading in both agree. Both frames are upright: roll and pitch of
/// the torso are its own.
fn upright(in_map: &TorsoPose, in_odometry: &TorsoPose) -> Pose<Map, Odometry> {
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), in_map.turned_rad(in_odometry));
    let shift = Vector3::from(in_map.place_m) - turn * Vector3::from(in_odometry.place_m);
    Pose::wrap(Isometry3::from_parts(Translation3::from(shift), turn))
}
