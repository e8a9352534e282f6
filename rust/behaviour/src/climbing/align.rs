//! The state `align`: to the place before the first edge from which it is measured, and square to it (003, section V.B).

use geometry::angle_between;
use planning::Step;

use super::{StairClimbing, State, drop_off::DropOff, leg::align_pose, state::Approach};
use crate::{Motion, Velocity, machine::Tick};

impl StairClimbing {
    /// One tick of the way there.
    pub(super) fn align(&mut self, tick: &Tick<'_>) -> Motion {
        let Some(first) = self.flight.first().copied() else {
            self.begin_search(tick);
            return Motion::Stand;
        };
        if self.walks_on(tick, &first) {
            return Motion::Stand;
        }
        self.head
            .turn_to(tick.in_robot(first.crossing_m), tick.passed_s);
        if self.flight.is_lost() {
            self.begin_search(tick);
            return Motion::Stand;
        }
        let goal = align_pose(&first, &self.config, &self.climbing, &self.feet);
        let way = tick.pose.relative(&goal);
        let turned_rad = angle_between(tick.pose.yaw_rad, goal.yaw_rad);
        let (tuning, walking) = (&self.config.tuning.align, self.walking.config());
        let there = way.x_m.abs() < tuning.along
            && way.y_m.abs() < tuning.across
            && turned_rad.abs() < tuning.turned;
        let velocity = Velocity {
            x_mps: (tuning.gain * way.x_m).clamp(-tuning.backward_speed, walking.forward_speed),
            y_mps: (tuning.gain * way.y_m).clamp(-walking.side_speed, walking.side_speed),
            yaw_radps: (walking.tuning.turn.gain * turned_rad)
                .clamp(-walking.turn_speed, walking.turn_speed),
        };
        let longest_s = tuning.longest;
        // From before the edge the plan may know better where to cross it than when the robot set off.
        if there && self.memory.tries.lanes == 0 && self.flight.change_lane() {
            self.memory.tries.lanes += 1;
            self.machine.begin_again(State::Align);
        } else if there
            || self.machine.lasted_s() > longest_s
            || self.drop_off(tick).is_neared(&tick.pose, &velocity)
        {
            self.enter(State::Approach(Approach::Measure));
            self.head.look_at(self.crossed_at_m(tick, &first));
            return Motion::Stand;
        }
        Motion::Walk(velocity)
    }

    /// Whether the first step turned out to be a slope, as the map has it: then it is walked on, or refused, as slopes are.
    pub(super) fn walks_on(&mut self, tick: &Tick<'_>, first: &Step) -> bool {
        let [x_m, y_m] = first.crossing_m;
        let is_slope = tick.situation.view.gradient_at(x_m, y_m) != [0.0; 2];
        if is_slope {
            self.flight.clear();
            self.walking.resume(tick.situation);
            self.enter(State::Walk);
        }
        is_slope
    }

    /// The floor that the robot stands on, as the map has it end.
    pub(super) fn drop_off<'a>(&'a self, tick: &Tick<'a>) -> DropOff<'a> {
        DropOff {
            view: tick.situation.view,
            feet: &self.feet,
            level_m: tick.ground_m,
            same_level_m: self.climbing.levels.same,
            raster: self.config.tuning.raster,
            tuning: &self.config.tuning.drop_off,
        }
    }
}
