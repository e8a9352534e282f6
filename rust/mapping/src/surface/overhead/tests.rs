//! Claims about layers, and what follows from them.

use super::*;
use crate::surface::OverheadTuning;
use proptest::prelude::*;
use settings::Table;

const HEIGHTS: Heights = Heights {
    bottom_m: -0.34,
    layer_m: 0.04,
    layers: 32,
};

#[test]
fn the_shipped_settings_are_allowed() {
    assert_eq!(OverheadTuning::default().check(), Ok(()));
}

proptest! {
    #[test]
    fn a_layer_is_between_two_heights_when_its_middle_is(low_m in -0.6..1.2f64, room_m in 0.0..0.8f64) {
        let bits = HEIGHTS.between(low_m, low_m + room_m);
        for layer in 0..64_u32 {
            let middle_m = HEIGHTS.middle_m(layer);
            let near = [low_m, low_m + room_m].iter().any(|at| (at - middle_m).abs() < 1e-9);
            let holds = layer < 32 && middle_m >= low_m && middle_m < low_m + room_m;
            prop_assert!(near || (bits >> layer & 1 == 1) == holds, "{}", layer);
        }
    }

    #[test]
    fn what_was_looked_through_stays_so_as_the_layers_follow_the_robot(layers in -6..6_i32) {
        let mut overhead = Overhead::new(4, OverheadTuning::default());
        let area = overhead.through.area();
        overhead.stand(area, &HEIGHTS, 0.0, 0.58);
        overhead.shift(0, 0, layers);
        let bottom_m = HEIGHTS.bottom_m + f64::from(layers) * HEIGHTS.layer_m;
        let moved = Heights { bottom_m, ..HEIGHTS };
        prop_assert!(overhead.is_seen(0, &moved, 0.0, 0.58));
        prop_assert!(!overhead.is_seen(0, &moved, 0.12, 0.58));
    }
}
