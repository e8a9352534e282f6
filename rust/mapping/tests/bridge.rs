//! A bridge as the handbook's Fig. 36.11 has it (004), in all models that keep heights: from below and from above.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{Block, DEPTH_CAMERA, camera, interior, look_through};
use geometry::{Map, Pose, Robot};
use mapping::{
    Elevation, ElevationConfig, FloorView, MultiLevel, MultiLevelConfig, Surface, WorldModel,
};

const ROBOT_M: f64 = 0.58;
/// The deck's underside and top.
const DECK_M: [f64; 2] = [0.65, 0.70];

/// A deck on two piers, across a road along x.
fn bridge() -> [Block; 3] {
    let [under, top] = DECK_M;
    [
        Block::new([0.8, -1.2, under], [1.4, 1.2, top], true),
        Block::new([0.8, 0.6, 0.0], [1.4, 1.2, under], false),
        Block::new([0.8, -1.2, 0.0], [1.4, -0.6, under], false),
    ]
}

fn models() -> [Box<dyn WorldModel>; 3] {
    let config = ElevationConfig::default;
    [
        Box::new(Elevation::new(config()).unwrap()),
        Box::new(Elevation::extended(config(), ROBOT_M).unwrap()),
        Box::new(multi_level()),
    ]
}

fn multi_level() -> MultiLevel {
    let config = MultiLevelConfig::default();
    MultiLevel::new(config, ElevationConfig::default(), Some(ROBOT_M)).unwrap()
}

/// Walks along the road up to the bridge, looking down and up, and on below it.
fn see_from_the_road(model: &mut dyn WorldModel) {
    for step in 0..8 {
        let pose = Pose::<Map, Robot>::from_yaw(-0.4 + 0.05 * f64::from(step), 0.0, 0.0, 0.0);
        for pitch in [0.6, 0.25, -0.1, -0.35] {
            let planes = look_through(DEPTH_CAMERA, &bridge(), &pose, camera(0.45, pitch, 0.0));
            assert!(model.insert(&planes, &pose).unwrap().used);
        }
    }
}

/// Walks along the deck, looking over its rims.
fn see_from_the_deck(model: &mut dyn WorldModel) {
    for step in 0..6 {
        let along = -1.0 + 0.08 * f64::from(step);
        let pose = Pose::<Map, Robot>::from_yaw(1.1, along, DECK_M[1], 1.571);
        for pan in [-0.6, 0.0, 0.6] {
            let planes = look_through(DEPTH_CAMERA, &bridge(), &pose, camera(0.45, 0.7, pan));
            assert!(model.insert(&planes, &pose).unwrap().used);
        }
    }
}

/// Of the cells of a rectangle, the share that is floor within 2 cm of a height.
fn floor_share(view: &FloorView, min: [f64; 2], max: [f64; 2], height_m: f64) -> f64 {
    let cells = interior(view, min, max);
    let is_floor = |surface: Surface| match surface {
        Surface::Floor(h) => (f64::from(h) - height_m).abs() < 0.02,
        Surface::Obstacle(_) | Surface::Unknown => false,
    };
    let floor = cells.iter().filter(|&&cell| is_floor(view.cell(cell)));
    floor.count() as f64 / cells.len() as f64
}

#[test]
fn the_underpass_is_blocked_to_elevation_and_free_to_the_extended_and_the_multi_level_map() {
    let [elevation, extended, multi_level] = models().map(|mut model| {
        see_from_the_road(model.as_mut());
        floor_share(model.view(), [0.84, -0.3], [1.36, 0.3], 0.0)
    });
    assert!(elevation < 0.6, "{elevation}");
    assert!(extended > 0.95, "{extended}");
    assert!(multi_level > 0.95, "{multi_level}");
}

#[test]
fn from_the_deck_the_deck_is_floor_in_all_and_the_road_below_it_stays_known_to_the_multi_level_map()
{
    for mut model in models() {
        see_from_the_deck(model.as_mut());
        let deck = floor_share(model.view(), [0.9, -0.3], [1.3, 0.3], DECK_M[1]);
        assert!(deck > 0.95, "{deck}");
    }
    let mut both = multi_level();
    see_from_the_road(&mut both);
    see_from_the_deck(&mut both);
    let deck = floor_share(both.view(), [0.9, -0.3], [1.3, 0.3], DECK_M[1]);
    assert!(deck > 0.95, "{deck}");
    let cells = interior(both.view(), [0.9, -0.3], [1.3, 0.3]);
    let two = cells.iter().filter(|&&cell| {
        let tops = both
            .patches(cell)
            .iter()
            .map(|one| f64::from(one.estimate().height_m));
        tops.zip([0.0, DECK_M[1]])
            .filter(|(top, truth)| (top - truth).abs() < 0.02)
            .count()
            == 2
    });
    assert!(two.count() * 20 >= cells.len() * 19);
    // Back on the road the way is below.
    see_from_the_road(&mut both);
    assert!(floor_share(both.view(), [0.84, -0.3], [1.36, 0.3], 0.0) > 0.95);
}

#[test]
fn the_vertical_depth_of_a_wall_is_right_to_a_cell() {
    let wall = [Block::new([1.0, -0.6, 0.0], [1.1, 0.6, 0.4], false)];
    let mut map = multi_level();
    let pose = Pose::<Map, Robot>::from_yaw(0.0, 0.0, 0.0, 0.0);
    for pitch in [0.5, 0.2, 0.0] {
        let planes = look_through(DEPTH_CAMERA, &wall, &pose, camera(0.5, pitch, 0.0));
        let _ = map.insert(&planes, &pose).unwrap();
    }
    let cell_m = map.view().lattice.cell_m;
    for row in -8..8 {
        let cell = map
            .view()
            .lattice
            .cell_at(1.01, cell_m * (f64::from(row) + 0.5));
        let depth_m = map
            .patches(cell)
            .iter()
            .map(mapping::Patch::depth_m)
            .fold(0.0, f32::max);
        assert!(
            (f64::from(depth_m) - 0.4).abs() <= cell_m,
            "{depth_m} in row {row}"
        );
    }
}

#[test]
fn a_box_that_is_removed_leaves_no_surface() {
    let there = [Block::new([0.7, -0.1, 0.0], [0.8, 0.1, 0.2], true)];
    let pose = Pose::<Map, Robot>::from_yaw(0.0, 0.0, 0.0, 0.0);
    let mut map = multi_level();
    for (blocks, frames) in [(&there[..], 6), (&[][..], 12)] {
        for _ in 0..frames {
            let planes = look_through(DEPTH_CAMERA, blocks, &pose, camera(0.5, 0.15, 0.0));
            let _ = map.insert(&planes, &pose).unwrap();
        }
    }
    for cell in interior(map.view(), [0.7, -0.1], [0.8, 0.1]) {
        assert!(
            map.patches(cell)
                .iter()
                .all(|one| one.estimate().height_m < 0.05)
        );
    }
}

#[test]
fn without_a_robot_the_room_that_counts_must_be_given() {
    let made = MultiLevel::new(
        MultiLevelConfig::default(),
        ElevationConfig::default(),
        None,
    );
    let said = made.unwrap_err().to_string();
    assert!(
        said.starts_with("navigation.multi_level.headroom must be given where there is no robot"),
        "{said}"
    );
}
