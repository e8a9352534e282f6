//! A map with parts that are in one of several states, and how probable scans are in it.

use geometry::Cell;
use plan_view::{BeamLikelihood, OccupancyMap, PlanarScan, log_odds, probability_of_log_odds};

/// A part of the map that changes.
#[derive(Debug, Clone, PartialEq)]
pub struct ChangingPart {
    /// Its cells, in order.
    pub cells: Vec<Cell>,
    /// Of each state, the most frequent first, the probability that each cell is occupied.
    pub states: Vec<Vec<f64>>,
    /// Of each state the share of the visits that found it.
    pub shares: Vec<f64>,
    /// Of each visit the state in which it found the part.
    pub of_visits: Vec<usize>,
}

/// An occupancy map with parts that change.
#[derive(Debug, Clone)]
pub struct StatefulMap {
    base: OccupancyMap,
    parts: Vec<ChangingPart>,
    rounds: usize,
}

impl StatefulMap {
    /// Of what all visits together know, and the parts that change.
    pub(super) const fn new(base: OccupancyMap, parts: Vec<ChangingPart>, rounds: usize) -> Self {
        Self {
            base,
            parts,
            rounds,
        }
    }

    /// What all visits together know, as one map: what it is compared with.
    pub const fn as_one_map(&self) -> &OccupancyMap {
        &self.base
    }

    /// The parts that change.
    pub fn parts(&self) -> &[ChangingPart] {
        &self.parts
    }

    /// The map with its parts in these states; those that are not named are in the most frequent.
    pub fn in_states(&self, states: &[usize]) -> OccupancyMap {
        let mut map = self.base.clone();
        for number in 0..self.parts.len() {
            self.put(&mut map, number, states.get(number).copied().unwrap_or(0));
        }
        map
    }

    /// The states that make scans from one place likeliest, and the logarithm of their density with them: one part after the other, from those of the most
    /// frequent on, until no change of one part alone adds to it. What a state is worth before any scan is its share of the visits.
    pub fn likeliest(
        &self,
        likelihood: &BeamLikelihood,
        scans: &[PlanarScan],
    ) -> (Vec<usize>, f64) {
        let mut states = vec![0; self.parts.len()];
        let mut map = self.in_states(&states);
        let of = |map: &OccupancyMap| {
            let each = scans
                .iter()
                .map(|scan| likelihood.log_likelihood(map, scan).0);
            each.sum::<f64>()
        };
        let prior = |part: usize, state: usize| libm::log(self.parts[part].shares[state]);
        let mut worth = of(&map) + (0..states.len()).map(|part| prior(part, 0)).sum::<f64>();
        for _ in 0..self.rounds {
            let before = states.clone();
            for part in 0..self.parts.len() {
                let was = states[part];
                for state in (0..self.parts[part].states.len()).filter(|state| *state != was) {
                    let held = states[part];
                    self.put(&mut map, part, state);
                    let others = (0..states.len()).filter(|other| *other != part);
                    let now = of(&map)
                        + prior(part, state)
                        + others.map(|other| prior(other, states[other])).sum::<f64>();
                    if now > worth {
                        (worth, states[part]) = (now, state);
                    } else {
                        self.put(&mut map, part, held);
                    }
                }
            }
            if states == before {
                break;
            }
        }
        (states, worth)
    }

    fn put(&self, map: &mut OccupancyMap, part: usize, state: usize) {
        let part = &self.parts[part];
        let prior = log_odds(map.config().prior);
        for (&cell, &p) in part.cells.iter().zip(&part.states[state]) {
            if let Some(belief) = map.cells().get(cell) {
                let change = log_odds(p) - f64::from(belief.log_odds) + prior;
                map.update(cell, probability_of_log_odds(change));
            }
        }
    }
}
