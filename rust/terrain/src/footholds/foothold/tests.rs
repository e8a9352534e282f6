//! Soles on floors, edges, slabs and what was not seen.

use super::*;
use geometry::{Grid, Lattice};
use proptest::prelude::*;

const SOLE: SoleSize = SoleSize {
    length_m: 0.105,
    width_m: 0.075,
};
const RISE_M: f64 = 0.055;
const CELL_M: f64 = 0.01;

/// A square metre around the origin.
fn map(height_m: impl Fn(f64, f64) -> f64) -> HeightMap {
    let lattice = Lattice {
        origin_m: [-0.5, -0.5],
        cell_m: CELL_M,
    };
    let mut heights_m = Grid::filled(100, 100, 0.0);
    for cell in heights_m.area().cells() {
        let [x_m, y_m] = lattice.center_of(cell);
        *heights_m.get_mut(cell).unwrap() = height_m(x_m, y_m) as f32;
    }
    HeightMap::new(lattice, heights_m, 0.0)
}

/// A sole with its middle at a place, at a heading.
fn stand(map: &HeightMap, x_m: f64, y_m: f64, yaw_rad: f64) -> Result<Foothold, NoFoothold> {
    let middle = map.lattice.cell_at(x_m, y_m);
    let [center_x_m, center_y_m] = map.lattice.center_of(middle);
    let off_m = [x_m - center_x_m, y_m - center_y_m];
    let config = FootholdConfig::default();
    let mut footholds = Footholds::new(
        config,
        (SOLE, RISE_M),
        std::iter::once(yaw_rad),
        (off_m, CELL_M),
    );
    footholds.read(map, middle, 0)
}

#[test]
fn on_a_floor_the_whole_sole_bears_and_beyond_the_map_none() {
    let floor = map(|_, _| 0.3);
    let found = stand(&floor, 0.0, 0.0, 0.0).unwrap();
    assert_eq!(found.bearing_share, 1.0);
    assert!((found.height_m - 0.3).abs() < 1e-6);
    assert!(found.bearing_m[0] < -0.0524 && found.bearing_m[1] > 0.0524);
    assert_eq!(stand(&floor, 0.48, 0.0, 0.0), Err(NoFoothold::Unseen));
    assert_eq!(stand(&floor, 1e9, -1e9, 0.0), Err(NoFoothold::Unseen));
}

#[test]
fn toes_may_hang_over_an_edge_by_a_quarter_and_what_bears_ends_there() {
    // The tread ends at x = 0; beyond it the ground is 4 cm lower.
    let edge = map(|x_m, _| if x_m < 0.0 { 0.04 } else { 0.0 });
    for hang_m in [0.005, 0.015, 0.02] {
        let found = stand(&edge, hang_m - 0.0525, 0.0, 0.0).unwrap();
        assert!((found.height_m - 0.04).abs() < 1e-6, "{found:?}");
        let edge_m = f64::from(found.bearing_m[1]);
        assert!(
            (edge_m - (0.0525 - hang_m)).abs() <= CELL_M,
            "{hang_m} {found:?}"
        );
        assert!(found.bearing_m[0] < -0.0524);
    }
    let half = stand(&edge, 0.0, 0.0, 0.0);
    assert_eq!(half, Err(NoFoothold::TooLittle));
}

#[test]
fn a_riser_is_kept_away_from_by_the_margin() {
    let riser = map(|x_m, _| if x_m > 0.0 { 0.04 } else { 0.0 });
    let toes = |to_riser_m: f64| stand(&riser, -0.0525 - to_riser_m, 0.0, 0.0);
    assert!(toes(0.021).is_ok());
    assert_eq!(toes(0.006), Err(NoFoothold::Higher));
    // And the sole never overlaps it, however little.
    assert_eq!(toes(-0.01), Err(NoFoothold::TooLittle));
}

