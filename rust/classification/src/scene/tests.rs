//! Claims about groups, labels and their map.

use geometry::Pose;
use nalgebra::{Isometry3, Matrix3, Rotation3, UnitQuaternion, Vector3};
use proptest::prelude::*;

use super::*;
use crate::markov_field::MarkovFieldConfig;
use crate::synthetic::Noise;

const COLS: usize = 160;
const ROWS: usize = 120;
const SIGMA: f64 = 0.003;
/// Eye over the floor, m.
const EYE_M: f64 = 0.6;

/// What is in the room, as boxes: least and largest corner, m. The floor is no box.
type Boxes = [[[f64; 3]; 2]];

/// A wall 2 m ahead and a cupboard before it.
const ROOM: &Boxes = &[
    [[2.0, -3.0, 0.0], [2.1, 3.0, 1.0]],
    [[1.7, -0.4, 0.0], [2.0, 0.1, 0.45]],
];

/// Optical frame in the map, looking along x and down by this angle.
fn pose(down_rad: f64) -> Pose<geometry::Map, geometry::Camera> {
    let ahead = Matrix3::new(0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0);
    let down = Rotation3::from_axis_angle(&Vector3::y_axis(), down_rad);
    let turned = UnitQuaternion::from_matrix(&(down.into_inner() * ahead));
    Pose::wrap(Isometry3::from_parts(
        Vector3::new(0.0, 0.0, EYE_M).into(),
        turned,
    ))
}

/// A picture of a room with noise, and which thing each pixel shows: 0 the floor, from 1 on the faces of boxes, front, side and top.
fn picture(boxes: &Boxes, down_rad: f64, sigma: f64, seed: u64) -> (DepthPicture, Vec<usize>) {
    let mut noise = Noise::new(seed);
    let map_from_camera = pose(down_rad);
    let mut picture = DepthPicture {
        cols: COLS,
        inverse_depths_per_m: vec![f32::NAN; COLS * ROWS],
        focal_px: [140.0; 2],
        centre_px: [79.5, 59.5],
        sigma_per_m: sigma,
        map_from_camera,
    };
    let mut shows = vec![usize::MAX; COLS * ROWS];
    for (at, thing) in shows.iter_mut().enumerate() {
        let ray = map_from_camera.inner.rotation * picture.ray(at);
        let floor = if ray.z < 0.0 {
            -EYE_M / ray.z
        } else {
            f64::INFINITY
        };
        let mut first = (floor, 0);
        for (number, [low, high]) in boxes.iter().enumerate() {
            for (axis, side) in [(0, low[0]), (1, low[1]), (1, high[1]), (2, high[2])] {
                let depth = (side - [0.0, 0.0, EYE_M][axis]) / ray[axis];
                let place = Vector3::new(0.0, 0.0, EYE_M) + ray * depth;
                let inside = (0..3).all(|i| i == axis || (low[i]..=high[i]).contains(&place[i]));
                if depth > 0.0 && depth < first.0 && inside {
                    first = (depth, 3 * number + 1 + axis);
                }
            }
        }
        if first.0 < 4.0 {
            picture.inverse_depths_per_m[at] = (1.0 / first.0 + noise.normal(sigma)) as f32;
            *thing = first.1;
        }
    }
    (picture, shows)
}

fn grouping() -> SceneGrouping {
    SceneGrouping::new(GroupingConfig::default(), ShapesConfig::default()).unwrap()
}

/// Of each thing shown by 100 pixels or more whether a group and it share 80 % of either (Hoover et al. 1996).
fn correct(groups: &Groups, shows: &[usize]) -> Vec<(usize, bool)> {
    let mut things = shows.to_vec();
    things.sort_unstable();
    things.dedup();
    let count = |is: &dyn Fn(usize) -> bool| (0..shows.len()).filter(|&at| is(at)).count();
    let large = things.into_iter().filter(|&thing| thing < usize::MAX);
    let large = large.filter(|&thing| count(&|at| shows[at] == thing) >= 100);
    large
        .map(|thing| {
            let whole = count(&|at| shows[at] == thing);
            let found = (1..=groups.each.len() as u16).any(|number| {
                let shared = count(&|at| shows[at] == thing && groups.of_pixel[at] == number);
                let own = count(&|at| groups.of_pixel[at] == number);
                5 * shared >= 4 * whole && 5 * shared >= 4 * own
            });
            (thing, found)
        })
        .collect()
}

