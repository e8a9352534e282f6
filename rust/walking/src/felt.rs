//! What the feet feel of the ground, and what they take it for.

use nalgebra::{Vector2, Vector3};

use crate::config::GaitConfig;
use crate::phase::{FootPose, Manner, Swing};
use crate::swing;

/// What is known of the ground under a foot in the air.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum KnownGround {
    /// The ground is taken to be as told: for looking ahead.
    AsTold,
    /// What the feet feel.
    Felt(Felt),
}

/// What the feet feel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Felt {
    /// Load on each sole, N.
    pub loads_n: [f64; 2],
    /// Centre of each sole by joints and attitude, in the plan, m.
    pub soles_m: [Vector3<f64>; 2],
    /// How far each leg was from reaching where its foot was put, m.
    pub short_m: [f64; 2],
    /// Centre of pressure on each sole, from its middle forward and to the left, m; the middle of one that carries nothing.
    pub pressed_m: [Vector2<f64>; 2],
    /// Where joints and attitude have it, in the plan, m.
    pub touched_m: [Vector3<f64>; 2],
}

impl Felt {
    /// Where the foot that has found ground stands: as told, at the height that joints and attitude say.
    pub(crate) fn found(&self, swing: &Swing, elapsed_s: f64, config: &GaitConfig) -> FootPose {
        FootPose {
            z_m: self.soles_m[swing.side.index()].z,
            ..swing.foot(elapsed_s, config)
        }
    }

    /// Whether a load means the ground: not on the way there, nor on another level that the foot comes down on. The level that it left
    /// is known, and the foot is above it for sure where joints and attitude say so: a swaying robot touches early.
    pub(crate) fn bears(&self, swing: &Swing, elapsed_s: f64, config: &GaitConfig) -> bool {
        let told_m = swing.foot(elapsed_s, config).z_m - swing.to.z_m;
        let felt_m = self.soles_m[swing.side.index()].z - swing.to.z_m;
        let knows = (swing.to.z_m - swing.from.z_m).abs() <= config.known_height;
        let above = told_m > config.obstructed_height || knows && felt_m > config.known_height;
        let level = swing.manner == Manner::Back || !above;
        level && elapsed_s >= swing::sinking(&config.tuning.swing) * swing.in_air_s(config)
    }

    /// Whether something is in the foot's way: a load on it before it comes down where it should, or a place far from where it
    /// should be.
    pub(crate) fn obstructs(
        &self,
        swing: &Swing,
        elapsed_s: f64,
        touches: bool,
        config: &GaitConfig,
    ) -> bool {
        let tuning = &config.tuning.landing;
        let share = elapsed_s / swing.in_air_s(config);
        let told = swing.foot(elapsed_s, config);
        let sole = &self.soles_m[swing.side.index()];
        let off_m = geometry::hypot(sole.x - told.planar.x_m, sole.y - told.planar.y_m);
        let ahead = swing.foot(elapsed_s + tuning.lag, config);
        let lag_m = ahead.planar.distance_m(&told.planar);
        share >= tuning.left_share && (touches || off_m > config.obstructed_distance + lag_m)
    }
}
