//! What one beam of a laser says of a cell (004, equation 36.6).

use super::OccupancyConfig;

/// The inverse model of a laser's beam: probability that a cell is occupied, given one range alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaserModel {
    prior: f64,
    occupied: f64,
    free: f64,
    cell_m: f64,
}

impl LaserModel {
    /// With the probabilities of a map's settings, of which `free < prior < occupied` holds.
    pub const fn new(config: &OccupancyConfig) -> Self {
        Self {
            prior: config.prior,
            occupied: config.occupied,
            free: config.free,
            cell_m: config.cell,
        }
    }

    /// Probability that a cell is occupied: whether the beam passes the cell, how far its middle is from the sensor, m, and the range, m, none of
    /// a maximum range reading.
    pub fn probability(&self, range_m: Option<f64>, covered: bool, distance_m: f64) -> f64 {
        let Some(range_m) = range_m.filter(|_| covered) else {
            return self.prior;
        };
        if (range_m - distance_m).abs() < self.cell_m / 2.0 {
            self.occupied
        } else if range_m >= distance_m {
            self.free
        } else {
            self.prior // behind what was seen: no part of the beam gets there
        }
    }
}
