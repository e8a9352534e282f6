//! What a description says of a foot.

use super::*;

fn leg(sensors: Option<ForceSensors>) -> Leg {
    let sole = Sole {
        link: "foot".to_owned(),
        position: [0.02, 0.005, -0.045],
        length: 0.15,
        width: 0.09,
    };
    Leg {
        joints: ["a", "b", "c", "d", "e", "f"].map(str::to_owned).to_vec(),
        sole,
        sensors,
    }
}

#[test]
fn force_sensors_are_at_the_soles_corners_unless_told_otherwise() {
    assert_eq!(leg(None).sensors_on_sole_m(), ([0.0; 2], [0.15, 0.09]));
    let inside = leg(Some(ForceSensors {
        position: [0.03, 0.0, -0.045],
        length: 0.1,
        width: 0.05,
    }));
    let (middle_m, size_m) = inside.sensors_on_sole_m();
    assert!((middle_m[0] - 0.01).abs() < 1e-12 && (middle_m[1] + 0.005).abs() < 1e-12);
    assert_eq!(size_m, [0.1, 0.05]);
}
