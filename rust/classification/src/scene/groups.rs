//! Groups of a picture's pixels: planes, and components of what lies on none; and the shape of each.

use nalgebra::Vector3;
use settings::{ConfigError, POSITIVE, Table, at_least, settings};

use super::merging::{SamePlane, merged};
use super::picture::{DepthPicture, PictureError};
use super::pixels::{Assignment, NONE, pieces, without_lone};
use super::plane_sums::PatchSums;
use super::shapes::{Group, ShapesConfig, measured};

settings! {
    /// How the pixels of a depth picture are grouped into planes and components.
    pub struct GroupingConfig("classification.grouping") {
        /// Side of the patches that planes are put together of. Smaller ones see smaller surfaces, larger ones bear more noise.
        patch: usize = 4, "px", at_least(2.0);
        /// A patch with a larger root mean square error, in noises, is no part of a plane.
        rough: f64 = 2.0, "1", POSITIVE;
        /// Pixels that err alike tell as much as one.
        alike: f64 = 8.0, "1", at_least(1.0);
        /// Squared noises by which the planes of two patches may differ: chance alone gives 16.3 in a thousandth of the cases.
        gate: f64 = 40.0, "1", POSITIVE;
        /// Noises by which the smaller of two patches may lie off the plane of both.
        misfit: f64 = 1.0, "1", POSITIVE;
        /// Noises by which a pixel may lie off its plane.
        reach: f64 = 5.0, "1", POSITIVE;
        /// Pixels of the smallest plane.
        least_plane: usize = 24, "px", at_least(3.0);
        /// Pixels of the smallest component.
        least_component: usize = 6, "px", at_least(1.0);
        /// Two pixels side by side are of one thing up to so many noises.
        jump: f64 = 5.0, "1", POSITIVE;
        /// Up to this share of the inverse depth more they are of one thing, too: slanted surfaces.
        jump_share: f64 = 0.04, "1", POSITIVE;
        /// Pixels in a row so far apart err each for itself: by what those say that lie in a line the noise of a picture is estimated.
        lag: usize = 6, "px", at_least(1.0);
        /// Standard deviation of an inverse depth at least: pictures that were drawn without any error have steps of their own.
        least_noise: f64 = 5e-4, "1/m", POSITIVE;
        /// Median of the size of an error, in standard deviations: that of a normal one.
        median: f64 = 0.6745, "1", POSITIVE;
    }
}

/// What a picture's pixels belong to.
#[derive(Debug, Clone, PartialEq)]
pub struct Groups {
    /// Number of each pixel's group, counted from 1; 0 of none.
    pub of_pixel: Vec<u16>,
    /// The groups.
    pub each: Vec<Group>,
}

/// Groups the pixels of depth pictures: handbook, section 36.3.5, Fig. 36.18.
#[derive(Debug, Clone)]
pub struct SceneGrouping {
    config: GroupingConfig,
    shapes: ShapesConfig,
}

impl SceneGrouping {
    /// With settings.
    pub fn new(config: GroupingConfig, shapes: ShapesConfig) -> Result<Self, ConfigError> {
        config.check()?;
        shapes.check()?;
        Ok(Self { config, shapes })
    }

    /// The standard deviation of the inverse depths of a picture, 1/m, estimated from them: by the median of how far a pixel lies off the
    /// middle of two, which most lie on a plane with. None where too few were seen.
    pub fn noise(&self, cols: usize, inverse_depths_per_m: &[f32]) -> Option<f64> {
        let lag = self.config.lag;
        let rows = inverse_depths_per_m.chunks_exact(cols.max(1));
        let triples = rows.flat_map(|row| {
            (2 * lag..row.len())
                .map(|at| [row[at - 2 * lag], row[at - lag], row[at]].map(f64::from))
        });
        let off = triples.map(|[a, b, c]| (a - 2.0 * b + c).abs());
        let mut off: Vec<f64> = off.filter(|off| off.is_finite()).collect();
        let middle = off.len() / 2;
        let median =
            (off.len() > 2 * lag).then(|| *off.select_nth_unstable_by(middle, f64::total_cmp).1)?;
        let squares = f64::from(1 + 2 * 2 + 1);
        let sigma = median / (self.config.median * squares.sqrt());
        Some(sigma.max(self.config.least_noise))
    }

    /// Groups a picture. One that shows nothing has no groups.
    pub fn group(&self, picture: &DepthPicture) -> Result<Groups, PictureError> {
        picture.check()?;
        let config = &self.config;
        let values = without_lone(picture, config.jump * config.jump);
        let (labels, planes) = self.planes(picture, &values);
        let mut on_plane = Assignment {
            picture,
            values: &values,
            planes,
            reach: config.reach,
        };
        let labels = self.joined(&mut on_plane, labels);
        let jump = |a: usize, b: usize| {
            let most = config.jump + config.jump_share * values[a].min(values[b]);
            (values[a] - values[b]).abs() <= most
        };
        // Planes fall apart where something stands before them; what is left over of them is of no plane.
        let alike = |a: usize, b: usize| labels[a] == labels[b];
        let on_one = |at: usize| labels[at] != NONE;
        let (mut of_pixel, planes) = pieces(picture, on_one, alike, config.least_plane);
        let rest = |at: usize| of_pixel[at] == NONE && !values[at].is_nan();
        let (components, _) = pieces(picture, rest, jump, config.least_component);
        let mut plane_of = vec![None; usize::from(planes)];
        for (at, number) in of_pixel.iter_mut().enumerate() {
            if *number != NONE {
                plane_of[usize::from(*number) - 1] =
                    Some(on_plane.planes[usize::from(labels[at]) - 1]);
            } else if components[at] != NONE {
                *number = planes.saturating_add(components[at]);
            }
        }
        let count = of_pixel.iter().copied().max().unwrap_or(NONE);
        plane_of.resize(usize::from(count), None);
        let each = measured(&self.shapes, picture, &values, &of_pixel, &plane_of);
        Ok(Groups { of_pixel, each })
    }

