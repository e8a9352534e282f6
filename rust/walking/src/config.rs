//! `[gait]` of robot.toml: how this robot walks.

use serde::{Deserialize, Serialize};
use settings::{ConfigError, require};

use crate::WalkError;
use crate::stance::Stance;

/// The gait's parameters. Lengths in metres, times in seconds, angles in radians.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct GaitConfig {
    /// Time from one landing to the next, s.
    pub step_time: f64,
    /// Part of the step time in which both feet carry, s.
    pub double_support: f64,
    /// Time to shift the weight onto the first foot, and at the end back to the middle, s.
    pub shift_time: f64,
    /// Height of the swing foot's sole over the higher of its two ends, m.
    pub step_height: f64,
    /// Longest step forward, m: from beside the standing foot to where it lands.
    pub max_forward: f64,
    /// Longest step backward, m.
    pub max_backward: f64,
    /// Largest extra distance between the feet in a side step, m.
    pub max_sideways: f64,
    /// Largest turn of one step, rad.
    pub max_turn: f64,
    /// Distance between the centres of the soles when they are side by side, m; without it, that of the upright stance.
    pub stance_width: f64,
    /// Least gap between the soles, m.
    pub foot_gap: f64,
    /// Height of the hips' centres over the soles, m; without it, that of the upright stance.
    pub hip_height: f64,
    /// The leg never gets longer than this share of its straight length.
    pub max_extension: f64,
    /// The hips are lowered so that a thigh stretches back no further than this, rad; without it, as far as a straight leg asks.
    pub hip_stretch: Option<f64>,
    /// Where the foot carries: this far from the sole's middle towards the other foot, m.
    pub support_inward: f64,
    /// Where along the sole it carries, m forward of the sole's middle, as far as that lies in the middle half of what bears; without it,
    /// in the middle of what bears.
    pub support_ahead: Option<f64>,
    /// A foot that stands higher than the other one carries further forward, by this share of the difference.
    pub support_forward: f64,
    /// The centre of pressure keeps this far from the sole's edges, m.
    pub sole_margin: f64,
    /// Gain from the error of the divergent component of motion to the centre of pressure; stable above 1.
    pub dcm_gain: f64,
    /// Share of the measured speed of the centre of mass that a tick takes over.
    pub velocity_blend: f64,
    /// How fast the reference follows the measured centre of mass, 1/s.
    pub reference_pull: f64,
    /// Speed at which a foot yields to a wrong share of the load, m/s per N.
    pub load_gain: f64,
    /// How fast the difference of the feet's heights is forgotten, 1/s.
    pub load_leak: f64,
    /// Largest difference of the feet's heights through load control, m.
    pub load_limit: f64,
    /// Load at which a foot counts as landed before its time, N.
    pub landing_load: f64,
    /// Speed at which a walking foot goes on down that is not on the ground at its time, m/s,
    pub late_speed: f64,
    /// and how far, m.
    pub late_depth: f64,
    /// Errors at landing up to this are left to the ankles, m; above, the step is moved.
    pub capture_deadband: f64,
    /// The farthest that a step is moved to catch a push, m.
    pub capture_limit: f64,
    /// Largest acceleration of a step's clock to catch a push.
    pub capture_hurry: f64,
    /// Error to the outer side, beyond the dead band, at which a step's clock stands still, m.
    pub capture_hold: f64,
    /// Longest time that the clock is held in a phase, s.
    pub capture_patience: f64,
    /// Speed at which an ankle yields, rad/s per metre that the centre of pressure is beside where it is to be,
    pub ankle_gain: f64,
    /// beyond this distance, m,
    pub ankle_deadband: f64,
    /// at most this fast, rad/s,
    pub ankle_speed: f64,
    /// and this far, rad.
    pub ankle_limit: f64,
    /// How fast an ankle that has yielded gets level again, 1/s.
    pub ankle_leak: f64,
    /// Share of the measured tilt that the swing foot makes up for.
    pub swing_tilt: f64,
    /// Speed over the ground that the foot of a long listed step keeps to on average, m/s.
    pub climb_speed: f64,
    /// Speed at which the foot of a high listed step rises and sinks on average, m/s.
    pub climb_lift_speed: f64,
    /// Time in which the foot of a listed step is in the air at least, s,
    pub climb_swing_time: f64,
    /// in which it has to be found on the ground after that, while the other foot still carries everything, s,
    pub climb_landing_time: f64,
    /// and on both feet between two listed steps, s.
    pub climb_double_support: f64,
    /// Height of a listed step's sole over the higher of its two ends, m.
    pub climb_clearance: f64,
    /// Longest listed step forward or backward, m.
    pub climb_forward: f64,
    /// Highest listed step up or down, m.
    pub climb_rise: f64,
    /// Speed at which a foot goes down that has not found the ground where it was told to be, m/s.
    pub probe_speed: f64,
    /// How much deeper than told a foot seeks the ground, m.
    pub probe_depth: f64,
    /// Speed at which a foot that was found on the ground goes on down while less than `landing_load` is on it, m/s.
    pub press_speed: f64,
    /// A listed step's foot that is this far beside its path has met something, m.
    pub obstructed_distance: f64,
    /// One that meets the next riser this near to its place comes down where it is, m: what lies behind its bearing part.
    pub brush_distance: f64,
    /// One that comes down on something this far above where it was told to land has met another level, m: 8 mm are climbed
    /// over, and heights are told within 3 mm.
    pub obstructed_height: f64,
    /// So has one whose sole is felt to be this far above the level that it left, m: a toe on the riser behind a short tread.
    pub known_height: f64,
    /// A listed step during which the DCM is this far beside its reference, towards the foot that has hardly left, is begun anew, m:
    /// 14 mm are the most in steps that go well.
    pub tip_error: f64,
    /// A walking foot that comes upon something this far above the floor has met another level, m.
    pub stumble_height: f64,
    /// Time in which a walking foot goes back off what it met, s.
    pub retreat_time: f64,
    /// Time to raise the arms, or to lower them, s.
    pub arms_time: f64,
    /// Speed up to which the hips are raised and lowered, m/s.
    pub hip_speed: f64,
    /// Largest speed of the head's joints, rad/s.
    pub gaze_speed: f64,
}

