//! From a route to a path: legs that are walked, and legs that are climbed or walked sideways.

use terrain::Terrain;

use super::shortcut::{lay, walk};
use crate::climb_links::{ClimbLinks, Fit, Stride, Way};
use crate::search::Route;
use crate::tuning::LegsTuning;
use crate::{Climb, Path, Sidle};

/// Two places are one up to this, m: a rounding guard.
const NO_WAY_M: f64 = 1e-9;

impl Path {
    /// Goes along a route over ways up to `worst`, straightened by these weights of the cells, and ends at `end_m` where that ends in a cell. It ends where a way begins that is in
    /// doubt.
    pub(crate) fn go_along(
        &mut self,
        (terrain, weights): (&Terrain, &[f32]),
        links: &ClimbLinks,
        (route, worst): (&Route, Fit),
        end_m: impl Fn(usize) -> [f64; 2],
        tuning: &LegsTuning,
    ) {
        if let (Some(&last), false) = (route.cells.last(), route.corners.is_empty()) {
            return self.walk_corners(terrain, &route.corners, end_m(last as usize));
        }
        let mut first = 0;
        for (i, pair) in route.cells.windows(2).enumerate() {
            let Some(way) = links.between(terrain, pair[0], pair[1], worst) else {
                continue;
            };
            self.walk(
                (terrain, weights),
                tuning,
                &route.cells[first..=i],
                way.enter_m,
            );
            if way.fit != Fit::Holds {
                return;
            }
            self.climb(terrain, tuning, links.strides(way), way);
            first = i + 1;
        }
        if let Some(&last) = route.cells.last()
            && (last as usize) < terrain.weights.len()
        {
            let end_m = end_m(last as usize);
            self.walk((terrain, weights), tuning, &route.cells[first..], end_m);
        }
    }

    fn walk(
        &mut self,
        ground: (&Terrain, &[f32]),
        tuning: &LegsTuning,
        cells: &[u32],
        end_m: [f64; 2],
    ) {
        let here = self.points_m.last() == Some(&end_m);
        if !(here && cells.len() == 1) {
            let points_m = &mut self.points_m;
            walk(points_m, ground, tuning.straighter, (cells, end_m));
        }
    }

    /// Walks a way that is not bound to the middles of cells: it is as straight as it should be.
    fn walk_corners(&mut self, terrain: &Terrain, corners: &[[f64; 2]], end_m: [f64; 2]) {
        let lattice = &terrain.lattice;
        let place_m = |corner: &[f64; 2]| {
            [0, 1].map(|axis| lattice.origin_m[axis] + (corner[axis] + 0.5) * lattice.cell_m)
        };
        let between = corners.get(1..corners.len() - 1).unwrap_or_default();
        for place_m in between.iter().map(place_m).chain([end_m]) {
            lay(&mut self.points_m, place_m, lattice.cell_m);
        }
    }

    fn climb(&mut self, terrain: &Terrain, tuning: &LegsTuning, strides: &[Stride], way: &Way) {
        let cell_m = terrain.lattice.cell_m;
        let begin = self.points_m.len() - 1;
        for stride in strides {
            let at_m = self.points_m[self.points_m.len() - 1];
            let away_m = geometry::hypot(at_m[0] - stride.from_m[0], at_m[1] - stride.from_m[1]);
            let from = self.points_m.len() - 1;
            let joined = self.climbs.last_mut().filter(|climb| {
                climb.to_point == from && from > begin && away_m <= tuning.same_place
            });
            if let Some(climb) = joined {
                climb.to_point += 1;
                climb.steps.push(stride.step);
            } else {
                if away_m > NO_WAY_M {
                    lay(&mut self.points_m, stride.from_m, cell_m);
                }
                let from_point = self.points_m.len() - 1;
                self.climbs.push(Climb {
                    from_point,
                    to_point: from_point + 1,
                    steps: vec![stride.step],
                });
            }
            self.points_m.push(stride.to_m);
        }
        if let Some(leave_m) = way.leave_m {
            lay(&mut self.points_m, leave_m, cell_m);
        }
        let end = self.points_m.len() - 1;
        self.spans.push([begin, end]);
        self.sidles.extend(way.turned_rad.map(|heading_rad| Sidle {
            from_point: begin,
            to_point: end,
            heading_rad,
        }));
    }
}