    /// The plane of each pixel by the patches around it, counted from 1, and the planes.
    fn planes(&self, picture: &DepthPicture, values: &[f64]) -> (Vec<u16>, Vec<Vector3<f64>>) {
        let side = self.config.patch;
        let (across, down) = (picture.cols.div_ceil(side), picture.rows().div_ceil(side));
        let patch_of = |at: usize| at / picture.cols / side * across + at % picture.cols / side;
        let mut sums = vec![PatchSums::default(); across * down];
        for (at, value) in values.iter().enumerate() {
            if !value.is_nan() {
                sums[patch_of(at)].add(&picture.ray(at), *value);
            }
        }
        let least = (side * side) as f64 / 2.0;
        let rough = self.config.rough * self.config.rough;
        let is_plane: Vec<bool> = (sums.iter())
            .map(|sums| sums.count() >= least && sums.cost() <= rough * sums.count())
            .collect();
        let mut pairs = Vec::new();
        for patch in (0..sums.len()).filter(|&patch| is_plane[patch]) {
            let right = (patch % across + 1 < across).then_some(patch + 1);
            let below = (patch + across < sums.len()).then_some(patch + across);
            let beside = [right, below].into_iter().flatten();
            pairs.extend(
                beside
                    .filter(|&other| is_plane[other])
                    .map(|other| [patch, other]),
            );
        }
        let part_of = merged(&self.same(), &sums, &pairs);
        let mut numbers = vec![NONE; sums.len()];
        let mut planes = Vec::new();
        for patch in (0..sums.len()).filter(|&patch| is_plane[patch]) {
            if part_of[patch] == patch {
                planes.extend(whole(&sums, &part_of, patch).plane());
                numbers[patch] = u16::try_from(planes.len()).unwrap_or(u16::MAX);
            }
            numbers[patch] = numbers[part_of[patch]];
        }
        let reach = self.config.reach;
        let assignment = Assignment {
            picture,
            values,
            planes,
            reach,
        };
        let labels = assignment.nearest(|at| {
            let (row, col) = (at / picture.cols / side, at % picture.cols / side);
            let cols = col.saturating_sub(1)..(col + 2).min(across);
            let rows = row.saturating_sub(1)..(row + 2).min(down);
            let mut near: Vec<u16> = rows
                .flat_map(|row| &numbers[row * across..][cols.clone()])
                .copied()
                .filter(|number| *number != NONE)
                .collect();
            near.sort_unstable();
            near.dedup();
            near
        });
        (labels, assignment.planes)
    }

    fn same(&self) -> SamePlane {
        let GroupingConfig {
            alike,
            gate,
            misfit,
            ..
        } = self.config;
        SamePlane {
            alike,
            gate,
            misfit,
        }
    }

    /// The pixels after the planes grew, were fitted to them anew, and those that are one were joined.
    fn joined(&self, on_plane: &mut Assignment<'_>, mut labels: Vec<u16>) -> Vec<u16> {
        on_plane.grow(&mut labels);
        on_plane.smooth(&mut labels);
        let mut sums = vec![PatchSums::default(); on_plane.planes.len()];
        let mut pairs = Vec::new();
        for (at, label) in labels
            .iter()
            .enumerate()
            .filter(|(_, label)| **label != NONE)
        {
            let number = usize::from(*label) - 1;
            if !on_plane.values[at].is_nan() {
                sums[number].add(&on_plane.picture.ray(at), on_plane.values[at]);
            }
            let beside = on_plane.picture.beside(at).into_iter().flatten();
            let others = beside.filter(|&other| labels[other] > *label);
            pairs.extend(others.map(|other| [number, usize::from(labels[other]) - 1]));
        }
        pairs.sort_unstable();
        pairs.dedup();
        let part_of = merged(&self.same(), &sums, &pairs);
        for number in 0..sums.len() {
            let plane = whole(&sums, &part_of, number).plane();
            on_plane.planes[number] = plane.unwrap_or(on_plane.planes[number]);
        }
        for label in labels.iter_mut().filter(|label| **label != NONE) {
            *label = part_of[usize::from(*label) - 1] as u16 + 1;
        }
        on_plane.smooth(&mut labels);
        labels
    }
}

/// What the parts of a patch sum up to.
fn whole(sums: &[PatchSums], part_of: &[usize], patch: usize) -> PatchSums {
    let parts = (patch..sums.len()).filter(|&other| part_of[other] == patch);
    parts.fold(PatchSums::default(), |whole, part| {
        whole.joined(&sums[part])
    })
}