impl Default for GaitConfig {
    fn default() -> Self {
        Self {
            step_time: 0.6,
            double_support: 0.15,
            shift_time: 0.6,
            step_height: 0.02,
            max_forward: 0.07,
            max_backward: 0.05,
            max_sideways: 0.06,
            max_turn: 0.3,
            stance_width: 0.0,
            foot_gap: 0.008,
            hip_height: 0.0,
            max_extension: 0.985,
            hip_stretch: None,
            support_inward: 0.0,
            support_ahead: None,
            support_forward: 0.2,
            sole_margin: 0.006,
            dcm_gain: 3.0,
            velocity_blend: 0.5,
            reference_pull: 0.0,
            load_gain: 0.0006,
            load_leak: 0.5,
            load_limit: 0.012,
            landing_load: 6.0,
            late_speed: 0.15,
            late_depth: 0.015,
            capture_deadband: 0.01,
            capture_limit: 0.08,
            capture_hurry: 1.0,
            capture_hold: 0.01,
            capture_patience: 0.6,
            ankle_gain: 30.0,
            ankle_deadband: 0.012,
            ankle_speed: 1.0,
            ankle_limit: 0.2,
            ankle_leak: 0.5,
            swing_tilt: 1.0,
            climb_speed: 0.195,
            climb_lift_speed: 0.172,
            climb_swing_time: 0.8,
            climb_landing_time: 0.2,
            climb_double_support: 0.2,
            climb_clearance: 0.02,
            climb_forward: 0.135,
            climb_rise: 0.055,
            probe_speed: 0.08,
            probe_depth: 0.012,
            press_speed: 0.02,
            obstructed_distance: 0.018,
            brush_distance: 0.01,
            obstructed_height: 0.011,
            known_height: 0.006,
            tip_error: 0.0175,
            stumble_height: 0.012,
            retreat_time: 0.2,
            arms_time: 1.5,
            hip_speed: 0.12,
            gaze_speed: 2.0,
        }
    }
}

impl GaitConfig {
    /// Reads `[gait]`; nothing stands for the defaults. Width and height of the stance are those of the body's upright stance
    /// unless given.
    pub fn read(table: &serde_json::Value, stance: &Stance) -> Result<Self, WalkError> {
        let mut config: Self = if table.is_null() {
            Self::default()
        } else {
            Self::deserialize(table).map_err(|error| WalkError::Form(error.to_string()))?
        };
        if table.get("stance_width").is_none() {
            config.stance_width = stance.width_m();
        }
        if table.get("hip_height").is_none() {
            config.hip_height = stance.hip_height_m;
        }
        config.check()?;
        Ok(config)
    }

