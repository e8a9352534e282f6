//! The steps ahead that the robot knows: the memorised one and those behind it (003, section V.C).

mod lookup;

use std::f64::consts::FRAC_PI_2;

use geometry::{PlanarPose, angle_between};
use planning::{Plan, Step};
use stairs::{ClimbingConfig, Staircase};

use crate::climbing::placement::depth_m;
use lookup::{LEAST_TREAD_M, following, is_same};
pub(crate) use lookup::{SAME_HEIGHT_M, covers, crosses_another, is_step, nearest, settled_rise_m};

/// An edge nearer than this to the robot's middle is out of view: what was measured before is better than what is thought
/// of it now, m.
const OUT_OF_VIEW_M: f64 = 0.17;

/// A robot on a tread deeper than this has room to turn and to walk, m.
pub(crate) const ROOMY_M: f64 = 0.22;

/// A lane further aside than this is another one, m.
const LANE_M: f64 = 0.08;

/// A robot whose middle is further than this before an edge has no foot over it yet, m.
const NOT_YET_THERE_M: f64 = 0.06;

/// Steps that neither the plan nor the view has shown for this long are lost, s.
const LOST_S: f64 = 1.5;
/// A plan may think of another way for this long, s.
const UNPLANNED_S: f64 = 4.0;

/// The steps ahead, in their order. In the map, so that the robot's own motion moves none of them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Flight {
    steps: Vec<Step>,
    /// How long neither the plan nor the view has shown the first of them, s.
    pub(crate) lost_s: f64,
    /// How long the plan has not led over it, s.
    pub(crate) unplanned_s: f64,
    /// How far to the left of the lane the plan now crosses the first step, m.
    elsewhere_m: f64,
}

impl Flight {
    /// The memorised step, *step₁* of 003.
    pub(crate) fn first(&self) -> Option<&Step> {
        self.steps.first()
    }

    /// The one behind it, *step₂* of 003.
    pub(crate) fn second(&self) -> Option<&Step> {
        self.steps.get(1)
    }

    /// All of them.
    pub(crate) fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// Takes over the steps of a plan's leg, but for the edges that the robot is too near to see, and where it crosses them: a
    /// plan may cross a wide edge anywhere, and the robot would follow to and fro.
    /// A plan that ends short takes nothing away that is still there.
    fn renew(&mut self, steps: &[Step], stairs: &Staircase, pose: &PlanarPose) {
        let before = std::mem::take(&mut self.steps);
        self.adopt(steps);
        if let Some(first) = before.first() {
            self.elsewhere_m = aside_m(&self.steps, first);
            shift(&mut self.steps, -self.elsewhere_m);
        }
        let mut last = None;
        for step in &mut self.steps {
            last = before.iter().position(|old| is_same(old, &step.stair));
            if let Some(at) = last {
                keep_better_edge(step, &before[at], pose);
            }
        }
        if let Some(last) = last {
            let planned = self.steps.len();
            let there = |old: &Step| stairs.stairs.iter().any(|stair| covers(stair, old));
            for old in &before[last + 1..] {
                let behind = |last: &Step| depth_m(last, old) > LEAST_TREAD_M;
                if !(there(old) && self.steps.last().is_some_and(behind)) {
                    break;
                }
                self.steps.push(*old);
            }
            look_up(&mut self.steps[planned..], stairs, pose);
        }
    }

    /// Takes over the steps of a plan's leg.
    pub(crate) fn adopt(&mut self, steps: &[Step]) {
        self.steps.clear();
        self.steps.extend_from_slice(steps);
        self.lost_s = 0.0;
        self.unplanned_s = 0.0;
        self.elsewhere_m = 0.0;
    }

    /// Takes the lane that the plan takes now, and says whether that is another one.
    pub(crate) fn change_lane(&mut self) -> bool {
        let changes = self.elsewhere_m.abs() > LANE_M;
        if changes {
            shift(&mut self.steps, std::mem::take(&mut self.elsewhere_m));
        }
        changes
    }

    /// The first step was taken.
    pub(crate) fn taken(&mut self) -> Option<Step> {
        (!self.steps.is_empty()).then(|| self.steps.remove(0))
    }

    /// Forgets all.
    pub(crate) fn clear(&mut self) {
        self.steps.clear();
        self.lost_s = 0.0;
        self.unplanned_s = 0.0;
    }

    /// Time passes.
    pub(crate) fn wait(&mut self, passed_s: f64) {
        self.lost_s += passed_s;
        self.unplanned_s += passed_s;
    }

    /// Whether the first step is no longer where the way leads: it is not seen, or the plan has left it for long.
    pub(crate) fn is_lost(&self) -> bool {
        self.is_out_of_sight() || self.unplanned_s > UNPLANNED_S
    }

    /// Whether neither the view nor the plan shows the first step.
    pub(crate) fn is_out_of_sight(&self) -> bool {
        self.lost_s > LOST_S
    }

