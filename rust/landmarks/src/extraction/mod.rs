//! Landmarks found in points: rocks and poles (004, section 36.3.5: rocks and tree trunks, references 36.36 and 36.37).

#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};

use core::f64::consts::PI;

use geometry::hypot;
use nalgebra::{Point3, Vector2};
use settings::{ConfigError, POSITIVE, Table, above, at_least, settings, within};

settings! {
    /// What stands on the ground and is small enough to be a landmark.
    pub struct ExtractionConfig("landmarks.extraction") {
        /// Points of one thing are no further apart than about this share of their distance.
        gap: f64 = 0.03, "1", POSITIVE;
        /// What is no higher is ground.
        lowest: f64 = 0.06, "m", POSITIVE;
        /// How many points a thing has at least.
        points: usize = 12, "1", at_least(3.0);
        /// Narrowest and widest that a landmark is.
        width: [f64; 2] = [0.04, 1.0], "m", POSITIVE;
        /// A pole is at least so many times as high as wide; what is less is a rock.
        slender: f64 = 2.5, "1", above(0.0);
        /// Its front is taken from this share of its width, in the middle.
        front: f64 = 0.3, "1", within(0.01, 1.0);
        /// The front is taken from this share of its height, at its foot: rocks lean back.
        foot: f64 = 0.6, "1", within(0.01, 1.0);
        /// Half of the angle that is in view, to each side of straight ahead: what its edge cuts is left out.
        view: f64 = 0.6, "rad", within(0.0, PI);
        /// How far from that edge a thing must end.
        edge: f64 = 0.015, "rad", at_least(0.0);
        /// What is nearer by more than this hides what is seen beside it.
        hiding: f64 = 0.3, "m", POSITIVE;
    }
    require (width[0]) < (width[1]);
}

/// What a thing is by its shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ThingShape {
    /// About as wide as high, or wider.
    Rock,
    /// Slender and upright: a trunk, a post.
    Pole,
}

/// A thing that stands on the ground, round as seen from above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StandingThing {
    /// Its middle on the ground, m, in the frame of the points.
    pub at_m: Vector2<f64>,
    /// Across, m.
    pub width_m: f64,
    /// Its highest point above the ground, m.
    pub height_m: f64,
    /// What it is.
    pub shape: ThingShape,
}

/// One thing's points as the eye sees them from above.
struct Cluster {
    /// Bearing, rad, distance over the ground and height, m, of each point.
    polar: Vec<[f64; 3]>,
    height_m: f64,
}

/// The rocks and poles among points of one picture or scan, m, in a frame with the eye `eye_m` above its origin, x ahead, y to the left and the ground in z = 0.
///
/// Points above the ground hang together where they are near. A thing that is round is seen between two tangents and begins where it is nearest: both tell
/// its middle and width. What another thing hides or the edge of view cuts, and what is too wide, as walls are, is no landmark.
///
/// # Errors
/// A setting cannot be used.
pub fn standing_things(
    points_m: &[Point3<f64>],
    eye_m: f64,
    config: &ExtractionConfig,
) -> Result<Vec<StandingThing>, ConfigError> {
    config.check()?;
    let high: Vec<&Point3<f64>> = points_m
        .iter()
        .filter(|point| point.coords.iter().all(|part| part.is_finite()) && point.z > config.lowest)
        .collect();
    let clusters: Vec<Cluster> = clusters(&high, config.gap)
        .iter()
        .map(|part| Cluster::of(part))
        .collect();
    let things = clusters.iter().filter(|one| {
        one.polar.len() >= config.points
            && !one.is_cut(config)
            && !clusters.iter().any(|other| other.hides(one, eye_m, config))
    });
    Ok(things.filter_map(|one| one.thing(config)).collect())
}