#[test]
fn floor_wall_and_cupboard_are_planes_of_their_own_at_four_fifths_overlap() {
    for seed in 0..5 {
        let (picture, shows) = picture(ROOM, 0.35, SIGMA, seed);
        let groups = grouping().group(&picture).unwrap();
        let found = correct(&groups, &shows);
        assert!(
            found.len() >= 3 && found.iter().all(|(_, found)| *found),
            "{found:?}"
        );
    }
}

#[test]
fn planes_stand_where_they_are() {
    let (picture, shows) = picture(ROOM, 0.35, SIGMA, 7);
    let groups = grouping().group(&picture).unwrap();
    let of = |thing: usize| {
        let number = |at: usize| usize::from(groups.of_pixel[at]);
        let mut counts = vec![0; groups.each.len() + 1];
        (0..shows.len())
            .filter(|&at| shows[at] == thing)
            .for_each(|at| counts[number(at)] += 1);
        let most = (1..counts.len())
            .max_by_key(|&number| counts[number])
            .unwrap();
        &groups.each[most - 1]
    };
    let floor = of(0);
    assert!(floor.plane.unwrap().normal.z > 0.9999);
    assert!(floor.plane.unwrap().distance_m.abs() < 0.003);
    assert!(floor.cut[3]);
    let front = of(4);
    let plane = front.plane.unwrap();
    assert!(plane.normal.x < -0.999 && (plane.distance_m + 1.7).abs() < 0.01);
    assert!(
        (front.heights_m[1] - 0.45).abs() < 0.03,
        "{:?}",
        front.heights_m
    );
    assert!(
        (front.extent_m[0] - 0.5).abs() < 0.04,
        "{:?}",
        front.extent_m
    );
    assert!((front.behind_m - 0.3).abs() < 0.03, "{}", front.behind_m);
    assert!(front.free > 0.2 && front.gap_m > 0.2);
    assert!(of(1).behind_m.is_infinite());
}

#[test]
fn what_lies_on_no_plane_is_a_component() {
    // A bar of 3 cm that stands before the wall: too narrow for a patch.
    let boxes = [ROOM[0], [[1.0, 0.2, 0.0], [1.03, 0.23, 0.8]]];
    let (picture, shows) = picture(&boxes, 0.2, SIGMA, 3);
    let groups = grouping().group(&picture).unwrap();
    let on_bar: Vec<usize> = (0..shows.len())
        .filter(|&at| (4..7).contains(&shows[at]))
        .collect();
    let numbers = on_bar
        .iter()
        .map(|&at| groups.of_pixel[at])
        .filter(|number| *number > 0);
    let mut numbers: Vec<u16> = numbers.collect();
    numbers.sort_unstable();
    numbers.dedup();
    let own = numbers.iter().filter(|&&number| {
        let all = groups
            .of_pixel
            .iter()
            .enumerate()
            .filter(|(_, one)| **one == number);
        let inside = all
            .clone()
            .filter(|(at, _)| on_bar.binary_search(at).is_ok())
            .count();
        2 * inside > all.count()
    });
    let own: Vec<_> = own
        .map(|number| &groups.each[usize::from(*number) - 1])
        .collect();
    assert!(!own.is_empty());
    assert!(own.iter().all(|group| group.extent_m[0] < 0.1), "{own:?}");
}

