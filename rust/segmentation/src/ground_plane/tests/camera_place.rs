//! Where the camera sits: what its height at several tilts of the head tells of it.

use nalgebra::{Isometry3, Translation3};

use super::*;

/// Where the head looks on open floor: aside, down, rad.
const GAZES: [(f64, f64); 7] = [
    (0.0, 0.55),
    (0.7, 0.8),
    (-0.7, 0.8),
    (1.1, 1.0),
    (-1.1, 1.0),
    (0.0, 0.8),
    (0.0, 1.1),
];

/// Height of the camera above the joint of the trunk, m.
const ABOVE_TRUNK_M: f64 = 0.225;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]
    #[test]
    fn a_camera_that_sits_elsewhere_in_the_head_is_found_to_millimetres(
        ahead_m in -0.007..0.007f64,
        above_m in -0.007..0.007f64,
        neck in -0.09..0.09f64,
        trunk in -0.02..0.02f64,
        seed in 0..1000_u64,
    ) {
        let mut noise = Noise::new(seed);
        let in_the_head = Isometry3::from_parts(
            Translation3::new(0.0, -above_m, ahead_m),
            UnitQuaternion::new(Vector3::x() * neck),
        );
        let truth = |by_joints: &Pose<Robot, Camera>| {
            let camera_m = by_joints.inner.translation.vector;
            let joint = Translation3::from(camera_m - Vector3::z() * ABOVE_TRUNK_M);
            let bend = joint * UnitQuaternion::new(Vector3::y() * trunk) * joint.inverse();
            Pose::wrap(bend * by_joints.inner * in_the_head)
        };
        let (mut segmenter, mut planes) = (segmenter(), planes());
        for (aside, down) in GAZES.iter().cycle().take(14).flat_map(|gaze| [gaze; 8]) {
            let by_joints = camera_pose(*aside, *down);
            let scan = Scene::floor().scan(&truth(&by_joints), by_joints, SIGMA, &mut noise);
            segmenter.segment(&scan, &mut planes).unwrap();
        }
        prop_assert!(planes.reliable);
        for down in [0.8, 1.1] {
            let by_joints = camera_pose(0.0, down);
            let predicted = segmenter.correction.predict(&by_joints).inner.translation;
            let off_m = truth(&by_joints).inner.translation.vector - predicted.vector;
            prop_assert!(off_m.x.abs() < 0.005 && off_m.z.abs() < 0.002, "{} at {}", off_m, down);
        }
    }
}
