//! Footsteps from one stance to another: on the level, onto a stair, and up a flight without a stop.

use geometry::PlanarPose;
use robot::Side;

use crate::{
    Footstep, StepManner, climbing::StairClimbingConfig, climbing::tuning::FootstepsTuning,
};

/// Both feet side by side somewhere in the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stance {
    /// Midway between the soles' centres.
    pub(crate) pose: PlanarPose,
    /// Height of the surface, m.
    pub(crate) height_m: f64,
    /// Part of the soles that bears load, from and to, from their middle forward, m.
    pub(crate) bearing_m: [f64; 2],
}

impl Stance {
    /// One foot of it, as a footstep of the map.
    pub(crate) fn foothold(&self, side: Side, stance_m: f64) -> Footstep {
        let place = PlanarPose::new(0.0, 0.5 * side.sign() * stance_m, 0.0);
        Footstep {
            side,
            manner: StepManner::Careful,
            pose: self.pose.compose(&place),
            height_m: self.height_m,
            slope: [0.0; 2],
            bearing_m: self.bearing_m,
        }
    }

    /// Both feet of it, the first of them `first`.
    pub(crate) fn both(&self, first: Side, stance_m: f64) -> [Footstep; 2] {
        [first, first.other()].map(|side| self.foothold(side, stance_m))
    }
}

/// The foot that goes first: the one on the side that is moved or turned to, so that the feet stay apart.
pub(crate) fn leading_side(from: &PlanarPose, to: &PlanarPose, tuning: &FootstepsTuning) -> Side {
    let way = from.relative(to);
    if way.y_m + tuning.turn_arm * way.yaw_rad < 0.0 {
        Side::Right
    } else {
        Side::Left
    }
}

/// Careful steps from where the robot stands to a stance at the same height. A turn to one side and a way to the other would
/// bring the feet together: then it turns first.
pub(crate) fn level(
    from: &PlanarPose,
    to: &Stance,
    stance_m: f64,
    config: &StairClimbingConfig,
) -> Vec<Footstep> {
    let tuning = &config.tuning.footsteps;
    let way = from.relative(&to.pose);
    let crosses = way.y_m * way.yaw_rad < 0.0;
    let far = way.x_m.abs() > tuning.aside || way.y_m.abs() > tuning.aside;
    let turns = way.yaw_rad.abs() > tuning.turn;
    if far && turns && (crosses || way.yaw_rad.abs() > config.step_turn) {
        let turned = PlanarPose::new(from.x_m, from.y_m, to.pose.yaw_rad);
        let on_the_spot = Stance {
            pose: turned,
            ..*to
        };
        let mut holds = straight(from, &on_the_spot, stance_m, config);
        holds.extend(straight(&turned, to, stance_m, config));
        return holds;
    }
    straight(from, to, stance_m, config)
}

fn straight(
    from: &PlanarPose,
    to: &Stance,
    stance_m: f64,
    config: &StairClimbingConfig,
) -> Vec<Footstep> {
    let way = from.relative(&to.pose);
    let lead = leading_side(from, &to.pose, &config.tuning.footsteps);
    let pairs = (way.y_m.abs() / config.step_side)
        .max(way.yaw_rad.abs() / config.step_turn)
        .ceil()
        .max(1.0);
    let steps = (way.x_m.abs() / config.step_forward)
        .ceil()
        .max(2.0 * pairs - 1.0) as usize;
    let pairs = steps.div_ceil(2) as f64;
    let along = |step: usize| {
        let forward = step.min(steps) as f64 / steps as f64;
        // Only the leading foot opens the stance; the other one closes it.
        let aside = step.div_ceil(2) as f64 / pairs;
        let local = PlanarPose::new(
            way.x_m * forward,
            way.y_m * aside.min(1.0),
            way.yaw_rad * aside.min(1.0),
        );
        Stance {
            pose: from.compose(&local),
            ..*to
        }
    };
    (1..=steps + 1)
        .map(|step| {
            let side = if step % 2 == 1 { lead } else { lead.other() };
            along(step).foothold(side, stance_m)
        })
        .collect()
}

/// One foot a stance and both on the last: up or down a flight without a stop.
pub(crate) fn alternating(first: Side, stances: &[Stance], stance_m: f64) -> Vec<Footstep> {
    let mut side = first;
    let mut holds: Vec<_> = stances
        .iter()
        .map(|stance| {
            let hold = stance.foothold(side, stance_m);
            side = side.other();
            hold
        })
        .collect();
    holds.extend(stances.last().map(|last| last.foothold(side, stance_m)));
    holds
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const STANCE_M: f64 = 0.085;

    fn stance(pose: PlanarPose) -> Stance {
        Stance {
            pose,
            height_m: 0.0,
            bearing_m: [-0.05, 0.05],
        }
    }

    proptest! {
        #[test]
        fn careful_steps_end_together_at_the_stance_and_keep_within_their_limits(
            x in -0.3..0.3f64, y in -0.15..0.15f64, yaw in -0.6..0.6f64,
        ) {
            let config = StairClimbingConfig::default();
            let from = PlanarPose::new(0.4, -0.2, 0.7);
            let to = stance(from.compose(&PlanarPose::new(x, y, yaw)));
            let mut feet = Side::BOTH.map(|side| stance(from).foothold(side, STANCE_M).pose);
            let holds = level(&from, &to, STANCE_M, &config);
            prop_assert!(holds.len() <= 30, "{}", holds.len());
            for (index, hold) in holds.iter().enumerate() {
                let other = feet[hold.side.other().index()];
                let apart = other.relative(&hold.pose);
                let aside_m = apart.y_m * hold.side.sign();
                prop_assert!(aside_m > 0.7 * STANCE_M && aside_m < STANCE_M + 0.05, "{} {}", index, aside_m);
                prop_assert!(apart.x_m.abs() <= config.step_forward + 0.02, "{}", apart.x_m);
                prop_assert!(apart.yaw_rad.abs() <= config.step_turn + 1e-9);
                feet[hold.side.index()] = hold.pose;
            }
            for side in Side::BOTH {
                let wanted = to.foothold(side, STANCE_M).pose;
                prop_assert!(feet[side.index()].distance_m(&wanted) < 1e-9);
            }
        }
    }

    #[test]
    fn a_flight_without_a_stop_has_one_foot_a_step_and_both_on_the_last() {
        let stances: Vec<_> = (1..=4)
            .map(|i| stance(PlanarPose::new(0.12 * f64::from(i), 0.0, 0.0)))
            .collect();
        let holds = alternating(Side::Right, &stances, STANCE_M);
        assert_eq!(holds.len(), 5);
        assert!(holds.windows(2).all(|pair| pair[0].side != pair[1].side));
        assert!((holds[3].pose.x_m - holds[4].pose.x_m).abs() < 1e-12);
    }
}
