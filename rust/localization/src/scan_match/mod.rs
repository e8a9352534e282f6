//! The localizer `scan_match`: leg odometry whose heading is kept by what stands out of the floor.

mod align;
mod config;
mod heading_filter;
mod keyframe;
mod profile;
mod surfaces;
#[cfg(test)]
mod tests;
mod tuning;

use crate::part::LocalizerPart;
use geometry::PlanarPose;
use mapping::FloorView;
use segmentation::Planes;
use settings::{ConfigError, Table};
use settings::{Part, TableDescription, read};

pub use config::MatchingConfig;
use heading_filter::HeadingFilter;
use keyframe::{Keyframe, Viewpoint};
use profile::UprightBeam;

use crate::localizer::{Estimate, Localizer, LocalizerError};
use crate::odometry::{OdometryLocalizer, OdometryLocalizerConfig};
use proprioception::{BodyState, ProprioceptionConfig};

/// How it is listed and made.
pub(crate) const PART: LocalizerPart = Part {
    name: "scan_match",
    about: "legs' odometry, its heading kept by upright surfaces that are seen again",
    source: None,
    tables: &[
        TableDescription::of::<MatchingConfig>(),
        TableDescription::of::<OdometryLocalizerConfig>(),
    ],
    make: |needs| {
        let odometry = read(needs.tables, "odometry")?;
        let (start, stance_m) = (needs.start_or_origin(), needs.stance_m);
        Ok(Box::new(MatchingLocalizer::new(
            OdometryLocalizer::new(start, stance_m, odometry)?,
            read(needs.tables, "proprioception")?,
            read(needs.tables, "scan_match")?,
        )?))
    },
};

/// Keeps places as [`OdometryLocalizer`] does, and corrects the heading: the upright surfaces of a frame are laid on those of earlier
/// ones, and by how far they have to be turned, over the time between, the gyroscope's bias and the heading's error are known.
///
/// Places stay odometry's: it is better at them than a camera whose own place on the head is known to a centimetre and a degree.
#[derive(Debug, Clone)]
pub struct MatchingLocalizer {
    config: MatchingConfig,
    /// What the gyroscope is like, and when the robot stands still.
    senses: ProprioceptionConfig,
    odometry: OdometryLocalizer,
    memory: Option<HeadingMemory>,
}

/// What is known since the first frame.
#[derive(Debug, Clone)]
struct HeadingMemory {
    filter: HeadingFilter,
    keyframes: Vec<Keyframe>,
    begin_ns: u64,
    last_ns: u64,
    /// How long the robot has been standing still, s.
    still_s: f64,
    /// How long the robot has rested in all, s.
    rested_s: f64,
}

impl MatchingLocalizer {
    /// Keeps the heading of an odometry by senses like these.
    pub fn new(
        odometry: OdometryLocalizer,
        senses: ProprioceptionConfig,
        config: MatchingConfig,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        senses.check()?;
        Ok(Self {
            config,
            senses,
            odometry,
            memory: None,
        })
    }

    fn stand(&mut self, body: &BodyState) -> Result<Viewpoint, LocalizerError> {
        let estimate = self.odometry.estimate(body)?;
        let place = estimate.map_from_robot.origin().inner;
        Ok(Viewpoint {
            odometry_yaw_rad: body.odometry_from_robot.yaw_rad(),
            map_from_robot: PlanarPose::new(place.x, place.y, estimate.map_from_robot.yaw_rad()),
        })
    }
}

impl HeadingMemory {
    fn new(body: &BodyState, senses: &ProprioceptionConfig) -> Self {
        Self {
            filter: HeadingFilter::new(senses.gyro_bias),
            keyframes: Vec::new(),
            begin_ns: body.time_ns,
            last_ns: body.time_ns,
            still_s: 0.0,
            rested_s: 0.0,
        }
    }

