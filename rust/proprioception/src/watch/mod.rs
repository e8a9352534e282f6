//! Each sense of the body held against the others: what cannot be right is found within a second, and what is left of the readings
//! lets the robot stand.

mod cells;
mod config;
mod gyro;
mod inertial;
mod joints;
mod load;
mod repair;
#[cfg(test)]
mod tests;
mod turn;

use geometry::GRAVITY_MPS2;
use robot::{Body, Side};
use sensing::{Observation, SenseFault};
use settings::{ConfigError, Table};

pub use config::SenseWatchConfig;

use crate::BodyState;
use repair::Repair;

/// What a check looks at: one tick.
pub(crate) struct Moment<'a> {
    /// What the senses say.
    observation: &'a Observation,
    /// What follows from it.
    state: &'a BodyState,
    /// What the joints were told at the tick before, rad; empty before the first.
    told_rad: &'a [f64],
    body: &'a Body,
    weight_n: f64,
    passed_s: f64,
    /// Feet that stand, or are to land, on a slope or on something that a foot met.
    on_uneven: [bool; 2],
    config: &'a SenseWatchConfig,
}

/// What a check found, and what can be done about the readings until the robot stands.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Finding {
    fault: SenseFault,
    repair: Repair,
}

/// One claim about senses that are whole.
trait Check: std::fmt::Debug + Send + Sync {
    /// Looks at a tick, and tells what cannot be right.
    fn look(&mut self, moment: &Moment<'_>) -> Option<Finding>;
}

/// Watches the body's senses.
#[derive(Debug)]
pub struct SenseWatch {
    body: Body,
    config: SenseWatchConfig,
    weight_n: f64,
    checks: Vec<Box<dyn Check>>,
    told_rad: Vec<f64>,
    before_ns: Option<u64>,
    on_uneven: [bool; 2],
    found: Option<Finding>,
    standing: repair::LegTurn,
}

impl SenseWatch {
    /// For this robot.
    pub fn new(body: &Body, config: SenseWatchConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            checks: vec![
                Box::new(inertial::ConstantUnit::default()),
                Box::new(inertial::Gravity::default()),
                Box::new(cells::ConstantCell::default()),
                Box::new(load::Missing::default()),
                Box::new(joints::Stuck::new(body)),
                Box::new(gyro::Resting::new(body)),
                Box::new(gyro::Turning::default()),
            ],
            weight_n: body.mass_kg() * GRAVITY_MPS2,
            told_rad: Vec::with_capacity(body.joint_count()),
            body: body.clone(),
            before_ns: None,
            on_uneven: [false; 2],
            found: None,
            standing: repair::LegTurn::default(),
            config,
        })
    }

    /// The observation without what was found wrong in it, if anything was: what is left is made up so that a robot that only wants
    /// to stand can. It has no picture.
    pub fn repaired(&self, observation: &Observation) -> Option<Observation> {
        let found = self.found.as_ref()?;
        let mut made = Observation {
            joint_positions_rad: observation.joint_positions_rad.clone(),
            joint_velocities_radps: observation.joint_velocities_radps.clone(),
            depth: None,
            ..*observation
        };
        found.repair.apply(&mut made, self.weight_n, &self.standing);
        Some(made)
    }

    /// Holds the senses against each other: the observation as it came, and the body state that was made of it or of what was left
    /// of it. The first fault that was found stays.
    pub fn look(&mut self, observation: &Observation, state: &BodyState) -> Option<&SenseFault> {
        let passed_s = self.before_ns.map_or(0.0, |before_ns| {
            observation.time_ns.saturating_sub(before_ns) as f64 * 1e-9
        });
        self.before_ns = Some(observation.time_ns);
        self.standing.follow(state, &self.body, passed_s);
        if self.found.is_none() {
            let moment = Moment {
                observation,
                state,
                told_rad: &self.told_rad,
                body: &self.body,
                weight_n: self.weight_n,
                passed_s,
                on_uneven: self.on_uneven,
                config: &self.config,
            };
            for check in &mut self.checks {
                let found = check.look(&moment);
                if self.found.is_none() {
                    self.found = found;
                }
            }
        }
        self.found.as_ref().map(|found| &found.fault)
    }

    /// Takes note of which feet stand, or are to land, on a slope or on something that a foot met: such a sole turns under the robot.
    pub const fn note_uneven(&mut self, on_uneven: [bool; 2]) {
        self.on_uneven = on_uneven;
    }

    /// Takes note of what the joints are told, rad.
    pub fn note_command(&mut self, positions_rad: &[f64]) {
        self.told_rad.clear();
        self.told_rad.extend_from_slice(positions_rad);
    }
}

/// The foot's name.
const fn foot_name(side: Side) -> &'static str {
    match side {
        Side::Left => "left",
        Side::Right => "right",
    }
}

/// How long something has held without a break, s.
#[derive(Debug, Clone, Copy, Default)]
struct Lasting(f64);

impl Lasting {
    fn count(&mut self, holds: bool, passed_s: f64) -> f64 {
        self.0 = if holds { self.0 + passed_s } else { 0.0 };
        self.0
    }
}