    /// Refuses what no gait can have.
    pub fn check(&self) -> Result<(), ConfigError> {
        for (name, value) in self.positive() {
            let holds = value.is_finite() && value > 0.0;
            require(holds, &format!("gait.{name}"), "> 0", value)?;
        }
        for (name, value) in self.not_negative() {
            let holds = value.is_finite() && value >= 0.0;
            require(holds, &format!("gait.{name}"), ">= 0", value)?;
        }
        self.check_bounds()
    }

    fn positive(&self) -> [(&'static str, f64); 32] {
        [
            ("step_time", self.step_time),
            ("double_support", self.double_support),
            ("shift_time", self.shift_time),
            ("step_height", self.step_height),
            ("max_forward", self.max_forward),
            ("max_backward", self.max_backward),
            ("max_sideways", self.max_sideways),
            ("max_turn", self.max_turn),
            ("stance_width", self.stance_width),
            ("hip_height", self.hip_height),
            ("max_extension", self.max_extension),
            ("landing_load", self.landing_load),
            ("capture_limit", self.capture_limit),
            ("capture_hold", self.capture_hold),
            ("climb_speed", self.climb_speed),
            ("climb_lift_speed", self.climb_lift_speed),
            ("climb_swing_time", self.climb_swing_time),
            ("climb_double_support", self.climb_double_support),
            ("climb_clearance", self.climb_clearance),
            ("climb_forward", self.climb_forward),
            ("climb_rise", self.climb_rise),
            ("probe_speed", self.probe_speed),
            ("obstructed_distance", self.obstructed_distance),
            ("brush_distance", self.brush_distance),
            ("obstructed_height", self.obstructed_height),
            ("known_height", self.known_height),
            ("tip_error", self.tip_error),
            ("stumble_height", self.stumble_height),
            ("retreat_time", self.retreat_time),
            ("arms_time", self.arms_time),
            ("hip_speed", self.hip_speed),
            ("gaze_speed", self.gaze_speed),
        ]
    }

    fn not_negative(&self) -> [(&'static str, f64); 20] {
        [
            ("foot_gap", self.foot_gap),
            ("support_forward", self.support_forward),
            ("sole_margin", self.sole_margin),
            ("reference_pull", self.reference_pull),
            ("load_gain", self.load_gain),
            ("load_leak", self.load_leak),
            ("load_limit", self.load_limit),
            ("capture_deadband", self.capture_deadband),
            ("capture_patience", self.capture_patience),
            ("late_speed", self.late_speed),
            ("late_depth", self.late_depth),
            ("swing_tilt", self.swing_tilt),
            ("ankle_gain", self.ankle_gain),
            ("ankle_deadband", self.ankle_deadband),
            ("ankle_speed", self.ankle_speed),
            ("ankle_limit", self.ankle_limit),
            ("ankle_leak", self.ankle_leak),
            ("climb_landing_time", self.climb_landing_time),
            ("probe_depth", self.probe_depth),
            ("press_speed", self.press_speed),
        ]
    }

    fn check_bounds(&self) -> Result<(), ConfigError> {
        let (double, gain) = (self.double_support, self.dcm_gain);
        let short = double < self.step_time;
        require(short, "gait.double_support", "below step_time", double)?;
        let bent = self.max_extension < 1.0;
        require(bent, "gait.max_extension", "below 1", self.max_extension)?;
        let stable = gain.is_finite() && gain > 1.0;
        require(stable, "gait.dcm_gain", "> 1", gain)?;
        let share = (0.0..=1.0).contains(&self.velocity_blend);
        let blend = self.velocity_blend;
        require(share, "gait.velocity_blend", "from 0 to 1", blend)?;
        let inward = self.support_inward;
        require(inward.is_finite(), "gait.support_inward", "finite", inward)?;
        let stretch = self.hip_stretch.unwrap_or(0.5);
        let bent = stretch > 0.0 && stretch < 1.5;
        require(bent, "gait.hip_stretch", "> 0 and < 1.5", stretch)?;
        let ahead = self.support_ahead.unwrap_or(0.0);
        require(ahead.is_finite(), "gait.support_ahead", "finite", ahead)?;
        let hurry = self.capture_hurry;
        let faster = hurry.is_finite() && hurry >= 1.0;
        require(faster, "gait.capture_hurry", ">= 1", hurry)?;
        require(
            self.max_turn < 1.0,
            "gait.max_turn",
            "below 1",
            self.max_turn,
        )
    }
}
