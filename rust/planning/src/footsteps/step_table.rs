//! The steps from a foot at each heading to cells of the lattice.

use std::f64::consts::TAU;

use geometry::{PlanarPose, wrap_angle};
use robot::Side;

use super::config::FootstepsConfig;
use super::limits::{StepLimits, StepReach};

/// A step on the lattice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LatticeStep {
    /// Columns and rows from the foot that stands.
    pub(super) offset: [i32; 2],
    /// Heading there.
    pub(super) heading: usize,
    /// How far it goes.
    pub(super) reach: StepReach,
}

/// Headings of feet, and steps between them.
#[derive(Debug, Clone)]
pub(super) struct StepTable {
    headings: usize,
    cell_m: f64,
    /// Where steps are meant to go, for a left foot: forward, to the left, turn to the left, in a right foot's frame.
    wanted: Vec<PlanarPose>,
    /// From a left foot to the robot's middle at each heading, m.
    middles_m: Vec<[f64; 2]>,
    /// For each heading of the foot that stands, twice: the steps of a left foot and of a right one.
    steps: Vec<Vec<LatticeStep>>,
}

impl StepTable {
    /// Steps within these limits, between the middles of cells of this size; heading 0 points along x.
    pub(super) fn new(config: &FootstepsConfig, limits: &StepLimits, cell_m: f64) -> Self {
        let mut table = Self {
            headings: config.headings,
            cell_m,
            wanted: wanted(config, limits),
            middles_m: Vec::new(),
            steps: Vec::new(),
        };
        for heading in 0..config.headings {
            for side in Side::BOTH {
                let standing = PlanarPose::new(0.0, 0.0, table.yaw_rad(heading));
                if side == Side::Left {
                    let middle = limits.middle_of(&standing, side);
                    table.middles_m.push([middle.x_m, middle.y_m]);
                }
                table
                    .steps
                    .push(table.steps_from(&standing, heading, side, limits));
            }
        }
        table
    }

    /// A heading, rad.
    pub(super) fn yaw_rad(&self, heading: usize) -> f64 {
        TAU * heading as f64 / self.headings as f64
    }

    /// The heading nearest to this one, rad.
    pub(super) fn nearest(&self, yaw_rad: f64) -> usize {
        let turns = yaw_rad * self.headings as f64 / TAU;
        (turns.round() as isize).rem_euclid(self.headings as isize) as usize
    }

    /// Where the robot's middle is when the foot of a side stands at a place at a heading, m.
    pub(super) fn middle_m(&self, foot: &PlanarPose, heading: usize, side: Side) -> [f64; 2] {
        let [x_m, y_m] = self.middles_m[heading];
        [foot.x_m + side.sign() * x_m, foot.y_m + side.sign() * y_m]
    }

