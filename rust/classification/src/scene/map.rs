//! Labels in the map: what the pictures say of each cube, smoothed by its neighbours.

use std::collections::BTreeMap;

use settings::{ConfigError, POSITIVE, Table, at_least, settings};

use super::groups::Groups;
use super::labels::{Label, SceneClasses};
use super::picture::DepthPicture;
use crate::markov_field::{MarkovField, MarkovFieldConfig};

settings! {
    /// How labels are kept in a map.
    pub struct LabelMapConfig("classification.label_map") {
        /// Side of a cube that has a label.
        cube: f64 = 0.05, "m", POSITIVE;
        /// What is farther from the camera is not kept: its place and its shape are not known well enough.
        farthest: f64 = 3.0, "m", POSITIVE;
        /// Cubes that fewer pixels saw are left out.
        least_pixels: usize = 3, "px", at_least(1.0);
        /// A cube's pictures together count as so many, however many they are: they show the same thing and err alike.
        pictures: f64 = 1.0, "1", POSITIVE;
    }
}

/// A cube with its label.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LabelledCube {
    /// Middle of what was seen in it, m.
    pub place_m: [f64; 3],
    /// What it is by the pictures alone.
    pub alone: Label,
    /// What it is, its neighbours considered.
    pub label: Label,
}

#[derive(Debug, Clone, Default)]
struct Cube {
    sum_m: [f64; 3],
    pixels: usize,
    costs: [f64; Label::ALL.len()],
}

/// A map of labels.
#[derive(Debug, Clone)]
pub struct LabelMap {
    config: LabelMapConfig,
    field: MarkovFieldConfig,
    cubes: BTreeMap<[i32; 3], Cube>,
}

impl LabelMap {
    /// An empty map.
    pub fn new(config: LabelMapConfig, field: MarkovFieldConfig) -> Result<Self, ConfigError> {
        config.check()?;
        field.check()?;
        Ok(Self {
            config,
            field,
            cubes: BTreeMap::new(),
        })
    }

    /// Takes in a picture's groups: each pixel says of the cube that it lies in what its group is.
    pub fn insert(&mut self, picture: &DepthPicture, groups: &Groups, classes: &SceneClasses) {
        let costs: Vec<Vec<f64>> = groups
            .each
            .iter()
            .map(|group| classes.costs(group))
            .collect();
        for (at, number) in groups.of_pixel.iter().enumerate() {
            let inverse = f64::from(picture.inverse_depths_per_m[at]);
            if *number == 0 || inverse.is_nan() || inverse * self.config.farthest < 1.0 {
                continue;
            }
            let point = picture.point(at, inverse);
            let cell = |value: f64| (value / self.config.cube).floor() as i32;
            let cube = self
                .cubes
                .entry([cell(point.x), cell(point.y), cell(point.z)])
                .or_default();
            cube.pixels += 1;
            for (sum, value) in cube.sum_m.iter_mut().zip(point.iter()) {
                *sum += value;
            }
            for (sum, cost) in cube.costs.iter_mut().zip(&costs[usize::from(*number) - 1]) {
                *sum += cost;
            }
        }
    }

    /// The cubes with their labels, smoothed by the random field over those nearest to each.
    pub fn points(&self) -> Result<Vec<LabelledCube>, ConfigError> {
        let kept: Vec<&Cube> = (self.cubes.values())
            .filter(|cube| cube.pixels >= self.config.least_pixels)
            .collect();
        let places: Vec<[f64; 3]> = (kept.iter())
            .map(|cube| cube.sum_m.map(|sum| sum / cube.pixels as f64))
            .collect();
        let costs: Vec<Vec<f64>> = (kept.iter())
            .map(|cube| {
                let each = self.config.pictures / cube.pixels as f64;
                let least = cube.costs.iter().copied().fold(f64::INFINITY, f64::min);
                cube.costs
                    .iter()
                    .map(|cost| (cost - least) * each)
                    .collect()
            })
            .collect();
        let field = MarkovField::of_cloud(self.field.clone(), &places)?;
        let smoothed = field.labels(&costs);
        let alone = |costs: &Vec<f64>| {
            let better = |a: usize, b: usize| if costs[b] < costs[a] { b } else { a };
            (0..costs.len()).reduce(better).unwrap_or(0)
        };
        let cubes = places.iter().zip(&costs).zip(&smoothed);
        Ok(cubes
            .map(|((place_m, costs), label)| LabelledCube {
                place_m: *place_m,
                alone: Label::ALL[alone(costs)],
                label: Label::ALL[*label],
            })
            .collect())
    }
}
