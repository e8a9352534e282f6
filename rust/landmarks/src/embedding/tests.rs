//! Looks of things that nobody named, told apart by where they lie.

use super::*;
use geometry::SplitMix64;
use proptest::prelude::*;

/// Side of a picture of a thing, pixels.
const SIDE: usize = 12;

/// What a camera sees of a thing from a random side: how much nearer than its background each pixel is, in units of the thing's size.
fn look(kind: usize, random: &mut SplitMix64) -> Vec<f64> {
    let mut upto = |low: f64, high: f64| low + (high - low) * random.uniform();
    let (turn, slender, lean) = (upto(0.0, 1.6), upto(0.75, 1.3), upto(-0.08, 0.08));
    let centre = [upto(-0.08, 0.08), upto(-0.08, 0.08)];
    let mut pixels = Vec::with_capacity(SIDE * SIDE);
    for at in 0..SIDE * SIDE {
        let place = |at: usize| (at as f64 + 0.5) / SIDE as f64 * 2.0 - 1.0;
        let (x, z) = (place(at % SIDE) - centre[0], place(at / SIDE) - centre[1]);
        let x = x - lean * z;
        let depth = match kind {
            // A rock: an ellipsoid.
            0 => 0.7 - (x / slender).powi(2) - z * z,
            // A post: a slender cylinder.
            1 => 0.06 - (x / slender).powi(2),
            // A box, of which an edge is seen.
            2 => {
                let (sin, cos) = libm::sincos(turn);
                let [left, right] = [0.6 * cos, 0.6 * sin].map(|side| side * slender);
                let into = if x < 0.0 { left + x } else { right - x };
                if z.abs() < 0.6 { into } else { -1.0 }
            }
            // A wall with a step in it.
            _ => {
                if x > 0.3 * slender - 0.15 {
                    0.9
                } else {
                    0.3
                }
            }
        };
        pixels.push(depth.max(0.0).sqrt());
    }
    pixels
        .into_iter()
        .map(|pixel| pixel + 0.08 * (random.uniform() + random.uniform() - 1.0))
        .collect()
}

/// H51.
#[test]
fn looks_of_four_kinds_of_things_lie_apart_in_three_dimensions() {
    for seed in 0..3 {
        let mut random = SplitMix64::new(seed);
        let learned: Vec<_> = (0..160).map(|at| look(at % 4, &mut random)).collect();
        let embedding = Embedding::learn(EmbeddingConfig::default(), &learned).unwrap();
        let places: Vec<_> = (0..160).map(|at| embedding.place_of(at).unwrap()).collect();
        let right = (0..200).filter(|at| {
            let place = embedding.place(&look(at % 4, &mut random)).unwrap();
            assert_eq!(place.len(), 3);
            let away = places.iter().map(|known| (known - &place).norm());
            let near = nearest(away.enumerate().collect(), 5);
            let votes = near.iter().filter(|(known, _)| known % 4 == at % 4);
            votes.count() >= 3
        });
        let right = right.count();
        assert!(right >= 180, "seed {seed}: {right} of 200");
    }
}

#[test]
fn a_strip_that_is_rolled_up_is_unrolled() {
    let mut random = SplitMix64::new(9);
    let mut flat = Vec::new();
    let rolled: Vec<Vec<f64>> = (0..200)
        .map(|_| {
            let (along, across) = (9.0 * random.uniform() + 3.0, 2.0 * random.uniform());
            flat.push(along * along);
            let (sin, cos) = libm::sincos(along);
            vec![along * cos, along * sin, across]
        })
        .collect();
    let config = EmbeddingConfig {
        dimensions: 1,
        neighbours: 6,
    };
    let embedding = Embedding::learn(config, &rolled).unwrap();
    let found: Vec<f64> = (0..200)
        .map(|at| embedding.place_of(at).unwrap()[0])
        .collect();
    // The length of a spiral grows with the square of its angle.
    let mean = |numbers: &[f64]| numbers.iter().sum::<f64>() / numbers.len() as f64;
    let product = |a: &[f64], b: &[f64]| {
        let (mean_a, mean_b) = (mean(a), mean(b));
        a.iter()
            .zip(b)
            .map(|(a, b)| (a - mean_a) * (b - mean_b))
            .sum::<f64>()
    };
    let correlation =
        product(&found, &flat) / (product(&found, &found) * product(&flat, &flat)).sqrt();
    assert!(correlation.abs() > 0.98, "{correlation}");
}

#[test]
fn what_cannot_be_learned_from_is_refused() {
    let learn = |looks: &[Vec<f64>]| Embedding::learn(EmbeddingConfig::default(), looks);
    assert!(matches!(
        learn(&[]),
        Err(EmbeddingError::TooFew { found: 0, least: 8 })
    ));
    let mut looks = vec![vec![0.0, 1.0]; 20];
    looks[7] = vec![f64::NAN, 0.0];
    let message = learn(&looks).unwrap_err().to_string();
    assert_eq!(message, "look 7 must be 2 finite numbers");
    looks[7] = vec![0.0, 1.0];
    let same = learn(&looks).unwrap();
    assert!(same.place(&[0.0]).is_none());
    assert_eq!(same.place(&[0.0, 1.0]).unwrap().norm(), 0.0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]
    #[test]
    fn a_look_that_was_learned_lies_where_it_lay(
        looks in prop::collection::vec(prop::collection::vec(-1.0..1.0f64, 6), 20..40),
    ) {
        let embedding = Embedding::learn(EmbeddingConfig::default(), &looks).unwrap();
        for (index, look) in looks.iter().enumerate() {
            let off = embedding.place(look).unwrap() - embedding.place_of(index).unwrap();
            prop_assert!(off.norm() < 1e-5);
        }
    }
}
