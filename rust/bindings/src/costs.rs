//! What ground costs a robot: by its shape, and by speed and curvature.

use std::collections::BTreeMap;

use costs::{
    GroundShape, LimitsConfig, MotionConfig, MotionCost, RobotLimits, SpeedOnCurve, Traversability,
    TraversabilityConfig,
};
use geometry::Grid;
use numpy::{PyArray2, PyArrayMethods, PyUntypedArrayMethods, ToPyArray, ndarray};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use robot::Body;
use settings::{TableDescription, overlay};

use crate::error::{bad_setting, parse, run};

/// The tables that a user may set.
#[derive(serde::Deserialize, Default)]
#[serde(default, deny_unknown_fields)]
struct CostSettings {
    limits: LimitsConfig,
    traversability: TraversabilityConfig,
    motion: MotionConfig,
}

/// Costs for one robot: description and settings as JSON, the tables `limits`, `traversability` and `motion` of `[costs]`.
#[pyclass(frozen, name = "GroundCosts", module = "treadwell._core")]
pub(crate) struct PyGroundCosts {
    limits: RobotLimits,
    traversability: Traversability,
    motion: MotionCost,
}

fn grid<T: Clone>(array: &Bound<'_, PyArray2<f64>>, value: impl Fn(f64) -> T) -> Grid<T> {
    let array = array.readonly();
    let array = array.as_array();
    let mut grid = Grid::filled(array.ncols(), array.nrows(), value(f64::NAN));
    for (cell, one) in grid.values_mut().iter_mut().zip(array.iter()) {
        *cell = value(*one);
    }
    grid
}

pub(crate) fn array<'py>(py: Python<'py>, grid: &Grid<f64>) -> Bound<'py, PyArray2<f64>> {
    let shape = (grid.rows(), grid.cols());
    let values = grid.values();
    ndarray::Array2::from_shape_fn(shape, |(row, col)| values[row * shape.1 + col]).to_pyarray(py)
}

fn ground(slope: f64, roughness_m: f64) -> GroundShape {
    GroundShape {
        slope,
        roughness_m,
        ..GroundShape::LEVEL
    }
}

/// The settings that were given, as JSON, over the defaults of a robot of that size.
fn over_sized(py: Python<'_>, body: &Body, given: &str) -> PyResult<String> {
    let size = body.description().size();
    let mut settings = serde_json::json!({
        "limits": TableDescription::of::<LimitsConfig>().defaults_at(&size),
        "traversability": TableDescription::of::<TraversabilityConfig>().defaults_at(&size),
    });
    overlay(&mut settings, &parse(py, given)?);
    Ok(settings.to_string())
}

#[pymethods]
impl PyGroundCosts {
    #[new]
    #[pyo3(signature = (description_json, settings="{}"))]
    fn new(py: Python<'_>, description_json: &str, settings: &str) -> PyResult<Self> {
        let body =
            Body::new(parse(py, description_json)?).map_err(|error| bad_setting(py, &error))?;
        let settings: CostSettings = parse(py, &over_sized(py, &body, settings)?)?;
        let limits = RobotLimits::of(&body, &settings.limits);
        let limits = limits.map_err(|error| bad_setting(py, &error))?;
        let traversability = Traversability::new(settings.traversability, limits);
        let motion = MotionCost::new(settings.motion, limits);
        Ok(Self {
            limits,
            traversability: traversability.map_err(|error| bad_setting(py, &error))?,
            motion: motion.map_err(|error| bad_setting(py, &error))?,
        })
    }

    /// What the robot can do: metres, metres a second, rise per metre.
    #[getter]
    fn limits(&self) -> BTreeMap<&'static str, f64> {
        let limits = &self.limits;
        BTreeMap::from([
            ("slope", limits.slope),
            ("roughness", limits.roughness_m),
            ("step", limits.step_m),
            ("radius", limits.radius_m),
            ("height", limits.height_m),
            ("speed", limits.speed_mps),
            ("com_height", limits.com_height_m),
            ("half_support", limits.half_support_m),
            ("sole", limits.sole_m),
        ])
    }

    /// (rows, cols) what a metre costs in each cell of `heights` (rows, cols), m, NaN unknown, with cells of `cell` m: 1 on level ground,
    /// infinite where the robot cannot go. `head_room`: m above each cell.
    #[pyo3(signature = (heights, cell, head_room=None))]
    fn map<'py>(
        &self,
        py: Python<'py>,
        heights: &Bound<'_, PyArray2<f64>>,
        cell: f64,
        head_room: Option<&Bound<'_, PyArray2<f64>>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        if !(cell > 0.0 && cell.is_finite()) {
            return Err(PyValueError::new_err(format!(
                "cell must be > 0 m, got {cell}"
            )));
        }
        if let Some(room) = head_room.filter(|room| room.shape() != heights.shape()) {
            let (found, expected) = (room.shape(), heights.shape());
            return Err(PyValueError::new_err(format!(
                "head_room must have the shape of heights, {expected:?}, got {found:?}"
            )));
        }
        let heights = grid(heights, |height_m| height_m.is_finite().then_some(height_m));
        let room = head_room.map(|room| {
            let known = |room_m: f64| {
                if room_m.is_nan() {
                    f64::INFINITY
                } else {
                    room_m
                }
            };
            grid(room, known)
        });
        let costs = run(py, || {
            self.traversability.map(&heights, room.as_ref(), cell)
        })?;
        Ok(array(py, &costs))
    }

    /// How near the robot comes to tipping over and to slipping, 1 just does: slope and roughness (m) of the ground, its friction, the
    /// speed, m/s, and the path's curvature, 1/m.
    fn demand(
        &self,
        slope: f64,
        roughness: f64,
        friction: f64,
        speed: f64,
        curvature: f64,
    ) -> (f64, f64) {
        let going = SpeedOnCurve {
            speed_mps: speed,
            curvature_per_m: curvature,
        };
        let demand = (self.motion).demand(&ground(slope, roughness), friction, &going);
        (demand.tip, demand.slip)
    }

    /// What a metre costs more at that speed on that curve; infinite where the robot tips, slips or is not as fast.
    fn motion_cost(
        &self,
        slope: f64,
        roughness: f64,
        friction: f64,
        speed: f64,
        curvature: f64,
    ) -> f64 {
        let going = SpeedOnCurve {
            speed_mps: speed,
            curvature_per_m: curvature,
        };
        (self.motion).cost(&ground(slope, roughness), friction, &going)
    }

    /// The fastest that the robot goes there along a curve, m/s; `None` where it cannot even stand.
    fn fastest(&self, slope: f64, roughness: f64, friction: f64, curvature: f64) -> Option<f64> {
        (self.motion).fastest_mps(&ground(slope, roughness), friction, curvature)
    }
}
