//! Whether the next stair may be stepped on from here ([`stairs::conditions`]: 003, section V.C), and where the feet go.

use geometry::{Map, PlanarPose, Point, angle_between};
use planning::Step;
use stairs::{
    Ahead, ClimbingConfig, Feet, Footing, Onward, Stand, Tolerance, Unfit, Unready, conditions,
};

use crate::climbing::StairClimbingConfig;
use crate::climbing::flight::{depth_m, settled_rise_m};
use crate::climbing::footsteps::Stance;
use crate::climbing::tuning::PlacementTuning;

/// What is behind the tread that is stepped on next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Behind<'a> {
    /// Another step that was measured.
    Step(&'a Step),
    /// The surface goes on, further than a sole needs.
    Level,
    /// The surface ends this far behind its front edge and nothing is known behind it, m.
    End(f64),
    /// Too little of it was seen: this much from its front edge, m.
    Unseen(f64),
}

/// The robot before a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Before<'a> {
    /// Settings.
    pub(crate) config: &'a StairClimbingConfig,
    /// Table I.
    pub(crate) climbing: &'a ClimbingConfig,
    /// Its feet.
    pub(crate) feet: &'a Feet,
    /// Where it stands in the map.
    pub(crate) pose: PlanarPose,
    /// Height of the ground there, m.
    pub(crate) ground_m: f64,
}

/// What the conditions say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Verdict {
    /// All hold: both feet go here.
    Go(Stance),
    /// They would hold if the robot first moved here on the ground that it stands on.
    Move(Stance),
    /// More must be seen of the tread first; so much of it is known, m.
    Look(f64),
    /// They cannot hold.
    Refuse(Unfit),
}

impl Before<'_> {
    /// Checks the conditions of the step `next` with what is behind it.
    pub(crate) fn check(&self, next: &Step, behind: &Behind<'_>) -> Verdict {
        let onward = match *behind {
            Behind::Step(after) => Onward::Edge {
                depth_m: depth_m(next, after),
                rise_m: after.rise_m,
            },
            Behind::Level => Onward::Level,
            Behind::End(depth_m) => Onward::Edge {
                depth_m,
                // The toes stay on the surface, as before a step up.
                rise_m: self.climbing.ascend.step_min_z,
            },
            Behind::Unseen(depth_m) => return Verdict::Look(depth_m),
        };
        let ahead = Ahead {
            rise_m: settled_rise_m(next.rise_m, self.climbing, self.config.tuning.lookup.doubt),
            onward,
        };
        let tolerance = Tolerance {
            toes_m: self.config.near_tolerance,
            askew_rad: self.config.aligned,
        };
        let stand = self.stand(next);
        let on_the_way = self.aside_m(next).abs() <= self.config.step_side;
        match conditions(self.climbing, self.feet, &ahead, &stand, &tolerance) {
            Err(Unready::Unfit(unfit)) => Verdict::Refuse(unfit),
            Ok(footing) if on_the_way => match self.stance_on(next, behind, footing, onward) {
                Ok(stance) => Verdict::Go(stance),
                Err(unfit) => Verdict::Refuse(unfit),
            },
            Ok(_) | Err(_) => Verdict::Move(self.start_stance(next)),
        }
    }

    /// How the robot stands before the step.
    fn stand(&self, next: &Step) -> Stand {
        let edge = &next.stair.front;
        let askew_rad = angle_between(edge.heading_rad(), self.pose.yaw_rad);
        let middle_m = edge.beyond_m([self.pose.x_m, self.pose.y_m]);
        let [left_room_m, right_room_m] = next.stair.room_beside_m();
        Stand {
            toes_m: middle_m + 0.5 * self.feet.length_m * libm::cos(askew_rad),
            askew_rad,
            left_m: self.left_m(next, &edge.left) + left_room_m,
            right_m: right_room_m - self.left_m(next, &edge.right),
        }
    }

    /// How far to the left of the robot a place lies, along the front edge of a step, m.
    fn left_m(&self, next: &Step, place: &Point<Map>) -> f64 {
        let (sin, cos) = libm::sincos(next.stair.front.heading_rad());
        (place.inner.y - self.pose.y_m) * cos - (place.inner.x - self.pose.x_m) * sin
    }

    /// Where to stand before the step is taken.
    pub(crate) fn start_stance(&self, next: &Step) -> Stance {
        let toes_m = self.climbing.set_for(next.rise_m).approach_x;
        let heading_rad = next.stair.front.heading_rad();
        let half_m = 0.5 * self.feet.length_m;
        Stance {
            pose: self.beyond(next, heading_rad, toes_m - half_m),
            height_m: self.ground_m,
            bearing_m: [-half_m, half_m.min(half_m - toes_m)],
        }
    }

    /// Where the robot's middle will cross the step's front edge, m: not where the way does, which may be a hand's breadth
    /// beside it.
    pub(crate) fn crossed_at_m(&self, next: &Step) -> [f64; 2] {
        let pose = self.beyond(next, next.stair.front.heading_rad(), 0.0);
        [pose.x_m, pose.y_m]
    }

    /// The pose with this heading whose middle is this far beyond the front edge, beside where the robot is now as far as
    /// there is room.
    fn beyond(&self, next: &Step, heading_rad: f64, middle_m: f64) -> PlanarPose {
        let edge = &next.stair.front;
        let here = [self.pose.x_m, self.pose.y_m];
        let square_rad = edge.heading_rad();
        let (sin, cos) = libm::sincos(square_rad);
        let forward_m = middle_m - edge.beyond_m(here);
        let aside_m = self.aside_m(next);
        PlanarPose::new(
            here[0] + cos * forward_m - sin * aside_m,
            here[1] + sin * forward_m + cos * aside_m,
            heading_rad,
        )
    }

    /// How far to the left the robot must move to have room on both sides of the step, with some to spare, and not to be far
    /// from where the way crosses its edge, m.
    fn aside_m(&self, next: &Step) -> f64 {
        let tuning = &self.config.tuning.placement;
        let off_the_way_m = tuning.off_the_way;
        let room_m = 0.5 * self.feet.pair_width_m + self.climbing.side_room + tuning.spare;
        let stand = self.stand(next);
        let (most_m, least_m) = (stand.left_m - room_m, room_m - stand.right_m);
        let [x_m, y_m] = next.crossing_m;
        let crossing_m = self.left_m(next, &Point::new(x_m, y_m, 0.0));
        let wanted_m = 0.0_f64.clamp(crossing_m - off_the_way_m, crossing_m + off_the_way_m);
        if least_m < most_m {
            wanted_m.clamp(least_m, most_m)
        } else {
            f64::midpoint(least_m, most_m)
        }
    }

    fn stance_on(
        &self,
        next: &Step,
        behind: &Behind<'_>,
        footing: Footing,
        onward: Onward,
    ) -> Result<Stance, Unfit> {
        let edge_rad = next.stair.front.heading_rad();
        let half_m = 0.5 * self.feet.length_m;
        let half_pair_m = 0.5 * self.feet.pair_width_m;
        // Between two edges that are turned against each other the feet stand half way (a spiral).
        let turn_rad = match behind {
            Behind::Step(after) => half_turn_rad(
                edge_rad,
                after.stair.front.heading_rad(),
                &self.config.tuning.placement,
            ),
            _ => 0.0,
        };
        let slack_m = half_pair_m * libm::sin(turn_rad).abs();
        let set = self.climbing.set_for(next.rise_m);
        let least_m = set.front_x_limit + slack_m;
        let here_m = next.stair.front.beyond_m([self.pose.x_m, self.pose.y_m]);
        let stride_m = set.longest_stride + here_m - half_m;
        let mut heel_m = footing.heel_m.min(stride_m).max(least_m);
        if let Onward::Edge { depth_m, rise_m } = onward {
            let limit_m = self.climbing.set_for(rise_m).back_x_limit - slack_m;
            let most_m = depth_m + limit_m - self.feet.length_m;
            if most_m < least_m - self.climbing.tolerance {
                let needed_m = depth_m + least_m - most_m;
                return Err(Unfit::TreadTooShort(depth_m, needed_m));
            }
            heel_m = heel_m.min(most_m);
        }
        let front_m = match onward {
            Onward::Level => half_m,
            Onward::Edge { depth_m, .. } => half_m.min(depth_m - heel_m - half_m),
        };
        Ok(Stance {
            pose: self.beyond(next, edge_rad + turn_rad, heel_m + half_m),
            height_m: self.ground_m + next.rise_m,
            bearing_m: [(-heel_m).max(0.0) - half_m, front_m],
        })
    }

    /// What is behind a step of which no following one was measured.
    pub(crate) fn without_next(&self, next: &Step) -> Behind<'static> {
        let depth_m = next.stair.front.beyond_m(next.stair.back.middle_m());
        let set = self.climbing.set_for(next.rise_m);
        let tuning = &self.config.tuning.placement;
        let needed_m =
            set.front_x_limit.max(tuning.heels) + self.feet.length_m + tuning.known_ahead;
        if depth_m >= needed_m {
            Behind::Level
        } else if next.stair.back_fit.is_some() || next.stair.seen_ends.back > 0 {
            Behind::End(depth_m)
        } else {
            Behind::Unseen(depth_m)
        }
    }
}