    /// Takes in what is known now: the plan's steps where it shows the memorised one, else the stairs themselves.
    pub(crate) fn refresh(
        &mut self,
        plan: Option<&Plan>,
        stairs: &Staircase,
        pose: &PlanarPose,
        config: &ClimbingConfig,
    ) {
        let Some(first) = self.steps.first().copied() else {
            return;
        };
        if let Some(steps) = plan.and_then(|plan| steps_from(plan, &first, pose)) {
            self.renew(&steps, stairs, pose);
            return;
        }
        if stairs.stairs.iter().any(|stair| covers(stair, &first)) {
            self.lost_s = 0.0;
        }
        look_up(&mut self.steps, stairs, pose);
        while let Some(next) = self
            .steps
            .last()
            .and_then(|last| following(last, stairs, config))
        {
            self.steps.push(next);
        }
    }
}

/// Gives each step the stair that it is by now, and has it cross that one's edge. A stair that is seen to be higher by now may be none
/// that the robot climbs.
fn look_up(steps: &mut [Step], stairs: &Staircase, pose: &PlanarPose) {
    let mut before_higher_m = 0.0;
    for step in steps {
        let mut higher_m = 0.0;
        if let Some(stair) = stairs.stairs.iter().find(|stair| is_same(step, stair)) {
            let old = *step;
            step.stair = *stair;
            higher_m = stair.height_m() - old.stair.height_m();
            let (sin, cos) = stair.front.heading_rad().sin_cos();
            let off_m = stair.front.beyond_m(old.crossing_m);
            step.crossing_m[0] -= off_m * cos;
            step.crossing_m[1] -= off_m * sin;
            keep_better_edge(step, &old, pose);
        }
        step.rise_m += higher_m - before_higher_m;
        before_higher_m = higher_m;
    }
}

/// How far to the left of where it was crossed before the first step is crossed now, m.
fn aside_m(steps: &[Step], before: &Step) -> f64 {
    steps.first().map_or(0.0, |first| {
        let (sin, cos) = first.stair.front.heading_rad().sin_cos();
        let [x_m, y_m] = first.crossing_m;
        let [from_x_m, from_y_m] = before.crossing_m;
        (y_m - from_y_m) * cos - (x_m - from_x_m) * sin
    })
}

/// Moves where steps are crossed to the left.
fn shift(steps: &mut [Step], left_m: f64) {
    for step in steps {
        let (sin, cos) = step.stair.front.heading_rad().sin_cos();
        step.crossing_m[0] -= left_m * sin;
        step.crossing_m[1] += left_m * cos;
    }
}

/// An edge stays where it was measured while it is out of view, and when what is said of it now is worth less. One that was
/// not measured goes where it is measured, and one of which but a piece was known to where more of it is.
fn keep_better_edge(step: &mut Step, old: &Step, pose: &PlanarPose) {
    const WORSE: f64 = 2.0;
    const PIECE: f64 = 0.5;
    let away_m = -old.stair.front.beyond_m([pose.x_m, pose.y_m]);
    let out_of_view = away_m < OUT_OF_VIEW_M;
    let stays = match (&old.stair.front_fit, &step.stair.front_fit) {
        (Some(old), Some(new)) => out_of_view || new.place_sigma_m > WORSE * old.place_sigma_m,
        (Some(_), None) => true,
        (None, Some(_)) => false,
        (None, None) => out_of_view,
    };
    let was_a_piece = old.stair.front.length_m() < PIECE * step.stair.front.length_m();
    if stays && !was_a_piece {
        step.stair.front = old.stair.front;
        step.stair.front_fit = old.stair.front_fit;
        step.stair.left_margin_m = old.stair.left_margin_m;
        step.stair.right_margin_m = old.stair.right_margin_m;
        step.crossing_m = old.crossing_m;
        if (step.rise_m - old.rise_m).abs() < SAME_HEIGHT_M {
            step.rise_m = old.rise_m;
        }
    }
}

/// The plan's steps from this one on, as far as no tread between them is roomy, and those before it that came to be seen while
/// the robot was not yet at their edges: from far away two low steps are one. The plan may walk on a tread between two of them.
/// One that leads the other way is none of them: halfway over an edge a plan may begin with going back over it.
fn steps_from(plan: &Plan, first: &Step, pose: &PlanarPose) -> Option<Vec<Step>> {
    let heading_rad = first.stair.front.heading_rad();
    let is_to_come = |step: &&Step| {
        let aside_rad = angle_between(step.stair.front.heading_rad(), heading_rad).abs();
        let beyond_m = step.stair.front.beyond_m([pose.x_m, pose.y_m]);
        aside_rad < FRAC_PI_2 && beyond_m < -NOT_YET_THERE_M
    };
    let climbs = &plan.way.as_ref().ok()?.climbs;
    let steps: Vec<_> = climbs.iter().flat_map(|climb| &climb.steps).collect();
    let at = steps.iter().position(|step| is_same(first, &step.stair))?;
    let to_come = steps[..at].iter().rev().copied().take_while(is_to_come);
    let follows = |pair: &&[&Step]| {
        let depth_m = depth_m(pair[0], pair[1]);
        depth_m > LEAST_TREAD_M && depth_m < ROOMY_M
    };
    let following = steps[at..].windows(2).take_while(follows);
    let range = at - to_come.count()..=at + following.count();
    Some(steps[range].iter().copied().copied().collect())
}

#[cfg(test)]
mod tests;
