//! Probabilities in 8 bits and the Bayesian update by table look-up: equations (6), (7), (12) and (13) of 000.
//!
//! The codes are evenly spaced in log-odds, and the spacing divides the weight of one measurement: every update moves a
//! code by a whole number of steps, so that nothing is lost by rounding, however many updates follow each other. Only the
//! limits are rounded to the nearest code.

/// Code of probability 0.5.
const EVEN: u8 = 128;
/// Largest distance of a code in use from [`EVEN`].
const REACH: f64 = 127.0;

/// Equation (6): probability of occupancy after a measurement with these likelihoods under occupied and empty.
pub fn bayes(prior: f64, given_occupied: f64, given_empty: f64) -> f64 {
    let occupied = given_occupied * prior;
    occupied / (occupied + given_empty * (1.0 - prior))
}

fn logit(probability: f64) -> f64 {
    libm::log(probability / (1.0 - probability))
}

/// Codes of probabilities, what a hit and a miss make of each, and which of them count as occupied.
#[derive(Debug, Clone, PartialEq)]
pub struct ProbabilityTable {
    step_logit: f64,
    min: u8,
    max: u8,
    hit: [u8; 256],
    miss: [u8; 256],
    occupied: [bool; 256],
}

impl ProbabilityTable {
    /// Tables for the sensor model `p_sense` (in 0.5..1), the threshold `p_occ` and the limits `p_min`, `p_max`.
    pub fn new(p_sense: f64, p_occ: f64, p_min: f64, p_max: f64) -> Self {
        let reach = logit(p_max).max(-logit(p_min));
        let steps = (REACH * logit(p_sense) / reach).floor().max(1.0);
        let mut table = Self {
            step_logit: logit(p_sense) / steps,
            min: 0,
            max: 255,
            hit: [0; 256],
            miss: [0; 256],
            occupied: [false; 256],
        };
        table.min = table.encode(p_min);
        table.max = table.encode(p_max);
        for code in 0..=u8::MAX {
            let prior = table.decode(code);
            // Equation (12) for the voxel that holds the point and for the voxels before it; (13) for empty ones.
            table.hit[usize::from(code)] = table.encode(bayes(prior, p_sense, 1.0 - p_sense));
            table.miss[usize::from(code)] = table.encode(bayes(prior, 1.0 - p_sense, p_sense));
            // Strict, and not at the mercy of the last bit where a whole number of hits meets the threshold.
            table.occupied[usize::from(code)] = logit(prior) > logit(p_occ) + 1e-9;
        }
        table
    }

    /// Code of the nearest probability within the limits.
    pub fn encode(&self, probability: f64) -> u8 {
        let steps = (logit(probability) / self.step_logit).round();
        let code = (f64::from(EVEN) + steps).clamp(0.0, 255.0) as u8;
        code.clamp(self.min, self.max)
    }

    /// Probability of a code.
    pub fn decode(&self, code: u8) -> f64 {
        let log_odds = (f64::from(code) - f64::from(EVEN)) * self.step_logit;
        1.0 / (1.0 + libm::exp(-log_odds))
    }

    /// Code of a voxel of which nothing is known: exactly 0.5, equation (4).
    pub const fn unknown(&self) -> u8 {
        EVEN
    }

    /// Code after a measurement at the voxel.
    pub const fn after_hit(&self, code: u8) -> u8 {
        self.hit[code as usize]
    }

    /// Code after a ray that passed through the voxel.
    pub const fn after_miss(&self, code: u8) -> u8 {
        self.miss[code as usize]
    }

    /// Whether the probability exceeds `p_occ`: inequality (7), strict.
    pub const fn is_occupied(&self, code: u8) -> bool {
        self.occupied[code as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn table() -> ProbabilityTable {
        ProbabilityTable::new(0.7, 0.7, 0.05, 0.95)
    }

    #[test]
    fn the_table_is_the_formula_rounded() {
        let table = table();
        for code in table.min..=table.max {
            let prior = table.decode(code);
            let hit = bayes(prior, 0.7, 0.3).clamp(0.05, 0.95);
            let miss = bayes(prior, 0.3, 0.7).clamp(0.05, 0.95);
            assert!((table.decode(table.after_hit(code)) - hit).abs() < 0.5 / 255.0);
            assert!((table.decode(table.after_miss(code)) - miss).abs() < 0.5 / 255.0);
        }
    }

    #[test]
    fn likelihoods_of_occupied_and_empty_sum_to_one_in_effect() {
        let table = table();
        // P(z|c) + P(z|not c) = 1: a hit and a miss cancel exactly.
        let code = table.unknown();
        assert_eq!(table.after_miss(table.after_hit(code)), code);
    }

    #[test]
    fn n_hits_from_even_give_the_closed_form() {
        let table = ProbabilityTable::new(0.6, 0.7, 0.03, 0.97);
        let mut code = table.unknown();
        for n in 1..=7 {
            code = table.after_hit(code);
            let (s, f) = (0.6_f64.powi(n), 0.4_f64.powi(n));
            assert!((table.decode(code) - s / (s + f)).abs() < 1e-12, "{n} hits");
        }
    }

    #[test]
    fn the_threshold_is_strict() {
        let table = table();
        let once = table.after_hit(table.unknown());
        assert!((table.decode(once) - 0.7).abs() < 1e-12);
        assert!(!table.is_occupied(once), "0.7 does not exceed 0.7");
        assert!(table.is_occupied(table.after_hit(once)));
    }

    #[test]
    fn a_million_hits_stay_within_the_limit_and_three_misses_undo_them() {
        let table = table();
        let mut code = table.unknown();
        for _ in 0..1_000_000 {
            code = table.after_hit(code);
        }
        assert!(table.decode(code) <= 0.95 + 0.5 / 255.0);
        let mut misses = 0;
        while table.is_occupied(code) {
            code = table.after_miss(code);
            misses += 1;
        }
        // logit 0.95 - k logit 0.7 <= logit 0.7
        let expected = ((logit(0.95) - logit(0.7)) / logit(0.7)).ceil() as i32;
        assert_eq!((misses, expected), (3, 3));
    }

    proptest! {
        #[test]
        fn ten_thousand_updates_stay_within_one_part_in_255(seed in any::<u64>()) {
            let table = table();
            let (mut code, mut reference, mut state) = (table.unknown(), 0.5_f64, seed | 1);
            for _ in 0..10_000 {
                state ^= state << 13;
                state ^= state >> 7;
                state ^= state << 17;
                let (hit, miss) = if state & 1 == 0 { (0.7, 0.3) } else { (0.3, 0.7) };
                reference = bayes(reference, hit, miss).clamp(0.05, 0.95);
                code = if state & 1 == 0 { table.after_hit(code) } else { table.after_miss(code) };
                let stored = table.decode(code);
                prop_assert!((0.0..=1.0).contains(&stored));
                prop_assert!((stored - reference).abs() < 1.0 / 255.0);
            }
        }

        #[test]
        fn the_order_of_updates_is_irrelevant_away_from_the_limits(order in prop::collection::vec(any::<bool>(), 0..4)) {
            let table = table();
            let run = |sequence: &[bool]| {
                sequence.iter().fold(table.unknown(), |code, &hit| {
                    if hit { table.after_hit(code) } else { table.after_miss(code) }
                })
            };
            let mut reversed = order.clone();
            reversed.reverse();
            let mut sorted = order.clone();
            sorted.sort_unstable();
            prop_assert_eq!(run(&order), run(&reversed));
            prop_assert_eq!(run(&order), run(&sorted));
        }
    }
}
