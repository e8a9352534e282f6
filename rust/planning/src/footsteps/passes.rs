//! The searches that make up a plan: for steps to the goal first, then for steps to what is not known.
//!
//! Who may end before what is not known nearly always finds such an end near by, and its estimate of the way beyond then keeps a search from
//! going far enough to find the steps that lead to the goal itself.

use geometry::Goal;
use mapping::HeightMap;
use terrain::footholds::HighBlocks;

use super::lattice_tables::FINENESSES;
use super::layer::FootstepLayer;
use super::plan::{FootstepPlan, PlannedFootstep};
use super::question::FootstepQuestion;
use super::space::{FootstepSpace, START};
use super::spots::StandingFoot;
use super::unseen::Unseen;
use crate::search::ara_star::SearchProgress;

impl FootstepLayer {
    /// The best steps of all searches, and how many places of a foot the longest of them expanded.
    pub(super) fn best_steps(
        &mut self,
        seen: (&HeightMap, &HighBlocks),
        (start, question): ([StandingFoot; 2], &FootstepQuestion<'_>),
        goal: &Goal,
    ) -> (Option<FootstepPlan>, usize) {
        let from = (start, question);
        let ends_early = question.unseen != Unseen::Closed;
        let to_goal = if ends_early {
            self.config.to_goal
        } else {
            self.config.most_expansions
        };
        let (mut best, mut expanded) = (None, 0);
        for fineness in 0..FINENESSES {
            // Who is cornered looks at more steps.
            if best.is_some() || expanded > self.config.cornered {
                break;
            }
            if self.field.is_goal_seen() {
                let how = (Unseen::Closed, fineness, to_goal);
                (best, expanded) = self.search_steps(seen, from, goal, how);
            }
            if ends_early {
                let how = (question.unseen, fineness, self.config.most_expansions);
                let (other, more) = self.search_steps(seen, from, goal, how);
                expanded = expanded.max(more);
                best = cheaper(best, other);
            }
        }
        (best, expanded)
    }

    /// One search, for places of a foot of which no more are expanded than this; the best plan, if there is any, and how many were.
    fn search_steps(
        &mut self,
        (map, blocks): (&HeightMap, &HighBlocks),
        (start, question): ([StandingFoot; 2], &FootstepQuestion<'_>),
        goal: &Goal,
        (ends, fineness, most): (Unseen, usize, usize),
    ) -> (Option<FootstepPlan>, usize) {
        let Some(tables) = &mut self.tables else {
            return (None, 0);
        };
        self.spots.clear();
        let mut space = FootstepSpace {
            map,
            blocks,
            config: &self.config,
            limits: &self.limits,
            field: &self.field,
            goal: *goal,
            unseen: ends,
            first: question.first,
            table: &mut tables.steps[fineness],
            footholds: &mut tables.footholds,
            start,
            spots: &mut self.spots,
            most,
            expanded: 0,
        };
        let mut best: Option<FootstepPlan> = None;
        let (times, began) = (&mut self.times, self.began);
        let found = |space: &mut FootstepSpace<'_>, progress: &SearchProgress| {
            if times.first_s.is_nan() {
                times.first_s = began.elapsed().as_secs_f64();
            }
            if let Some(steps) = space.steps_to(progress.last) {
                take_better(&mut best, (steps, space.exit(progress.last)), progress);
            }
        };
        let _ = (self.search).run_in(&mut space, START, &self.config.search(), found);
        let expanded = space.expanded;
        (space.kept_or(best, question), expanded)
    }
}

/// The cheaper one of two plans.
fn cheaper(one: Option<FootstepPlan>, other: Option<FootstepPlan>) -> Option<FootstepPlan> {
    match (one, other) {
        (Some(one), Some(other)) if other.whole_s < one.whole_s => Some(other),
        (one, other) => one.or(other),
    }
}

/// Keeps the better plan of two, and what the first one cost.
fn take_better(
    best: &mut Option<FootstepPlan>,
    (steps, exit_m): (Vec<PlannedFootstep>, Option<[f64; 2]>),
    progress: &SearchProgress,
) {
    let cost_s = steps.iter().map(|step| step.cost.total_s()).sum();
    let first = best
        .as_ref()
        .map_or((cost_s, progress.expanded), |plan| plan.first);
    // What a plan costs that ends before the goal does not tell how good it is.
    if best
        .as_ref()
        .is_none_or(|plan| exit_m.is_some() || cost_s <= plan.cost_s)
    {
        *best = Some(FootstepPlan {
            steps,
            exit_m,
            whole_s: progress.cost,
            cost_s,
            epsilon: progress.epsilon,
            first,
            expanded: progress.expanded,
        });
    }
}

#[cfg(test)]
mod tests {
    use geometry::PlanarPose;

    use super::*;
    use crate::footsteps::tests::{flight, goal, layer, map};

    #[test]
    fn who_can_step_to_the_goal_does_and_looks_at_no_pocket_beside_the_stairs() {
        // A platform, a flight of stairs down that is as broad as a robot needs, and what it hides at its sides.
        let stairs = |known: bool| {
            map(move |x_m, y_m| {
                let height_m = 0.12 - flight(x_m, 0.5, (0.03, 0.13, 4));
                match (x_m > 0.5, y_m.abs() < 0.17, (0.5..0.75).contains(&x_m)) {
                    (true, false, true) => f64::NAN,
                    (true, false, false) => 0.0,
                    (true, true, true) if !known => f64::NAN,
                    _ => height_m,
                }
            })
        };
        let mut layer = layer();
        let mut ask = |known: bool| {
            let question = FootstepQuestion {
                feet: layer.feet_around(&PlanarPose::new(0.35, -0.1, 0.0)),
                first: None,
                unseen: Unseen::Priced {
                    stop_before_m: 0.2,
                    faces_rad: 0.8,
                },
                vain_m: &[],
                planned: &[],
            };
            let plan = layer.plan_over(&stairs(known), &question, &goal(1.5, 0.0));
            plan.unwrap()
        };
        assert_eq!(ask(true).exit_m, None);
        assert!(ask(false).exit_m.is_some());
    }

    #[test]
    fn a_goal_that_was_not_seen_and_is_told_to_lie_below_is_farther_than_one_on_the_level() {
        let seen = map(|x_m, _| if x_m < 0.8 { 0.2 } else { f64::NAN });
        let mut layer = layer();
        let mut whole_s = |height_m: Option<f64>| {
            let question = FootstepQuestion {
                feet: layer.feet_around(&PlanarPose::default()),
                first: None,
                unseen: Unseen::Priced {
                    stop_before_m: 0.2,
                    faces_rad: 0.8,
                },
                vain_m: &[],
                planned: &[],
            };
            let to = Goal {
                height_m,
                ..goal(1.8, 0.0)
            };
            layer.plan_over(&seen, &question, &to).unwrap().whole_s
        };
        let level_s = whole_s(None);
        assert_eq!(whole_s(Some(0.2)), level_s);
        assert!(whole_s(Some(0.0)) > level_s + 5.0);
    }
}
