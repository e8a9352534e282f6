//! Finds steps among the stairs that are known.

use geometry::{Map, PlanarPose, angle_between, distance_m, same_level};
use planning::Step;
use stairs::{ClimbingConfig, LevelsConfig, Stair, Staircase};

use crate::climbing::tuning::StepLookupTuning;

/// Which sights are of the same step.
#[derive(Debug, Clone, Default)]
pub(crate) struct Lookup {
    pub(crate) tuning: StepLookupTuning,
    /// Which heights are one level.
    pub(crate) levels: LevelsConfig,
}

/// By what steps are found.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StepRules<'a> {
    /// Which changes of height are steps.
    pub(crate) climbing: &'a ClimbingConfig,
    /// Which sights are of the same step.
    pub(crate) lookup: &'a Lookup,
}

/// From the front edge of a step to that of the next one, along the way, m.
pub(crate) fn depth_m(next: &Step, after: &Step) -> f64 {
    next.stair.front.beyond_m(after.crossing_m)
}

/// Whether a stair is where the feet would come to stand on a step.
pub(crate) fn covers(stair: &Stair<Map>, step: &Step, lookup: &Lookup) -> bool {
    let (on_it_m, margin_m) = (lookup.tuning.on_it, lookup.tuning.margin);
    let (sin, cos) = libm::sincos(step.stair.front.heading_rad());
    let [x_m, y_m] = step.crossing_m;
    let place_m = [x_m + cos * on_it_m, y_m + sin * on_it_m];
    same_level(step.stair.height_m(), stair.height_m(), lookup.levels.same)
        && stair.front.beyond_m(place_m) > -margin_m
        && stair.back.beyond_m(place_m) < margin_m
}

/// Whether a stair is the one of a step.
pub(crate) fn is_same(step: &Step, stair: &Stair<Map>, lookup: &Lookup) -> bool {
    let turned_rad = angle_between(step.stair.front.heading_rad(), stair.front.heading_rad());
    let same_place_m = if step.stair.front_fit.is_some() {
        lookup.tuning.same_place
    } else {
        lookup.tuning.vague_place
    };
    same_level(step.stair.height_m(), stair.height_m(), lookup.levels.same)
        && stair.front.beyond_m(step.crossing_m).abs() < same_place_m
        && turned_rad.abs() < lookup.tuning.same_heading
}

/// The step behind another by the stairs alone: the nearest whose change of height a parameter set takes.
pub(crate) fn following(last: &Step, stairs: &Staircase, rules: &StepRules<'_>) -> Option<Step> {
    let (least_m, joint_m) = (rules.lookup.tuning.least_tread, rules.lookup.tuning.joint);
    let end_m = last.stair.front.beyond_m(last.stair.back.middle_m()) + joint_m;
    let way = (last.crossing_m, last.stair.front.heading_rad());
    let near = |depth_m| depth_m > least_m && depth_m < end_m;
    nearest_where(near, stairs, way, last.stair.height_m(), rules)
}

/// The nearest stair ahead of a robot that a parameter set takes (003, section V), no further than `reach_m`.
pub(crate) fn nearest(
    stairs: &Staircase,
    pose: &PlanarPose,
    ground_m: f64,
    reach_m: f64,
    rules: &StepRules<'_>,
) -> Option<Step> {
    let way = ([pose.x_m, pose.y_m], pose.yaw_rad);
    let near = |away_m| away_m > 0.0 && away_m < reach_m;
    nearest_where(near, stairs, way, ground_m, rules)
}

/// The nearest step from a level on a way, given by a place, m, and a heading, rad, of those whose edge is `near` enough, m.
fn nearest_where(
    near: impl Fn(f64) -> bool,
    stairs: &Staircase,
    (from_m, heading_rad): ([f64; 2], f64),
    level_m: f64,
    rules: &StepRules<'_>,
) -> Option<Step> {
    let step = |stair: &Stair<Map>| {
        let (away_m, crossing_m) = ahead(stair, from_m, heading_rad, &rules.lookup.tuning)?;
        let step = Step {
            stair: *stair,
            rise_m: stair.height_m() - level_m,
            crossing_m,
        };
        (near(away_m) && is_step(step.rise_m, rules.climbing)).then_some((away_m, step))
    };
    let steps = stairs.stairs.iter().filter_map(step);
    let nearest = steps.min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.map(|(_, step)| step)
}