    /// Goes on to the time of a frame. While the robot rests, proprioception learns the gyroscope's bias.
    fn advance(
        &mut self,
        body: &BodyState,
        senses: &ProprioceptionConfig,
        config: &MatchingConfig,
    ) {
        let passed_s = body.time_ns.saturating_sub(self.last_ns) as f64 * 1e-9;
        self.last_ns = self.last_ns.max(body.time_ns);
        self.filter
            .predict(passed_s, config.heading_drift, senses.gyro_bias_drift);
        let still = body.stands_level && body.angular_velocity_radps.amax() < senses.still_rate;
        self.still_s = if still { self.still_s + passed_s } else { 0.0 };
        if self.still_s > senses.still_time {
            self.rested_s += passed_s;
            let noise_radps = config.rest_noise / self.rested_s.sqrt();
            self.filter
                .rested(geometry::hypot(noise_radps, config.bias_creep));
        }
    }

    /// Compares a frame with the keyframes; returns how much is known of its heading by them, 1/rad^2.
    fn compare(
        &mut self,
        beams: &[UprightBeam],
        stand: &Viewpoint,
        config: &MatchingConfig,
    ) -> f64 {
        let one_frame = config.heading_noise * config.heading_noise;
        let mut information = 0.0;
        for (index, keyframe) in self.keyframes.iter_mut().enumerate() {
            let since = self.filter.since(index);
            let Some(turn) = keyframe.compare(beams, stand, since, config) else {
                continue;
            };
            let variance = turn.variance_rad2.max(one_frame);
            let believed = turn.in_place
                && turn.beyond_rad.powi(2) < config.gate.powi(2) * (since.1 + variance);
            keyframe.judge(believed);
            if believed {
                information += 1.0 / turn.variance_rad2;
                self.filter
                    .correct(index, turn.beyond_rad, variance * config.alike);
            }
        }
        information
    }

    /// Draws the keyframe that is being made, begins one where those that are known say too little, and forgets some.
    fn draw(
        &mut self,
        beams: &[UprightBeam],
        stand: &Viewpoint,
        known: f64,
        config: &MatchingConfig,
    ) {
        let mut drawing = self
            .keyframes
            .last()
            .is_some_and(|last| !last.is_whole(config));
        if !drawing && beams.len() >= config.least_beams && known < config.enough.powi(-2) {
            self.filter.remember(config.keyframe_noise);
            self.keyframes.push(Keyframe::new(*stand, config));
            drawing = true;
        }
        if drawing && let Some(last) = self.keyframes.last_mut() {
            last.add(beams, stand);
        }
        let whole = 0..self.keyframes.len() - usize::from(drawing);
        let refuted = (whole.clone()).find(|&index| self.keyframes[index].is_refuted(config));
        let furthest = || {
            whole
                .clone()
                .filter(|_| self.keyframes.len() > config.keyframes)
                .max_by(|&a, &b| {
                    let [a, b] = [a, b].map(|index| self.keyframes[index].distance_m(stand));
                    a.total_cmp(&b)
                })
        };
        if let Some(index) = refuted.or_else(furthest) {
            drop(self.keyframes.remove(index));
            self.filter.forget(index);
        }
    }
}

impl Localizer for MatchingLocalizer {
    fn correct(
        &mut self,
        body: &BodyState,
        planes: &Planes,
        view: &FloorView,
    ) -> Result<(), LocalizerError> {
        self.odometry.correct(body, planes, view)?;
        let stand = self.stand(body)?;
        let (config, senses) = (&self.config, &self.senses);
        let memory = self
            .memory
            .get_or_insert_with(|| HeadingMemory::new(body, senses));
        let before_rad = memory.filter.error_rad();
        memory.advance(body, senses, config);
        if body.time_ns.saturating_sub(memory.begin_ns) as f64 * 1e-9 > config.settling {
            let beams = profile::beams(planes, config);
            let known = if beams.len() < config.least_beams {
                0.0
            } else {
                memory.compare(&beams, &stand, config)
            };
            memory.draw(&beams, &stand, known, config);
        }
        let turn_rad = memory.filter.error_rad() - before_rad;
        self.odometry.turn(body, turn_rad);
        Ok(())
    }

    fn needs_unbroken_way(&self) -> bool {
        true
    }

    fn estimate(&mut self, body: &BodyState) -> Result<Estimate, LocalizerError> {
        self.odometry.estimate(body)
    }
}
