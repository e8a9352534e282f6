//! The localizer as a whole: it tracks, it finds, it finds again, and it says what it does not know.

use geometry::{PlanarPose, Pose};

use super::world::{Walk, World};
use super::*;

fn start(at: &PlanarPose, level_m: f64) -> Pose<Map, Robot> {
    Pose::from_yaw(at.x_m, at.y_m, level_m, at.yaw_rad)
}

/// Way and turn of one frame on a round of about 6 m through the room's free part.
fn round(number: usize) -> [f64; 2] {
    let turning = number % 150 >= 110;
    if turning {
        [0.004, 0.0785]
    } else {
        [0.022, 0.0]
    }
}

/// Mean and worst error in the plane of a walk of 60 s, m, and the error that odometry alone ended with.
fn track(world: &World, config: MonteCarloConfig) -> [f64; 3] {
    let at = PlanarPose::new(1.1, 0.9, 1.57);
    let localizer =
        MonteCarloLocalizer::new(world.map(&config), Some(start(&at, 0.0)), config).unwrap();
    let mut walk = Walk::new(world, localizer, at, 0.0);
    let errors: Vec<f64> = (0..375)
        .map(|number| {
            let [forward_m, turn_rad] = round(number);
            walk.step(forward_m, turn_rad)[0]
        })
        .collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let worst = errors.iter().copied().fold(0.0, f64::max);
    [mean, worst, walk.odometry_error_m(&at)]
}

/// Steps of a walk in the pool of so many threads; all bits of what comes out.
fn bits(threads: usize) -> Vec<u64> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    pool.install(|| {
        let world = World::two_levels();
        let config = MonteCarloConfig {
            most_particles: 1500,
            ..MonteCarloConfig::default()
        };
        let localizer = MonteCarloLocalizer::new(world.map(&config), None, config).unwrap();
        let mut walk = Walk::new(&world, localizer, PlanarPose::new(2.6, 1.2, 0.3), 0.0);
        (0..25)
            .flat_map(|_| walk.step(0.01, 0.05).map(f64::to_bits))
            .collect()
    })
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    assert_eq!(bits(1), bits(4));
}

/// Frames until the estimate is within 0.1 m and 0.1 rad, on the right level, and stays so for 2 s.
fn frames_to_find(walk: &mut Walk<'_>, most: usize) -> Option<usize> {
    let mut good = 0;
    for number in 0..most {
        // Looks round, then goes on a small circle.
        let error = walk.step(if number < 30 { 0.004 } else { 0.012 }, 0.07);
        let found = error[0] < 0.1 && error[2] < 0.05 && error[1] < 0.1;
        good = if found { good + 1 } else { 0 };
        if good > 12 {
            return Some(number - 12);
        }
    }
    None
}

#[test]
fn a_search_that_is_begun_again_guesses_elsewhere() {
    let world = World::two_levels();
    let config = MonteCarloConfig::default();
    let map = world.map(&config);
    let localizer = MonteCarloLocalizer::new(map.clone(), None, config.clone()).unwrap();
    let mut walk = Walk::new(&world, localizer, PlanarPose::new(2.6, 1.2, 0.3), 0.0);
    let _ = walk.step(0.0, 0.0);
    let reading = walk.localizer.last.unwrap();
    let places = |step| -> Vec<_> {
        let search = PlaceSearch::anywhere(&config, &map, &reading, step);
        search.particles().map(|one| one.pose.place_m).collect()
    };
    assert_eq!(places(3), places(3));
    assert_ne!(places(3), places(4));
}

/// Where a robot that odometry has at (1, 0) is taken to be, after it was taken to be there and a frame says that it is `off`.
fn followed(off: [f64; 3], turned_rad: f64) -> Pose<Map, Robot> {
    let odometry_from_robot = Pose::from_yaw(1.0, 0.0, 0.0, 0.3);
    let found: Pose<Map, Robot> = Pose::from_yaw(1.0 + off[0], off[1], off[2], 0.3 + turned_rad);
    let found = found * odometry_from_robot.inverse();
    let config = MonteCarloConfig::default();
    follow(&Pose::identity(), &found, &odometry_from_robot, &config) * odometry_from_robot
}

#[test]
fn within_the_bands_odometry_holds_beyond_them_the_frames_do_by_and_by() {
    let still = followed([0.01, -0.015, 0.003], 0.015);
    let at = still.origin().inner;
    assert!((at.x - 1.0).abs() < 1e-9 && at.y.abs() < 1e-9 && at.z.abs() < 1e-9);
    assert!((still.yaw_rad() - 0.3).abs() < 1e-9);
    let drawn = followed([0.0, 0.12, 0.07], -0.12);
    let at = drawn.origin().inner;
    assert!((at.y - 0.01).abs() < 1e-9 && (at.z - 0.0066).abs() < 1e-9);
    assert!((drawn.yaw_rad() - 0.29).abs() < 1e-9);
}

#[test]
fn who_is_elsewhere_is_there_at_once() {
    let at = followed([0.0, 2.0, 0.36], 1.0);
    assert!((at.origin().inner.y - 2.0).abs() < 1e-9 && (at.yaw_rad() - 1.3).abs() < 1e-9);
}

/// What takes seconds: not in the fast part of the tests.
mod slow {
    use super::*;

    #[test]
    fn a_walk_of_a_minute_is_tracked_where_odometry_drifts_away() {
        for range_model in [RangeModel::RayCast, RangeModel::LikelihoodField] {
            let config = MonteCarloConfig {
                range_model,
                ..MonteCarloConfig::default()
            };
            let [mean, worst, odometry] = track(&World::room(), config);
            assert!(mean < 0.05 && worst < 0.15, "{mean} {worst}");
            assert!(odometry > 0.5, "{odometry}");
        }
    }

