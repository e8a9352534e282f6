//! The steps that are planned: over the ground as it is known now, from where the feet stand.

use geometry::{Goal, PlanarPose};
use planning::footsteps::{
    FootstepPlan, FootstepQuestion, NoFootsteps, PlannedFootstep, SoleSize, Unseen,
};
use robot::Side;
use terrain::ground_map::SoleOnGround;

use super::Footsteps;
use crate::Footstep;
use crate::machine::Tick;

/// The steps that were planned last, of which some may have been taken.
#[derive(Debug, Clone, Default)]
pub(super) struct LastSteps {
    pub(super) steps: Vec<PlannedFootstep>,
    /// How the walker is told of places in the map.
    pub(super) told_from_map: PlanarPose,
    /// Which one of the walker's list is the first of them.
    pub(super) first: usize,
}

impl LastSteps {
    /// Those from this one of the walker's list on, in the map as the walker is told of it now.
    pub(super) fn from(&self, next: usize, told_from_map: &PlanarPose) -> Vec<PlannedFootstep> {
        let moved = told_from_map.inverse().compose(&self.told_from_map);
        let steps = (self.steps.iter()).skip(next.saturating_sub(self.first));
        let there = steps.map(|step| PlannedFootstep {
            pose: moved.compose(&step.pose),
            ..*step
        });
        there.collect()
    }
}

impl Footsteps {
    /// Where the soles are in the map.
    pub(super) fn soles(tick: &Tick<'_>) -> [PlanarPose; 2] {
        tick.situation
            .soles
            .map(|sole| tick.pose.compose(&sole.pose))
    }

    /// How high the soles are in the map, m.
    pub(super) fn sole_heights_m(tick: &Tick<'_>) -> [f64; 2] {
        tick.situation
            .soles
            .map(|sole| tick.ground_m + sole.height_m)
    }

    /// How the soles stand, left and right.
    pub(super) fn standing(&self, tick: &Tick<'_>) -> [SoleOnGround; 2] {
        let SoleSize { length_m, width_m } = self.layer.limits().sole;
        tick.situation.soles.map(|sole| SoleOnGround {
            pose: tick.pose.compose(&sole.pose),
            half_m: [0.5 * length_m, 0.5 * width_m],
            height_m: (tick.ground_m + sole.height_m) as f32,
            slope: sole.slope.map(|rise| rise as f32),
        })
    }

    /// Reads the ground around soles that stand so.
    pub(super) fn read_ground(&mut self, tick: &Tick<'_>, soles: &[SoleOnGround; 2]) {
        let limits = *self.layer.limits();
        let half_m = [0.5 * limits.sole.length_m, 0.5 * limits.sole.width_m];
        let (view, stairs) = (tick.situation.view, tick.situation.stairs);
        let around_m = [tick.pose.x_m, tick.pose.y_m];
        let _ = self.ground.read(view, stairs, around_m);
        self.failed
            .take_from(self.ground.map_mut(), half_m, limits.careful_rise_m);
        for sole in self.felt.iter().chain(soles) {
            self.ground.stand_on(sole);
        }
    }

    /// Where feet stood there is ground, whatever the map makes of it later: they can go back.
    pub(super) fn feel(&mut self, tick: &Tick<'_>) {
        let apart_m = 0.5 * self.layer.limits().sole.width_m;
        let soles = self.standing(tick);
        self.stances.stand(soles, apart_m);
        for sole in soles {
            self.felt
                .retain(|other| other.pose.distance_m(&sole.pose) > apart_m);
            self.felt.push(sole);
        }
        let too_many = self.felt.len().saturating_sub(self.config.felt);
        let _ = self.felt.drain(..too_many);
    }

    /// Plans steps from feet that stand here, over the ground as it was read; those on from here that were planned before may be kept.
    pub(super) fn plan_from(
        &mut self,
        tick: &Tick<'_>,
        feet: [PlanarPose; 2],
        first: Option<Side>,
        planned: &[PlannedFootstep],
    ) -> Result<FootstepPlan, NoFootsteps> {
        // Where the robot looked in vain it goes nearer.
        let nearer = 1.0 / f64::from(1 + self.looks);
        let unseen = Unseen::Priced {
            stop_before_m: self.config.look_from * nearer,
            faces_rad: self.config.faces,
        };
        let question = FootstepQuestion {
            feet,
            first,
            unseen,
            vain_m: self.failed.unseen_m(),
            planned,
        };
        let goal = tick.situation.goal;
        // At its rim it would not be sure to have arrived.
        let inside = Goal {
            radius_m: self.walking.config().arrive_share * goal.radius_m,
            ..*goal
        };
        let planned = self.layer.plan_over(self.ground.map(), &question, &inside);
        self.planned = (Some(planned.clone()), self.planned.1 + 1);
        planned
    }

    /// Height of the ground under a foot, m.
    pub(super) fn height_under_m(&self, foot: &PlanarPose) -> Option<f64> {
        let map = self.ground.map();
        let cell = map.lattice.cell_at(foot.x_m, foot.y_m);
        map.height_m(cell).map(f64::from)
    }

    /// A planned step as the walker is told it, in the map.
    pub(super) fn told(&self, step: &PlannedFootstep) -> Footstep {
        let slope = step.foothold.slope.map(f64::from);
        let [ahead, left] = slope;
        let is_level = geometry::hypot(ahead, left) < self.config.level_slope;
        Footstep {
            side: step.side,
            pose: step.pose,
            height_m: f64::from(step.foothold.height_m),
            slope: if is_level { [0.0; 2] } else { slope },
            bearing_m: step.foothold.bearing_m.map(f64::from),
            manner: step.manner,
        }
    }
}

/// Both feet, after the one of this side has gone there.
pub(super) fn after(feet: &[PlanarPose; 2], side: Side, to: PlanarPose) -> [PlanarPose; 2] {
    let mut feet = *feet;
    feet[side.index()] = to;
    feet
}

#[cfg(test)]
mod tests {
    use planning::footsteps::{StepCost, StepManner};
    use terrain::footholds::Foothold;

    use super::*;

    #[test]
    fn steps_that_were_taken_are_left_out_and_the_others_lie_as_the_walker_is_told_of_them() {
        let step = |x_m: f64| PlannedFootstep {
            side: Side::Left,
            pose: PlanarPose::new(x_m, 0.0, 0.0),
            foothold: Foothold {
                height_m: 0.0,
                slope: [0.0; 2],
                bearing_m: [-0.05, 0.05],
                bearing_share: 1.0,
                unevenness: 0.0,
                closed_share: 0.0,
            },
            manner: StepManner::Careful,
            cost: StepCost {
                time_s: 1.0,
                partial_s: 0.0,
                margin_s: 0.0,
                turn_s: 0.0,
            },
        };
        let last = LastSteps {
            steps: [0.1, 0.2, 0.3].map(step).to_vec(),
            told_from_map: PlanarPose::new(0.01, 0.0, 0.0),
            first: 4,
        };
        // The foot that stands came to stand 2 cm short of where the walker was told to put it.
        let told_from_map = PlanarPose::new(0.03, 0.0, 0.0);
        let places_m = |next: usize| -> Vec<f64> {
            let steps = last.from(next, &told_from_map);
            steps.iter().map(|step| step.pose.x_m).collect()
        };
        assert_eq!(places_m(5).len(), 2);
        assert!((places_m(5)[0] - 0.18).abs() < 1e-12);
        assert_eq!(places_m(7), [0.0; 0]);
        assert_eq!(places_m(0).len(), 3);
    }
}
