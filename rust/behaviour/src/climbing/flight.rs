//! The steps ahead that the robot knows: the memorised one and those behind it (003, section V.C).

use geometry::{Map, PlanarPose, angle_between};
use planning::{Plan, Step};
use stairs::{ClimbingConfig, Edge, Stair, Staircase};

/// Two sights of one stair differ by less than this in height, m,
pub(crate) const SAME_HEIGHT_M: f64 = 0.012;
/// in the place of the front edge, m,
const SAME_PLACE_M: f64 = 0.05;
/// where it was measured before; else than this, m,
const VAGUE_PLACE_M: f64 = 0.09;
/// and in its heading, rad.
const SAME_HEADING_RAD: f64 = 0.4;
/// An edge nearer than this to the robot's middle is out of view: what was measured before is better than what is thought
/// of it now, m.
const OUT_OF_VIEW_M: f64 = 0.17;
/// A step follows another when its front edge is no further than this behind the other's back edge, m.
const JOINT_M: f64 = 0.06;

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

    /// Takes over the steps of a plan's leg, but for the edges that the robot is too near to see, and where it crosses them.
    /// A plan that ends short takes nothing away that is still there.
    fn renew(&mut self, steps: &[Step], stairs: &Staircase, pose: &PlanarPose) {
        let before = std::mem::take(&mut self.steps);
        self.adopt(steps);
        if let Some(first) = before.first() {
            keep_lane(&mut self.steps, first);
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
            let there = |old: &&Step| stairs.stairs.iter().any(|stair| covers(stair, old));
            self.steps
                .extend(before[last + 1..].iter().take_while(there).copied());
            look_up(&mut self.steps[planned..], stairs, pose);
        }
    }

    /// Takes over the steps of a plan's leg.
    pub(crate) fn adopt(&mut self, steps: &[Step]) {
        self.steps.clear();
        self.steps.extend_from_slice(steps);
        self.lost_s = 0.0;
        self.unplanned_s = 0.0;
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
        self.lost_s > LOST_S || self.unplanned_s > UNPLANNED_S
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
            self.renew(steps, stairs, pose);
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

/// Gives each step the stair that it is by now, and has it cross that one's edge.
fn look_up(steps: &mut [Step], stairs: &Staircase, pose: &PlanarPose) {
    for step in steps {
        if let Some(stair) = stairs.stairs.iter().find(|stair| is_same(step, stair)) {
            let old = *step;
            step.stair = *stair;
            let (sin, cos) = stair.front.heading_rad().sin_cos();
            let off_m = stair.front.beyond_m(old.crossing_m);
            step.crossing_m[0] -= off_m * cos;
            step.crossing_m[1] -= off_m * sin;
            keep_better_edge(step, &old, pose);
        }
    }
}

/// Where the first step is crossed stays: a plan may cross a wide edge anywhere, and the robot would follow to and fro.
fn keep_lane(steps: &mut [Step], before: &Step) {
    let left_m = |edge: &Edge<Map>, [x_m, y_m]: [f64; 2], from_m: [f64; 2]| {
        let (sin, cos) = edge.heading_rad().sin_cos();
        (y_m - from_m[1]) * cos - (x_m - from_m[0]) * sin
    };
    let aside_m = steps.first().map_or(0.0, |first| {
        left_m(&first.stair.front, before.crossing_m, first.crossing_m)
    });
    for step in steps {
        let (sin, cos) = step.stair.front.heading_rad().sin_cos();
        step.crossing_m[0] -= aside_m * sin;
        step.crossing_m[1] += aside_m * cos;
    }
}

/// An edge stays where it was measured while it is out of view, and when what is said of it now is worth less. One that was
/// not measured goes where it is measured.
fn keep_better_edge(step: &mut Step, old: &Step, pose: &PlanarPose) {
    const WORSE: f64 = 2.0;
    let away_m = -old.stair.front.beyond_m([pose.x_m, pose.y_m]);
    let out_of_view = away_m < OUT_OF_VIEW_M;
    let stays = match (&old.stair.front_fit, &step.stair.front_fit) {
        (Some(old), Some(new)) => out_of_view || new.place_sigma_m > WORSE * old.place_sigma_m,
        (Some(_), None) => true,
        (None, Some(_)) => false,
        (None, None) => out_of_view,
    };
    if stays {
        step.stair.front = old.stair.front;
        step.stair.front_fit = old.stair.front_fit;
        step.stair.left_margin_m = old.stair.left_margin_m;
        step.stair.right_margin_m = old.stair.right_margin_m;
        step.crossing_m = old.crossing_m;
        step.rise_m = old.rise_m;
    }
}

/// Whether a stair is where the feet would come to stand on a step.
pub(crate) fn covers(stair: &Stair<Map>, step: &Step) -> bool {
    const ON_IT_M: f64 = 0.05;
    const MARGIN_M: f64 = 0.02;
    let (sin, cos) = step.stair.front.heading_rad().sin_cos();
    let [x_m, y_m] = step.crossing_m;
    let place_m = [x_m + cos * ON_IT_M, y_m + sin * ON_IT_M];
    (step.stair.height_m() - stair.height_m()).abs() < SAME_HEIGHT_M
        && stair.front.beyond_m(place_m) > -MARGIN_M
        && stair.back.beyond_m(place_m) < MARGIN_M
}

/// The plan's steps from this one on, and those before it that came to be seen while the robot was not yet at their edges: from
/// far away two low steps are one.
fn steps_from<'a>(plan: &'a Plan, first: &Step, pose: &PlanarPose) -> Option<&'a [Step]> {
    let is_to_come =
        |step: &&Step| step.stair.front.beyond_m([pose.x_m, pose.y_m]) < -NOT_YET_THERE_M;
    let path = plan.way.as_ref().ok()?;
    path.climbs.iter().find_map(|climb| {
        let at = climb
            .steps
            .iter()
            .position(|step| is_same(first, &step.stair))?;
        let to_come = climb.steps[..at].iter().rev().take_while(is_to_come);
        Some(&climb.steps[at - to_come.count()..])
    })
}

