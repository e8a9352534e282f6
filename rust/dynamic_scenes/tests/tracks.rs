//! Laws of clusters and tracks (H68, H72).

use dynamic_scenes::{
    ClustersConfig, MovingCluster, MovingTracks, PointOfView, TrackFilter, TracksConfig,
    moving_clusters,
};
use geometry::SplitMix64;
use proptest::prelude::*;

fn cluster(at_m: [f64; 2]) -> MovingCluster {
    MovingCluster {
        at_m,
        radius_m: 0.15,
        is_cut: false,
        points: Vec::new(),
    }
}

fn turned([x, y]: [f64; 2], angle_rad: f64, by_m: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = libm::sincos(angle_rad);
    [cos * x - sin * y + by_m[0], sin * x + cos * y + by_m[1]]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// What the filter knows is a covariance, whatever it is told: symmetric and positive; and it grows with the time ahead.
    #[test]
    fn a_track_stays_a_gaussian_and_is_less_sure_of_what_is_further_ahead(
        looks in prop::collection::vec((0.01..1.0f64, -3.0..3.0f64, -3.0..3.0f64, 0.01..0.5f64), 1..40),
    ) {
        let mut filter = TrackFilter::new(0.0, [0.0, 0.0], 0.06, 0.4, 0.25);
        for (wait_s, x, y, sigma_m) in looks {
            filter.predict(filter.time_s() + wait_s);
            filter.update([x, y], sigma_m);
            let [now, later] = [0.0, 1.0].map(|ahead_s| filter.predicted(ahead_s).covariance_m2);
            prop_assert!((now - now.transpose()).norm() <= 1e-12 * now.norm());
            prop_assert!(now.cholesky().is_some() && (later - now).cholesky().is_some());
        }
    }

    /// Tracks of a world that is turned and moved are the tracks turned and moved.
    #[test]
    fn tracks_do_not_depend_on_where_the_map_lies(
        seed in 0..1000_u64, angle_rad in -3.0..3.0f64, east_m in -20.0..20.0f64, north_m in -20.0..20.0f64,
    ) {
        let mut numbers = SplitMix64::new(seed);
        let config = TracksConfig::default();
        let mut tracks = [(); 2].map(|()| MovingTracks::new(config.clone()).unwrap());
        for frame in 0..30 {
            let time_s = 0.1 * f64::from(frame);
            let seen: Vec<_> = (0..3)
                .map(|number| {
                    let [noise_x, noise_y] = numbers.normals();
                    let along = f64::from(number) - 1.0;
                    [along + 0.3 * time_s + 0.03 * noise_x, 0.2 * along * time_s + 0.03 * noise_y]
                })
                .collect();
            let there = |at_m: &[f64; 2]| cluster(turned(*at_m, angle_rad, [east_m, north_m]));
            let here_ids = tracks[0].update(time_s, &seen.iter().map(|at| cluster(*at)).collect::<Vec<_>>());
            let there_ids = tracks[1].update(time_s, &seen.iter().map(there).collect::<Vec<_>>());
            prop_assert_eq!(&here_ids, &there_ids);
            prop_assert!(here_ids[0] != here_ids[1] && here_ids[1] != here_ids[2]);
        }
        for (here, there) in tracks[0].tracks().iter().zip(tracks[1].tracks()) {
            let expected = turned(here.predicted(1.0).at_m, angle_rad, [east_m, north_m]);
            let found = there.predicted(1.0).at_m;
            prop_assert!(geometry::distance_m(expected, found) < 1e-9);
        }
    }

    /// Clusters are of the points, not of their order; no point is in two.
    #[test]
    fn clusters_do_not_depend_on_the_order_of_the_points(
        places in prop::collection::vec((-2.0..2.0f64, -2.0..2.0f64, 0.0..1.0f64, any::<bool>(), any::<bool>()), 0..150),
    ) {
        let config = ClustersConfig { points: 2, ..ClustersConfig::default() };
        let points: Vec<_> = places
            .iter()
            .map(|&(x, y, z, moves, stays)| PointOfView {
                at_m: [x, y, z], height_m: z, moves, stays, at_side: false,
            })
            .collect();
        let back: Vec<_> = points.iter().rev().copied().collect();
        let members = |points: &[PointOfView], back: bool| -> Vec<Vec<usize>> {
            let found = moving_clusters(points, [0.0; 2], &config);
            let index = |at: usize| if back { points.len() - 1 - at } else { at };
            let members = |one: MovingCluster| {
                let mut members: Vec<usize> = one.points.into_iter().map(index).collect();
                members.sort_unstable();
                members
            };
            found.into_iter().map(members).collect()
        };
        let found = members(&points, false);
        prop_assert_eq!(&found, &members(&back, true));
        let all: Vec<usize> = found.concat();
        let mut once = all.clone();
        once.sort_unstable();
        once.dedup();
        prop_assert_eq!(all.len(), once.len());
    }
}

#[test]
fn pairs_are_the_nearest_together_not_one_after_the_other() {
    let mut tracks = MovingTracks::new(TracksConfig::default()).unwrap();
    let first = tracks.update(0.0, &[cluster([0.0, 0.0]), cluster([0.2, 0.0])]);
    // The first that is seen is nearer to the second track, which the second needs.
    let then = tracks.update(0.1, &[cluster([0.11, 0.0]), cluster([0.31, 0.0])]);
    assert_eq!(first, then);
}

#[test]
fn what_is_not_seen_is_forgotten_and_what_is_far_is_new() {
    let config = TracksConfig::default();
    let mut tracks = MovingTracks::new(config.clone()).unwrap();
    let old = tracks.update(0.0, &[cluster([0.0, 0.0])]);
    let far = tracks.update(0.1, &[cluster([2.0, 0.0])]);
    assert_ne!(old, far);
    assert_eq!(tracks.tracks().len(), 2);
    let _none = tracks.update(0.05 + config.forget, &[]);
    assert_eq!(tracks.tracks().len(), 1);
}
