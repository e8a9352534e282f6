//! Claims about the filter on made-up towns; those on real clouds stand in `tests/test_ground_filter.py`.

use proptest::prelude::*;

use super::*;
use crate::synthetic::Noise;

fn filter(points: &[Point3]) -> Ground {
    let filter = GroundFilter::new(GroundFilterConfig::default()).unwrap();
    filter.filter(points).unwrap()
}

/// A town of 100 m on a slope of 5 %, with houses and trees, and whether each point is ground.
fn town(seed: u64, offset_m: [f64; 2]) -> (Vec<Point3>, Vec<bool>) {
    let mut noise = Noise::new(seed);
    let house = [noise.within(15.0, 55.0), noise.within(15.0, 60.0)];
    let mut points = Vec::new();
    let mut truth = Vec::new();
    for _ in 0..10_000 {
        let [x, y] = [noise.within(0.0, 100.0), noise.within(0.0, 100.0)];
        let ground_m = 300.0 + 0.05 * x + noise.normal(0.03);
        let in_house =
            (0.0..30.0).contains(&(x - house[0])) && (0.0..20.0).contains(&(y - house[1]));
        let in_tree = ((x - 90.0) * (x - 90.0) + (y - 90.0) * (y - 90.0)) < 16.0;
        let above_m = if in_house {
            6.0
        } else if in_tree && noise.within(0.0, 1.0) < 0.7 {
            noise.within(2.0, 8.0)
        } else {
            0.0
        };
        points.push([x + offset_m[0], y + offset_m[1], ground_m + above_m]);
        truth.push(above_m == 0.0);
    }
    (points, truth)
}

#[test]
fn of_a_town_on_a_slope_less_than_one_point_in_a_hundred_is_misjudged() {
    for seed in 0..20 {
        let (points, truth) = town(seed, [0.0, 0.0]);
        let found = filter(&points).is_ground;
        let wrong = found.iter().zip(&truth).filter(|(a, b)| a != b).count();
        assert!(wrong < 100, "seed {seed}: {wrong} of 10,000");
    }
}

#[test]
fn five_million_metres_away_it_is_the_same_town() {
    let (here, _) = town(3, [0.0, 0.0]);
    let (there, _) = town(3, [512_000.0, 5_403_000.0]);
    let (here, there) = (filter(&here).is_ground, filter(&there).is_ground);
    let differ = here.iter().zip(&there).filter(|(a, b)| a != b).count();
    assert!(differ < 10, "{differ}");
}

#[test]
fn the_spacing_is_that_of_where_the_cloud_is() {
    let mut noise = Noise::new(8);
    // Two strips of 100 m x 10 m, far apart: 0.5 points a square metre.
    let points: Vec<_> = (0..1000)
        .map(|index| {
            [
                noise.within(0.0, 100.0),
                noise.within(0.0, 10.0) + f64::from(index % 2) * 500.0,
                0.0,
            ]
        })
        .collect();
    let spacing_m = raster::spacing_m(&points);
    assert!((spacing_m - 2.0_f64.sqrt()).abs() < 0.2, "{spacing_m}");
}

#[test]
fn clouds_that_nothing_can_be_said_of_are_refused() {
    let filter = GroundFilter::new(GroundFilterConfig::default()).unwrap();
    let said = |points: &[Point3]| filter.filter(points).err().unwrap().to_string();
    assert_eq!(said(&[]), "the cloud has 0 points, at least 1 are needed");
    let odd = said(&[[0.0; 3], [1.0, f64::NAN, 0.0]]);
    assert_eq!(odd, "point 1 is not finite: [1.0, NaN, 0.0]");
    let mut wide: Vec<_> = (0..100)
        .map(|index| [f64::from(index % 10), f64::from(index / 10), 0.0])
        .collect();
    wide.push([1e6, 1e6, 0.0]);
    assert!(
        said(&wide).starts_with("the cloud spans 1000000 m by 1000000 m"),
        "{}",
        said(&wide)
    );
    for points in [
        &[[1.0, 2.0, 3.0]][..],
        &[[0.0; 3], [5.0, 0.0, 0.0]],
        &[[1.0; 3], [1.0; 3]],
    ] {
        assert!(
            filter
                .filter(points)
                .unwrap()
                .is_ground
                .iter()
                .all(|ground| *ground)
        );
    }
}

#[test]
fn an_opening_is_that_of_the_definition() {
    let mut noise = Noise::new(2);
    let mut grid = Grid::filled(13, 9, 0.0);
    grid.values_mut()
        .iter_mut()
        .for_each(|value| *value = noise.within(0.0, 9.0));
    let disc = |radius: i32| -> Vec<[i32; 2]> {
        (-radius..=radius)
            .flat_map(|x| (-radius..=radius).map(move |y| [x, y]))
            .filter(|[x, y]| x * x + y * y <= radius * radius)
            .collect()
    };
    let within = |grid: &Grid<f64>, radius: i32, pick: fn(f64, f64) -> f64| {
        let mut picked = grid.clone();
        for (index, value) in picked.values_mut().iter_mut().enumerate() {
            let (col, row) = ((index % 13) as i32, (index / 13) as i32);
            *value = (disc(radius).iter())
                .filter_map(|[x, y]| grid.get(geometry::Cell::new(col + x, row + y)))
                .copied()
                .reduce(pick)
                .unwrap();
        }
        picked
    };
    for radius in 1..5 {
        let expected = within(&within(&grid, radius, f64::min), radius, f64::max);
        assert_eq!(opening::opened(&grid, radius as usize), expected);
    }
}

proptest! {
    #[test]
    fn ground_that_is_a_plane_is_all_ground(seed in 0_u64..1000, slope in -0.12..0.12_f64) {
        let mut noise = Noise::new(seed);
        let points: Vec<_> = (0..400)
            .map(|_| {
                let [x, y] = [noise.within(0.0, 30.0), noise.within(0.0, 30.0)];
                [x, y, slope * x]
            })
            .collect();
        prop_assert!(filter(&points).is_ground.iter().all(|ground| *ground));
    }

    #[test]
    fn holes_are_filled_from_within_the_heights_around_and_nothing_else_changes(
        heights in prop::collection::vec(prop::option::of(-5.0..5.0_f64), 35),
    ) {
        prop_assume!(heights.iter().any(Option::is_some));
        let mut grid = Grid::filled(7, 5, f64::NAN);
        for (value, height) in grid.values_mut().iter_mut().zip(&heights) {
            *value = height.unwrap_or(f64::NAN);
        }
        holes::fill(&mut grid, 50);
        let there = heights.iter().flatten();
        let low = there.clone().copied().fold(f64::INFINITY, f64::min);
        let high = there.copied().fold(f64::NEG_INFINITY, f64::max);
        for (value, height) in grid.values().iter().zip(&heights) {
            prop_assert!(height.map_or(*value >= low - 1e-9 && *value <= high + 1e-9, |kept| kept == *value));
        }
    }
}
