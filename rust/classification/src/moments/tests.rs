//! Claims about bushes, wires and walls.

use proptest::prelude::*;

use super::*;
use crate::synthetic::Noise;

/// A bush of 1 m radius, a wire of 12 m that sags, a wall of 3 m x 2 m, each measured with 1 cm of noise and thinned to a share.
pub(crate) fn scene(seed: u64, share: f64) -> (Vec<Point3>, Vec<PointClass>) {
    let mut noise = Noise::new(seed);
    let mut points = Vec::new();
    let mut truth = Vec::new();
    let turn = noise.within(0.0, core::f64::consts::TAU);
    let (sin, cos) = libm::sincos(turn);
    let mut add = |noise: &mut Noise, count: f64, class, draw: &dyn Fn(&mut Noise) -> Point3| {
        for _ in 0..(count * share) as usize {
            let [x, y, z] = draw(noise).map(|value| value + noise.normal(0.01));
            points.push([cos * x - sin * y, sin * x + cos * y, z]);
            truth.push(class);
        }
    };
    add(&mut noise, 4000.0, PointClass::Scatter, &|noise| loop {
        let point = [0; 3].map(|_| noise.within(-1.0, 1.0));
        if point.iter().map(|value| value * value).sum::<f64>() < 1.0 {
            return point;
        }
    });
    add(&mut noise, 1000.0, PointClass::Linear, &|noise| {
        let x = noise.within(-6.0, 6.0);
        [x, 4.0, 4.0 + 0.01 * x * x]
    });
    add(&mut noise, 4000.0, PointClass::Surface, &|noise| {
        [noise.within(-1.5, 1.5), -4.0, noise.within(0.0, 2.0)]
    });
    (points, truth)
}

/// The mean over the classes of the share that is told right.
pub(crate) fn accuracy(found: &[PointClass], truth: &[PointClass]) -> f64 {
    let classes = [PointClass::Scatter, PointClass::Linear, PointClass::Surface];
    let shares = classes.map(|class| {
        let of_class = found
            .iter()
            .zip(truth)
            .filter(|(_, truth)| **truth == class);
        let right = of_class
            .clone()
            .filter(|(found, truth)| found == truth)
            .count();
        right as f64 / of_class.count() as f64
    });
    shares.iter().sum::<f64>() / 3.0
}

#[test]
fn a_point_alone_is_of_no_class() {
    let classes = PointClasses::new(MomentsConfig::default()).unwrap();
    let points = [[0.0; 3], [9.0, 0.0, 0.0], [0.0, 9.0, 0.0]];
    assert_eq!(classes.classify(&points).unwrap(), [PointClass::Unknown; 3]);
    assert!(classes.classify(&[]).is_err());
}

/// Claims that take seconds.
mod slow {
    use super::*;

    /// The mean over clouds of the share that is told right, at full density, half and a quarter of it.
    fn at_densities(config: &MomentsConfig, seeds: u64) -> [f64; 3] {
        let classes = PointClasses::new(config.clone()).unwrap();
        [1.0, 0.5, 0.25].map(|share| {
            let of_seed = |seed| {
                let (points, truth) = scene(seed, share);
                accuracy(&classes.classify(&points).unwrap(), &truth)
            };
            (0..seeds).map(of_seed).sum::<f64>() / seeds as f64
        })
    }

    fn spread(all: [f64; 3]) -> f64 {
        all.iter().copied().fold(0.0, f64::max) - all.iter().copied().fold(1.0, f64::min)
    }

    #[test]
    fn bush_wire_and_wall_are_told_apart_nine_times_in_ten() {
        let classes = PointClasses::new(MomentsConfig::default()).unwrap();
        for seed in 0..20 {
            let (points, truth) = scene(seed, 1.0);
            let right = accuracy(&classes.classify(&points).unwrap(), &truth);
            assert!(right >= 0.9, "seed {seed}: {right:.3}");
        }
    }

    #[test]
    fn a_scale_by_density_is_as_good_at_a_quarter_of_the_points_and_no_fixed_one_is() {
        let by_density = at_densities(&MomentsConfig::default(), 20);
        assert!(
            by_density.iter().all(|right| *right >= 0.9),
            "{by_density:?}"
        );
        assert!(spread(by_density) <= 0.03, "{by_density:?}");
        for radius_m in [0.1, 0.15, 0.2, 0.25] {
            let fixed = MomentsConfig {
                neighbours: 4,
                radius_per_noise: radius_m / MomentsConfig::default().noise,
                most_radius: radius_m,
                ..MomentsConfig::default()
            };
            let of_fixed = at_densities(&fixed, 4);
            assert!(spread(of_fixed) > 0.03, "{radius_m} m: {of_fixed:?}");
        }
    }
}

proptest! {
    #[test]
    fn saliencies_are_shares_of_one_and_turn_with_the_cloud(seed in 0_u64..500, far in -1e6..1e6_f64) {
        let mut noise = Noise::new(seed);
        let points: Vec<Point3> = (0..40).map(|_| [0; 3].map(|_| noise.within(-0.2, 0.2))).collect();
        let moved: Vec<Point3> = points.iter().map(|[x, y, z]| [y + far, *z, *x]).collect();
        let classes = PointClasses::new(MomentsConfig::default()).unwrap();
        let [here, there] = [&points, &moved].map(|cloud| classes.saliencies(cloud).unwrap());
        for (one, other) in here.iter().flatten().zip(there.iter().flatten()) {
            prop_assert!((one.scatter + one.linear + one.surface - 1.0).abs() < 1e-9);
            prop_assert!((one.direction.norm() - 1.0).abs() < 1e-9);
            prop_assert!((one.scatter - other.scatter).abs() < 1e-5, "{one:?} {other:?}");
            prop_assert!((one.surface - other.surface).abs() < 1e-5);
        }
    }
}