#[test]
fn a_slab_that_ends_under_the_sole_is_stood_on_as_tilted_as_it_is() {
    let rise = libm::tan(8.0_f64.to_radians());
    let slab = map(|x_m, _| if x_m < 0.035 { 0.1 + rise * x_m } else { -0.05 });
    let found = stand(&slab, 0.0, 0.0, 0.0).unwrap();
    assert!((f64::from(found.slope[0]) - rise).abs() < 1e-3, "{found:?}");
    assert!((f64::from(found.height_m) - 0.1).abs() < 1e-3);
    let steep = map(|x_m, _| 0.25 * x_m);
    assert_eq!(stand(&steep, 0.0, 0.0, 0.0), Err(NoFoothold::TooSteep));
}

#[test]
fn a_sole_on_two_slabs_is_known_to_rock() {
    // They meet in a ridge under its middle; and one is a little lower than the other where the toes are.
    let ridge = map(|x_m, _| -0.12 * x_m.abs());
    let lower = map(|x_m, _| if x_m > 0.03 { -0.009 } else { 0.0 });
    let deep = map(|x_m, _| if x_m > 0.03 { -0.04 } else { 0.0 });
    let even = map(|x_m, y_m| 0.1 * x_m + 0.05 * y_m);
    let [ridge, lower, deep, even] =
        [ridge, lower, deep, even].map(|map| stand(&map, 0.0, 0.0, 0.0).unwrap().unevenness);
    assert!(even < 1e-3 && deep < 1e-3, "{even} {deep}");
    assert!(ridge > 0.05 && lower > 0.1, "{ridge} {lower}");
}

#[test]
fn what_was_not_seen_bears_nothing() {
    let seen = |from_m: f64| map(move |x_m, _| if x_m > from_m { f64::NAN } else { 0.0 });
    assert!(stand(&seen(0.035), 0.0, 0.0, 0.0).is_ok());
    assert_eq!(stand(&seen(0.0), 0.0, 0.0, 0.0), Err(NoFoothold::Unseen));
}

#[test]
fn a_bar_between_two_places_is_in_the_way_of_a_foot_that_is_not_lifted_over_it() {
    let bar = map(|x_m, _| {
        if (0.0..0.012).contains(&x_m) {
            0.025
        } else {
            0.0
        }
    });
    let blocks = HighBlocks::new(&bar);
    let config = FootholdConfig::default();
    let footholds = Footholds::new(
        config,
        (SOLE, RISE_M),
        std::iter::once(0.0),
        ([0.0; 2], CELL_M),
    );
    let place = |x_m: f64| PlanarPose::new(x_m, 0.0, 0.0);
    let free = |from_m: f64, to_m: f64, than_m: f32| {
        let (from, to) = (place(from_m), place(to_m));
        footholds.is_way_free((&bar, &blocks), (&from, 0), (&to, 0), than_m)
    };
    assert!(!free(-0.08, 0.08, 0.02) && free(-0.08, 0.08, 0.03));
    assert!(free(-0.2, -0.08, 0.02));
    assert!(blocks.is_higher_within(&bar, [-0.1, 0.0], 0.12, 0.02));
    assert!(!blocks.is_higher_within(&bar, [-0.1, 0.0], 0.09, 0.02));
}

