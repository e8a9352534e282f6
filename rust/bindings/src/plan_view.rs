//! Maps of the plane that a laser sweeps: occupancy and lines.

use geometry::PlanarPose;
use numpy::{
    IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyUntypedArrayMethods, ToPyArray, ndarray,
};
use plan_view::{
    AlignmentConfig, BeamLikelihood, BeamLikelihoodConfig, LineAlignment, LineFinder,
    LineFinderConfig, OccupancyConfig, OccupancyMap, PlanarBeam, PlanarScan, SonarConfig,
    SonarModel, SplitAndMergeConfig,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{bad_setting, parse, run};

/// Rows of an array (n, 2).
pub(crate) fn places(points: &Bound<'_, PyArray2<f64>>) -> PyResult<Vec<[f64; 2]>> {
    let points = points.readonly();
    if points.shape()[1] != 2 {
        return Err(PyValueError::new_err(format!(
            "points must be (n, 2), got {:?}",
            points.shape()
        )));
    }
    let rows = points.as_array();
    Ok(rows
        .rows()
        .into_iter()
        .map(|row| [row[0], row[1]])
        .collect())
}

/// A scan of which the points in the map are known, and where the sensor was; a point that is no number is a reading of nothing.
fn scan_of(points_m: &[[f64; 2]], eye_m: [f64; 2]) -> PlanarScan {
    let beam = |at_m: &[f64; 2]| {
        let off = [at_m[0] - eye_m[0], at_m[1] - eye_m[1]];
        let range_m = geometry::hypot(off[0], off[1]);
        if range_m.is_finite() {
            PlanarBeam::new(libm::atan2(off[1], off[0]), Some(range_m))
        } else {
            PlanarBeam::new(0.0, None)
        }
    };
    PlanarScan {
        map_from_sensor: PlanarPose::new(eye_m[0], eye_m[1], 0.0),
        beams: points_m.iter().map(beam).collect(),
    }
}

/// Scans of points in the map, m: of which scan each is, and from where each scan was taken, m.
fn scans_of(
    points_m: &[[f64; 2]],
    scan: &[usize],
    eyes_m: &[[f64; 2]],
) -> PyResult<Vec<PlanarScan>> {
    let mut each = vec![Vec::new(); eyes_m.len()];
    for (at_m, &of) in points_m.iter().zip(scan) {
        let said = || PyValueError::new_err(format!("scan {of} has no eye"));
        each.get_mut(of).ok_or_else(said)?.push(*at_m);
    }
    if scan.len() != points_m.len() {
        return Err(PyValueError::new_err(
            "scan must be (n,), as points are (n, 2)",
        ));
    }
    Ok(each
        .iter()
        .zip(eyes_m)
        .map(|(points_m, &eye_m)| scan_of(points_m, eye_m))
        .collect())
}

/// An occupancy grid of a laser's scans that grows with what is seen. `settings` is JSON: `[navigation.occupancy_2d]`.
#[pyclass(name = "OccupancyMap", module = "treadwell._core")]
pub(crate) struct PyOccupancyMap(OccupancyMap);

#[pymethods]
impl PyOccupancyMap {
    #[new]
    #[pyo3(signature = (settings="{}"))]
    fn new(py: Python<'_>, settings: &str) -> PyResult<Self> {
        let config: OccupancyConfig = parse(py, settings)?;
        let map = OccupancyMap::new(config).map_err(|error| bad_setting(py, &error))?;
        Ok(Self(map))
    }

    /// Takes in a scan: points (n, 2) m in the map's frame, NaN for nothing seen, all seen from `eye`, m. How many beams said something.
    fn insert(
        &mut self,
        py: Python<'_>,
        points: &Bound<'_, PyArray2<f64>>,
        eye: [f64; 2],
    ) -> PyResult<usize> {
        let scan = scan_of(&places(points)?, eye);
        let map = &mut self.0;
        let counts = run(py, || map.insert(&scan))?.map_err(|error| bad_setting(py, &error))?;
        Ok(counts.used)
    }

    /// Takes in measurements of sonars at `pose` (x, y m and heading rad): their directions from there, rad, and ranges, m, NaN for nothing heard.
    /// `settings` is JSON: `[plan_view.sonar]`.
    #[pyo3(signature = (pose, bearings, ranges, settings="{}"))]
    fn insert_sonar(
        &mut self,
        py: Python<'_>,
        pose: [f64; 3],
        bearings: Vec<f64>,
        ranges: Vec<f64>,
        settings: &str,
    ) -> PyResult<usize> {
        let config: SonarConfig = parse(py, settings)?;
        let model = SonarModel::new(config).map_err(|error| bad_setting(py, &error))?;
        let beam = |(bearing_rad, range_m): (f64, f64)| {
            PlanarBeam::new(
                bearing_rad,
                Some(range_m).filter(|range_m| !range_m.is_nan()),
            )
        };
        let scan = PlanarScan {
            map_from_sensor: PlanarPose::new(pose[0], pose[1], pose[2]),
            beams: bearings.into_iter().zip(ranges).map(beam).collect(),
        };
        let map = &mut self.0;
        let counts = run(py, || map.insert_sonar(&scan, &model))?;
        Ok(counts.map_err(|error| bad_setting(py, &error))?.used)
    }

    /// Lower-left corner, m, side of a cell, m, and for each cell [row, col] the probability that it is occupied, float32, NaN where nothing was
    /// seen, and how many scans said something of it, uint16.
    #[expect(
        clippy::type_complexity,
        reason = "a tuple of arrays, as Python gets it"
    )]
    fn cells<'py>(
        &self,
        py: Python<'py>,
    ) -> (
        [f64; 2],
        f64,
        Bound<'py, PyArray2<f32>>,
        Bound<'py, PyArray2<u16>>,
    ) {
        let (cells, lattice) = (self.0.cells(), self.0.lattice());
        let shape = (cells.rows(), cells.cols());
        let at = |row: usize, col: usize| geometry::Cell::new(col as i32, row as i32);
        let occupied = ndarray::Array2::from_shape_fn(shape, |(row, col)| {
            self.0
                .probability(at(row, col))
                .map_or(f32::NAN, |p| p as f32)
        });
        let looks = ndarray::Array2::from_shape_fn(shape, |(row, col)| {
            cells.get(at(row, col)).map_or(0, |belief| belief.looks)
        });
        (
            lattice.origin_m,
            lattice.cell_m,
            occupied.to_pyarray(py),
            looks.to_pyarray(py),
        )
    }

    /// Logarithm of the density of a scan, as `insert` takes it, in the map, and of how many beams it is. `settings` is JSON:
    /// `[plan_view.beam_likelihood]`.
    #[pyo3(signature = (points, eye, settings="{}"))]
    fn log_likelihood(
        &self,
        py: Python<'_>,
        points: &Bound<'_, PyArray2<f64>>,
        eye: [f64; 2],
        settings: &str,
    ) -> PyResult<(f64, usize)> {
        let config: BeamLikelihoodConfig = parse(py, settings)?;
        let model = BeamLikelihood::new(config).map_err(|error| bad_setting(py, &error))?;
        let scan = scan_of(&places(points)?, eye);
        run(py, || model.log_likelihood(&self.0, &scan))
    }
}

