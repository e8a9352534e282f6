//! A map of what is static alone, and which beams ended in it, by expectation maximization (004, section 36.4; ref. 36.66, Haehnel et al. 2003).

use geometry::{Cell, Grid, Lattice};
use plan_view::{PlanarBeam, PlanarScan};
use settings::{ConfigError, NOT_NEGATIVE, POSITIVE, Table, at_least, between, settings, within};
use volume::VoxelWalk;

settings! {
    /// How beams come to end in static things or in moving ones.
    pub struct StaticMapConfig("dynamic_scenes.static_cells") {
        /// Side of a cell.
        cell: f64 = 0.05, "m", within(0.001, 10.0);
        /// Probability that a beam that gets to an occupied cell ends in it.
        stopped: f64 = 0.95, "1", between(0.0, 1.0);
        /// Probability that a beam ends in a cell that is free of static things: something that moves is there.
        passing: f64 = 0.3, "1", between(0.0, 1.0);
        /// Beams say nothing of the cells this near before their ends: the error of a range.
        margin: f64 = 0.1, "m", NOT_NEGATIVE;
        /// Ranges further than this are left out.
        max_range: f64 = 50.0, "m", POSITIVE;
        /// Most rounds of expectation and maximization.
        rounds: usize = 50, "1", at_least(1.0);
        /// They end when a round adds less than this to the log likelihood of a look.
        gain: f64 = 1e-5, "1", POSITIVE;
    }
    require (passing) < (stopped);
}

/// Beams that ended in a cell, and that passed it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct CellCounts {
    ended: f64,
    passed: f64,
}

/// What was found.
#[derive(Debug, Clone)]
pub struct StaticCells {
    /// Where the cells lie in the map frame.
    pub lattice: Lattice,
    /// Share of the time that each cell is statically occupied, in effect its probability; NaN of cells that no beam said anything of.
    pub occupied: Grid<f64>,
    /// Of each scan, of each of its beams: probability that it ended in something static; NaN of beams that saw nothing or cannot be used.
    pub beam_is_static: Vec<Vec<f64>>,
    /// Log likelihood of all looks after each round, never falling.
    pub log_likelihoods: Vec<f64>,
}

/// The static map of scans with known poses, over so many columns and rows with the corner of the first cell at a place of the map frame, m.
///
/// Each beam that ends in cell j does so with probability `stopped m_j + passing (1 - m_j)`, and passes it else. The E-step finds for each look the
/// expectation that it was at a cell statically occupied, the M-step the `m` that make these likeliest.
pub fn static_map(
    scans: &[PlanarScan],
    origin_m: [f64; 2],
    size: [usize; 2],
    config: &StaticMapConfig,
) -> Result<StaticCells, ConfigError> {
    config.check()?;
    let lattice = Lattice {
        origin_m,
        cell_m: config.cell,
    };
    let mut counts = Grid::filled(size[0], size[1], CellCounts::default());
    for scan in scans {
        for beam in &scan.beams {
            count(&mut counts, lattice, (scan, beam), config);
        }
    }
    let mut occupied = Grid::filled(size[0], size[1], f64::NAN);
    for (m, counts) in occupied.values_mut().iter_mut().zip(counts.values()) {
        if counts.ended + counts.passed > 0.0 {
            *m = 0.5;
        }
    }
    let looks: f64 = counts
        .values()
        .iter()
        .map(|cell| cell.ended + cell.passed)
        .sum();
    let mut log_likelihoods: Vec<f64> = Vec::new();
    for _ in 0..config.rounds {
        let mut sum = 0.0;
        for (m, cell) in occupied.values_mut().iter_mut().zip(counts.values()) {
            if m.is_nan() {
                continue;
            }
            // E: of the beams that ended here, and of those that passed, how many met a cell that is statically occupied.
            let met = cell.ended * expectation(*m, [config.stopped, config.passing])
                + cell.passed * expectation(*m, [1.0 - config.stopped, 1.0 - config.passing]);
            *m = met / (cell.ended + cell.passed); // M
            let ends = config.stopped * *m + config.passing * (1.0 - *m);
            sum += cell.ended * libm::log(ends) + cell.passed * libm::log(1.0 - ends);
        }
        let gained = log_likelihoods.last().map(|last| sum - last);
        log_likelihoods.push(sum);
        if gained.is_some_and(|gained| gained < config.gain * looks) {
            break;
        }
    }
    let expected = |scan: &PlanarScan, beam: &PlanarBeam| {
        let m = end_m(scan, beam, config)
            .and_then(|[x_m, y_m]| occupied.get(lattice.cell_at(x_m, y_m)).copied());
        m.map_or(f64::NAN, |m| {
            expectation(m, [config.stopped, config.passing])
        })
    };
    let of_scan = |scan: &PlanarScan| scan.beams.iter().map(|beam| expected(scan, beam)).collect();
    Ok(StaticCells {
        lattice,
        beam_is_static: scans.iter().map(of_scan).collect(),
        occupied,
        log_likelihoods,
    })
}

/// Probability that a cell was met as statically occupied that is so with probability m, where what was seen is so likely of one that is and of one
/// that is not.
fn expectation(m: f64, [of_occupied, of_free]: [f64; 2]) -> f64 {
    of_occupied * m / (of_occupied * m + of_free * (1.0 - m))
}

/// Where a beam ends, m in the map frame.
fn end_m(scan: &PlanarScan, beam: &PlanarBeam, config: &StaticMapConfig) -> Option<[f64; 2]> {
    let range_m = beam
        .range_m
        .filter(|range_m| beam.is_usable() && *range_m <= config.max_range)?;
    Some(along(scan, beam, range_m))
}

fn along(scan: &PlanarScan, beam: &PlanarBeam, range_m: f64) -> [f64; 2] {
    let pose = &scan.map_from_sensor;
    let (sin, cos) = libm::sincos(pose.yaw_rad + beam.bearing_rad);
    [pose.x_m + range_m * cos, pose.y_m + range_m * sin]
}

/// Counts a beam in the cell in which it ends and those that it passes.
fn count(
    counts: &mut Grid<CellCounts>,
    lattice: Lattice,
    (scan, beam): (&PlanarScan, &PlanarBeam),
    config: &StaticMapConfig,
) {
    let Some(end_m) = end_m(scan, beam, config) else {
        return;
    };
    let end = lattice.cell_at(end_m[0], end_m[1]);
    if let Some(cell) = counts.get_mut(end) {
        cell.ended += 1.0;
    }
    let eye_m = [scan.map_from_sensor.x_m, scan.map_from_sensor.y_m];
    let short_m = (geometry::distance_m(eye_m, end_m) - config.margin).max(0.0);
    let [from, to] = [eye_m, along(scan, beam, short_m)].map(|at_m| {
        let [x, y] = [0, 1].map(|axis| (at_m[axis] - lattice.origin_m[axis]) / lattice.cell_m);
        [x, y, 0.5]
    });
    let size = [counts.cols() as i32, counts.rows() as i32, 1];
    for [col, row, _] in VoxelWalk::new(from, to, size).into_iter().flatten() {
        let passed = Cell::new(col, row);
        if let Some(cell) = counts.get_mut(passed).filter(|_| passed != end) {
            cell.passed += 1.0;
        }
    }
}
