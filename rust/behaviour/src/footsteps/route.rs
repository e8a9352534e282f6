//! The steps that are planned: over the ground as it is known now, from where the feet stand.

use geometry::{Cell, CellArea, Goal, PlanarPose};
use mapping::HeightMap;
use planning::footsteps::{
    Blurred, FootstepPlan, FootstepQuestion, NoFootsteps, PlannedFootstep, Unseen,
};
use robot::Side;
use terrain::ground_map::SoleOnGround;

use super::Footsteps;
use crate::machine::Tick;
use crate::{Footstep, Misstep};

/// Where feet found no ground, or met something, and what stayed unseen from near by: nothing is planned there until the robot walks again.
#[derive(Debug, Clone, Default)]
pub(super) struct Failed {
    feet: Vec<(Footstep, Misstep)>,
    /// Places that were looked at and stayed unseen, m.
    unseen_m: Vec<[f64; 2]>,
}

impl Failed {
    /// A foot that was to land here did not.
    pub(super) fn note(&mut self, hold: Footstep, misstep: Misstep) {
        self.feet.push((hold, misstep));
    }

    /// A place that was looked at stayed unseen, m.
    pub(super) fn note_unseen(&mut self, place_m: [f64; 2]) {
        self.unseen_m.push(place_m);
    }

    /// How many places stayed unseen.
    pub(super) fn unseen(&self) -> usize {
        self.unseen_m.len()
    }

    /// What was noted counts no more.
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }

    /// How often a foot failed.
    pub(super) fn count(&self) -> usize {
        self.feet.len()
    }

    /// Moves the ground under soles of this half length and breadth, m, that failed, out of reach of legs that climb so high, m: down where there was none, up where something was in the way.
    fn take_from(&self, map: &mut HeightMap, half_m: [f64; 2], rise_m: f64) {
        let out_of_reach_m = 2.0 * rise_m;
        for &[x_m, y_m] in &self.unseen_m {
            let place = PlanarPose::new(x_m, y_m, 0.0);
            for cell in cells_under(map, &place, [half_m[0]; 2]) {
                if map.height_m(cell).is_none() {
                    map.set(cell, HeightMap::BOTTOMLESS_M, 0.0);
                }
            }
        }
        // One failure may be a matter of balance, and the place is looked at again.
        let again = |hold: &Footstep| {
            let near = |other: &&(Footstep, Misstep)| {
                other.0.pose.distance_m(&hold.pose) < 2.0 * half_m[0]
            };
            self.feet.iter().filter(near).count() > 1
        };
        for (hold, misstep) in self.feet.iter().filter(|(hold, _)| again(hold)) {
            let height_m = match misstep {
                Misstep::NoGround => hold.height_m - out_of_reach_m,
                Misstep::Obstructed => hold.height_m + out_of_reach_m,
            };
            for cell in cells_under(map, &hold.pose, half_m) {
                map.set(cell, height_m as f32, 0.0);
            }
        }
    }
}

/// The cells under a sole.
fn cells_under(
    map: &HeightMap,
    pose: &PlanarPose,
    half_m: [f64; 2],
) -> impl Iterator<Item = Cell> + use<> {
    let reach_m = geometry::hypot(half_m[0], half_m[1]);
    let lattice = map.lattice;
    let area = CellArea {
        min: lattice.cell_at(pose.x_m - reach_m, pose.y_m - reach_m),
        max: lattice.cell_at(pose.x_m + reach_m, pose.y_m + reach_m),
    };
    let from_map = pose.inverse();
    area.cells().filter(move |cell| {
        let [x_m, y_m] = lattice.center_of(*cell);
        let (ahead_m, left_m) = from_map.apply(x_m, y_m);
        ahead_m.abs() <= half_m[0] && left_m.abs() <= half_m[1]
    })
}

impl Footsteps {
    /// Where the soles are in the map.
    pub(super) fn soles(tick: &Tick<'_>) -> [PlanarPose; 2] {
        tick.situation
            .soles
            .map(|sole| tick.pose.compose(&sole.pose))
    }

    /// How high the soles are in the map, m.
    pub(super) fn sole_heights_m(tick: &Tick<'_>) -> [f64; 2] {
        tick.situation
            .soles
            .map(|sole| tick.ground_m + sole.height_m)
    }

    /// Reads the ground around feet that stand here, so high, m.
    pub(super) fn read_ground(
        &mut self,
        tick: &Tick<'_>,
        feet: &[PlanarPose; 2],
        heights_m: [f64; 2],
    ) {
        let limits = *self.layer.limits();
        let half_m = [0.5 * limits.sole.length_m, 0.5 * limits.sole.width_m];
        let (view, stairs) = (tick.situation.view, tick.situation.stairs);
        let around_m = [tick.pose.x_m, tick.pose.y_m];
        let _ = self.ground.read(view, stairs, around_m);
        self.failed
            .take_from(self.ground.map_mut(), half_m, limits.careful_rise_m);
        for (pose, height_m) in feet.iter().zip(heights_m) {
            self.ground.stand_on(&SoleOnGround {
                pose: *pose,
                half_m,
                height_m: height_m as f32,
            });
        }
    }

