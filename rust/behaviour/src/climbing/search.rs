//! The state `search`: stands, looks down and swings the head to find stairs, or the one that was lost (003, section V.A).

use super::{StairClimbing, State};
use crate::{Motion, machine::Tick};

impl StairClimbing {
    /// Looks for the step that was lost, else towards the goal.
    pub(super) fn begin_search(&mut self, tick: &Tick<'_>) {
        self.memory.tries.searches += 1;
        self.look_for_steps(tick);
    }

    /// Looks for the step in mind, else towards the goal, where nothing was lost.
    pub(super) fn look_for_steps(&mut self, tick: &Tick<'_>) {
        let goal = tick.situation.goal;
        let place_m = self
            .flight
            .first()
            .map_or([goal.x_m, goal.y_m], |step| step.crossing_m);
        self.head.search(tick.bearing_rad(place_m));
        self.enter(State::Search);
    }

    /// One tick of the search.
    pub(super) fn search(&mut self, tick: &Tick<'_>) -> Motion {
        let climbs = self.leg(tick).is_some();
        self.ahead.climb.count(climbs, tick.passed_s);
        let found = self
            .ahead
            .is_sure(self.walking.config().tuning.look_around.sure_after);
        let seen = self.look(tick, false);
        if (!found && !seen) || self.had_stumbled {
            return Motion::Stand;
        }
        if self.memory.tries.searches > self.walking.config().tries
            || (!found && tick.breaks_a_limit())
        {
            let reason = tick.no_way_reason().unwrap_or_else(|| {
                "lost: the stairs were seen and could not be found again".to_owned()
            });
            self.refuse(reason);
        } else {
            self.flight.clear();
            self.walking.resume(tick.situation);
            self.enter(State::Walk);
        }
        Motion::Stand
    }

    /// One tick of any look, standing; true at its end, which comes soon where enough is known.
    pub(super) fn look(&mut self, tick: &Tick<'_>, known: bool) -> bool {
        if !tick.situation.standing {
            return false;
        }
        let frames = tick.situation.frames_used;
        self.head.advance(frames, tick.passed_s) || (known && self.head.has_glanced(frames))
    }
}
