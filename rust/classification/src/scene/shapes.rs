//! The shape of a group of pixels: how it stands, how far it reaches, and what lies beside it.

use geometry::Plane;
use nalgebra::{Matrix2, Point3, Unit, Vector2, Vector3};
use settings::{NOT_NEGATIVE, POSITIVE, SHARE, settings};

use super::picture::DepthPicture;
use super::pixels::NONE;

settings! {
    /// How the shape of a group is described. What labels are told by was learned with these: with others it is to be learned anew.
    pub struct ShapesConfig("classification.shapes") {
        /// Share of a group's pixels at either end that its heights and its extent leave out.
        tail: f64 = 0.02, "1", SHARE;
        /// A plane whose normal rises by no more is upright: the sine of 20 degrees.
        leaning: f64 = 0.342, "1", SHARE;
        /// Planes are turned the same way up to this cosine of the angle between them, of 10 degrees.
        parallel: f64 = 0.985, "1", SHARE;
        /// A plane no farther behind another one is not behind it.
        touching: f64 = 0.02, "m", NOT_NEGATIVE;
        /// What lies beside a group is another thing from so many noises on, not the next pixel of a slanted one.
        apart: f64 = 8.0, "1", POSITIVE;
        /// What is higher is as high as this.
        highest: f64 = 1.2, "m", POSITIVE;
        /// What is longer is as long as this.
        longest: f64 = 1.5, "m", POSITIVE;
        /// What is deeper from front to back is as deep as this.
        deepest: f64 = 0.6, "m", POSITIVE;
        /// What stands farther before the rest stands so far before it.
        widest_gap: f64 = 1.0, "m", POSITIVE;
        /// A plane farther behind is so far behind.
        farthest_behind: f64 = 0.5, "m", POSITIVE;
        /// What is known less precisely is known as precisely as this.
        largest_error: f64 = 0.2, "m", POSITIVE;
    }
}

/// Number of features of a group.
pub(crate) const FEATURES: usize = 17;

/// A plane or a component of what lies on none.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Its plane in the map, the normal towards the camera; none of a component.
    pub plane: Option<Plane>,
    /// Pixels.
    pub pixels: usize,
    /// Middle, m, in the map.
    pub middle_m: [f64; 3],
    /// Heights above the floor that 2 % of its pixels lie below and above, m.
    pub heights_m: [f64; 2],
    /// How far it reaches over the floor along its longer side and across, without 2 % at either end, m.
    pub extent_m: [f64; 2],
    /// Whether the picture ends above, left, right and below it.
    pub cut: [bool; 4],
    /// Of the pixels beside it those that are farther away: it stands before something.
    pub free: f64,
    /// Of the pixels beside it those that are nearer: something stands before it.
    pub hidden: f64,
    /// How much farther away that is what it stands before, left and right of it, m: the median; 0 where there is nothing.
    pub gap_m: f64,
    /// How far behind it the nearest plane lies that is upright and turned the same way, as it is, m; infinite where there is none.
    pub behind_m: f64,
    /// Standard deviation of a depth there, m: what is smaller is not seen.
    pub error_m: f64,
    /// Of the pixels left and right of it those that are farther away: its sides end freely.
    pub free_sides: f64,
    /// How askew it stands to the largest upright plane of the picture: the sine of twice the angle between them, 0 where they are
    /// parallel or square. As a door that stands ajar does.
    pub askew: f64,
}

impl Group {
    /// What labels are told by, each cut off where more would not tell more.
    pub fn features(&self, config: &ShapesConfig) -> [f64; FEATURES] {
        let upright = self.plane.map_or(0.5, |plane| 1.0 - plane.normal.z.abs());
        let [low_m, high_m] = self.heights_m;
        let yes = |is: bool| f64::from(u8::from(is));
        // A step is a few centimetres high, a wall a metre: the root tells both apart from what is a little higher.
        let root = |height_m: f64| height_m.signum() * height_m.abs().min(config.highest).sqrt();
        [
            upright,
            yes(self.plane.is_some()),
            root(low_m),
            root(high_m),
            root(f64::midpoint(low_m, high_m)),
            self.extent_m[0].min(config.longest),
            self.extent_m[1].min(config.deepest),
            yes(self.cut[0]),
            yes(self.cut[3]),
            yes(self.cut[1]) + yes(self.cut[2]),
            self.free,
            self.hidden,
            self.gap_m.min(config.widest_gap),
            self.behind_m.min(config.farthest_behind),
            self.error_m.min(config.largest_error),
            self.free_sides,
            self.askew,
        ]
    }
}

/// The shapes of groups; `planes` are over the noise, none of components.
pub(crate) fn measured(
    config: &ShapesConfig,
    picture: &DepthPicture,
    values: &[f64],
    of_pixel: &[u16],
    planes: &[Option<Vector3<f64>>],
) -> Vec<Group> {
    let mut pixels = vec![Vec::new(); planes.len()];
    for (at, number) in of_pixel
        .iter()
        .enumerate()
        .filter(|(_, number)| **number != NONE)
    {
        pixels[usize::from(*number) - 1].push(at);
    }
    let mut each: Vec<Group> = (pixels.iter().zip(planes))
        .map(|(pixels, plane)| shape(config, picture, values, of_pixel, pixels, plane.as_ref()))
        .collect();
    let standing: Vec<_> = each
        .iter()
        .map(|group| {
            group
                .plane
                .filter(|plane| plane.normal.z.abs() < config.leaning)
        })
        .collect();
    let largest = (0..each.len())
        .filter(|&at| standing[at].is_some())
        .max_by_key(|&at| each[at].pixels);
    let walls = largest.and_then(|at| standing[at]);
    for (group, own) in each.iter_mut().zip(&standing) {
        let Some(own) = own else { continue };
        let behind = standing.iter().flatten().filter_map(|other| {
            let behind_m = own.distance_m - other.distance_m;
            (own.normal.dot(&other.normal) > config.parallel && behind_m > config.touching)
                .then_some(behind_m)
        });
        group.behind_m = behind.fold(f64::INFINITY, f64::min);
        if let Some(walls) = walls {
            let (along, across) = (
                own.normal.xy().dot(&walls.normal.xy()),
                own.normal.xy().perp(&walls.normal.xy()),
            );
            group.askew = (2.0 * along * across).abs();
        }
    }
    each
}

