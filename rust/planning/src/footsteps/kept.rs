//! Steps that were planned before, on ground that is known better now.

use super::plan::{FootstepPlan, PlannedFootstep};
use super::question::FootstepQuestion;
use super::space::FootstepSpace;

impl FootstepSpace<'_> {
    /// Plans are kept until a support changes: the steps that were planned before, where all of them are possible still and they end at the goal or
    /// before what was not seen, if `found` is better by no more than a walked step.
    pub(super) fn kept_or(
        &mut self,
        found: Option<FootstepPlan>,
        question: &FootstepQuestion<'_>,
    ) -> Option<FootstepPlan> {
        let kept = self.kept(question.planned);
        match (kept, found) {
            (Some(kept), Some(found)) if found.whole_s + self.limits.walked_s < kept.whole_s => {
                Some(found)
            }
            (Some(kept), Some(found)) => Some(FootstepPlan {
                epsilon: found.epsilon,
                first: found.first,
                ..kept
            }),
            (kept, found) => kept.or(found),
        }
    }

    fn kept(&mut self, planned: &[PlannedFootstep]) -> Option<FootstepPlan> {
        let places = planned.iter().map(|step| (step.side, step.pose));
        let (steps, last) = self.steps_through(places, 0.0).ok()?;
        let last = last?;
        let cost_s = steps.iter().map(|step| step.cost.total_s()).sum();
        let on_s = if self.is_at_goal(&last) {
            0.0
        } else {
            self.on_from_s(&last)?
        };
        Some(FootstepPlan {
            exit_m: self.exit_of(&last),
            steps,
            cost_s,
            whole_s: cost_s + on_s,
            epsilon: self.config.epsilon,
            first: (cost_s, 0),
            expanded: 0,
        })
    }
}

#[cfg(test)]
mod tests {
    use geometry::{Cell, Goal, PlanarPose};
    use mapping::HeightMap;

    use super::*;
    use crate::footsteps::tests::{LIMITS, flight, goal, layer, map};
    use crate::footsteps::{NoFootsteps, Unseen};

    /// Plans over a map, from where the feet stand after `taken` steps of a plan whose other steps may be kept.
    fn on(
        seen: &HeightMap,
        planned: &[PlannedFootstep],
        (taken, to): (usize, &Goal),
    ) -> Result<FootstepPlan, NoFootsteps> {
        let mut layer = layer();
        let mut feet = layer.feet_around(&PlanarPose::default());
        for step in &planned[..taken] {
            feet[step.side.index()] = step.pose;
        }
        let question = FootstepQuestion {
            feet,
            first: planned.get(taken).map(|step| step.side),
            unseen: Unseen::Closed,
            vain_m: &[],
            planned: &planned[taken..],
        };
        layer.plan_over(seen, &question, to)
    }

    fn places(steps: &[PlannedFootstep]) -> Vec<PlanarPose> {
        steps.iter().map(|step| step.pose).collect()
    }

    #[test]
    fn a_plan_is_kept_step_by_step_until_a_support_changes_or_another_is_better() {
        let stairs = map(|x_m, _| flight(x_m, 0.5, (0.04, 0.2, 3)));
        let to = goal(1.5, 0.0);
        let plan = on(&stairs, &[], (0, &to)).unwrap();
        let mut kept = 0;
        for taken in 1..plan.steps.len() {
            let rest = &plan.steps[taken..];
            let rest_s: f64 = rest.iter().map(|step| step.cost.total_s()).sum();
            let found = on(&stairs, &plan.steps, (taken, &to)).unwrap();
            let better_s = rest_s - found.whole_s;
            assert!(places(&found.steps) == places(rest) || better_s > LIMITS.walked_s);
            kept += usize::from(places(&found.steps) == places(rest));
        }
        assert!(kept > 0);
        let third = &plan.steps[2];
        let mut changed = stairs.clone();
        let lattice = stairs.lattice;
        for cell in stairs.heights_m().area().cells() {
            let [x_m, y_m] = lattice.center_of(cell);
            if geometry::distance_m([x_m, y_m], [third.pose.x_m, third.pose.y_m]) < 0.05 {
                changed.set(Cell::new(cell.col, cell.row), -0.2, 0.0);
            }
        }
        let other = on(&changed, &plan.steps, (1, &to)).unwrap();
        assert_ne!(places(&other.steps), places(&plan.steps[1..]));
        // The goal has moved to where the robot is.
        let nearer = on(&stairs, &plan.steps, (1, &goal(0.0, 0.0))).unwrap();
        assert!(nearer.steps.len() < plan.steps.len() - 1);
    }
}
