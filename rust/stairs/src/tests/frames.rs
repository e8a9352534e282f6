//! Single views and head swings.

use super::*;

#[test]
fn a_head_swing_over_four_steps_finds_four_with_their_heights() {
    let scene = Scene::stairs(0.4, 0.03, 0.12, 4);
    for seed in 0..5 {
        let mut looker = Looker::new(seed, SIGMA);
        for i in 0..12 {
            let camera = camera_pose(0.05 * f64::from(i - 6), 0.75);
            let _ = looker.look(&scene, &camera, &Pose::identity(), 0);
        }
        let stairs = &looker.recognizer.staircase.stairs;
        assert_eq!(stairs.len(), 4, "seed {seed}");
        for (i, stair) in stairs.iter().enumerate() {
            let (rise_m, front_m) = (0.03 * (i + 1) as f64, 0.4 + 0.12 * i as f64);
            assert!((stair.height_m() - rise_m).abs() < 0.003, "{stair:?}");
            assert!((stair.front.middle().inner.x - front_m).abs() < 0.005);
            assert!(stair.front.heading_rad().abs() < 0.02);
        }
    }
}
