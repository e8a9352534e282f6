//! What is told of a path beside its places: room, what was not seen, cost.

use terrain::Terrain;

use crate::climb_links::room_at_edges::distance_m;
use crate::sideways_passages::TURNS_RAD;
use crate::{AStarConfig, Path, Sidle};

impl Path {
    /// Number of steps.
    pub(crate) fn steps(&self) -> usize {
        self.climbs.iter().map(|climb| climb.steps.len()).sum()
    }

    /// How many of its points were not seen.
    pub(crate) fn unknown_points(&self) -> usize {
        self.unknown.iter().filter(|&&unknown| unknown).count()
    }

    /// Whether the robot is on a leg sideways: until its end no other way is better.
    pub(crate) fn in_passage(&self) -> bool {
        let first = self.sidles.first();
        self.end.is_certain() && first.is_some_and(|sidle| sidle.from_point == 0)
    }

    /// Whether the piece from a point to the next lies at stairs.
    pub(crate) fn at_stairs(&self, piece: usize) -> bool {
        self.spans
            .iter()
            .any(|span| (span[0]..span[1]).contains(&piece))
    }

    /// The leg that is walked sideways to which the piece from a point to the next belongs.
    fn sidle_at(&self, piece: usize) -> Option<&Sidle> {
        let holds = |sidle: &&Sidle| (sidle.from_point..sidle.to_point).contains(&piece);
        self.sidles.iter().find(holds)
    }

    /// Finds clearance, unknown parts and cost under this terrain.
    pub(crate) fn annotate(&mut self, terrain: &Terrain, config: &AStarConfig) {
        let points_m = &self.points_m;
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
                            .sideways_weight(pair[1], sidle.heading_rad, 0.0)
                            .unwrap_or(1.0 + config.sideways_cost)
                } else if self.at_stairs(i) {
                    distance_m(pair[0], pair[1])
                } else {
                    let cost = terrain.straight_cost_m(pair[0], pair[1]);
                    cost.unwrap_or(f64::INFINITY)
                }
            })
            .sum();
        let cost_m = walked_m
            + config.climb_cost * self.steps() as f64
            + config.turn_cost * TURNS_RAD * self.sidles.len() as f64;
        (self.unknown, self.clearance_m) = (unknown, clearance_m);
        self.cost_m = cost_m;
    }
}