    /// All headings, rad.
    pub(super) fn yaws_rad(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.headings).map(|heading| self.yaw_rad(heading))
    }

    /// The steps of a foot of this side when the other one stands at a heading, to be lent while the map is asked about them.
    pub(super) fn steps_mut(&mut self, heading: usize, side: Side) -> &mut Vec<LatticeStep> {
        &mut self.steps[2 * heading + side.index()]
    }

    /// The steps of a foot of this side when the other one stands at a pose, whose position counts from the centre of its cell: the nearest
    /// cell to each place, where that is within reach.
    pub(super) fn steps_from(
        &self,
        standing: &PlanarPose,
        heading: usize,
        side: Side,
        limits: &StepLimits,
    ) -> Vec<LatticeStep> {
        let mut steps: Vec<LatticeStep> = Vec::new();
        for wanted in &self.wanted {
            let mirrored = PlanarPose::new(
                wanted.x_m,
                side.sign() * wanted.y_m,
                side.sign() * wanted.yaw_rad,
            );
            let turns = (mirrored.yaw_rad * self.headings as f64 / TAU).round() as isize;
            let to_heading = (heading as isize + turns).rem_euclid(self.headings as isize) as usize;
            let (x_m, y_m) = standing.apply(mirrored.x_m, mirrored.y_m);
            let to = (to_heading, [x_m, y_m]);
            let Some(step) = self.nearest_within_reach(standing, to, (side, limits)) else {
                continue;
            };
            if !steps.contains(&step) {
                steps.push(step);
            }
        }
        steps
    }

    /// The step to the cell nearest to a place, m from the centre of the standing foot's cell, of those around it that are within reach. Where the place
    /// itself is walked to, so is the cell, if any is.
    fn nearest_within_reach(
        &self,
        standing: &PlanarPose,
        (heading, place_m): (usize, [f64; 2]),
        (side, limits): (Side, &StepLimits),
    ) -> Option<LatticeStep> {
        let turn_rad = wrap_angle(self.yaw_rad(heading) - standing.yaw_rad);
        let across_m = limits.across_m(turn_rad);
        let (sin, cos) = libm::sincos(standing.yaw_rad);
        let reach = |[x_m, y_m]: [f64; 2]| {
            let [x_m, y_m] = [x_m - standing.x_m, y_m - standing.y_m];
            let seen = PlanarPose::new(cos * x_m + sin * y_m, cos * y_m - sin * x_m, turn_rad);
            limits.reach_across(&seen, side, across_m)
        };
        let wanted = reach(place_m);
        let middle = place_m.map(|place_m| (place_m / self.cell_m).round() as i32);
        let around = (-1..=1).flat_map(|row| (-1..=1).map(move |col| [col, row]));
        let steps = around.filter_map(|[col, row]| {
            let offset = [middle[0] + col, middle[1] + row];
            let cell_m = offset.map(|cells| f64::from(cells) * self.cell_m);
            let reach = reach(cell_m)?;
            let step = LatticeStep {
                offset,
                heading,
                reach,
            };
            let other = wanted.is_some_and(|wanted| wanted != reach);
            Some((other, geometry::distance_m(cell_m, place_m), step))
        });
        let nearer =
            |a: &(bool, f64, _), b: &(bool, f64, _)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1));
        steps.min_by(nearer).map(|(_, _, step)| step)
    }

    /// The step that puts a foot beside the one that stands at a heading.
    pub(super) fn beside(
        &self,
        heading: usize,
        side: Side,
        limits: &StepLimits,
    ) -> Option<LatticeStep> {
        let standing = PlanarPose::new(0.0, 0.0, self.yaw_rad(heading));
        let there = limits.beside(&standing, side);
        self.nearest_within_reach(&standing, (heading, [there.x_m, there.y_m]), (side, limits))
    }
}

/// Where steps are meant to go, for a left foot in the frame of the right one that stands.
fn wanted(config: &FootstepsConfig, limits: &StepLimits) -> Vec<PlanarPose> {
    let turn_rad = TAU / config.headings as f64;
    let turns = (limits.max_turn_rad / turn_rad) as i32;
    let mut wanted = Vec::new();
    for turn in -turns..=turns {
        let yaw_rad = f64::from(turn) * turn_rad;
        let [nearest_m, farthest_m] = limits.across_m(yaw_rad);
        for x_m in along_m(config, limits) {
            for across in 0..config.across {
                let share = across as f64 / (config.across.max(2) - 1) as f64;
                let least_m = nearest_m.max(limits.stance_width_m);
                let wide_m = farthest_m.min(least_m + limits.careful_sideways_m);
                let y_m = least_m + share * (wide_m - least_m);
                let [x_m, y_m] = limits.pulled_in(x_m, y_m);
                wanted.push(PlanarPose::new(x_m, y_m, yaw_rad));
            }
        }
    }
    wanted
}

/// Places along: beside the other foot, as far as the robot walks both ways, as far as a careful step goes, and evenly between.
fn along_m(config: &FootstepsConfig, limits: &StepLimits) -> Vec<f64> {
    let mut along_m = vec![
        -limits.max_backward_m,
        0.0,
        limits.max_forward_m,
        limits.careful_forward_m,
    ];
    let between = config.along.saturating_sub(along_m.len());
    for place in 1..=between {
        let share = place as f64 / (between + 1) as f64;
        along_m.push(share * limits.careful_forward_m);
    }
    along_m.sort_by(f64::total_cmp);
    along_m
}
