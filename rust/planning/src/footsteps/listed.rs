//! Steps that a planner lists: looked at as those of a search are, and taken as they are listed.

use std::time::Instant;

use geometry::{Goal, PlanarPose};
use mapping::HeightMap;
use robot::Side;
use terrain::footholds::{HighBlocks, NoFoothold};
use thiserror::Error;

use super::lattice_tables::{LatticeTables, stand};
use super::layer::FootstepLayer;
use super::limits::StepReach;
use super::plan::{FootstepPlan, PlannedFootstep};
use super::space::FootstepSpace;
use super::spots::StandingFoot;
use super::unseen::Unseen;

/// Where a foot is to be put.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ListedStep {
    /// The foot that moves.
    pub side: Side,
    /// Where the middle of its sole is put, in the map.
    pub pose: PlanarPose,
}

/// Why a step is not taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum StepFault {
    /// The foot that stands has no ground that is known.
    #[error("the ground under the feet was not seen")]
    UnseenStart,
    /// The sole does not stand there.
    #[error("{}", ground(*.0))]
    Ground(NoFoothold),
    /// Beyond what the legs do.
    #[error("it is farther, nearer to the other foot, or more turned than a step goes")]
    Reach,
    /// The foot or the body does not get there.
    #[error(
        "it is too high or too low, too long for a step down, or something is in the way of foot or body"
    )]
    Way,
}

const fn ground(fault: NoFoothold) -> &'static str {
    match fault {
        NoFoothold::Unseen => "the ground there was not seen",
        NoFoothold::TooLittle => "too little of the sole would bear there",
        NoFoothold::Higher => "something higher is too near to the sole there",
        NoFoothold::TooSteep => "the ground there is too steep",
    }
}

/// The first step of a list that is not taken, and why.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("step {number} of {of}, {} at ({:.2}, {:.2}) m: {fault}", side_word(.step.side), .step.pose.x_m, .step.pose.y_m)]
pub struct RefusedStep {
    /// Which one, counted from 1.
    pub number: usize,
    /// Of so many.
    pub of: usize,
    /// The step.
    pub step: ListedStep,
    /// Why.
    pub fault: StepFault,
}

const fn side_word(side: Side) -> &'static str {
    match side {
        Side::Left => "left",
        Side::Right => "right",
    }
}

impl FootstepLayer {
    /// Listed steps, from where the feet stand, as they would be taken; each by the rules for the steps of a search.
    ///
    /// # Errors
    ///
    /// The first step that is not possible.
    pub fn follow(
        &mut self,
        map: &HeightMap,
        feet: &[PlanarPose; 2],
        listed: &[ListedStep],
        goal: &Goal,
    ) -> Result<FootstepPlan, RefusedStep> {
        let refused = |(index, fault): (usize, StepFault)| RefusedStep {
            number: index + 1,
            of: listed.len(),
            step: listed[index],
            fault,
        };
        self.began = Instant::now();
        let blocks = HighBlocks::new(map);
        let cell_m = map.lattice.cell_m;
        let tables = self.tables.take().filter(|tables| tables.cell_m == cell_m);
        let tables = (self.tables).insert(
            tables.unwrap_or_else(|| LatticeTables::new(&self.config, &self.limits, cell_m)),
        );
        let start = stand(map, tables, feet).map_err(|_| refused((0, StepFault::UnseenStart)))?;
        let mut space = FootstepSpace {
            map,
            blocks: &blocks,
            config: &self.config,
            limits: &self.limits,
            field: &self.field,
            goal: *goal,
            unseen: Unseen::Closed,
            first: None,
            table: &mut tables.steps[0],
            footholds: &mut tables.footholds,
            start,
            spots: &mut self.spots,
            most: 0,
            expanded: 0,
        };
        let poses = listed.iter().map(|step| (step.side, step.pose));
        // Feet come to stand a bit off where they were put: by a cell, and the way on is still that of the list.
        let (steps, last) = space.steps_through(poses, cell_m).map_err(refused)?;
        let cost_s = steps.iter().map(|step| step.cost.total_s()).sum();
        let on_m = last.map_or(0.0, |foot| {
            let middle = self.limits.middle_of(&foot.pose, foot.side);
            geometry::distance_m([middle.x_m, middle.y_m], [goal.x_m, goal.y_m])
        });
        let took_s = self.began.elapsed().as_secs_f64();
        (self.times.first_s, self.times.best_s) = (took_s, took_s);
        Ok(FootstepPlan {
            exit_m: None,
            cost_s,
            whole_s: cost_s + on_m / self.limits.speed_mps(),
            epsilon: 1.0,
            first: (cost_s, 0),
            expanded: 0,
            steps,
        })
    }
}

