//! Why a stair is not stepped on, in a word and a sentence.

use super::config::ClimbingConfig;

/// Why a stair is not stepped on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unfit {
    /// The change of height is none: floor, m. All that is more is climbed as a step.
    TooLow(f64),
    /// The change of height is too large, m.
    TooHigh(f64),
    /// The tread is too short for a sole: its depth and what is needed, m.
    TreadTooShort(f64, f64),
    /// The ground between a way down and a way up is too short: its depth and what is needed, m.
    GapTooShort(f64, f64),
    /// The stair is too narrow for both feet: its width and what is needed, m.
    TooNarrow(f64, f64),
}

impl Unfit {
    /// The word as written in `result.json`.
    pub const fn word(&self) -> &'static str {
        match self {
            Self::TooLow(_) => "step_too_low",
            Self::TooHigh(_) => "step_too_high",
            Self::TreadTooShort(..) => "tread_too_short",
            Self::GapTooShort(..) => "gap_too_short",
            Self::TooNarrow(..) => "too_narrow",
        }
    }

    /// One sentence with figures, and the limit that is broken.
    pub fn sentence(&self, climbing: &ClimbingConfig) -> String {
        let mm = |length_m: f64| (1e3 * length_m.abs()).round();
        match *self {
            Self::TooLow(rise_m) => format!("what is {} mm high is floor and no step", mm(rise_m)),
            Self::TooHigh(rise_m) => {
                let (way, limit_m) = if rise_m > 0.0 {
                    ("", climbing.ascend.step_max_z)
                } else {
                    (" down", climbing.descend.step_min_z)
                };
                let (rise, limit) = (mm(rise_m), mm(limit_m));
                format!("the step{way} is {rise} mm high, {limit} mm is the limit")
            }
            Self::TreadTooShort(depth_m, needed_m) => format!(
                "the tread is {} mm deep, {} mm is needed",
                mm(depth_m),
                mm(needed_m)
            ),
            Self::GapTooShort(depth_m, needed_m) => format!(
                "the basin is {} mm deep, {} mm is needed",
                mm(depth_m),
                mm(needed_m)
            ),
            Self::TooNarrow(width_m, needed_m) => format!(
                "the stair is {} mm wide, {} mm is needed",
                mm(width_m),
                mm(needed_m)
            ),
        }
    }
}