proptest! {
    /// Whichever way the sole points.
    #[test]
    fn a_slope_is_found_as_it_is(
        forward in -0.1..0.1f64, left in -0.1..0.1f64, yaw_rad in -4.0..4.0f64, x_m in -0.3..0.3f64, y_m in -0.3..0.3f64,
    ) {
        let (sin, cos) = libm::sincos(yaw_rad);
        let slope = map(|x_m, y_m| forward * (cos * x_m + sin * y_m) + left * (cos * y_m - sin * x_m));
        let found = stand(&slope, x_m, y_m, yaw_rad).unwrap();
        prop_assert!((f64::from(found.slope[0]) - forward).abs() < 1e-4);
        prop_assert!((f64::from(found.slope[1]) - left).abs() < 1e-4);
        prop_assert_eq!(found.bearing_share, 1.0);
        let expected_m = forward * (cos * x_m + sin * y_m) + left * (cos * y_m - sin * x_m);
        prop_assert!((f64::from(found.height_m) - expected_m).abs() < 1e-4);
    }

    /// No sole that stands overlaps what is higher than it by more than it may.
    #[test]
    fn no_sole_stands_in_what_is_higher(
        steps in prop::collection::vec(-0.05..0.05f64, 25), yaw_rad in -4.0..4.0f64, x_m in -0.4..0.4f64, y_m in -0.4..0.4f64,
    ) {
        let rubble = map(|x_m, y_m| {
            let at = |value_m: f64| ((value_m + 0.5) / 0.2).clamp(0.0, 4.0) as usize;
            steps[at(y_m) * 5 + at(x_m)]
        });
        if let Ok(found) = stand(&rubble, x_m, y_m, yaw_rad) {
            let pose = PlanarPose::new(x_m, y_m, yaw_rad);
            for cell in rubble.heights_m().area().cells() {
                let [cell_x_m, cell_y_m] = rubble.lattice.center_of(cell);
                let at = pose.relative(&PlanarPose::new(cell_x_m, cell_y_m, 0.0));
                if at.x_m.abs() < 0.5 * SOLE.length_m && at.y_m.abs() < 0.5 * SOLE.width_m {
                    let plane_m = found.height_m + found.slope[0] * at.x_m as f32 + found.slope[1] * at.y_m as f32;
                    prop_assert!(rubble.height_m(cell).unwrap() <= plane_m + 0.0061);
                }
            }
        }
    }
}

#[test]
fn nothing_is_in_the_way_where_the_foot_stands_but_what_is_high_ahead_is() {
    let free = |high: [f64; 2]| {
        let map = map(|x_m, _| {
            if (high[0]..high[1]).contains(&x_m) {
                0.1
            } else {
                0.0
            }
        });
        let config = FootholdConfig::default();
        let footholds = Footholds::new(
            config,
            (SOLE, RISE_M),
            std::iter::once(0.0),
            ([0.0; 2], CELL_M),
        );
        let places = [0.0, 0.15].map(|x_m| PlanarPose::new(x_m, 0.0, 0.0));
        let (from, to) = ((&places[0], 0), (&places[1], 0));
        footholds.is_way_free((&map, &HighBlocks::new(&map)), from, to, 0.03)
    };
    // The map has something where the foot is: it is off.
    assert!(free([-0.06, -0.03]));
    assert!(!free([0.08, 0.1]));
    assert!(!free([-0.03, 0.2]));
}

#[test]
fn what_is_blurred_bears_nothing_and_is_in_the_way_where_it_is_high() {
    let mut floor = map(|_, _| 0.0);
    for cell in floor.heights_m().area().cells() {
        let [x_m, _] = floor.lattice.center_of(cell);
        if x_m > 0.03 {
            floor.set_blurred(cell, 0.0);
        }
    }
    let found = stand(&floor, 0.0, 0.0, 0.0).unwrap();
    assert!(
        found.bearing_share < 0.85 && found.bearing_m[1] < 0.04,
        "{found:?}"
    );
    let cell = floor.lattice.cell_at(0.045, 0.0);
    floor.set_blurred(cell, 0.03);
    assert_eq!(stand(&floor, 0.0, 0.0, 0.0), Err(NoFoothold::Higher));
}

#[test]
fn what_is_closed_beside_a_sole_is_unknown_or_out_of_reach_and_no_stair() {
    let closed_share = |beyond_m: f64, away_m: f64| {
        let map = map(|_, y_m| if y_m > 0.0375 + away_m { beyond_m } else { 0.1 });
        stand(&map, 0.0, 0.0, 0.0).unwrap().closed_share
    };
    for open_m in [0.1, 0.06, 0.14] {
        assert_eq!(closed_share(open_m, 0.02), 0.0, "{open_m}");
    }
    for closed_m in [f64::NAN, 0.0, 0.2] {
        let near = closed_share(closed_m, 0.02);
        assert!((0.1..0.2).contains(&near), "{closed_m} {near}");
        assert!(closed_share(closed_m, 0.01) > near);
        assert_eq!(closed_share(closed_m, 0.05), 0.0);
    }
}
