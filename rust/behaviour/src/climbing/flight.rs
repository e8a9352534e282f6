//! The steps ahead that the robot knows: the memorised one and those behind it (003, section V.C).

mod lookup;

use std::f64::consts::FRAC_PI_2;

use geometry::{PlanarPose, angle_between, same_level};
use planning::{Plan, Step};
use stairs::{ClimbingConfig, LevelsConfig, Staircase};

use crate::climbing::tuning::{FlightTuning, StairClimbingTuning};
use lookup::{Lookup, following, is_same};
pub(crate) use lookup::{
    StepRules, covers, crosses_another, depth_m, is_step, nearest, settled_rise_m,
};

/// The steps ahead, in their order. In the map, so that the robot's own motion moves none of them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Flight {
    /// All of them.
    pub(crate) steps: Vec<Step>,
    /// How long neither the plan nor the view has shown the first of them, s.
    pub(crate) lost_s: f64,
    /// How long the plan has not led over it, s.
    pub(crate) unplanned_s: f64,
    /// How far to the left of the lane the plan now crosses the first step, m.
    elsewhere_m: f64,
    tuning: FlightTuning,
    lookup: Lookup,
}

impl Flight {
    /// No step is known yet.
    pub(crate) fn new(tuning: &StairClimbingTuning, levels: &LevelsConfig) -> Self {
        Self {
            tuning: tuning.flight.clone(),
            lookup: Lookup {
                tuning: tuning.lookup.clone(),
                levels: levels.clone(),
            },
            ..Self::default()
        }
    }

    /// Which sights are of the same step.
    pub(crate) const fn lookup(&self) -> &Lookup {
        &self.lookup
    }

    /// The memorised step, *step₁* of 003.
    pub(crate) fn first(&self) -> Option<&Step> {
        self.steps.first()
    }

    /// The one behind it, *step₂* of 003.
    pub(crate) fn second(&self) -> Option<&Step> {
        self.steps.get(1)
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
            last = before
                .iter()
                .position(|old| is_same(old, &step.stair, &self.lookup));
            if let Some(at) = last {
                keep_better_edge(step, &before[at], pose, (&self.tuning, &self.lookup));
            }
        }
        if let Some(last) = last {
            let planned = self.steps.len();
            let there = |old: &Step| {
                stairs
                    .stairs
                    .iter()
                    .any(|stair| covers(stair, old, &self.lookup))
            };
            for old in &before[last + 1..] {
                let behind = |last: &Step| depth_m(last, old) > self.lookup.tuning.least_tread;
                if !(there(old) && self.steps.last().is_some_and(behind)) {
                    break;
                }
                self.steps.push(*old);
            }
            look_up(
                &mut self.steps[planned..],
                stairs,
                pose,
                (&self.tuning, &self.lookup),
            );
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
        let changes = self.elsewhere_m.abs() > self.tuning.lane;
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
        self.is_out_of_sight() || self.unplanned_s > self.tuning.unplanned_after
    }

    /// Whether neither the view nor the plan shows the first step.
    pub(crate) fn is_out_of_sight(&self) -> bool {
        self.lost_s > self.tuning.lost_after
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
        if let Some(steps) = plan.and_then(|plan| self.steps_from(plan, &first, pose)) {
            self.renew(&steps, stairs, pose);
            return;
        }
        if stairs
            .stairs
            .iter()
            .any(|stair| covers(stair, &first, &self.lookup))
        {
            self.lost_s = 0.0;
        }
        look_up(&mut self.steps, stairs, pose, (&self.tuning, &self.lookup));
        let rules = StepRules {
            climbing: config,
            lookup: &self.lookup,
        };
        while let Some(next) = self
            .steps
            .last()
            .and_then(|last| following(last, stairs, &rules))
        {
            self.steps.push(next);
        }
    }

