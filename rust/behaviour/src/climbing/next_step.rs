//! The step to take next, and what is known of what comes behind it.

use planning::Step;

use super::StairClimbing;
use super::flight::{depth_m, nearest};
use super::placement::Behind;
use crate::machine::Tick;

impl StairClimbing {
    /// The step to take now: the memorised one, else what is seen ahead. None where the climb has led to the goal, or to a place
    /// from which the way goes on level, whatever stairs there are beyond it.
    pub(super) fn next_step(&mut self, tick: &Tick<'_>) -> Option<Step> {
        if self.memory.on.is_some() && tick.has_level_way() && self.has_room(tick) {
            self.flight.clear();
            return None;
        }
        if self.is_in_doubt() || self.flight.first().is_none() {
            if let Some(steps) = self.planned_ahead(tick) {
                self.flight.adopt(steps);
            } else if tick.situation.plan.is_none() && self.flight.first().is_none() {
                let reach_m = self.reach_m();
                let (stairs, ground_m) = (tick.situation.stairs, tick.ground_m);
                let step = nearest(stairs, &tick.pose, ground_m, reach_m, &self.rules());
                self.flight.adopt(step.as_slice());
            }
        }
        let mut first = self.flight.first().copied()?;
        if self.memory.on.is_some() && self.leaves_the_goal_by(tick, &first) {
            self.flight.clear();
            return None;
        }
        if self.memory.on.is_some() {
            // A tread may be narrow and the edge behind it wide: wherever a plan crosses that, there is no walking to the side.
            let at = [tick.pose.x_m, tick.pose.y_m];
            first.crossing_m = first.stair.front.straight_on_m(at);
        }
        Some(first)
    }

    /// Whether the memorised step may have been a glance of something beside the way: no foot has tried it, and by now it is not
    /// seen, or not planned and its edge never was measured.
    pub(super) fn is_in_doubt(&self) -> bool {
        let unseen = self.flight.is_out_of_sight();
        let measured = self
            .flight
            .first()
            .is_some_and(|first| self.is_usable(first));
        self.memory.tries.missteps == 0 && self.flight.is_lost() && (unseen || !measured)
    }

    /// The steps within reach that the plan leads over.
    fn planned_ahead<'a>(&self, tick: &Tick<'a>) -> Option<&'a [Step]> {
        let at = [tick.pose.x_m, tick.pose.y_m];
        let beyond_m = |step: &Step| step.stair.front.beyond_m(at);
        let path = tick.situation.plan?.way.as_ref().ok()?;
        let steps = path.climbs.iter().find_map(|climb| {
            // The plan may not have noticed yet that a step was taken.
            let ahead = climb.steps.iter().position(|step| beyond_m(step) <= 0.0)?;
            Some(&climb.steps[ahead..])
        })?;
        let farthest_m = self.config.tuning.next_step.planned * self.reach_m();
        (beyond_m(&steps[0]) > -farthest_m).then_some(steps)
    }

    /// How far ahead of the robot's middle the edge of a step may be that is taken next, m.
    fn reach_m(&self) -> f64 {
        0.5 * self.feet.length_m + self.config.tuning.next_step.reach
    }

    /// What is behind the next step, as far as it was measured.
    pub(super) fn behind(&self, tick: &Tick<'_>, first: &Step) -> Behind<'_> {
        match self.flight.second() {
            Some(second)
                if self.is_measured(second)
                    || self.memory.tries.looks >= self.walking.config().tries =>
            {
                Behind::Step(second)
            }
            Some(second) => Behind::Unseen(depth_m(first, second)),
            None => self.before(tick).without_next(first),
        }
    }
}