    #[test]
    fn what_the_map_does_not_have_in_the_way_is_put_up_with() {
        let mut world = World::room();
        world.unmapped = vec![
            [[0.5, 3.9, 0.0], [0.8, 4.2, 0.4]],
            [[1.5, 1.2, 0.0], [1.7, 1.4, 0.3]],
            [[0.4, 1.2, 0.0], [0.6, 1.5, 0.5]],
            [[1.6, 4.3, 0.0], [1.9, 4.6, 0.6]],
            [[1.55, 3.2, 0.0], [1.75, 3.4, 0.25]],
        ];
        let [mean, worst, _] = track(&world, MonteCarloConfig::default());
        assert!(mean < 0.05 && worst < 0.15, "{mean} {worst}");
    }

    #[test]
    fn in_a_corridor_that_looks_the_same_everywhere_the_spread_along_it_grows_and_across_it_does_not()
     {
        const SEEDS: u64 = 6;
        const FRAMES: usize = 150;
        let world = World::walled(14.0, 1.2);
        // One filter's spread along is chance: by the mean of several.
        let (mut along, mut inside) = (0.0, 0);
        for seed in 0..SEEDS {
            let config = MonteCarloConfig {
                seed,
                ..MonteCarloConfig::default()
            };
            let at = PlanarPose::new(4.0, 0.6, 0.0);
            let localizer =
                MonteCarloLocalizer::new(world.map(&config), Some(start(&at, 0.0)), config)
                    .unwrap();
            let mut walk = Walk::new(&world, localizer, at, 0.0);
            // As wrong as the motion model says, and no more.
            walk.drift = [1.0, 0.0];
            for _ in 0..FRAMES {
                let _ = walk.step(0.022, 0.0);
                let belief = walk.localizer.belief().unwrap();
                let off = (belief.torso.place_m[0] - walk.truth.x_m).abs();
                inside += usize::from(off < 2.5 * belief.covariance.m11.sqrt());
            }
            let covariance = walk.localizer.belief().unwrap().covariance;
            along += covariance.m11.sqrt() / SEEDS as f64;
            assert!(covariance.m22.sqrt() < 0.03, "{covariance}");
        }
        assert!(along > 0.06, "{along}");
        assert!(inside * 10 > SEEDS as usize * FRAMES * 9, "{inside}");
    }

    #[test]
    fn on_two_levels_the_right_place_is_found_from_anywhere_in_9_of_10() {
        let world = World::two_levels();
        let places = [
            (PlanarPose::new(2.6, 1.2, 0.3), 0.0),
            (PlanarPose::new(1.1, 1.3, 2.0), 0.72),
            (PlanarPose::new(0.9, 1.8, -1.0), 0.0),
            (PlanarPose::new(1.2, 1.9, -2.0), 0.72),
            (PlanarPose::new(3.0, 1.8, 1.2), 0.0),
        ];
        let mut found = 0;
        let map = world.map(&MonteCarloConfig::default());
        for seed in 0..10 {
            let config = MonteCarloConfig {
                seed,
                ..MonteCarloConfig::default()
            };
            let localizer = MonteCarloLocalizer::new(map.clone(), None, config).unwrap();
            let (at, level_m) = places[seed as usize % places.len()];
            let mut walk = Walk::new(&world, localizer, at, level_m);
            let frames = frames_to_find(&mut walk, 125);
            found += usize::from(frames.is_some());
        }
        assert!(found >= 9, "{found}");
    }

    #[test]
    fn who_is_carried_to_another_level_finds_out_where_in_5_of_6() {
        let world = World::two_levels();
        let map = world.map(&MonteCarloConfig::default());
        let (below, above) = (
            PlanarPose::new(2.6, 1.2, 0.3),
            PlanarPose::new(1.1, 1.5, 2.0),
        );
        let mut found = 0;
        for seed in 0..6 {
            let config = MonteCarloConfig {
                seed,
                ..MonteCarloConfig::default()
            };
            let [(from, from_m), (to, to_m)] = if seed % 2 == 0 {
                [(below, 0.0), (above, 0.72)]
            } else {
                [(above, 0.72), (below, 0.0)]
            };
            let localizer =
                MonteCarloLocalizer::new(map.clone(), Some(start(&from, from_m)), config);
            let mut walk = Walk::new(&world, localizer.unwrap(), from, from_m);
            for _ in 0..40 {
                let _ = walk.step(0.01, 0.06);
            }
            (walk.truth, walk.level_m) = (to, to_m);
            let frames = frames_to_find(&mut walk, 125);
            found += usize::from(frames.is_some());
        }
        assert!(found >= 5, "{found}");
    }

    #[test]
    fn a_room_that_is_the_same_after_half_a_turn_but_for_one_thing_is_not_mistaken_in_5_of_6() {
        let mut world = World::walled(3.0, 2.0);
        world.mapped.push([[2.6, 0.0, 0.0], [3.0, 0.5, 0.6]]);
        let map = world.map(&MonteCarloConfig::default());
        let mut right = 0;
        for seed in 0..6 {
            let config = MonteCarloConfig {
                seed,
                ..MonteCarloConfig::default()
            };
            let localizer = MonteCarloLocalizer::new(map.clone(), None, config).unwrap();
            // It begins with its back to the thing.
            let mut walk = Walk::new(&world, localizer, PlanarPose::new(1.2, 1.0, 2.6), 0.0);
            let found = (0..150).find_map(|_| {
                let error = walk.step(0.004, 0.07);
                (!walk.localizer.is_lost()).then_some(error)
            });
            right += usize::from(found.is_some_and(|[off_m, ..]| off_m < 0.1));
        }
        assert!(right >= 5, "{right}");
    }
}
