//! Claims about labels along a way.

use super::*;
use crate::synthetic::Noise;
use proptest::prelude::*;

/// A way of 300 places, traversable or not, and how likely a noisy measurement of each is in either class.
fn way(seed: u64) -> (Vec<usize>, Vec<Vec<f64>>) {
    let mut noise = Noise::new(seed);
    let mut class = 0;
    (0..300)
        .map(|_| {
            if noise.within(0.0, 1.0) > 0.9 {
                class = 1 - class;
            }
            let measured = class as f64 + noise.normal(0.6);
            let likelihood = |mean: f64| libm::exp(-(measured - mean) * (measured - mean) / 0.72);
            (class, vec![likelihood(0.0), likelihood(1.0)])
        })
        .unzip()
}

fn most(values: &[f64]) -> usize {
    (0..values.len())
        .reduce(|a, b| if values[b] > values[a] { b } else { a })
        .unwrap()
}

#[test]
fn along_a_way_fewer_places_are_misjudged_than_each_by_itself() {
    let chain = MarkovChain::sticky(&MarkovChainConfig::default(), 2).unwrap();
    let mut sums = [0.0; 3];
    for seed in 0..40 {
        let (truth, likelihoods) = way(seed);
        let wrong = |found: Vec<usize>| {
            found.iter().zip(&truth).filter(|(a, b)| a != b).count() as f64 / 300.0
        };
        let alone = wrong(likelihoods.iter().map(|seen| most(seen)).collect());
        let beliefs = chain.beliefs(&likelihoods).unwrap();
        let smoothed = wrong(beliefs.iter().map(|belief| most(belief)).collect());
        let course = wrong(chain.most_likely(&likelihoods).unwrap());
        assert!(
            smoothed <= alone && course <= alone,
            "seed {seed}: {alone} {smoothed} {course}"
        );
        for (sum, one) in sums.iter_mut().zip([alone, smoothed, course]) {
            *sum += one / 40.0;
        }
    }
    assert!(
        sums[1] < 0.6 * sums[0] && sums[2] < 0.6 * sums[0],
        "{sums:?}"
    );
}

#[test]
fn what_is_no_chain_is_refused() {
    let said = |initial: &[f64], rows: &[&[f64]]| {
        let rows = rows.iter().map(|row| row.to_vec()).collect();
        MarkovChain::new(initial.to_vec(), rows)
            .unwrap_err()
            .to_string()
    };
    let even = [0.5, 0.5];
    assert!(said(&[0.5, 0.6], &[&even, &even]).starts_with("those of the first step"));
    assert!(said(&even, &[&even, &[1.1, -0.1]]).starts_with("those of a transition"));
    assert!(said(&even, &[&even]).starts_with("a row for each class"));
    let chain = MarkovChain::sticky(&MarkovChainConfig::default(), 2).unwrap();
    let wrong = chain.beliefs(&[vec![1.0]]).unwrap_err().to_string();
    assert_eq!(wrong, "step 0 has 1 likelihoods, the chain has 2 classes");
    let never = Err(ChainError::Impossible { step: 1 });
    assert_eq!(
        chain.beliefs(&[vec![1.0; 2], vec![0.0; 2]]),
        never.clone().map(|()| vec![])
    );
    assert_eq!(
        chain.most_likely(&[vec![1.0; 2], vec![0.0; 2]]),
        never.map(|()| vec![])
    );
    assert_eq!(chain.most_likely(&[]), Ok(vec![]));
}

fn chains() -> impl Strategy<Value = (MarkovChain, Vec<Vec<f64>>)> {
    let row = || {
        prop::collection::vec(0.05..1.0_f64, 3).prop_map(|row| {
            let sum: f64 = row.iter().sum();
            row.iter().map(|value| value / sum).collect::<Vec<_>>()
        })
    };
    let seen = prop::collection::vec(prop::collection::vec(0.01..1.0_f64, 3), 1..6);
    (row(), prop::collection::vec(row(), 3), seen).prop_map(|(initial, rows, seen)| {
        (
            MarkovChain {
                initial,
                transition: rows,
            },
            seen,
        )
    })
}

proptest! {
    #[test]
    fn beliefs_and_the_best_course_are_those_of_all_courses_written_out((chain, seen) in chains()) {
        let steps = seen.len();
        let mut marginal = vec![vec![0.0; 3]; steps];
        let mut best = (f64::NEG_INFINITY, Vec::new());
        for number in 0..3_usize.pow(steps as u32) {
            let course: Vec<usize> = (0..steps).map(|step| number / 3_usize.pow(step as u32) % 3).collect();
            let mut joint = chain.initial[course[0]] * seen[0][course[0]];
            for step in 1..steps {
                joint *= chain.transition[course[step - 1]][course[step]] * seen[step][course[step]];
            }
            for (step, class) in course.iter().enumerate() {
                marginal[step][*class] += joint;
            }
            if joint > best.0 {
                best = (joint, course);
            }
        }
        let beliefs = chain.beliefs(&seen).unwrap();
        for (belief, all) in beliefs.iter().zip(&marginal) {
            prop_assert!((belief.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            for (one, of_all) in belief.iter().zip(all) {
                prop_assert!((one - of_all / all.iter().sum::<f64>()).abs() < 1e-9);
            }
        }
        prop_assert_eq!(chain.most_likely(&seen).unwrap(), best.1);
    }
}
