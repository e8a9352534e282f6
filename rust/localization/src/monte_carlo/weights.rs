//! From likelihoods to weights: in log space, normalized, and no frame decides alone.

use super::{observation::LogLikelihood, particle::Particle, tuning::WeightsTuning};

/// Number of particles that weigh as much as these, which sum to one: `1 / sum w^2`.
pub(super) fn effective_number(particles: &[Particle]) -> f64 {
    1.0 / (particles.iter())
        .map(|particle| particle.weight * particle.weight)
        .sum::<f64>()
}

/// Multiplies the weights by likelihoods, of which the ranges' have the exponent `independence`, and normalizes. Where fewer than
/// `least_share` of the particles would be left to speak of, all is flattened by an exponent that leaves as many. A frame that is
/// impossible from everywhere says nothing: the weights stay. `logs` is room to work in.
pub(super) fn weigh(
    particles: &mut [Particle],
    likelihoods: &[LogLikelihood],
    [independence, least_share]: [f64; 2],
    tuning: &WeightsTuning,
    logs: &mut Vec<f64>,
) {
    logs.clear();
    logs.extend(
        likelihoods
            .iter()
            .map(|one| independence * one.ranges + one.body),
    );
    let best = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if !best.is_finite() {
        return;
    }
    for log in logs.iter_mut() {
        *log -= best;
    }
    let least = least_share * particles.len() as f64;
    let exponent = flattening(particles, logs, least, tuning);
    let (weights, mut sum) = (logs, 0.0);
    for (particle, log) in particles.iter().zip(weights.iter_mut()) {
        *log = particle.weight * (exponent * *log).exp();
        sum += *log;
    }
    // Nothing: the best may be one that weighed nothing before.
    if sum > 0.0 {
        for (particle, weight) in particles.iter_mut().zip(weights.iter()) {
            particle.weight = weight / sum;
        }
    }
}

/// The exponent of the likelihoods, 1 at most, that leaves an effective number of at least `least`.
fn flattening(particles: &[Particle], logs: &[f64], least: f64, tuning: &WeightsTuning) -> f64 {
    let is_enough = |exponent: f64| {
        let (mut sum, mut squares) = (0.0, 0.0);
        for (particle, log) in particles.iter().zip(logs) {
            let weight = particle.weight * (exponent * log).exp();
            sum += weight;
            squares += weight * weight;
        }
        squares > 0.0 && sum * sum / squares >= least
    };
    if is_enough(1.0) {
        return 1.0;
    }
    let (mut low, mut high) = (0.5, 1.0);
    for _ in 0..tuning.halvings {
        if is_enough(low) {
            break;
        }
        (low, high) = (0.5 * low, low);
    }
    for _ in 0..tuning.refinements {
        let exponent = f64::midpoint(low, high);
        if is_enough(exponent) {
            low = exponent;
        } else {
            high = exponent;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn cloud(count: usize) -> Vec<Particle> {
        let particle = Particle {
            weight: 1.0 / count as f64,
            ..Particle::default()
        };
        vec![particle; count]
    }

    fn of(ranges: f64) -> LogLikelihood {
        LogLikelihood { ranges, body: 0.0 }
    }

    fn weighed(mut particles: Vec<Particle>, logs: &[f64]) -> Vec<f64> {
        let likelihoods: Vec<_> = logs.iter().map(|&log| of(log)).collect();
        let tuning = WeightsTuning::default();
        weigh(
            &mut particles,
            &likelihoods,
            [1.0, 0.3],
            &tuning,
            &mut Vec::new(),
        );
        particles.iter().map(|particle| particle.weight).collect()
    }

    #[test]
    fn a_frame_that_is_impossible_from_everywhere_leaves_the_weights() {
        for impossible in [f64::NEG_INFINITY, f64::NAN] {
            assert_eq!(weighed(cloud(4), &[impossible; 4]), [0.25; 4]);
        }
        let mut particles = cloud(3);
        particles[0].weight = 0.0;
        let found = weighed(particles, &[-1.0, f64::NEG_INFINITY, f64::NEG_INFINITY]);
        assert_eq!(found, [0.0, 1.0 / 3.0, 1.0 / 3.0]);
    }

    #[test]
    fn what_only_a_weightless_guess_explains_makes_no_weight_a_non_number() {
        let mut particles = cloud(3);
        particles[0].weight = 0.0;
        let found = weighed(particles, &[0.0, -3000.0, -3000.0]);
        assert_eq!(found, [0.0, 0.5, 0.5]);
    }

    proptest! {
        #[test]
        fn weights_are_bayes_where_none_decides_alone(logs in prop::collection::vec(-2.0..0.0f64, 5..50)) {
            let mut particles = cloud(logs.len());
            let likelihoods: Vec<_> = logs.iter().map(|&log| of(log)).collect();
            weigh(&mut particles, &likelihoods, [1.0, 0.1], &WeightsTuning::default(), &mut Vec::new());
            let sum = logs.iter().map(|log| log.exp()).sum::<f64>();
            for (particle, log) in particles.iter().zip(&logs) {
                prop_assert!((particle.weight - log.exp() / sum).abs() < 1e-12);
            }
        }

        #[test]
        fn however_unlikely_all_are_weights_sum_to_one_and_enough_are_left(logs in prop::collection::vec(-3000.0..-1000.0f64, 20..200)) {
            let mut particles = cloud(logs.len());
            let likelihoods: Vec<_> = logs.iter().map(|&log| of(log)).collect();
            weigh(&mut particles, &likelihoods, [1.0, 0.2], &WeightsTuning::default(), &mut Vec::new());
            let sum = particles.iter().map(|particle| particle.weight).sum::<f64>();
            prop_assert!((sum - 1.0).abs() < 1e-9);
            let number = effective_number(&particles);
            prop_assert!(number >= 0.2 * logs.len() as f64, "{number}");
            // The order stays.
            for (a, b) in particles.iter().zip(&particles[1..]).zip(logs.iter().zip(&logs[1..])).map(|((a, b), (la, lb))| if la > lb { (a, b) } else { (b, a) }) {
                prop_assert!(a.weight >= b.weight);
            }
        }
    }
}