/// Whether a change of height falls between the thresholds of a parameter set.
pub(crate) fn is_step(rise_m: f64, config: &ClimbingConfig) -> bool {
    let set = config.set_for(rise_m);
    let tolerance_m = config.tolerance;
    rise_m > set.step_min_z - tolerance_m && rise_m < set.step_max_z + tolerance_m
}

/// The change of height of a step in mind that counts, m: one that is seen a little above the limit is at the limit. It was not when
/// the step was planned, and heights vary as long as they are seen.
pub(crate) fn settled_rise_m(rise_m: f64, config: &ClimbingConfig, doubt_m: f64) -> f64 {
    let set = config.set_for(rise_m);
    let limit_m = if rise_m > 0.0 {
        set.step_max_z
    } else {
        -set.step_min_z
    };
    let most_m = limit_m + config.tolerance;
    let is_in_doubt = (most_m..=most_m + doubt_m).contains(&rise_m.abs());
    if is_in_doubt {
        most_m.copysign(rise_m)
    } else {
        rise_m
    }
}

/// How far ahead of a place in this direction the stair's front edge is crossed, and where; `None` where it is not.
fn ahead(
    stair: &Stair<Map>,
    [x_m, y_m]: [f64; 2],
    heading_rad: f64,
    lookup: &StepLookupTuning,
) -> Option<(f64, [f64; 2])> {
    let edge = &stair.front;
    let towards = libm::cos(angle_between(heading_rad, edge.heading_rad()));
    if towards < lookup.towards {
        return None;
    }
    let away_m = -edge.beyond_m([x_m, y_m]) / towards;
    let (sin, cos) = libm::sincos(heading_rad);
    let crossing_m = [x_m + cos * away_m, y_m + sin * away_m];
    let aside_m = distance_m(crossing_m, edge.middle_m());
    (aside_m < 0.5 * edge.length_m()).then_some((away_m, crossing_m))
}

/// Whether a robot on the way to where a step is taken from would cross the edge of another one.
pub(crate) fn crosses_another(
    stairs: &Staircase,
    (pose, ground_m): (&PlanarPose, f64),
    to: &PlanarPose,
    step: &Step,
    rules: &StepRules<'_>,
) -> bool {
    nearest(stairs, pose, ground_m, pose.distance_m(to), rules)
        .is_some_and(|other| !is_same(step, &other.stair, rules.lookup))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::climbing::simulation::stair;

    #[test]
    fn the_way_to_a_step_may_cross_its_own_edge_but_no_other_one() {
        let climbing = ClimbingConfig::default();
        let lookup = Lookup {
            tuning: StepLookupTuning::default(),
            levels: climbing.levels.clone(),
        };
        let rules = StepRules {
            climbing: &climbing,
            lookup: &lookup,
        };
        let low = stair([0.07, 0.0, 0.0], [0.25, 0.0, 0.0], 0.018, 0.6);
        let high = stair([0.25, 0.0, 0.0], [0.43, 0.0, 0.0], 0.036, 0.6);
        let stairs = Staircase {
            stairs: vec![low, high],
            ..Staircase::default()
        };
        let step = |stair: Stair<Map>| Step {
            stair,
            rise_m: 0.018,
            crossing_m: [stair.front.middle().inner.x, 0.0],
        };
        let crosses = |to_m: f64, step: &Step| {
            let to = PlanarPose::new(to_m, 0.0, 0.0);
            crosses_another(&stairs, (&PlanarPose::default(), 0.0), &to, step, &rules)
        };
        assert!(crosses(0.21, &step(high)));
        assert!(!crosses(0.03, &step(high)));
        assert!(!crosses(0.08, &step(low)));
    }
}
