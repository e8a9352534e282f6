//! What is asked of an octree: boxes and rays.

mod beams;

use beams::{CENTRE, RESOLUTION, SPAN, frames, in_voxels, point, tree};
use mapping::Update;
use proptest::prelude::*;
use volume::VoxelWalk;
use volume::octree::{Cast, Sighting};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]
    #[test]
    fn a_cast_ray_ends_in_the_first_occupied_voxel(
        frames in frames(3.0),
        origin in point(3.0),
        direction in point(1.0),
        max_range_m in prop_oneof![Just(f64::INFINITY), 0.1..5.0_f64],
        through_unknown in any::<bool>(),
    ) {
        let mut tree = tree();
        for (eye, rays) in &frames {
            let _beyond = tree.insert(*eye, rays, Update::PerFrame).unwrap();
        }
        let far = std::array::from_fn(|axis| origin[axis] + 50.0 * direction[axis]);
        let mut expected = Cast::Nothing;
        for voxel in VoxelWalk::new(in_voxels(origin), in_voxels(far), [SPAN; 3]).unwrap() {
            let centre = voxel.map(|at| (f64::from(at) + 0.5 - CENTRE) * RESOLUTION);
            let off = (0..3).map(|a| (centre[a] - origin[a]).powi(2)).sum::<f64>().sqrt();
            let starts = voxel == in_voxels(origin).map(|at| at as i32);
            if off > max_range_m && !starts {
                break;
            }
            match tree.log_odds(voxel.map(|at| at as u16)) {
                Some(value) if value >= 0.0 => expected = Cast::Occupied(centre),
                None if !through_unknown => expected = Cast::Unknown(centre),
                _ => continue,
            }
            break;
        }
        prop_assert_eq!(tree.cast_ray(origin, direction, Sighting { max_range_m, through_unknown }), expected);
    }
}

#[test]
fn a_cast_in_a_box_room_is_the_distance_to_its_wall() {
    let mut tree = tree();
    for n in 0..40 * 40 {
        let (a, b) = (
            f64::from(n % 40) * 0.1 + 0.05 - 2.0,
            f64::from(n / 40) * 0.1 + 0.05 - 2.0,
        );
        for wall in [-2.05, 2.05] {
            for at in [[wall, a, b], [a, wall, b], [a, b, wall]] {
                tree.update_voxel(tree.key_at(at).unwrap(), true);
            }
        }
    }
    let sighting = Sighting {
        max_range_m: f64::INFINITY,
        through_unknown: true,
    };
    let origin = [0.31, -0.42, 0.13];
    for n in 0..500 {
        let (turn, rise) = (0.37 * f64::from(n), 0.9 * libm::sin(0.11 * f64::from(n)));
        let direction = [
            libm::cos(turn) * libm::cos(rise),
            libm::sin(turn) * libm::cos(rise),
            libm::sin(rise),
        ];
        let to_wall =
            |axis: usize| (2.0_f64.copysign(direction[axis]) - origin[axis]) / direction[axis];
        let expected = to_wall(0).min(to_wall(1)).min(to_wall(2));
        let Cast::Occupied(end) = tree.cast_ray(origin, direction, sighting) else {
            panic!("the room is closed");
        };
        let found = (0..3)
            .map(|a| (end[a] - origin[a]).powi(2))
            .sum::<f64>()
            .sqrt();
        assert!((found - expected).abs() <= 0.5 * RESOLUTION * 3.0_f64.sqrt() + 1e-9);
    }
}
