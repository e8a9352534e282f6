//! Random numbers of one sense: standard normals by Marsaglia's polar method (Marsaglia and Bray 1964).

use geometry::SplitMix64;

/// Independent numbers of mean 0 and standard deviation 1, always the same ones of a seed.
#[derive(Debug, Clone)]
pub struct Normals {
    uniform: SplitMix64,
    /// The second of a pair.
    spare: Option<f64>,
}

impl Normals {
    /// From a seed on.
    pub const fn new(seed: u64) -> Self {
        Self {
            uniform: SplitMix64::new(seed),
            spare: None,
        }
    }

    /// The next number.
    pub fn draw(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        loop {
            let across = 2.0 * self.uniform.uniform() - 1.0;
            let up = 2.0 * self.uniform.uniform() - 1.0;
            let square = across * across + up * up;
            if square > 0.0 && square < 1.0 {
                let stretch = (-2.0 * libm::log(square) / square).sqrt();
                self.spare = Some(up * stretch);
                return across * stretch;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_have_the_moments_and_tails_of_a_normal_distribution() {
        let mut normals = Normals::new(3);
        let drawn: Vec<f64> = (0..100_000).map(|_| normals.draw()).collect();
        let moment = |power: i32| {
            drawn.iter().map(|value| value.powi(power)).sum::<f64>() / drawn.len() as f64
        };
        let expected = [0.0, 1.0, 0.0, 3.0];
        for (power, wanted) in (1..).zip(expected) {
            let found = moment(power);
            assert!((found - wanted).abs() < 0.06, "{power}: {found}");
        }
        let beyond = |sigmas: f64| {
            drawn.iter().filter(|value| value.abs() > sigmas).count() as f64 / drawn.len() as f64
        };
        assert!((beyond(1.0) - 0.3173).abs() < 0.006);
        assert!((beyond(2.0) - 0.0455).abs() < 0.003);
        assert!((beyond(3.0) - 0.0027).abs() < 0.0007);
    }

    #[test]
    fn neighbours_are_independent_and_a_seed_repeats() {
        let mut normals = Normals::new(11);
        let drawn: Vec<f64> = (0..50_000).map(|_| normals.draw()).collect();
        for lag in 1..4 {
            let pairs = drawn.iter().zip(&drawn[lag..]);
            let correlation = pairs.map(|(a, b)| a * b).sum::<f64>() / drawn.len() as f64;
            assert!(correlation.abs() < 0.015, "{lag}: {correlation}");
        }
        let mut again = Normals::new(11);
        assert!(drawn.iter().all(|value| *value == again.draw()));
        assert_ne!(Normals::new(12).draw(), drawn[0]);
    }
}
