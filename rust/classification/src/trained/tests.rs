//! Claims about the trained classifier beside the ones by limits and saliency.

use super::*;
use crate::moments::tests::{accuracy as of_points, scene};
use crate::slope_statistics::tests::{CELL_M, accuracy as of_cells, site};
use crate::synthetic::Noise;
use crate::{MomentsConfig, PointClass, PointClasses, SlopeStatistics, SlopeStatisticsConfig};

fn trained(examples: &[(Vec<f64>, usize)], classes: usize) -> TrainedClasses {
    TrainedClasses::train(&TrainedConfig::default(), examples, classes).unwrap()
}

#[test]
fn of_two_like_classes_the_border_lies_where_they_are_equally_likely() {
    let mut noise = Noise::new(3);
    let examples: Vec<_> = (0..4000)
        .map(|index| {
            (
                vec![(index % 2) as f64 * 4.0 + noise.normal(1.0)],
                index % 2,
            )
        })
        .collect();
    let trained = trained(&examples, 2);
    let border = (0..400)
        .map(|at| f64::from(at) * 0.01)
        .find(|at| trained.classify(&[*at]) == 1);
    assert!((border.unwrap() - 2.0).abs() < 0.15, "{border:?}");
    // Twice the same, to the bit.
    let again = super::tests::trained(&examples, 2);
    assert_eq!(trained.costs(&[1.7]), again.costs(&[1.7]));
}

#[test]
fn what_cannot_be_learned_from_is_refused() {
    let said = |examples: &[(Vec<f64>, usize)]| {
        TrainedClasses::train(&TrainedConfig::default(), examples, 2)
            .unwrap_err()
            .to_string()
    };
    assert_eq!(said(&[]), "class 0 has 0 examples, at least 2 are needed");
    let uneven = said(&[(vec![1.0], 0), (vec![1.0, 2.0], 1)]);
    assert_eq!(uneven, "example 1 has 2 features, expected 1");
    assert_eq!(
        said(&[(vec![f64::NAN], 0)]),
        "example 0 has a feature that is not finite"
    );
}

/// Claims that take seconds.
mod slow {
    use super::*;

    #[test]
    fn trained_on_other_sites_obstacles_are_told_as_well_as_by_limits_and_better_in_noise() {
        let statistics = SlopeStatistics::new(SlopeStatisticsConfig::default()).unwrap();
        for (noise_m, margin) in [(0.005, 0.0), (0.015, 0.02)] {
            let mut examples = Vec::new();
            for seed in 100..110 {
                let (heights_m, truth) = site(seed, noise_m);
                let all = statistics.statistics(&heights_m, CELL_M);
                // As many of each kind: the accuracy counts both alike.
                let mut pick = Noise::new(seed);
                let obstacles = truth.iter().filter(|obstacle| **obstacle).count() as f64;
                let share = obstacles / (truth.len() as f64 - obstacles);
                for (one, obstacle) in all.values().iter().zip(truth) {
                    if let Some(one) = one
                        && (obstacle || pick.within(0.0, 1.0) < share)
                    {
                        examples.push((statistics.features(one), usize::from(obstacle)));
                    }
                }
            }
            let trained = trained(&examples, 2);
            let (mut by_limits, mut by_training) = (0.0, 0.0);
            for seed in 0..20 {
                let (heights_m, truth) = site(seed, noise_m);
                let all = statistics.statistics(&heights_m, CELL_M);
                let found: Vec<_> = (all.values().iter())
                    .map(|one| one.map(|one| trained.classify(&statistics.features(&one)) == 1))
                    .collect();
                by_training += of_cells(&found, &truth) / 20.0;
                by_limits +=
                    of_cells(statistics.obstacles(&heights_m, CELL_M).values(), &truth) / 20.0;
            }
            assert!(
                by_training >= by_limits + margin,
                "{noise_m} m: {by_training:.3} {by_limits:.3}"
            );
            assert!(by_training > 0.85, "{noise_m} m: {by_training:.3}");
        }
    }

    #[test]
    fn trained_on_other_clouds_points_are_told_as_well_as_by_their_saliency() {
        let classes = PointClasses::new(MomentsConfig::default()).unwrap();
        let told = [PointClass::Scatter, PointClass::Linear, PointClass::Surface];
        let features = |cloud: &[crate::Point3]| -> Vec<Vec<f64>> {
            let all = classes.saliencies(cloud).unwrap();
            all.iter()
                .map(|one| one.map_or(vec![0.0; 2], |one| vec![one.scatter, one.linear]))
                .collect()
        };
        let mut examples = Vec::new();
        for seed in 200..204 {
            let (points, truth) = scene(seed, 0.2);
            let labels = truth.iter().map(|class| *class as usize - 1);
            examples.extend(features(&points).into_iter().zip(labels));
        }
        let trained = trained(&examples, 3);
        let (mut by_saliency, mut by_training) = (0.0, 0.0);
        for seed in 0..20 {
            let (points, truth) = scene(seed, 0.2);
            let found: Vec<_> = (features(&points).iter())
                .map(|features| told[trained.classify(features)])
                .collect();
            by_training += of_points(&found, &truth) / 20.0;
            by_saliency += of_points(&classes.classify(&points).unwrap(), &truth) / 20.0;
        }
        assert!(
            by_training >= by_saliency,
            "{by_training:.4} {by_saliency:.4}"
        );
    }
}
