//! Places of feet as a space that is searched: a node is the foot that stands, and the one that moves came from the node before it.

use geometry::{Cell, Goal, PlanarPose};
use mapping::HeightMap;
use robot::Side;
use terrain::footholds::{Footholds, HighBlocks};

use super::config::FootstepsConfig;
use super::goal_field::GoalField;
use super::limits::StepLimits;
use super::plan::PlannedFootstep;
use super::spots::{FootSpot, Spots, StandingFoot};
use super::step_table::{LatticeStep, StepTable};
use super::unseen::Unseen;
use crate::search::ara_star::Space;

/// The node at which the robot stands on both feet.
pub(super) const START: u32 = 0;

/// What is searched, and on which map.
pub(super) struct FootstepSpace<'a> {
    pub(super) map: &'a HeightMap,
    pub(super) blocks: &'a HighBlocks,
    pub(super) config: &'a FootstepsConfig,
    pub(super) limits: &'a StepLimits,
    pub(super) field: &'a GoalField,
    pub(super) goal: Goal,
    pub(super) unseen: Unseen,
    /// The foot that moves first, where that is not free.
    pub(super) first: Option<Side>,
    pub(super) table: &'a mut StepTable,
    pub(super) footholds: &'a mut Footholds,
    /// Both feet at the start, left and right.
    pub(super) start: [StandingFoot; 2],
    pub(super) spots: &'a mut Spots,
    /// So many places of a foot are expanded at most.
    pub(super) most: usize,
    /// Places of a foot that were expanded.
    pub(super) expanded: usize,
}

impl FootstepSpace<'_> {
    /// The foot that stands at a node that is not the start.
    pub(super) fn foot_at(&self, node: u32) -> Option<StandingFoot> {
        let index = node.checked_sub(START + 1)?;
        let spot = self.spots.all[index as usize / 2];
        let side = Side::BOTH[index as usize % 2];
        let [x_m, y_m] = self.map.lattice.center_of(spot.cell);
        Some(StandingFoot {
            side,
            pose: PlanarPose::new(x_m, y_m, self.table.yaw_rad(spot.heading)),
            cell: spot.cell,
            heading: spot.heading,
            foothold: spot.foothold?,
        })
    }

    /// The foot of this side at a node: at the start, both stand.
    fn foot(&self, node: u32, side: Side) -> Option<StandingFoot> {
        match node {
            START => Some(self.start[side.index()]),
            _ => self.foot_at(node),
        }
    }

    /// The node of a foot of this side at a place of the lattice, where a sole stands there.
    fn node_of(&mut self, cell: Cell, heading: usize, side: Side) -> Option<u32> {
        let Self {
            spots,
            footholds,
            map,
            ..
        } = self;
        let index = *spots.by_place.entry((cell, heading)).or_insert_with(|| {
            spots.all.push(FootSpot {
                cell,
                heading,
                foothold: footholds.read(map, cell, heading).ok(),
            });
            spots.all.len() as u32 - 1
        });
        let stands = spots.all[index as usize].foothold.is_some();
        stands.then_some(START + 1 + 2 * index + side.index() as u32)
    }

    /// The node at which a step of the lattice ends, and that step.
    fn along(
        &mut self,
        (standing, moving): (&StandingFoot, &StandingFoot),
        step: LatticeStep,
    ) -> Option<(u32, PlannedFootstep)> {
        let [right, up] = step.offset;
        let cell = Cell::new(standing.cell.col + right, standing.cell.row + up);
        let to = self.node_of(cell, step.heading, moving.side)?;
        let there = self.foot_at(to)?;
        self.step((standing, moving), &there, step.reach)
            .map(|taken| (to, taken))
    }

    /// Tells of the steps of one foot.
    fn steps_of(
        &mut self,
        standing: StandingFoot,
        moving: StandingFoot,
        steps: &[LatticeStep],
        reach: &mut impl FnMut(u32, f64),
    ) {
        for &step in steps {
            if let Some((to, taken)) = self.along((&standing, &moving), step) {
                reach(to, taken.cost.total_s());
            }
        }
    }

    fn expand(&mut self, node: u32, parent: Option<u32>) {
        let index = node as usize;
        if self.spots.came_from.len() <= index {
            self.spots.came_from.resize(index + 1, START);
        }
        self.spots.came_from[index] = parent.unwrap_or(START);
    }

    /// The steps to a node that was expanded, and the one that puts the feet side by side. `None` where one of them is not possible: a later
    /// pass has found a cheaper way to a place on the way, with the other foot elsewhere.
    pub(super) fn steps_to(&mut self, last: u32) -> Option<Vec<PlannedFootstep>> {
        let before = |&node: &u32| (node != START).then(|| self.spots.came_from[node as usize]);
        let mut nodes: Vec<u32> = std::iter::successors(Some(last), before).collect();
        nodes.reverse();
        let mut feet = self.start;
        let mut steps = Vec::with_capacity(nodes.len());
        for &node in nodes.iter().skip(1) {
            let there = self.foot_at(node)?;
            let (standing, moving) = (feet[there.side.other().index()], feet[there.side.index()]);
            let reach = self
                .limits
                .reach(&standing.pose.relative(&there.pose), there.side)?;
            steps.push(self.step((&standing, &moving), &there, reach)?);
            feet[there.side.index()] = there;
        }
        if let Some(standing) = self.foot_at(last).filter(|foot| self.is_at_goal(foot)) {
            let moving = feet[standing.side.other().index()];
            steps.push(self.closing(&standing, &moving)?);
        }
        Some(steps)
    }

    /// The step that ends a plan.
    fn closing(
        &mut self,
        standing: &StandingFoot,
        moving: &StandingFoot,
    ) -> Option<PlannedFootstep> {
        let step = self
            .table
            .beside(standing.heading, moving.side, self.limits)?;
        self.along((standing, moving), step).map(|(_, taken)| taken)
    }

    pub(super) fn is_at_goal(&self, foot: &StandingFoot) -> bool {
        let goal = &self.goal;
        let middle_m = self.table.middle_m(&foot.pose, foot.heading, foot.side);
        geometry::distance_m(middle_m, [goal.x_m, goal.y_m]) <= goal.radius_m
    }
}