/// The lines that points (n, 2), m, lie on: `normal` (k,) rad and `distance` (k,) m of each line, `share` (k,) of the points, those with most
/// first; `held`: share of the points that some line holds; `criterion`; and where they are: `ends` (m, 4) m, x and y of both ends of
/// each stretch with points, of `line` (m,). `settings` is JSON: `[plan_view.lines]`.
///
/// With `scan` (n,), of which scan each point is, and `eyes` (s, 2) m, from where each was taken, the scans are laid onto the lines as well:
/// `poses` (s, 3) is where each was taken then, x and y m, and by how much it is turned, rad. `alignment` is JSON: `[plan_view.alignment]`.
#[pyfunction]
#[pyo3(signature = (points, settings="{}", *, scan=None, eyes=None, alignment="{}"))]
pub(crate) fn find_lines<'py>(
    py: Python<'py>,
    points: &Bound<'_, PyArray2<f64>>,
    settings: &str,
    scan: Option<Vec<usize>>,
    eyes: Option<&Bound<'_, PyArray2<f64>>>,
    alignment: &str,
) -> PyResult<Bound<'py, PyDict>> {
    let config: LineFinderConfig = parse(py, settings)?;
    let finder = LineFinder::new(config).map_err(|error| bad_setting(py, &error))?;
    let mut points = places(points)?;
    let made = PyDict::new(py);
    let found = if let (Some(scan), Some(eyes)) = (scan, eyes) {
        let config: AlignmentConfig = parse(py, alignment)?;
        let align = LineAlignment::new(config).map_err(|error| bad_setting(py, &error))?;
        let mut scans = scans_of(&points, &scan, &places(eyes)?)?;
        let both = run(py, || align.find(&finder, &scans))?;
        let (found, poses) = both.map_err(|error| bad_setting(py, &error))?;
        let rows = ndarray::Array2::from_shape_fn((poses.len(), 3), |(row, at)| {
            [poses[row].x_m, poses[row].y_m, poses[row].yaw_rad][at]
        });
        made.set_item("poses", rows.to_pyarray(py))?;
        for (scan, pose) in scans.iter_mut().zip(poses) {
            scan.map_from_sensor = pose;
        }
        points = scans.iter().flat_map(PlanarScan::ends_m).collect();
        found
    } else {
        run(py, || finder.find(&points))?.map_err(|error| bad_setting(py, &error))?
    };
    let lines = found.mixture.lines();
    let drawn = run(py, || finder.stretches(&found, &points))?;
    let numbers = |values: Vec<f64>| -> Bound<'py, PyArray1<f64>> { values.into_pyarray(py) };
    made.set_item(
        "normal",
        numbers(lines.iter().map(|line| line.normal_rad).collect()),
    )?;
    made.set_item(
        "distance",
        numbers(lines.iter().map(|line| line.distance_m).collect()),
    )?;
    made.set_item(
        "share",
        numbers(found.mixture.shares()[..lines.len()].to_vec()),
    )?;
    made.set_item("held", found.held)?;
    made.set_item("criterion", found.criterion)?;
    let ends = ndarray::Array2::from_shape_fn((drawn.len(), 4), |(row, at)| {
        drawn[row].ends_m[at / 2][at % 2]
    });
    made.set_item("ends", ends.to_pyarray(py))?;
    let of: Vec<i64> = drawn.iter().map(|stretch| stretch.line as i64).collect();
    made.set_item("line", of.into_pyarray(py))?;
    Ok(made)
}

/// The lines of a scan whose points (n, 2), m, come in order (004, Fig. 36.4): of each the first and the last point, and its normal, rad, and
/// distance, m. `settings` is JSON: `[plan_view.split_and_merge]`.
#[pyfunction]
#[pyo3(signature = (points, settings="{}"))]
pub(crate) fn split_and_merge(
    py: Python<'_>,
    points: &Bound<'_, PyArray2<f64>>,
    settings: &str,
) -> PyResult<Vec<(usize, usize, f64, f64)>> {
    let config: SplitAndMergeConfig = parse(py, settings)?;
    let points = places(points)?;
    let pieces = run(py, || plan_view::split_and_merge(&points, &config))?;
    let pieces = pieces.map_err(|error| bad_setting(py, &error))?;
    let ends = pieces.iter().map(|piece| {
        let line = &piece.line;
        (piece.first, piece.last, line.normal_rad, line.distance_m)
    });
    Ok(ends.collect())
}
