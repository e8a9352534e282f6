//! Drawing particles anew, with as little chance as possible, and only as many as it takes.

use super::particle::{Particle, PoseBins};
use super::random::Stream;

/// Low-variance resampling (Thrun, Burgard, Fox 2005, table 4.4): `count` particles of equal weight, by one random number.
pub(super) fn low_variance(
    particles: &[Particle],
    count: usize,
    stream: &mut Stream,
    drawn: &mut Vec<Particle>,
) {
    drawn.clear();
    let weight = 1.0 / count as f64;
    let weights = particles.iter().map(|particle| particle.weight);
    geometry::low_variance(weights, count, stream.uniform(), |index| {
        drawn.push(Particle {
            pose: particles[index].pose,
            weight,
        });
    });
}

/// How many particles it takes so that, where they lie in `bins` cells, the Kullback-Leibler distance from what they stand for is
/// below `error` with the probability of `quantile` (Fox 2003, equation (7)).
pub(super) fn needed(bins: usize, [error, quantile]: [f64; 2]) -> usize {
    if bins < 2 {
        return 1;
    }
    let free = (bins - 1) as f64;
    let spread = 2.0 / (9.0 * free);
    (free / (2.0 * error) * (1.0 - spread + spread.sqrt() * quantile).powi(3)).ceil() as usize
}

/// Draws into `drawn` as many of `particles` as their spread needs, between `least` and `most`.
pub(super) fn resample(
    particles: &[Particle],
    ([side_m, side_rad], kld): ([f64; 2], [f64; 2]),
    [least, most]: [usize; 2],
    stream: &mut Stream,
    (bins, drawn): (&mut PoseBins, &mut Vec<Particle>),
) {
    // Those that survive tell how many cells matter.
    low_variance(particles, particles.len(), &mut stream.clone(), drawn);
    let count = needed(bins.count(drawn, side_m, side_rad), kld).clamp(least, most);
    low_variance(particles, count, stream, drawn);
}

#[cfg(test)]
mod tests {
    use super::super::random::Purpose;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn each_is_drawn_as_often_as_it_weighs_give_or_take_one(
            weights in prop::collection::vec(0.0..1.0f64, 1..40), count in 1..200_usize, seed in 0..100_u64,
        ) {
            let sum = weights.iter().sum::<f64>().max(1e-9);
            let mut particles = vec![Particle::default(); weights.len()];
            for (index, (particle, weight)) in particles.iter_mut().zip(&weights).enumerate() {
                particle.weight = weight / sum;
                particle.pose.place_m[0] = index as f64;
            }
            let mut drawn = Vec::new();
            low_variance(&particles, count, &mut Stream::new(seed, 0, Purpose::Resampling, 0), &mut drawn);
            prop_assert_eq!(drawn.len(), count);
            prop_assert!((drawn.iter().map(|p| p.weight).sum::<f64>() - 1.0).abs() < 1e-9);
            for particle in &particles {
                let times = drawn.iter().filter(|p| p.pose == particle.pose).count() as f64;
                prop_assert!((times - particle.weight * count as f64).abs() <= 1.0 + 1e-6);
            }
        }

        #[test]
        fn what_spreads_further_needs_more(bins in 1..5000_usize) {
            let kld = [0.05, 2.33];
            prop_assert!(needed(bins + 1, kld) >= needed(bins, kld));
            // Twice the error times the number is about chi-squared with bins - 1 degrees of freedom.
            if bins > 50 { prop_assert!(needed(bins, kld) as f64 > (bins - 1) as f64 / 0.1); }
        }
    }
}
