//! Looking from the voxels into the picture, against following every ray.

mod common;

use common::{Block, camera, look};
use geometry::{Camera, Lattice, Map, Pose};
use mapping::{Clearing, Fog, FogConfig, Update, WorldModel};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use proptest::prelude::*;
use volume::{OccupancyGrid, Picture, Placement, ProbabilityTable, Ray, Size};

const SIZE: Size = Size {
    cols: 60,
    rows: 50,
    layers: 24,
};
const CELL_M: f64 = 0.04;
const RANGE_M: f64 = 1.6;

/// A picture with its depths; NaN where nothing was seen.
#[derive(Debug, Clone)]
struct Frame {
    picture: Picture,
    eye_m: [f64; 3],
    depths_m: Vec<f64>,
}

impl Frame {
    /// Rays to what was seen, cut at the longest range.
    fn rays(&self) -> impl Iterator<Item = (usize, Ray)> {
        let Picture {
            size_px: [width, _],
            focal_px,
            centre_px,
            axes: [right, down, forward],
        } = self.picture;
        self.depths_m
            .iter()
            .enumerate()
            .filter_map(move |(pixel, &depth_m)| {
                let u = ((pixel % width) as f64 - centre_px[0]) / focal_px[0];
                let v = ((pixel / width) as f64 - centre_px[1]) / focal_px[1];
                let along: [f64; 3] =
                    std::array::from_fn(|a| u * right[a] + v * down[a] + forward[a]);
                let length = along.iter().map(|part| part * part).sum::<f64>().sqrt();
                let reach_m = depth_m.min(RANGE_M / length);
                let end_m = std::array::from_fn(|a| self.eye_m[a] + reach_m * along[a]);
                let hit = depth_m <= reach_m;
                depth_m.is_finite().then_some((pixel, Ray { end_m, hit }))
            })
    }
}

fn grid(layer_m: f64) -> OccupancyGrid {
    let placement = Placement {
        lattice: Lattice {
            origin_m: [-0.5, -1.0],
            cell_m: CELL_M,
        },
        bottom_m: -0.02,
        layer_m,
    };
    OccupancyGrid::new(SIZE, placement, ProbabilityTable::new(0.7, 0.7, 0.05, 0.95))
}

fn insert(grid: &mut OccupancyGrid, frame: &Frame, clearing: Clearing) {
    let (eye_m, picture) = (frame.eye_m, &frame.picture);
    let _area = grid.insert_picture(eye_m, picture, frame.rays(), Update::PerFrame, clearing);
}

/// Probabilities of all voxels.
fn probabilities(grid: &OccupancyGrid) -> Vec<f64> {
    probabilities_of(grid, SIZE)
}

fn probabilities_of(grid: &OccupancyGrid, size: Size) -> Vec<f64> {
    let Placement {
        lattice,
        bottom_m,
        layer_m,
    } = grid.placement;
    let middle = |n: usize| n as f64 + 0.5;
    (0..size.cols * size.rows * size.layers)
        .map(|number| {
            let [col, row, layer] = [
                number % size.cols,
                number / size.cols % size.rows,
                number / (size.cols * size.rows),
            ];
            grid.probability([
                lattice.origin_m[0] + middle(col) * CELL_M,
                lattice.origin_m[1] + middle(row) * CELL_M,
                bottom_m + middle(layer) * layer_m,
            ])
        })
        .collect()
}

/// A camera of any attitude whose picture has pixels of any size, in or beside the grid.
fn view() -> impl Strategy<Value = (Picture, [f64; 3])> {
    let size = (4_usize..70, 4_usize..70);
    let focal = (20.0..150.0_f64, 0.8..1.25_f64);
    let attitude = (-3.2..3.2_f64, -0.5..1.6_f64, -0.6..0.6_f64);
    let eye = [-0.7..1.8_f64, -1.1..1.1, 0.0..0.9_f64];
    (size, focal, attitude, eye).prop_map(|(size, focal, (yaw, down, roll), eye_m)| {
        // Looking along x: the picture's right is -y, its down is -z.
        let optical = UnitQuaternion::from_matrix(&nalgebra::Matrix3::new(
            0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0,
        ));
        let turned = UnitQuaternion::from_euler_angles(roll, down, yaw) * optical;
        let place = Translation3::from(Vector3::from(eye_m));
        let pose = Pose::<Map, Camera>::wrap(Isometry3::from_parts(place, turned));
        let picture = Picture {
            size_px: [size.0, size.1],
            focal_px: [focal.0, focal.0 * focal.1],
            centre_px: [0.4 * size.0 as f64, 0.6 * size.1 as f64],
            axes: Picture::axes_of(&pose),
        };
        (picture, eye_m)
    })
}