#[test]
fn the_noise_of_a_picture_is_told_by_the_picture() {
    for sigma in [0.001, 0.01, 0.03] {
        let (picture, _) = picture(ROOM, 0.35, sigma, 1);
        let found = grouping()
            .noise(COLS, &picture.inverse_depths_per_m)
            .unwrap();
        assert!((found / sigma - 1.0).abs() < 0.25, "{sigma}: {found}");
    }
    assert_eq!(grouping().noise(COLS, &vec![f32::NAN; COLS * ROWS]), None);
    let least = GroupingConfig::default().least_noise;
    assert_eq!(grouping().noise(COLS, &vec![1.0; COLS * ROWS]), Some(least));
}

#[test]
fn a_picture_of_nothing_has_no_groups_and_a_broken_one_is_refused() {
    let (mut picture, _) = picture(ROOM, 0.35, SIGMA, 1);
    picture.inverse_depths_per_m.fill(f32::NAN);
    assert_eq!(grouping().group(&picture).unwrap().each, []);
    for value in [0.0, -1.0, f32::INFINITY] {
        picture.inverse_depths_per_m.fill(value);
        assert_eq!(grouping().group(&picture).unwrap().each, []);
    }
    picture.sigma_per_m = 0.0;
    assert_eq!(grouping().group(&picture), Err(PictureError::BadCamera));
    picture.cols = 7;
    let pixels = COLS * ROWS;
    assert_eq!(
        grouping().group(&picture),
        Err(PictureError::WrongSize { cols: 7, pixels })
    );
}

#[test]
fn what_is_known_tells_floor_wall_and_cupboard() {
    let classes = SceneClasses::known(ShapesConfig::default()).unwrap();
    let (picture, shows) = picture(ROOM, 0.35, SIGMA, 2);
    let groups = grouping().group(&picture).unwrap();
    let mut map = LabelMap::new(LabelMapConfig::default(), MarkovFieldConfig::default()).unwrap();
    map.insert(&picture, &groups, &classes);
    let points = map.points().unwrap();
    assert!(points.len() > 500);
    let at = |place: [f64; 3], label: Label| {
        let near = points
            .iter()
            .filter(|point| (0..3).all(|axis| (point.place_m[axis] - place[axis]).abs() < 0.15));
        let near: Vec<_> = near.collect();
        let right = near.iter().filter(|point| point.label == label).count();
        assert!(
            near.len() > 5 && 10 * right >= 9 * near.len(),
            "{label:?}: {right} of {}",
            near.len()
        );
    };
    at([1.2, 0.0, 0.0], Label::Floor);
    at([2.0, 0.6, 0.4], Label::Wall);
    at([1.7, -0.1, 0.2], Label::Furniture);
    assert_eq!(shows.len(), picture.inverse_depths_per_m.len());
}

#[test]
fn labels_are_named_and_learned_of_labels_that_there_are() {
    assert_eq!(Label::ALL.map(|label| label as usize), [0, 1, 2, 3, 4, 5]);
    let examples = [(vec![0.0], 0), (vec![1.0], 6)];
    let refused = SceneClasses::learned(
        &crate::TrainedConfig::default(),
        ShapesConfig::default(),
        &examples,
    );
    assert_eq!(
        refused.unwrap_err().to_string(),
        "example 1 has label 6, the last is 5"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn groups_are_counted_from_one_and_every_pixel_is_of_one_that_there_is(
        down in 0.0..0.6_f64, sigma in 0.001..0.03_f64, seed in 0..1000_u64,
    ) {
        let (picture, shows) = picture(ROOM, down, sigma, seed);
        let groups = grouping().group(&picture).unwrap();
        let mut counts = vec![0; groups.each.len() + 1];
        for (at, number) in groups.of_pixel.iter().enumerate() {
            counts[usize::from(*number)] += 1;
            prop_assert!(*number == 0 || shows[at] < usize::MAX);
        }
        for (group, count) in groups.each.iter().zip(&counts[1..]) {
            prop_assert_eq!(group.pixels, *count);
            prop_assert!(*count > 0 && group.heights_m[0] <= group.heights_m[1]);
            prop_assert!(group.features(&ShapesConfig::default()).iter().all(|value| value.is_finite()));
        }
        prop_assert_eq!(&groups, &grouping().group(&picture).unwrap());
    }
}