    /// Plans steps from feet that stand here, over the ground as it was read.
    pub(super) fn plan_from(
        &mut self,
        tick: &Tick<'_>,
        feet: [PlanarPose; 2],
        first: Option<Side>,
    ) -> Result<FootstepPlan, NoFootsteps> {
        // Where the robot looked in vain it goes nearer.
        let nearer = 1.0 / f64::from(1 + self.looks);
        let unseen = Unseen::Priced {
            stop_before_m: self.config.look_from * nearer,
            faces_rad: self.config.faces,
        };
        let mut question = FootstepQuestion {
            feet,
            first,
            unseen,
            blurred: Blurred::Crossed,
        };
        let goal = tick.situation.goal;
        // At its rim it would not be sure to have arrived.
        let inside = Goal {
            radius_m: self.walking.config().arrive_share * goal.radius_m,
            ..*goal
        };
        let mut planned = self.layer.plan_over(self.ground.map(), &question, &inside);
        if planned.is_err() {
            // Where edges are known better once they were looked at from near by, more steps may be possible.
            question.blurred = Blurred::Unseen;
            planned = self.layer.plan_over(self.ground.map(), &question, &inside);
        }
        self.planned = (Some(planned.clone()), self.planned.1 + 1);
        planned
    }

    /// Height of the ground under a foot, m.
    pub(super) fn height_under_m(&self, foot: &PlanarPose) -> Option<f64> {
        let map = self.ground.map();
        let cell = map.lattice.cell_at(foot.x_m, foot.y_m);
        map.height_m(cell).map(f64::from)
    }
}

/// Since when a plan may tell that the robot got on: as it stands and looks, steps that were planned anew on the way count as not taken yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Since {
    /// Since the last plan of a robot that stood.
    Look = 0,
    /// Since the last plan of a robot that stepped.
    Step = 1,
}

/// How far the robot has come, by what its plans cost.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct CostToGo {
    /// The least that the way on has cost, s.
    least_s: Option<f64>,
    /// How often it was found to be longer than it had seemed.
    longer: u32,
}

impl CostToGo {
    /// Takes in what the way on costs; whether that tells that the robot gets on: it is shorter by this than before, or, so often at most,
    /// so much longer that something new is known.
    pub(super) fn gets_on(&mut self, whole_s: f64, by_s: f64, most: u32) -> bool {
        let shorter = self.least_s.is_none_or(|least_s| whole_s < least_s - by_s);
        let longer = self.least_s.is_some_and(|least_s| whole_s > least_s + by_s);
        self.longer += u32::from(longer);
        let counts = shorter || longer && self.longer <= most;
        if counts {
            self.least_s = Some(whole_s);
        }
        counts
    }
}

/// A planned step as the walker is told it, in the map.
pub(super) fn told(step: &PlannedFootstep) -> Footstep {
    Footstep {
        side: step.side,
        pose: step.pose,
        height_m: f64::from(step.foothold.height_m),
        bearing_m: step.foothold.bearing_m.map(f64::from),
        manner: step.manner,
    }
}

/// Both feet, after the one of this side has gone there.
pub(super) fn after(feet: &[PlanarPose; 2], side: Side, to: PlanarPose) -> [PlanarPose; 2] {
    let mut feet = *feet;
    feet[side.index()] = to;
    feet
}

#[cfg(test)]
mod tests {
    use geometry::{Grid, Lattice};

    use super::*;

    #[test]
    fn a_way_that_gets_shorter_gets_on_and_one_that_gets_longer_does_so_often_only() {
        let mut to_go = CostToGo::default();
        let gets_on = [20.0, 19.9, 18.0, 18.2, 25.0, 24.8, 31.0, 40.0]
            .map(|whole_s| to_go.gets_on(whole_s, 0.5, 2));
        assert_eq!(
            gets_on,
            [true, false, true, false, true, false, true, false]
        );
        assert!(to_go.gets_on(30.0, 0.5, 2));
    }

    #[test]
    fn where_a_foot_failed_twice_it_is_not_put_again_and_what_stays_unseen_is_no_way() {
        let lattice = Lattice {
            origin_m: [0.0; 2],
            cell_m: 0.01,
        };
        let hold = Footstep {
            side: Side::Left,
            pose: PlanarPose::new(0.5, 0.5, 0.3),
            height_m: 0.03,
            bearing_m: [-0.05, 0.05],
            manner: planning::footsteps::StepManner::Careful,
        };
        let map = |failed: &Failed| {
            let mut heights_m = Grid::filled(100, 100, 0.03);
            *heights_m.get_mut(lattice.cell_at(0.2, 0.2)).unwrap() = f32::NAN;
            let mut map = HeightMap::new(lattice, heights_m, 0.0);
            failed.take_from(&mut map, [0.05, 0.04], 0.05);
            map
        };
        let at = |map: &HeightMap, place_m: f64| map.height_m(lattice.cell_at(place_m, place_m));
        let mut failed = Failed::default();
        failed.note(hold, Misstep::NoGround);
        assert_eq!(at(&map(&failed), 0.5), Some(0.03));
        failed.note(hold, Misstep::NoGround);
        assert!(at(&map(&failed), 0.5).unwrap() < -0.05);
        failed.note_unseen([0.2, 0.2]);
        assert_eq!(at(&map(&failed), 0.2), Some(HeightMap::BOTTOMLESS_M));
        assert_eq!(at(&map(&failed), 0.22), Some(0.03));
        failed.forget();
        assert_eq!(at(&map(&failed), 0.2), None);
    }
}
