//! From a route to a path: legs that are walked and legs that are climbed.

use crate::portals::{Fit, Portals, Stride, Way};
use crate::room::distance_m;
use crate::search::Route;
use crate::shortcut::{lay, walk};
use crate::slits::TURNS_RAD;
use crate::terrain::Terrain;
use crate::{AStarConfig, Climb, Path, Sidle};

/// A step begins where the one before it ended when it is no further away than this, m.
const SAME_PLACE_M: f64 = 0.01;

/// A path without what the terrain says of it.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Draft {
    pub(crate) points_m: Vec<[f64; 2]>,
    pub(crate) climbs: Vec<Climb>,
    pub(crate) sidles: Vec<Sidle>,
    /// Ranges of points at stairs or in slits, first and last, with what is walked close to edges.
    pub(crate) spans: Vec<[usize; 2]>,
}

impl Draft {
    /// The path of a route over ways up to `worst`, from `start_m`, that ends at `end_m` where it ends in a cell. It ends
    /// where a way begins that is in doubt.
    pub(crate) fn of(
        terrain: &Terrain,
        portals: &Portals,
        (route, worst): (&Route, Fit),
        start_m: [f64; 2],
        end_m: impl Fn(usize) -> [f64; 2],
    ) -> Self {
        let mut draft = Self {
            points_m: vec![start_m],
            ..Self::default()
        };
        let mut first = 0;
        for (i, pair) in route.cells.windows(2).enumerate() {
            let Some(way) = link_between(terrain, portals, pair[0], pair[1], worst) else {
                continue;
            };
            draft.walk(terrain, &route.cells[first..=i], way.enter_m);
            if way.fit != Fit::Holds {
                return draft;
            }
            draft.climb(terrain, portals.strides(way), way);
            first = i + 1;
        }
        if let Some(&last) = route.cells.last()
            && (last as usize) < terrain.weights.len()
        {
            draft.walk(terrain, &route.cells[first..], end_m(last as usize));
        }
        draft
    }

    fn walk(&mut self, terrain: &Terrain, cells: &[u32], end_m: [f64; 2]) {
        let here = self.points_m.last() == Some(&end_m);
        if !(here && cells.len() == 1) {
            walk(&mut self.points_m, terrain, cells, end_m);
        }
    }

    fn climb(&mut self, terrain: &Terrain, strides: &[Stride], way: &Way) {
        let cell_m = terrain.lattice.cell_m;
        let begin = self.points_m.len() - 1;
        for stride in strides {
            let at_m = self.points_m[self.points_m.len() - 1];
            let away_m = (at_m[0] - stride.from_m[0]).hypot(at_m[1] - stride.from_m[1]);
            let from = self.points_m.len() - 1;
            let joined = self
                .climbs
                .last_mut()
                .filter(|climb| climb.to_point == from && from > begin && away_m <= SAME_PLACE_M);
            if let Some(climb) = joined {
                climb.to_point += 1;
                climb.steps.push(stride.step);
            } else {
                if away_m > 1e-9 {
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

    /// Number of steps.
    pub(crate) fn steps(&self) -> usize {
        self.climbs.iter().map(|climb| climb.steps.len()).sum()
    }

    /// Whether the piece from a point to the next lies at stairs.
    pub(crate) fn at_stairs(&self, piece: usize) -> bool {
        self.spans
            .iter()
            .any(|span| (span[0]..span[1]).contains(&piece))
    }

    /// The point at which the robot stands on a tread before a climb: where it is, or where the climb before ended at these
    /// stairs.
    pub(crate) fn tread_before(&self, index: usize) -> Option<usize> {
        let from = self.climbs[index].from_point;
        if from == 0 {
            return Some(0);
        }
        let before = self.climbs[..index].last()?.to_point;
        let here = |span: &[usize; 2]| span[0] < before && from < span[1];
        self.spans.iter().any(here).then_some(before)
    }

    /// The leg that is walked sideways to which the piece from a point to the next belongs.
    fn sidle_at(&self, piece: usize) -> Option<&Sidle> {
        let holds = |sidle: &&Sidle| (sidle.from_point..sidle.to_point).contains(&piece);
        self.sidles.iter().find(holds)
    }

    /// With clearance, unknown parts and cost under this terrain.
    pub(crate) fn annotate(&self, terrain: &Terrain, config: &AStarConfig) -> Path {
        let points_m = self.points_m.clone();
        let index = |point: &[f64; 2]| terrain.index_at(*point);
        let unknown = points_m
            .iter()
            .map(|p| index(p).is_none_or(|i| terrain.unknown[i]))
            .collect();
        let clearance_m = points_m
            .iter()
            .map(|p| index(p).map_or(f64::INFINITY, |i| terrain.clearance_m(i)))
            .collect();
        let pieces = points_m.windows(2).enumerate();
        let walked_m: f64 = pieces
            .map(|(i, pair)| {
                if let Some(sidle) = self.sidle_at(i) {
                    distance_m(pair[0], pair[1])
                        * terrain
                            .sideways_weight(pair[1], sidle.heading_rad, 0.0, config)
                            .unwrap_or(1.0 + config.sideways_cost)
                } else if self.at_stairs(i) {
                    distance_m(pair[0], pair[1])
                } else {
                    let cost = terrain.straight_cost_m(pair[0], pair[1]);
                    cost.unwrap_or(f64::INFINITY)
                }
            })
            .sum();
        Path {
            points_m,
            unknown,
            clearance_m,
            climbs: self.climbs.clone(),
            sidles: self.sidles.clone(),
            cost_m: walked_m
                + config.climb_cost * self.steps() as f64
                + config.turn_cost * TURNS_RAD * self.sidles.len() as f64,
        }
    }
}

/// The link that leads from one node of a route to the next, if they are not neighbouring cells: the cheapest of those that
/// fit as well as `worst`.
pub(crate) fn link_between<'a>(
    terrain: &Terrain,
    portals: &'a Portals,
    from: u32,
    to: u32,
    worst: Fit,
) -> Option<&'a Way> {
    let cols = terrain.cols;
    let place = |cell: u32| (cell as usize % cols, cell as usize / cols);
    let ((a, b), (c, d)) = (place(from), place(to));
    let neighbours = a.abs_diff(c) <= 1 && b.abs_diff(d) <= 1;
    if neighbours && (to as usize) < terrain.weights.len() {
        return None;
    }
    let links = portals.links.from(from as usize);
    let joining = links.filter(|&(index, link)| link.to == to && portals.way(index).fit <= worst);
    let best = joining.min_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
    best.map(|(index, _)| portals.way(index))
}