impl FootstepSpace<'_> {
    /// The steps to these places one after the other, and the foot that stands at the last; or which one is not possible, and why. What is out
    /// of reach by no more than this, m, is put nearer.
    pub(super) fn steps_through(
        &mut self,
        places: impl Iterator<Item = (Side, PlanarPose)>,
        slack_m: f64,
    ) -> Result<(Vec<PlannedFootstep>, Option<StandingFoot>), (usize, StepFault)> {
        let mut feet = self.start;
        let (mut steps, mut last) = (Vec::new(), None);
        for (index, (side, pose)) in places.enumerate() {
            let [standing, moving] = [side.other(), side].map(|side| feet[side.index()]);
            let near = self.within_reach(&standing.pose, &pose, side, slack_m);
            let (pose, reach) = near.ok_or((index, StepFault::Reach))?;
            let there = (self.stand_at(side, pose)).map_err(|no| (index, StepFault::Ground(no)))?;
            let step = self.step((&standing, &moving), &there, reach);
            steps.push(step.ok_or((index, StepFault::Way))?);
            feet[side.index()] = there;
            last = Some(there);
        }
        Ok((steps, last))
    }

    /// The place where a foot is put, and how far the step goes: here, or as little nearer to beside the other foot as the legs ask for.
    fn within_reach(
        &self,
        standing: &PlanarPose,
        pose: &PlanarPose,
        side: Side,
        slack_m: f64,
    ) -> Option<(PlanarPose, StepReach)> {
        const PARTS: u32 = 4;
        let ahead = standing.relative(pose);
        let beside_m = side.sign() * self.limits.stance_width_m;
        let away_m = geometry::hypot(ahead.x_m, ahead.y_m - beside_m).max(f64::EPSILON);
        (0..=PARTS).find_map(|part| {
            let share = (slack_m * f64::from(part) / f64::from(PARTS) / away_m).min(1.0);
            let y_m = ahead.y_m + share * (beside_m - ahead.y_m);
            let near = PlanarPose::new(ahead.x_m * (1.0 - share), y_m, ahead.yaw_rad);
            let there = if part == 0 {
                *pose
            } else {
                standing.compose(&near)
            };
            Some((there, self.limits.reach(&near, side)?))
        })
    }

    /// A foot of this side that stands at a place, wherever in a cell.
    fn stand_at(&mut self, side: Side, pose: PlanarPose) -> Result<StandingFoot, NoFoothold> {
        let cell = self.map.lattice.cell_at(pose.x_m, pose.y_m);
        let heading = self.table.nearest(pose.yaw_rad);
        let foothold = self.footholds.read(self.map, cell, heading)?;
        Ok(StandingFoot {
            side,
            pose,
            cell,
            heading,
            foothold,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::footsteps::tests::{flight, goal, layer, map};

    fn ask(seen: &HeightMap, listed: &[ListedStep]) -> Result<FootstepPlan, RefusedStep> {
        let mut layer = layer();
        let feet = layer.feet_around(&PlanarPose::default());
        layer.follow(seen, &feet, listed, &goal(1.5, 0.0))
    }

    /// Steps straight ahead, left first, each so far from the other foot's, m.
    fn ahead(count: usize, stride_m: f64) -> Vec<ListedStep> {
        let sides = [Side::Left, Side::Right].into_iter().cycle();
        let steps = sides
            .take(count)
            .enumerate()
            .map(|(index, side)| ListedStep {
                side,
                pose: PlanarPose::new((index + 1) as f64 * stride_m, 0.0425 * side.sign(), 0.0),
            });
        steps.collect()
    }

    fn as_listed(plan: &FootstepPlan) -> Vec<ListedStep> {
        let steps = plan.steps.iter().map(|step| ListedStep {
            side: step.side,
            pose: step.pose,
        });
        steps.collect()
    }

    #[test]
    fn a_list_that_holds_is_taken_as_it_is_and_costs_what_its_steps_do() {
        let level = map(|_, _| 0.0);
        let listed = ahead(6, 0.05);
        let plan = ask(&level, &listed).unwrap();
        for (step, wanted) in plan.steps.iter().zip(&listed) {
            assert_eq!((step.side, step.pose), (wanted.side, wanted.pose));
        }
        assert!((plan.cost_s - 6.0 * 0.5).abs() < 1e-9);
        assert!(plan.whole_s > plan.cost_s);
        let stairs = map(|x_m, _| flight(x_m, 0.5, (0.04, 0.2, 3)));
        let mut layer = layer();
        let feet = layer.feet_around(&PlanarPose::default());
        let found = layer.plan(&stairs, feet, &goal(1.5, 0.0)).unwrap();
        let over = ask(&stairs, &as_listed(&found)).unwrap();
        assert_eq!(over.steps, found.steps);
    }

    #[test]
    fn the_first_step_that_does_not_hold_is_named_and_says_why() {
        let level = map(|_, _| 0.0);
        let far = ask(&level, &ahead(3, 0.3)).unwrap_err();
        assert_eq!((far.number, far.fault), (1, StepFault::Reach));
        let stairs = |rise_m: f64| map(move |x_m, _| flight(x_m, 0.5, (rise_m, 0.2, 3)));
        let mut layer = layer();
        let feet = layer.feet_around(&PlanarPose::default());
        let found = layer.plan(&stairs(0.04), feet, &goal(1.5, 0.0)).unwrap();
        let high = ask(&stairs(0.07), &as_listed(&found)).unwrap_err();
        assert_eq!(high.fault, StepFault::Way);
        let hole = map(|x_m, _| {
            if (0.1..0.3).contains(&x_m) {
                f64::NAN
            } else {
                0.0
            }
        });
        let unseen = ask(&hole, &ahead(4, 0.06)).unwrap_err();
        assert_eq!(unseen.fault, StepFault::Ground(NoFoothold::Unseen));
        assert!(unseen.number > 1);
        let said = unseen.to_string();
        assert!(
            said.starts_with(&format!("step {} of 4, ", unseen.number)),
            "{said}"
        );
        assert!(said.ends_with("m: the ground there was not seen"), "{said}");
    }
}