/// The shape of one group.
fn shape(
    config: &ShapesConfig,
    picture: &DepthPicture,
    values: &[f64],
    of_pixel: &[u16],
    pixels: &[usize],
    plane: Option<&Vector3<f64>>,
) -> Group {
    let there = |at: usize| {
        let on = plane.map(|plane| plane.dot(&picture.ray(at)));
        on.filter(|on| *on > 0.0).unwrap_or(values[at]) * picture.sigma_per_m
    };
    let seen = pixels
        .iter()
        .filter(|&&at| plane.is_some() || !values[at].is_nan());
    let points: Vec<_> = seen.map(|&at| picture.point(at, there(at))).collect();
    let mut beside = Beside {
        apart: config.apart,
        ..Beside::default()
    };
    for &at in pixels {
        for (side, other) in picture.beside(at).into_iter().enumerate() {
            match other {
                None => beside.cut[side] = true,
                Some(other) if of_pixel[other] == of_pixel[at] => {}
                Some(other) => beside.count(side, [values[at], values[other]], picture.sigma_per_m),
            }
        }
    }
    let total = beside.total.max(1) as f64;
    let middle_depth_m = 1.0 / there(pixels[pixels.len() / 2]);
    let (middle_m, heights_m, extent_m) = spread(&points, config.tail);
    Group {
        plane: plane.map(|plane| in_map(picture, plane)),
        pixels: pixels.len(),
        middle_m,
        heights_m,
        extent_m,
        cut: beside.cut,
        free: beside.farther as f64 / total,
        hidden: beside.nearer as f64 / total,
        free_sides: beside.gaps_m.len() as f64 / beside.at_sides.max(1) as f64,
        askew: 0.0,
        gap_m: beside.gap_m(),
        behind_m: f64::INFINITY,
        error_m: middle_depth_m * middle_depth_m * picture.sigma_per_m,
    }
}

/// What lies beside a group.
#[derive(Debug, Default)]
struct Beside {
    /// Noises from which on it is another thing.
    apart: f64,
    cut: [bool; 4],
    total: usize,
    farther: usize,
    nearer: usize,
    /// Pixels left and right of it.
    at_sides: usize,
    gaps_m: Vec<f64>,
}

impl Beside {
    /// Takes in what lies beside a pixel on one side: the inverse depths of both over the noise, and the noise, 1/m.
    fn count(&mut self, side: usize, [own, other]: [f64; 2], sigma_per_m: f64) {
        self.total += 1;
        self.at_sides += usize::from(side == 1 || side == 2);
        self.nearer += usize::from(other - own > self.apart);
        if own - other > self.apart {
            self.farther += 1;
            if side == 1 || side == 2 {
                self.gaps_m
                    .push((other.recip() - own.recip()) / sigma_per_m);
            }
        }
    }

    /// The median of the gaps, m.
    fn gap_m(mut self) -> f64 {
        self.gaps_m.sort_unstable_by(f64::total_cmp);
        self.gaps_m
            .get(self.gaps_m.len() / 2)
            .copied()
            .unwrap_or(0.0)
    }
}

/// A plane over the noise as one of the map, its normal towards the camera.
fn in_map(picture: &DepthPicture, plane: &Vector3<f64>) -> Plane {
    let pose = &picture.map_from_camera.inner;
    let normal = Unit::new_normalize(pose.rotation * -plane);
    let away_m = 1.0 / (plane.norm() * picture.sigma_per_m);
    Plane {
        normal,
        distance_m: normal.dot(&pose.translation.vector) - away_m,
    }
}

/// Middle, heights and extents of points.
fn spread(points: &[Point3<f64>], tail: f64) -> ([f64; 3], [f64; 2], [f64; 2]) {
    let count = points.len().max(1) as f64;
    let middle = points
        .iter()
        .map(|point| point.coords)
        .sum::<Vector3<f64>>()
        / count;
    let flat = |point: &Point3<f64>| (point.coords - middle).xy();
    let moments = (points.iter()).map(|point| flat(point) * flat(point).transpose());
    let eigen = moments.sum::<Matrix2<f64>>().symmetric_eigen();
    let range = |of: &dyn Fn(&Point3<f64>) -> f64| {
        let mut values: Vec<f64> = points.iter().map(of).collect();
        values.sort_unstable_by(f64::total_cmp);
        let at = |share: f64| {
            let last = values.len().saturating_sub(1) as f64;
            values
                .get((share * last).round() as usize)
                .copied()
                .unwrap_or(0.0)
        };
        [at(tail), at(1.0 - tail)]
    };
    let across = |column: usize| {
        let axis: Vector2<f64> = eigen.eigenvectors.column(column).into_owned();
        let [low, high] = range(&|point| flat(point).dot(&axis));
        high - low
    };
    let sides = [across(0), across(1)];
    let extents = [sides[0].max(sides[1]), sides[0].min(sides[1])];
    (middle.into(), range(&|point| point.z), extents)
}