/// Depths: a smooth surface, noise, pixels of any depth, and such in which nothing was seen.
fn frame() -> impl Strategy<Value = Frame> {
    (view(), 0.05..2.0_f64, -0.02..0.02_f64, any::<u64>()).prop_map(
        |((picture, eye_m), depth_m, slope, seed)| {
            let [width, height] = picture.size_px;
            let depths_m = (0..(width * height) as u64).map(|pixel| {
                // Bits of a counter, mixed (Steele 2014).
                let mixed = (pixel + 1)
                    .wrapping_mul(seed | 1)
                    .wrapping_mul(0x9e37_79b9_7f4a_7c15);
                let mixed = mixed ^ (mixed >> 31);
                let part = (mixed >> 40) as f64 / f64::from(1 << 24);
                match mixed % 16 {
                    0 => f64::NAN,
                    1 => 2.5 * part,
                    _ => (depth_m + slope * (pixel % width as u64) as f64 + 0.03 * part).max(0.01),
                }
            });
            Frame {
                depths_m: depths_m.collect(),
                picture,
                eye_m,
            }
        },
    )
}

#[test]
fn a_fog_looks_into_pictures_and_follows_the_rays_of_other_frames() {
    let blocks = [
        Block::new([0.6, -0.5, 0.0], [0.69, 0.5, 0.038], true),
        Block::new([0.9, 0.3, 0.0], [1.0, 0.5, 0.3], false),
        Block::new([-3.0, 1.4, 0.0], [4.0, 1.5, 0.6], false),
    ];
    let pose = Pose::identity();
    let map = |clearing: Clearing, is_picture: bool| {
        let config = FogConfig {
            clearing,
            ..FogConfig::default()
        };
        let size = Size {
            cols: config.cells,
            rows: config.cells,
            layers: config.layers,
        };
        let mut fog = Fog::new(config).unwrap();
        for pan in [-0.5, 0.0, 0.5, 0.0] {
            let mut planes = look(&blocks, &pose, camera(0.5, 0.6, pan));
            planes.camera = planes.camera.filter(|_| is_picture);
            assert!(fog.insert(&planes, &pose).unwrap().used);
        }
        (probabilities_of(&fog.occupancy, size), fog.view().clone())
    };
    let (exact, exact_view) = map(Clearing::EveryRay, true);
    assert!(map(Clearing::Projected, false).0 == exact);
    let (projected, view) = map(Clearing::Projected, true);
    let free = |map: &[f64]| map.iter().filter(|&&p| p < 0.5).count();
    assert!(
        projected
            .iter()
            .zip(&exact)
            .all(|(now, exact)| now >= exact)
    );
    assert!(free(&projected) < free(&exact));
    assert!(free(&projected) as f64 > 0.965 * free(&exact) as f64);
    let cells = exact_view.cells.area().cells();
    let same = cells.filter(|&cell| {
        std::mem::discriminant(&view.cell(cell)) == std::mem::discriminant(&exact_view.cell(cell))
    });
    let share = same.count() as f64 / exact_view.cells.values().len() as f64;
    assert!(share > 0.995, "{share} of the view is the same");
}

/// What takes seconds: not in the fast part of the tests.
mod slow {
    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(150))]
        #[test]
        fn what_is_projected_frees_no_voxel_that_rays_do_not_and_hits_the_same(
            frames in prop::collection::vec(frame(), 1..4),
            layer_m in prop_oneof![Just(0.04), 0.02..0.07_f64],
        ) {
            let [mut exact, mut projected] = [grid(layer_m), grid(layer_m)];
            for frame in frames.iter().flat_map(|frame| [frame, frame]) {
                let before = probabilities(&projected);
                insert(&mut exact, frame, Clearing::EveryRay);
                insert(&mut projected, frame, Clearing::Projected);
                let mut once = grid(layer_m);
                insert(&mut once, frame, Clearing::EveryRay);
                let (once, exact, now) = (probabilities(&once), probabilities(&exact), probabilities(&projected));
                for (((hit, exact), now), before) in once.into_iter().zip(exact).zip(now).zip(before) {
                    prop_assert!(now >= exact, "{now} where every ray says {exact}");
                    prop_assert!(hit <= 0.5 || now > before || now > 0.949, "{before} is hit and stays {now}");
                    prop_assert!(hit >= 0.5 || now <= before, "{before} is passed and becomes {now}");
                }
            }
        }
    }
}
