//! Scatter, line or surface, by the second-order moments of the points around a point.

use nalgebra::{Matrix3, Vector3};
use settings::{ConfigError, POSITIVE, Table, at_least, settings};

use crate::cloud::{CloudError, Point3, check};
use crate::neighbours::Neighbours;

settings! {
    /// How points are told apart by the shape of what is around them: bushes and grass, wires and branches, ground and walls.
    pub struct MomentsConfig("classification.moments") {
        /// A neighbourhood reaches to the so many nearest points: it shrinks where the cloud is dense.
        neighbours: usize = 25, "1", at_least(4.0), "Lalonde, Unnikrishnan, Vandapel and Hebert 2005, section 3";
        /// Standard deviation of a coordinate.
        noise: f64 = 0.01, "m", POSITIVE;
        /// A neighbourhood reaches at least as far as this many times the noise, whatever the density: below it noise has the say.
        radius_per_noise: f64 = 8.0, "1", POSITIVE, "Lalonde, Unnikrishnan, Vandapel and Hebert 2005, equation (1)";
        /// A neighbourhood reaches no farther.
        most_radius: f64 = 1.5, "m", POSITIVE;
        /// Points with fewer around them are of no class.
        least_points: usize = 5, "1", at_least(3.0);
        /// Worth of being spread in all directions, against being a line. More makes more of what is thin a scatter.
        scatter: f64 = 1.0, "1", POSITIVE;
        /// Worth of being spread in two directions, against being a line.
        surface: f64 = 1.0, "1", POSITIVE;
    }
}

/// What a point belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum PointClass {
    /// Too few points are near.
    Unknown = 0,
    /// Spread in all directions: bushes, grass, leaves.
    Scatter = 1,
    /// Spread along a line: wires, branches, thin trunks.
    Linear = 2,
    /// Spread over a surface: ground, walls, rocks.
    Surface = 3,
}

/// How much the neighbourhood of a point is spread in three, one and two directions, each from 0 to 1; together 1.
///
/// They are differences of the standard deviations along the principal axes, a >= b >= c, over the largest: c / a, (a - b) / a,
/// (b - c) / a. Lalonde et al., Journal of Field Robotics 23 (2006), equation (1), have the variances in their place; with their
/// roots the border of a surface, which is half a neighbourhood, is a surface still.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Saliency {
    /// Of scatter.
    pub scatter: f64,
    /// Of a line.
    pub linear: f64,
    /// Of a surface.
    pub surface: f64,
    /// Along the line, or the line that comes nearest.
    pub direction: Vector3<f64>,
    /// Across the surface, or the surface that comes nearest.
    pub normal: Vector3<f64>,
    /// How far the neighbourhood reaches, m.
    pub radius_m: f64,
}

/// Tells points apart by the shape of their neighbourhood.
#[derive(Debug, Clone)]
pub struct PointClasses {
    config: MomentsConfig,
}

impl PointClasses {
    /// With settings.
    pub fn new(config: MomentsConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self { config })
    }

    /// The class of each point, in the cloud's order.
    pub fn classify(&self, points: &[Point3]) -> Result<Vec<PointClass>, CloudError> {
        let saliencies = self.saliencies(points)?;
        Ok(saliencies
            .iter()
            .map(|saliency| saliency.map_or(PointClass::Unknown, |one| self.class_of(&one)))
            .collect())
    }

    /// How much each point is scatter, line and surface; `None` where too few points are near.
    pub fn saliencies(&self, points: &[Point3]) -> Result<Vec<Option<Saliency>>, CloudError> {
        check(points, 1)?;
        let tree = Neighbours::new(points);
        let at_each = points.iter().map(|place| {
            let (near, radius_m) = self.around(&tree, *place);
            (near.len() >= self.config.least_points)
                .then(|| saliency(points, *place, &near, radius_m))
        });
        Ok(at_each.collect())
    }

    /// The class that a saliency says, without its neighbours.
    pub fn class_of(&self, saliency: &Saliency) -> PointClass {
        let scatter = self.config.scatter * saliency.scatter;
        let surface = self.config.surface * saliency.surface;
        if scatter >= surface && scatter >= saliency.linear {
            PointClass::Scatter
        } else if surface >= saliency.linear {
            PointClass::Surface
        } else {
            PointClass::Linear
        }
    }

    /// The neighbourhood of a place and how far it reaches, m: to the nearest points, but beyond the noise.
    fn around(&self, tree: &Neighbours, place: Point3) -> (Vec<usize>, f64) {
        let config = &self.config;
        let nearest: Vec<_> = tree.nearest(place, config.neighbours + 1).collect();
        let reach_m = nearest.last().map_or(0.0, |(_, distance_m)| *distance_m);
        let least_m = config.radius_per_noise * config.noise;
        let radius_m = reach_m.max(least_m).min(config.most_radius);
        let near = if reach_m < radius_m {
            tree.within(place, radius_m).collect()
        } else {
            let inside = (nearest.iter()).filter(|(_, distance_m)| *distance_m <= radius_m);
            inside.map(|(index, _)| *index).collect()
        };
        (near, radius_m)
    }
}

/// That of the points `near` around a place.
fn saliency(points: &[Point3], place: Point3, near: &[usize], radius_m: f64) -> Saliency {
    let place = Vector3::from(place);
    let count = near.len() as f64;
    let offsets = || {
        near.iter()
            .map(|&index| Vector3::from(points[index]) - place)
    };
    let mean = offsets().sum::<Vector3<f64>>() / count;
    let moments = offsets()
        .map(|offset| (offset - mean) * (offset - mean).transpose())
        .sum::<Matrix3<f64>>()
        / count;
    let eigen = moments.symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let [a, b, c] = order.map(|axis| eigen.eigenvalues[axis].max(0.0).sqrt());
    let axis = |which: usize| eigen.eigenvectors.column(order[which]).into_owned();
    let share = |part: f64| if a > 0.0 { part / a } else { 0.0 };
    Saliency {
        scatter: if a > 0.0 { c / a } else { 1.0 },
        linear: share(a - b),
        surface: share(b - c),
        direction: axis(0),
        normal: axis(2),
        radius_m,
    }
}

#[cfg(test)]
pub(crate) mod tests;
