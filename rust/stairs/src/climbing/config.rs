//! What the robot climbs: `[navigation.climbing]`, with the parameter sets of 003's Table I for the way up and for the way down.

use settings::{ANY, ConfigError, NOT_NEGATIVE, POSITIVE, require, settings};

settings! {
    /// One column of Table I of 003: the limits of a step up, or of a step down. Places are of the toes past the edge ahead or of
    /// the heels past the edge behind, positive beyond the edge in walking direction.
    pub struct ParameterSet("navigation.climbing.ascend") {
        /// Least change of height, negative for a way down.
        step_min_z: f64 = 0.015, "m", ANY, "003, Table I";
        /// Largest change of height, negative for a way down.
        step_max_z: f64 = 0.050, "m", ANY, "003, Table I";
        /// How far in front of the first edge the robot aligns.
        align_distance: f64 = 0.100, "m", ANY, "003, Table I";
        /// Where the toes are put before the step, past the edge ahead.
        approach_x: f64 = -0.015, "m", ANY, "003, Table I";
        /// Least place of the heels past the edge behind, after the step.
        front_x_limit: f64 = -0.025, "m", ANY, "003, Table I";
        /// Farthest place of the toes past the edge ahead, when that leads on with this set.
        back_x_limit: f64 = -0.005, "m", ANY, "003, Table I";
        /// Where the toes should be past the edge ahead, when that leads on with this set.
        back_x_desired: f64 = -0.015, "m", ANY, "003, Table I";
        /// Longest way of the robot's middle in one step onto a stair. With legs whose hips stretch back little, the ankle behind
        /// comes to its end as its foot is lifted off a lower step.
        longest_stride: f64 = 0.15, "m", POSITIVE;
    }
}

impl ParameterSet {
    /// The column of Table I for the way up.
    fn ascend() -> Self {
        Self::default()
    }

    /// The column of Table I for the way down.
    fn descend() -> Self {
        Self {
            step_min_z: -0.050,
            step_max_z: -0.015,
            align_distance: 0.050,
            approach_x: 0.015,
            front_x_limit: 0.015,
            back_x_limit: 0.025,
            back_x_desired: 0.015,
            longest_stride: 0.15,
        }
    }
}

settings! {
    /// What the robot climbs, for planner and behaviour alike.
    pub struct ClimbingConfig("navigation.climbing") {
        /// Changes of height up to this are floor.
        floor_max: f64 = 0.01, "m", NOT_NEGATIVE;
        /// Error of a measured height, or depth of a tread, that the limits allow for.
        tolerance: f64 = 0.0025, "m", NOT_NEGATIVE;
        /// Room beside the feet on a stair, to each side.
        side_room: f64 = 0.02, "m", NOT_NEGATIVE;
        /// Place of the heels past the front edge of what goes on level, unless `front_x_limit` asks for more; on the way down
        /// they come down farther by `tuning.spare_below`.
        level_x: f64 = 0.015, "m", ANY;
        /// Which heights are one level.
        levels: LevelsConfig;
        /// Parameters of a step up.
        ascend: ParameterSet = ParameterSet::ascend(), "-", ANY;
        /// Parameters of a step down.
        descend: ParameterSet = ParameterSet::descend(), "-", ANY;
        /// Numbers of climbing that few will want to turn.
        tuning: ClimbingTuning;
    }
    check ClimbingConfig::goes_up_and_down;
}

settings! {
    /// Which heights are one level, for terrain, planner and behaviour alike.
    pub struct LevelsConfig("navigation.climbing.levels") {
        /// Heights that differ by no more than this are one level: some four times what two measured heights differ by (standard
        /// deviation of both: 1.1 mm each, and what the robot's own height is off), and less than the least step, with its error.
        same: f64 = 0.012, "m", NOT_NEGATIVE, "docs/results/stairs.md, docs/results/floor_map.md";
        /// A height that is told from outside, such as a goal's, is a level when they differ by no more than this: over a long way the
        /// robot's own height drifts.
        told: f64 = 0.02, "m", NOT_NEGATIVE, "docs/results/odometry.md; the judge allows a goal as much";
    }
}

settings! {
    /// Numbers of climbing that few will want to turn.
    pub struct ClimbingTuning("navigation.climbing.tuning") {
        /// How much further than it must be a heel comes down behind a riser where the ground goes on: it sinks along that.
        spare_below: f64 = 0.01, "m", ANY;
    }
}

impl ClimbingConfig {
    /// The set for a change of height: up or down.
    pub fn set_for(&self, rise_m: f64) -> &ParameterSet {
        if rise_m > 0.0 {
            &self.ascend
        } else {
            &self.descend
        }
    }

    fn goes_up_and_down(&self, key: &str) -> Result<(), ConfigError> {
        let up = &self.ascend;
        require(
            0.0 < up.step_min_z && up.step_min_z < up.step_max_z,
            &format!("{key}.ascend.step_min_z"),
            "> 0 and below step_max_z",
            up.step_min_z,
        )?;
        let down = &self.descend;
        require(
            down.step_min_z < down.step_max_z && down.step_max_z < 0.0,
            &format!("{key}.descend.step_max_z"),
            "< 0 and above step_min_z",
            down.step_max_z,
        )
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;
    use settings::{Table, Tables, read};

    use super::*;

    #[test]
    fn what_is_not_said_of_the_way_down_is_that_of_the_way_down() {
        let tables = Tables::from([(
            "climbing".to_owned(),
            json!({"descend": {"front_x_limit": 0.010}}),
        )]);
        let config: ClimbingConfig = read(&tables, "climbing").unwrap();
        let expected = ParameterSet {
            front_x_limit: 0.010,
            ..ParameterSet::descend()
        };
        assert_eq!(config.descend, expected);
        assert_eq!((config.ascend.step_max_z, config.check()), (0.050, Ok(())));
    }

    #[test]
    fn the_list_has_both_ways_with_their_own_defaults() {
        let all = ClimbingConfig::parameters();
        let default = |key: &str| {
            let found = all.iter().find(|one| one.key == key);
            found.map(|one| one.default.clone())
        };
        let [up, down] = ["ascend", "descend"]
            .map(|way| default(&format!("navigation.climbing.{way}.front_x_limit")));
        assert_eq!((up, down), (Some(json!(-0.025)), Some(json!(0.015))));
    }

    #[test]
    fn a_way_up_that_goes_down_and_a_way_down_that_goes_up_are_refused() {
        let mut config = ClimbingConfig::default();
        config.ascend.step_min_z = -0.01;
        let said = config.check().unwrap_err().to_string();
        assert_eq!(
            said,
            "navigation.climbing.ascend.step_min_z must be > 0 and below step_max_z, got -0.01"
        );
        let mut config = ClimbingConfig::default();
        config.descend.step_max_z = 0.0;
        let said = config.check().unwrap_err().to_string();
        assert_eq!(
            said,
            "navigation.climbing.descend.step_max_z must be < 0 and above step_min_z, got 0"
        );
    }
}
