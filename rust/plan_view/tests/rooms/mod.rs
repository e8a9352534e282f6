//! Random rooms of 4 to 12 walls, two of them 15 cm apart; 5 % of the points lie anywhere, the others 2 cm off their wall.

use std::f64::consts::TAU;

use geometry::SplitMix64;
use plan_view::PlanarLine;

const SIGMA_M: f64 = 0.02;
const RANDOM: f64 = 0.05;
const POINTS_PER_M: f64 = 50.0;

/// A room's points, m, and the lines of its walls.
pub(crate) fn room(seed: u64) -> (Vec<[f64; 2]>, Vec<PlanarLine>) {
    let mut numbers = SplitMix64::new(1000 + seed);
    let walls = loop {
        let count = 4 + (numbers.uniform() * 9.0) as usize;
        if let Some(walls) = drawn(count, &mut numbers) {
            break walls;
        }
    };
    let mut points = Vec::new();
    for [from, to] in &walls {
        let length = geometry::distance_m(*from, *to);
        let way = [0, 1].map(|axis| (to[axis] - from[axis]) / length);
        for _ in 0..(length * POINTS_PER_M) as usize {
            let (along, off) = (numbers.uniform() * length, SIGMA_M * normal(&mut numbers));
            points.push([
                from[0] + along * way[0] - off * way[1],
                from[1] + along * way[1] + off * way[0],
            ]);
        }
    }
    let random = (points.len() as f64 * RANDOM / (1.0 - RANDOM)).round() as usize;
    for _ in 0..random {
        points.push([0, 1].map(|_| 8.0 * numbers.uniform() - 4.0));
    }
    let lines = walls.iter().filter_map(|ends| PlanarLine::fit(*ends));
    (points, lines.collect())
}

/// All walls but one go round a middle; the last stands 15 cm inside the longest, half as long. None where two others could be taken for one.
fn drawn(count: usize, numbers: &mut SplitMix64) -> Option<Vec<[[f64; 2]; 2]>> {
    let round = count - 1;
    let corner = |index: usize, numbers: &mut SplitMix64| {
        let angle = TAU * (index as f64 + 0.6 * (numbers.uniform() - 0.5)) / round as f64;
        let radius = 2.0 + 1.8 * numbers.uniform();
        [radius * libm::cos(angle), radius * libm::sin(angle)]
    };
    let corners: Vec<_> = (0..round).map(|index| corner(index, numbers)).collect();
    let mut walls: Vec<_> = (0..round)
        .map(|index| [corners[index], corners[(index + 1) % round]])
        .collect();
    let length = |wall: &[[f64; 2]; 2]| geometry::distance_m(wall[0], wall[1]);
    if walls.iter().any(|wall| length(wall) < 0.6) {
        return None;
    }
    let off = |line: &PlanarLine, wall: &[[f64; 2]; 2]| {
        let [one, other] = wall.map(|at| line.signed_distance_m(at).abs());
        one.max(other)
    };
    for (index, one) in walls.iter().enumerate() {
        let line = PlanarLine::fit(*one)?;
        if walls[..index].iter().any(|other| off(&line, other) < 0.3) {
            return None;
        }
    }
    let [from, to] = *walls
        .iter()
        .max_by(|one, other| length(one).total_cmp(&length(other)))?;
    let size = geometry::distance_m(from, to);
    let inwards = [-(to[1] - from[1]) / size, (to[0] - from[0]) / size];
    let at = |part: f64| {
        [0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis]) + 0.15 * inwards[axis])
    };
    walls.push([at(0.25), at(0.75)]);
    Some(walls)
}

fn normal(numbers: &mut SplitMix64) -> f64 {
    (0..12).map(|_| numbers.uniform()).sum::<f64>() - 6.0
}
