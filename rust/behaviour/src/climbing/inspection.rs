//! Stairs that a plan needs and does not use yet: too little of them is known from afar, so they are looked at from near by.

use geometry::{Map, PlanarPose, distance_m};
use mapping::FloorView;
use planning::{Path, Plan, Step};
use stairs::Stair;
use terrain::support::{is_roomy, may_be_level_floor};

use crate::climbing::flight::is_step;
use crate::climbing::leg::align_pose;
use crate::climbing::placement::Before;
use crate::climbing::tuning::InspectionTuning;
use crate::machine::Tick;

/// Where to go and what to look at there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Inspection {
    /// Where to stand.
    pub(crate) pose: PlanarPose,
    /// Middle of the nearest edge.
    pub(crate) edge_m: [f64; 2],
}

impl Inspection {
    /// The nearest stair that was not looked at from near by, where the plan has no way, or none to the goal's level.
    pub(crate) fn find(
        tick: &Tick<'_>,
        before: &Before<'_>,
        room_m: f64,
        inspected: &[[f64; 2]],
    ) -> Option<Self> {
        let situation = tick.situation;
        let tuning = &before.config.tuning.inspection;
        let no_way = situation.plan?.way.is_err();
        if !no_way && !tick.goal_is_elsewhere(before.climbing.floor_max) {
            return None;
        }
        situation
            .stairs
            .stairs
            .iter()
            .filter(|stair| no_way || is_inviting(stair, before))
            .filter_map(|stair| Self::of(stair, before))
            .filter(|found| {
                let away_m = |place: &[f64; 2]| distance_m(*place, found.edge_m);
                !inspected
                    .iter()
                    .any(|place| away_m(place) < tuning.inspected)
            })
            .filter(|found| found.is_free(situation.view, tick, room_m, before))
            .min_by(|a, b| a.away_m(&tick.pose).total_cmp(&b.away_m(&tick.pose)))
    }

    fn of(stair: &Stair<Map>, before: &Before<'_>) -> Option<Self> {
        let tuning = &before.config.tuning.inspection;
        let rise_m = stair.height_m() - before.ground_m;
        let edge_m = stair.front.middle_m();
        let here_m = [before.pose.x_m, before.pose.y_m];
        let adjacent = rise_m.abs() > before.climbing.floor_max && rise_m.abs() < tuning.highest;
        let ahead = stair.front.beyond_m(here_m) < 0.0;
        if !(adjacent && ahead && distance_m(edge_m, here_m) < tuning.farthest) {
            return None;
        }
        let step = Step {
            stair: *stair,
            rise_m,
            crossing_m: edge_m,
        };
        Some(Self {
            pose: align_pose(&step, before.config, before.climbing, before.feet),
            edge_m,
        })
    }

    fn away_m(&self, pose: &PlanarPose) -> f64 {
        self.pose.distance_m(pose)
    }

    /// Whether a robot here has come near enough.
    pub(crate) fn is_reached(&self, pose: &PlanarPose, tuning: &InspectionTuning) -> bool {
        self.away_m(pose) < tuning.near
    }

    /// Whether nothing is known to stand on the straight way there, and no other level.
    fn is_free(&self, view: &FloorView, tick: &Tick<'_>, room_m: f64, before: &Before<'_>) -> bool {
        let spacing_m = before.config.tuning.inspection.spacing;
        let level_m = before.climbing.levels.same;
        places(&tick.pose, [self.pose.x_m, self.pose.y_m], spacing_m).all(|place_m| {
            is_roomy(view, place_m, room_m)
                && may_be_level_floor(view, place_m, tick.ground_m, level_m)
        })
    }

    /// A plan that leads there.
    pub(crate) fn plan(&self, from: &PlanarPose, room_m: f64, tuning: &InspectionTuning) -> Plan {
        straight_plan(from, [self.pose.x_m, self.pose.y_m], room_m, tuning)
    }
}

/// Whether a stair looks as if it could be stepped on, or may where it has not been seen to end: where the plan has a way,
/// nothing less is worth a detour.
fn is_inviting(stair: &Stair<Map>, before: &Before<'_>) -> bool {
    let rise_m = stair.height_m() - before.ground_m;
    let needed_m = before.feet.pair_width_m + 2.0 * before.climbing.side_room;
    let ends = stair.seen_ends.left > 0 && stair.seen_ends.right > 0;
    is_step(rise_m, before.climbing) && (!ends || stair.front.length_m() >= needed_m)
}

/// A plan that leads straight to a place, with so much room on the way, m.
pub(crate) fn straight_plan(
    from: &PlanarPose,
    to_m: [f64; 2],
    room_m: f64,
    tuning: &InspectionTuning,
) -> Plan {
    let points_m: Vec<_> = places(from, to_m, tuning.spacing).collect();
    Plan {
        way: Ok(Path {
            unknown: vec![false; points_m.len()],
            clearance_m: vec![room_m; points_m.len()],
            cost_m: distance_m([from.x_m, from.y_m], to_m),
            points_m,
            ..Path::default()
        }),
        replanned: false,
    }
}

/// Places on a straight way.
fn places(
    from: &PlanarPose,
    to_m: [f64; 2],
    spacing_m: f64,
) -> impl Iterator<Item = [f64; 2]> + use<> {
    let from_m = [from.x_m, from.y_m];
    let count = (distance_m(from_m, to_m) / spacing_m).ceil().max(1.0) as usize;
    (0..=count).map(move |i| {
        let share = i as f64 / count as f64;
        let at = |axis: usize| from_m[axis] + (to_m[axis] - from_m[axis]) * share;
        [at(0), at(1)]
    })
}

#[cfg(test)]
mod tests {
    use stairs::ClimbingConfig;

    use super::*;
    use crate::climbing::simulation::{FEET, stair};
    use crate::climbing::tests::up;
    use crate::{Outcome, StairClimbingConfig};

    #[test]
    fn stairs_too_narrow_for_the_feet_invite_only_while_they_were_not_seen_to_end() {
        let (config, climbing) = (StairClimbingConfig::default(), ClimbingConfig::default());
        let before = Before {
            config: &config,
            climbing: &climbing,
            feet: &FEET,
            pose: PlanarPose::default(),
            ground_m: 0.0,
        };
        let invites = |width_m: f64, left: usize, right: usize| {
            let mut stair = stair([0.6, 0.0, 0.0], [0.72, 0.0, 0.0], 0.03, width_m);
            (stair.seen_ends.left, stair.seen_ends.right) = (left, right);
            is_inviting(&stair, &before)
        };
        assert!(invites(0.3, 100, 100));
        assert!(!invites(0.15, 100, 100));
        assert!(invites(0.15, 100, 0) && invites(0.15, 0, 100));
    }

    /// What was lost may be searched for a few times only; stairs that are looked at from near by were not lost.
    #[test]
    fn stairs_are_inspected_and_climbed_after_as_many_searches_as_are_allowed() {
        let mut simulation = up(PlanarPose::new(-0.3, 0.0, 0.0));
        simulation.goal.height_m = Some(0.12);
        simulation.planned_within_m = 0.0;
        let allowed = simulation.behaviour.walking.config().tries;
        simulation.behaviour.memory.tries.searches = allowed;
        simulation.run_until(60.0, |simulation| {
            !simulation.behaviour.ahead.inspected.is_empty()
        });
        assert_eq!(simulation.behaviour.memory.tries.searches, allowed);
        simulation.planned_within_m = f64::INFINITY;
        let (outcome, _) = simulation.run(90.0);
        assert_eq!(
            outcome,
            Some(Outcome::GoalReached),
            "{:?}",
            simulation.states
        );
    }
}