/// Points in groups that hang together over the ground.
fn clusters<'a>(points: &[&'a Point3<f64>], gap: f64) -> Vec<Vec<&'a Point3<f64>>> {
    let mut cells: BTreeMap<[i64; 2], Vec<&Point3<f64>>> = BTreeMap::new();
    for point in points {
        // Cells that grow with the distance, as errors and the gaps between rays do.
        let polar = [
            libm::log(hypot(point.x, point.y)),
            libm::atan2(point.y, point.x),
        ];
        let cell = polar.map(|part| (part / gap).floor() as i64);
        cells.entry(cell).or_default().push(point);
    }
    let mut left: BTreeSet<[i64; 2]> = cells.keys().copied().collect();
    let mut found = Vec::new();
    while let Some(first) = left.pop_first() {
        let (mut open, mut part) = (vec![first], Vec::new());
        while let Some([col, row]) = open.pop() {
            part.extend(cells.get(&[col, row]).into_iter().flatten());
            for (east, north) in (-1..=1).flat_map(|east| (-1..=1).map(move |north| (east, north)))
            {
                open.extend(left.take(&[col + east, row + north]));
            }
        }
        found.push(part);
    }
    found
}

impl Cluster {
    fn of(points: &[&Point3<f64>]) -> Self {
        let polar = |point: &&Point3<f64>| {
            [
                libm::atan2(point.y, point.x),
                hypot(point.x, point.y),
                point.z,
            ]
        };
        Self {
            polar: points.iter().map(polar).collect(),
            height_m: points.iter().map(|point| point.z).fold(0.0, f64::max),
        }
    }

    /// The bearings between which it is seen, rad.
    fn sides(&self) -> [f64; 2] {
        let each = || self.polar.iter().map(|point| point[0]);
        [
            each().fold(f64::INFINITY, f64::min),
            each().fold(f64::NEG_INFINITY, f64::max),
        ]
    }

    fn nearest_m(&self) -> f64 {
        self.polar
            .iter()
            .map(|point| point[1])
            .fold(f64::INFINITY, f64::min)
    }

    /// Whether the edge of view cuts it.
    fn is_cut(&self, config: &ExtractionConfig) -> bool {
        let [right, left] = self.sides();
        right < config.edge - config.view || left > config.view - config.edge
    }

    /// Whether it stands before a side of another, as seen from an eye so high above the ground.
    fn hides(&self, other: &Self, eye_m: f64, config: &ExtractionConfig) -> bool {
        let [right, left] = self.sides();
        let is_before = self.nearest_m() + config.hiding < other.nearest_m();
        let covers = |side: f64| (right..=left).contains(&side);
        // What is low is looked over, down to where the other stands.
        let line_m = eye_m * (1.0 - self.nearest_m() / other.nearest_m());
        is_before && self.height_m > line_m && other.sides().into_iter().any(covers)
    }

    /// The disc between the two tangents that begins where it is nearest; none where it is too narrow or too wide.
    fn thing(&self, config: &ExtractionConfig) -> Option<StandingThing> {
        let [right, left] = self.sides();
        let middle = f64::midpoint(right, left);
        let half = 0.5 * (left - right);
        let foot_m = config.lowest + config.foot * (self.height_m - config.lowest);
        let is_front = |point: &&[f64; 3]| {
            (point[0] - middle).abs() <= config.front * half && point[2] <= foot_m
        };
        let mut front: Vec<f64> = self
            .polar
            .iter()
            .filter(is_front)
            .map(|point| point[1])
            .collect();
        if front.is_empty() {
            return None;
        }
        front.sort_by(f64::total_cmp);
        let near_m = front[front.len() / 2];
        let sine = libm::sin(half);
        let radius_m = near_m * sine / (1.0 - sine);
        let width_m = 2.0 * radius_m;
        let [narrowest_m, widest_m] = config.width;
        let (sin, cos) = libm::sincos(middle);
        let shape = if self.height_m >= config.slender * width_m {
            ThingShape::Pole
        } else {
            ThingShape::Rock
        };
        (half < 0.5 * PI && (narrowest_m..=widest_m).contains(&width_m)).then(|| StandingThing {
            at_m: Vector2::new(cos, sin) * (near_m + radius_m),
            width_m,
            height_m: self.height_m,
            shape,
        })
    }
}
