//! Landmarks and the robot's way among them, of ranges and bearings.

use geometry::PlanarPose;
use landmarks::{
    Embedding, EmbeddingConfig, ExtractionConfig, FastSlam, FastSlamConfig, LandmarkReading,
    LandmarksConfig, OdometryStep, RangeBearing, StandingThing, ThingShape,
    standing_things as find,
};
use nalgebra::Point3;
use numpy::{PyArray2, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error::{bad_setting, parse, run};

/// The tables that a user may set.
#[derive(serde::Deserialize, Default)]
#[serde(default, deny_unknown_fields)]
struct SlamSettings {
    readings: LandmarksConfig,
    fast_slam: FastSlamConfig,
}

/// A landmark as Python has it: x and y, m; their covariance xx, xy, yy, m²; name; probability that it is there; readings of it.
type Told = ([f64; 2], [f64; 3], Option<u32>, f64, u32);

/// Localizes and maps landmarks at once. The start is the map's origin. `settings` is JSON: the tables `readings` and `fast_slam` of `[landmarks]`.
#[pyclass(name = "FastSlam", module = "treadwell._core")]
pub(crate) struct PyFastSlam {
    slam: FastSlam,
}

#[pymethods]
impl PyFastSlam {
    #[new]
    #[pyo3(signature = (settings="{}"))]
    fn new(py: Python<'_>, settings: &str) -> PyResult<Self> {
        let settings: SlamSettings = parse(py, settings)?;
        let start = PlanarPose::default();
        let slam = FastSlam::new(&start, settings.fast_slam, settings.readings);
        Ok(Self {
            slam: slam.map_err(|error| bad_setting(py, &error))?,
        })
    }

    /// Moves as odometry says: forward, left, m, turn, rad, and the time that passed, s.
    fn advance(&mut self, forward: f64, left: f64, turn: f64, passed: f64) -> PyResult<()> {
        if ![forward, left, turn, passed]
            .iter()
            .all(|part| part.is_finite())
        {
            return Err(PyValueError::new_err("a step of odometry must be finite"));
        }
        self.slam.advance(&OdometryStep {
            forward_m: forward,
            left_m: left,
            turn_rad: turn,
            passed_s: passed,
        });
        Ok(())
    }

    /// Takes in what is seen at one time: ranges, m, and bearings, rad, (n, 2), and their names, n.
    fn see(
        &mut self,
        py: Python<'_>,
        readings: &Bound<'_, PyArray2<f64>>,
        names: Vec<Option<u32>>,
    ) -> PyResult<()> {
        let shape = readings.shape();
        if shape != [names.len(), 2] {
            let said = format!("readings must be ({}, 2), got {shape:?}", names.len());
            return Err(PyValueError::new_err(said));
        }
        let readings = readings.readonly();
        let rows = readings.as_array();
        let seen: Vec<LandmarkReading> = names
            .into_iter()
            .zip(rows.rows())
            .map(|(name, row)| {
                let at = RangeBearing {
                    range_m: row[0],
                    bearing_rad: row[1],
                };
                LandmarkReading { at, name }
            })
            .collect();
        run(py, || self.slam.see(&seen))
    }

    /// Where the robot is: x, y, m, and heading, rad.
    fn pose(&self) -> [f64; 3] {
        let pose = self.slam.pose();
        [pose.x_m, pose.y_m, pose.yaw_rad]
    }

    /// What odometry's ways, turns to the left and turns to the right are multiplied by: of each, mean and standard deviation.
    fn scales(&self) -> [[f64; 2]; 3] {
        self.slam.scales()
    }

    /// The landmarks, in the order in which they were first seen: x and y, m; covariance xx, xy, yy, m²; name; probability that it is there; readings.
    fn landmarks(&self) -> Vec<Told> {
        let all = self.slam.landmarks().into_iter();
        all.map(|one| {
            let spread = one.covariance;
            (
                [one.at_m.x, one.at_m.y],
                [spread.m11, spread.m12, spread.m22],
                one.name,
                one.probability(),
                one.readings,
            )
        })
        .collect()
    }
}

/// Rocks and poles among points (n, 3) m, of an eye `eye` m above the origin, x ahead, y to the left, the ground in z = 0. `settings` is JSON, the table
/// `[landmarks.extraction]`. Of each x, y, width and height, m, and whether it is a pole.
#[pyfunction]
#[pyo3(signature = (points, eye, settings="{}"))]
pub(crate) fn standing_things(
    py: Python<'_>,
    points: &Bound<'_, PyArray2<f64>>,
    eye: f64,
    settings: &str,
) -> PyResult<Vec<([f64; 4], bool)>> {
    let config: ExtractionConfig = parse(py, settings)?;
    if points.shape()[1] != 3 {
        let said = format!("points must be (n, 3), got {:?}", points.shape());
        return Err(PyValueError::new_err(said));
    }
    let rows = points.readonly();
    let rows = rows.as_array();
    let points: Vec<_> = rows
        .rows()
        .into_iter()
        .map(|row| Point3::new(row[0], row[1], row[2]))
        .collect();
    let found = run(py, || find(&points, eye, &config))?;
    let found = found.map_err(|error| bad_setting(py, &error))?;
    let told = |one: StandingThing| {
        let is_pole = one.shape == ThingShape::Pole;
        ([one.at_m.x, one.at_m.y, one.width_m, one.height_m], is_pole)
    };
    Ok(found.into_iter().map(told).collect())
}

/// Looks laid out in a few dimensions: learned from `looks` (n, d). `settings` is JSON: `[landmarks.embedding]`.
#[pyclass(name = "Embedding", module = "treadwell._core", frozen)]
pub(crate) struct PyEmbedding(Embedding);

#[pymethods]
impl PyEmbedding {
    #[new]
    #[pyo3(signature = (looks, settings="{}"))]
    fn new(py: Python<'_>, looks: &Bound<'_, PyArray2<f64>>, settings: &str) -> PyResult<Self> {
        let config: EmbeddingConfig = parse(py, settings)?;
        let looks = rows_of(looks);
        let learned = run(py, || Embedding::learn(config, &looks))?;
        Ok(Self(learned.map_err(|error| bad_setting(py, &error))?))
    }

    /// Where looks (n, d) lie, (n, k).
    fn place<'py>(
        &self,
        py: Python<'py>,
        looks: &Bound<'_, PyArray2<f64>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let looks = rows_of(looks);
        let places = run(py, || {
            let place = |look: &Vec<f64>| Some(self.0.place(look)?.as_slice().to_vec());
            looks.iter().map(place).collect::<Option<Vec<_>>>()
        })?;
        let said =
            || PyValueError::new_err("looks must be as many finite numbers as those learned from");
        Ok(PyArray2::from_vec2(py, &places.ok_or_else(said)?)?)
    }
}

fn rows_of(array: &Bound<'_, PyArray2<f64>>) -> Vec<Vec<f64>> {
    let array = array.readonly();
    array
        .as_array()
        .rows()
        .into_iter()
        .map(|row| row.to_vec())
        .collect()
}
