//! Ground told from objects in clouds that were taken from above or over large areas.

mod holes;
mod opening;
mod raster;

use geometry::{Grid, Lattice};
use settings::{ConfigError, POSITIVE, Table, at_least, settings};

use crate::cloud::{CloudError, Point3, check};

settings! {
    /// How ground is told from buildings, trees and cars in a cloud from above: by openings that grow until the largest building is gone.
    pub struct GroundFilterConfig("classification.ground_filter") {
        /// Side of a cell, in mean distances between points.
        cell_per_spacing: f64 = 1.0, "1", POSITIVE, "Pingel, Clarke and McBride 2013, section 2.1";
        /// Width of the largest object that is no ground, as of a building. The openings grow until they are as wide.
        largest_object: f64 = 40.0, "m", POSITIVE, "Zhang et al. 2003, section II.C";
        /// Most openings. Denser clouds get larger cells, so that no more are needed.
        openings: usize = 40, "1", at_least(1.0);
        /// Ground rises no more than this from the middle of an opening to its edge.
        slope: f64 = 0.15, "1", POSITIVE, "Pingel, Clarke and McBride 2013, table 2";
        /// A cell that lies below all around it by more than this slope is an error of measurement.
        pit_slope: f64 = 5.0, "1", POSITIVE, "Pingel, Clarke and McBride 2013, section 2.2";
        /// A point this near to level ground is ground.
        near: f64 = 0.5, "m", POSITIVE, "Pingel, Clarke and McBride 2013, table 2";
        /// On a slope of 1 a point may be farther from the ground by this.
        near_by_slope: f64 = 1.25, "m", settings::NOT_NEGATIVE, "Pingel, Clarke and McBride 2013, table 2";
        /// Sweeps that make the heights in holes smooth.
        smoothing: usize = 200, "1", at_least(0.0);
        /// Most cells of the raster.
        most_cells: usize = 50_000_000, "1", at_least(16.0);
    }
}

/// What the filter says of a cloud.
#[derive(Debug, Clone, PartialEq)]
pub struct Ground {
    /// Whether each point lies on the ground, in the cloud's order.
    pub is_ground: Vec<bool>,
    /// Height of the bare ground at the middle of each cell, m.
    pub heights_m: Grid<f64>,
    /// Where the cells lie, in the cloud's own frame.
    pub lattice: Lattice,
}

/// Tells ground from objects by progressive morphological openings: Zhang et al., IEEE TGRS 41 (2003), with the provisional ground
/// and the slope-dependent margin of Pingel, Clarke and McBride, ISPRS Journal 77 (2013).
///
/// Claim: one set of settings serves towns and hills; what they follow from is the spacing of the points, the largest building and
/// the steepest ground.
#[derive(Debug, Clone)]
pub struct GroundFilter {
    config: GroundFilterConfig,
}

impl GroundFilter {
    /// With settings.
    pub fn new(config: GroundFilterConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self { config })
    }

    /// Which points are ground, and how high it is everywhere.
    pub fn filter(&self, points: &[Point3]) -> Result<Ground, CloudError> {
        let config = &self.config;
        check(points, 1)?;
        let reach_m = config.largest_object / 2.0;
        let spacing_m = raster::spacing_m(points);
        let cell_m = (config.cell_per_spacing * spacing_m).max(reach_m / config.openings as f64);
        let (lattice, mut lowest_m) = raster::lowest(points, cell_m, config.most_cells)?;
        let measured: Vec<_> = (lowest_m.values().iter())
            .map(|height_m| height_m.is_finite())
            .collect();
        holes::fill(&mut lowest_m, config.smoothing);

        let mut turned = lowest_m.clone();
        (turned.values_mut().iter_mut()).for_each(|height_m| *height_m = -*height_m);
        let pits = opening::raised(&turned, 1, config.pit_slope * cell_m);
        forget(&mut lowest_m, |index| pits[index]);
        holes::fill(&mut lowest_m, config.smoothing);

        let openings = whole_above(reach_m / cell_m).max(1);
        let objects = opening::raised(&lowest_m, openings, config.slope * cell_m);
        let mut heights_m = lowest_m;
        forget(&mut heights_m, |index| {
            objects[index] || pits[index] || !measured[index]
        });
        holes::fill(&mut heights_m, config.smoothing);

        let slopes = raster::slopes(&heights_m, cell_m);
        let is_ground = (points.iter())
            .map(|point| {
                let height_m = raster::between(&heights_m, &lattice, point);
                let slope = raster::between(&slopes, &lattice, point);
                (point[2] - height_m).abs() <= config.near + config.near_by_slope * slope
            })
            .collect();
        Ok(Ground {
            is_ground,
            heights_m,
            lattice,
        })
    }
}

/// The least whole number that is not below a positive value.
fn whole_above(value: f64) -> usize {
    let whole = value as usize;
    whole + usize::from(value > whole as f64)
}

/// Leaves holes where `drop` says so, but never a raster of holes alone.
fn forget(heights_m: &mut Grid<f64>, drop: impl Fn(usize) -> bool) {
    if (0..heights_m.values().len()).all(&drop) {
        return;
    }
    for (index, height_m) in heights_m.values_mut().iter_mut().enumerate() {
        if drop(index) {
            *height_m = f64::NAN;
        }
    }
}

#[cfg(test)]
mod tests;