/// Half of the turn from one edge to the next. What their headings may be wrong by is no turn.
fn half_turn_rad(from_rad: f64, to_rad: f64, tuning: &PlacementTuning) -> f64 {
    let most_rad = tuning.largest_turn;
    let turn_rad = angle_between(from_rad, to_rad);
    if turn_rad.abs() < tuning.unsure_turn {
        0.0
    } else {
        0.5 * turn_rad.clamp(-most_rad, most_rad)
    }
}

/// The refusal of a step, with figures.
pub(crate) fn reason(climbing: &ClimbingConfig, unfit: &Unfit) -> String {
    format!("{}: {}", unfit.word(), unfit.sentence(climbing))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::climbing::simulation::{FEET, stair};

    #[test]
    fn the_robot_moves_away_from_the_end_of_a_step_that_was_seen_whatever_lay_beyond_it_once() {
        let (config, climbing) = (StairClimbingConfig::default(), ClimbingConfig::default());
        let mut next = Step {
            stair: stair([0.2, 0.0, 0.0], [0.35, 0.0, 0.0], -0.018, 0.7),
            rise_m: -0.018,
            crossing_m: [0.2, 0.32],
        };
        next.stair.left_margin_m = 1.0;
        let before = Before {
            config: &config,
            climbing: &climbing,
            feet: &FEET,
            pose: PlanarPose::new(0.0, 0.32, 0.0),
            ground_m: 0.0,
        };
        let outer_foot_m = |seen: usize, next: &mut Step| {
            next.stair.seen_ends.left = seen;
            before.start_stance(next).pose.y_m + 0.5 * FEET.pair_width_m
        };
        assert!(outer_foot_m(0, &mut next) > 0.35);
        assert!(outer_foot_m(20, &mut next) < 0.35 - climbing.side_room);
    }
}