impl Space for FootstepSpace<'_> {
    fn for_each_step(&mut self, node: u32, parent: Option<u32>, mut reach: impl FnMut(u32, f64)) {
        if self.expanded >= self.most {
            return;
        }
        self.expanded += 1;
        let Some(standing) = self.foot_at(node) else {
            let first = self.first;
            for side in Side::BOTH {
                if first.is_some_and(|first| first != side) {
                    continue;
                }
                let [standing, moving] = [side.other(), side].map(|side| self.start[side.index()]);
                let [x_m, y_m] = self.map.lattice.center_of(standing.cell);
                let StandingFoot { pose, heading, .. } = standing;
                let from_cell = PlanarPose::new(pose.x_m - x_m, pose.y_m - y_m, pose.yaw_rad);
                let steps = self
                    .table
                    .steps_from(&from_cell, heading, side, self.limits);
                self.steps_of(standing, moving, &steps, &mut reach);
            }
            return;
        };
        let side = standing.side.other();
        let Some(moving) = parent.and_then(|parent| self.foot(parent, side)) else {
            return;
        };
        let steps = std::mem::take(self.table.steps_mut(standing.heading, side));
        self.steps_of(standing, moving, &steps, &mut reach);
        *self.table.steps_mut(standing.heading, side) = steps;
    }

    fn ending(&mut self, node: u32, parent: Option<u32>) -> Option<f64> {
        self.expand(node, parent);
        let Some(standing) = self.foot_at(node) else {
            let start = self.start[0];
            let arrived = self.is_at_goal(&start).then_some(0.0);
            return arrived.or_else(|| self.on_from_s(&start));
        };
        if !self.is_at_goal(&standing) {
            return self.on_from_s(&standing);
        }
        let moving = self.foot(parent?, standing.side.other())?;
        self.closing(&standing, &moving)
            .map(|step| step.cost.total_s())
    }

    fn remaining(&self, node: u32) -> f64 {
        let foot = self.foot_at(node).unwrap_or(self.start[0]);
        let [x_m, y_m] = self.table.middle_m(&foot.pose, foot.heading, foot.side);
        self.field.remaining_s(x_m, y_m)
    }
}