    /// The plan's steps from this one on, as far as no tread between them is roomy, and those before it that came to be seen while
    /// the robot was not yet at their edges: from far away two low steps are one. The plan may walk on a tread between two of them.
    /// One that leads the other way is none of them: halfway over an edge a plan may begin with going back over it.
    fn steps_from(&self, plan: &Plan, first: &Step, pose: &PlanarPose) -> Option<Vec<Step>> {
        let not_yet_m = self.tuning.not_yet_there;
        let heading_rad = first.stair.front.heading_rad();
        let is_to_come = |step: &&Step| {
            let aside_rad = angle_between(step.stair.front.heading_rad(), heading_rad).abs();
            let beyond_m = step.stair.front.beyond_m([pose.x_m, pose.y_m]);
            aside_rad < FRAC_PI_2 && beyond_m < -not_yet_m
        };
        let climbs = &plan.way.as_ref().ok()?.climbs;
        let steps: Vec<_> = climbs.iter().flat_map(|climb| &climb.steps).collect();
        let at = steps
            .iter()
            .position(|step| is_same(first, &step.stair, &self.lookup))?;
        let to_come = steps[..at].iter().rev().copied().take_while(is_to_come);
        let follows = |pair: &&[&Step]| {
            let depth_m = depth_m(pair[0], pair[1]);
            depth_m > self.lookup.tuning.least_tread && depth_m < self.tuning.roomy
        };
        let following = steps[at..].windows(2).take_while(follows);
        let range = at - to_come.count()..=at + following.count();
        Some(steps[range].iter().copied().copied().collect())
    }
}

/// Gives each step the stair that it is by now, and has it cross that one's edge. A stair that is seen to be higher by now may be none
/// that the robot climbs.
fn look_up(
    steps: &mut [Step],
    stairs: &Staircase,
    pose: &PlanarPose,
    tuning: (&FlightTuning, &Lookup),
) {
    let mut before_higher_m = 0.0;
    for step in steps {
        let mut higher_m = 0.0;
        if let Some(stair) = stairs
            .stairs
            .iter()
            .find(|stair| is_same(step, stair, tuning.1))
        {
            let old = *step;
            step.stair = *stair;
            higher_m = stair.height_m() - old.stair.height_m();
            let (sin, cos) = libm::sincos(stair.front.heading_rad());
            let off_m = stair.front.beyond_m(old.crossing_m);
            step.crossing_m[0] -= off_m * cos;
            step.crossing_m[1] -= off_m * sin;
            keep_better_edge(step, &old, pose, tuning);
        }
        step.rise_m += higher_m - before_higher_m;
        before_higher_m = higher_m;
    }
}

/// How far to the left of where it was crossed before the first step is crossed now, m.
fn aside_m(steps: &[Step], before: &Step) -> f64 {
    steps.first().map_or(0.0, |first| {
        let (sin, cos) = libm::sincos(first.stair.front.heading_rad());
        let [x_m, y_m] = first.crossing_m;
        let [from_x_m, from_y_m] = before.crossing_m;
        (y_m - from_y_m) * cos - (x_m - from_x_m) * sin
    })
}

/// Moves where steps are crossed to the left.
fn shift(steps: &mut [Step], left_m: f64) {
    for step in steps {
        let (sin, cos) = libm::sincos(step.stair.front.heading_rad());
        step.crossing_m[0] -= left_m * sin;
        step.crossing_m[1] += left_m * cos;
    }
}

/// An edge stays where it was measured while it is out of view, and when what is said of it now is worth less. One that was
/// not measured goes where it is measured, and one of which but a piece was known to where more of it is.
fn keep_better_edge(
    step: &mut Step,
    old: &Step,
    pose: &PlanarPose,
    (tuning, lookup): (&FlightTuning, &Lookup),
) {
    let worse = tuning.worse;
    let away_m = -old.stair.front.beyond_m([pose.x_m, pose.y_m]);
    let out_of_view = away_m < tuning.out_of_view;
    let stays = match (&old.stair.front_fit, &step.stair.front_fit) {
        (Some(old), Some(new)) => out_of_view || new.place_sigma_m > worse * old.place_sigma_m,
        (Some(_), None) => true,
        (None, Some(_)) => false,
        (None, None) => out_of_view,
    };
    let was_a_piece = old.stair.front.length_m() < tuning.piece * step.stair.front.length_m();
    if stays && !was_a_piece {
        step.stair.front = old.stair.front;
        step.stair.front_fit = old.stair.front_fit;
        step.stair.left_margin_m = old.stair.left_margin_m;
        step.stair.right_margin_m = old.stair.right_margin_m;
        step.crossing_m = old.crossing_m;
        if same_level(step.rise_m, old.rise_m, lookup.levels.same) {
            step.rise_m = old.rise_m;
        }
    }
}

#[cfg(test)]
mod tests;
