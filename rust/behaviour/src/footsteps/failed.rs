//! What failed where the robot steps: nothing is planned there until it walks again.

use geometry::{Cell, CellArea, PlanarPose};
use mapping::HeightMap;

use crate::{Footstep, Misstep};

/// Where feet found no ground, or met something, and what stayed unseen from near by: nothing is planned there until the robot walks again.
#[derive(Debug, Clone, Default)]
pub(super) struct Failed {
    feet: Vec<(Footstep, Misstep)>,
    /// Places that were looked at and stayed unseen, m.
    unseen_m: Vec<[f64; 2]>,
    /// Places that were looked at, m, and how often.
    looked_at: Vec<([f64; 2], u32)>,
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

    /// A place was looked at once more; whether that was so often, with what lies so near to it, m, that it counts as unseen for good.
    pub(super) fn look_at(&mut self, place_m: [f64; 2], near_m: f64, most: u32) -> bool {
        let near = |other: &&mut ([f64; 2], u32)| geometry::distance_m(other.0, place_m) < near_m;
        let looks = if let Some((_, looks)) = self.looked_at.iter_mut().find(near) {
            *looks += 1;
            *looks
        } else {
            self.looked_at.push((place_m, 1));
            1
        };
        let vain = looks >= most;
        if vain {
            self.note_unseen(place_m);
        }
        vain
    }

    /// The places that stayed unseen, m.
    pub(super) fn unseen_m(&self) -> &[[f64; 2]] {
        &self.unseen_m
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

    /// Moves the ground under soles of this half length and breadth, m, that failed, of legs that climb so high, m: out of
    /// reach below where there was none, and to where nothing bears where something was in the way.
    pub(super) fn take_from(&self, map: &mut HeightMap, half_m: [f64; 2], rise_m: f64) {
        let out_of_reach_m = 2.0 * rise_m;
        for &[x_m, y_m] in &self.unseen_m {
            let place = PlanarPose::new(x_m, y_m, 0.0);
            for cell in cells_under(map, &place, [half_m[0]; 2]) {
                if map.height_m(cell).is_none() && map.blurred_m(cell).is_none() {
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
            for cell in cells_under(map, &hold.pose, half_m) {
                match misstep {
                    Misstep::NoGround => {
                        map.set(cell, (hold.height_m - out_of_reach_m) as f32, 0.0);
                    }
                    // Nothing bears there, from however high a foot comes, and the body has room above it.
                    Misstep::Obstructed | Misstep::Buckled(_) => {
                        map.set_blurred(cell, (hold.height_m + rise_m) as f32);
                    }
                }
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

#[cfg(test)]
mod tests {
    use geometry::{Grid, Lattice};
    use robot::Side;

    use super::*;

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
            slope: [0.0; 2],
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
        let mut met = Failed::default();
        met.note(hold, Misstep::Obstructed);
        met.note(hold, Misstep::Obstructed);
        // No foot stands there, and none goes through it; the body has room.
        let met = map(&met);
        assert_eq!(at(&met, 0.5), None);
        let about_m = met.blurred_m(lattice.cell_at(0.5, 0.5)).unwrap();
        assert!((about_m - 0.08).abs() < 1e-6);
        failed.note_unseen([0.2, 0.2]);
        assert_eq!(at(&map(&failed), 0.2), Some(HeightMap::BOTTOMLESS_M));
        assert_eq!(at(&map(&failed), 0.22), Some(0.03));
        assert!(!failed.look_at([0.4, 0.4], 0.1, 2));
        assert!(!failed.look_at([0.6, 0.4], 0.1, 2));
        assert!(failed.look_at([0.42, 0.4], 0.1, 2));
        assert_eq!(failed.unseen(), 2);
        failed.forget();
        assert_eq!(at(&map(&failed), 0.2), None);
    }
}