/// Whether a stair is the one of a step.
pub(crate) fn is_same(step: &Step, stair: &Stair<Map>) -> bool {
    let turned_rad = angle_between(step.stair.front.heading_rad(), stair.front.heading_rad());
    let same_place_m = if step.stair.front_fit.is_some() {
        SAME_PLACE_M
    } else {
        VAGUE_PLACE_M
    };
    (step.stair.height_m() - stair.height_m()).abs() < SAME_HEIGHT_M
        && stair.front.beyond_m(step.crossing_m).abs() < same_place_m
        && turned_rad.abs() < SAME_HEADING_RAD
}

/// The step behind another by the stairs alone: the nearest whose change of height a parameter set takes.
fn following(last: &Step, stairs: &Staircase, config: &ClimbingConfig) -> Option<Step> {
    let heading_rad = last.stair.front.heading_rad();
    let middle = last.stair.back.middle().inner;
    let end_m = last.stair.front.beyond_m([middle.x, middle.y]) + JOINT_M;
    stairs
        .stairs
        .iter()
        .filter_map(|stair| {
            let rise_m = stair.height_m() - last.stair.height_m();
            let (depth_m, crossing_m) = ahead(stair, last.crossing_m, heading_rad)?;
            let near = depth_m > JOINT_M && depth_m < end_m;
            (near && is_step(rise_m, config)).then_some((depth_m, *stair, rise_m, crossing_m))
        })
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, stair, rise_m, crossing_m)| Step {
            stair,
            rise_m,
            crossing_m,
        })
}

/// The nearest stair ahead of a robot that a parameter set takes (003, section V), no further than `reach_m`.
pub(crate) fn nearest(
    stairs: &Staircase,
    pose: &PlanarPose,
    ground_m: f64,
    reach_m: f64,
    config: &ClimbingConfig,
) -> Option<Step> {
    stairs
        .stairs
        .iter()
        .filter_map(|stair| {
            let rise_m = stair.height_m() - ground_m;
            let (away_m, crossing_m) = ahead(stair, [pose.x_m, pose.y_m], pose.yaw_rad)?;
            let near = away_m > 0.0 && away_m < reach_m;
            (near && is_step(rise_m, config)).then_some((away_m, *stair, rise_m, crossing_m))
        })
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, stair, rise_m, crossing_m)| Step {
            stair,
            rise_m,
            crossing_m,
        })
}

/// Whether a change of height falls between the thresholds of a parameter set.
pub(crate) fn is_step(rise_m: f64, config: &ClimbingConfig) -> bool {
    let set = config.set_for(rise_m);
    let tolerance_m = config.tolerance;
    rise_m > set.step_min_z - tolerance_m && rise_m < set.step_max_z + tolerance_m
}

/// How far ahead of a place in this direction the stair's front edge is crossed, and where; `None` where it is not.
fn ahead(stair: &Stair<Map>, [x_m, y_m]: [f64; 2], heading_rad: f64) -> Option<(f64, [f64; 2])> {
    let edge = &stair.front;
    let towards = angle_between(heading_rad, edge.heading_rad()).cos();
    if towards < 0.5 {
        return None;
    }
    let away_m = -edge.beyond_m([x_m, y_m]) / towards;
    let (sin, cos) = heading_rad.sin_cos();
    let crossing_m = [x_m + cos * away_m, y_m + sin * away_m];
    let middle = edge.middle().inner;
    let aside_m = (crossing_m[0] - middle.x).hypot(crossing_m[1] - middle.y);
    (aside_m < 0.5 * edge.length_m()).then_some((away_m, crossing_m))
}

#[cfg(test)]
mod tests;
