//! Footsteps over a height map.

use behaviour::PlannedFootsteps;
use geometry::{Goal, Grid, Lattice, PlanarPose};
use mapping::HeightMap;
use numpy::{PyArray2, PyArrayMethods, PyUntypedArrayMethods, ToPyArray};
use planning::footsteps::{FootstepLayer, FootstepPlan, FootstepsConfig};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use robot::Body;
use settings::{Tables, read};

use crate::error::{bad_setting, parse, run};
use crate::stairs::side_name;

/// Plans footsteps for one robot. `settings` is JSON: `[navigation.footsteps]`.
#[pyclass(name = "FootstepLayer", module = "treadwell._core")]
pub(crate) struct PyFootstepLayer(FootstepLayer);

#[pymethods]
impl PyFootstepLayer {
    #[new]
    #[pyo3(signature = (description_json, settings="{}"))]
    fn new(py: Python<'_>, description_json: &str, settings: &str) -> PyResult<Self> {
        let body =
            Body::new(parse(py, description_json)?).map_err(|error| bad_setting(py, &error))?;
        let limits = ::pilot::step_limits(&body).map_err(|error| bad_setting(py, &error))?;
        let given = Tables::from([("footsteps".to_owned(), parse(py, settings)?)]);
        let tables = ::pilot::sized(&given, &body.description().size());
        let config: FootstepsConfig =
            read(&tables, "footsteps").map_err(|error| bad_setting(py, &error))?;
        let layer = FootstepLayer::new(config, limits).map_err(|error| bad_setting(py, &error))?;
        Ok(Self(layer))
    }

    /// Steps over heights (h, w) m, taken as exact, NaN where nothing is known; `lattice` is the corner (x, y), m,
    /// of row 0 and column 0, and the side of a cell, m. From both feet around `start` (x m, y m, yaw rad) to within a radius of a place: `goal`
    /// (x, y, radius), m: a dict and none, or none and the reason.
    #[pyo3(signature = (heights, lattice, start, goal))]
    fn plan(
        &mut self,
        py: Python<'_>,
        heights: &Bound<'_, PyArray2<f32>>,
        lattice: ([f64; 2], f64),
        start: [f64; 3],
        goal: [f64; 3],
    ) -> PyResult<(Option<Py<PyDict>>, Option<String>)> {
        let shape = [heights.shape()[0], heights.shape()[1]];
        let values = heights.readonly();
        let values = values
            .as_slice()
            .map_err(|error| PyValueError::new_err(error.to_string()))?;
        let mut grid = Grid::filled(shape[1], shape[0], f32::NAN);
        grid.values_mut().copy_from_slice(values);
        let (origin_m, cell_m) = lattice;
        let map = HeightMap::new(Lattice { origin_m, cell_m }, grid, 0.0);
        let feet = self
            .0
            .feet_around(&PlanarPose::new(start[0], start[1], start[2]));
        let goal = Goal {
            x_m: goal[0],
            y_m: goal[1],
            radius_m: goal[2],
            height_m: None,
        };
        let layer = &mut self.0;
        match run(py, || layer.plan(&map, feet, &goal))? {
            Ok(plan) => Ok((Some(as_dict(py, &plan)?), None)),
            Err(why) => Ok((None, Some(why.to_string()))),
        }
    }
}

/// The plan that a behaviour made last, as [`PyFootstepLayer::plan`] has it, or the `reason` why there was none, with `exit` (x, y) m or None, why a list of the planner's was `refused` or None, `count`, and `times` (first, best) s.
pub(crate) fn planned_as_dict(
    py: Python<'_>,
    planned: &PlannedFootsteps<'_>,
) -> PyResult<Py<PyDict>> {
    let made = match planned.plan {
        Ok(plan) => as_dict(py, plan)?,
        Err(_) => PyDict::new(py).unbind(),
    };
    let dict = made.bind(py);
    dict.set_item("reason", planned.plan.err().map(|none| none.to_string()))?;
    dict.set_item("exit", planned.plan.ok().and_then(|plan| plan.exit_m))?;
    dict.set_item("refused", planned.refused)?;
    dict.set_item("count", planned.count)?;
    dict.set_item("times", (planned.times.first_s, planned.times.best_s))?;
    Ok(made)
}

/// Corner (2,) m and side of a cell, m, and (rows, cols) heights, m, NaN where nothing is known.
pub(crate) type Ground<'py> = ((f64, f64), f64, Bound<'py, PyArray2<f32>>);

/// The ground over which a behaviour planned.
pub(crate) fn ground<'py>(py: Python<'py>, map: &HeightMap) -> PyResult<Ground<'py>> {
    let heights_m = map.heights_m();
    let shape = [heights_m.rows(), heights_m.cols()];
    let flat = heights_m.values().to_pyarray(py).reshape(shape)?;
    Ok((map.lattice.origin_m.into(), map.lattice.cell_m, flat))
}

fn as_dict(py: Python<'_>, plan: &FootstepPlan) -> PyResult<Py<PyDict>> {
    let made = PyDict::new(py);
    let steps = plan.steps.iter().map(|step| {
        let (pose, foothold) = (&step.pose, &step.foothold);
        (
            (side_name(step.side), step.manner.name()),
            (
                step.cost.time_s,
                step.cost.partial_s,
                step.cost.margin_s,
                step.cost.turn_s,
            ),
            (pose.x_m, pose.y_m, pose.yaw_rad),
            (
                foothold.height_m,
                foothold.slope,
                foothold.bearing_m,
                foothold.bearing_share,
            ),
        )
    });
    made.set_item("steps", steps.collect::<Vec<_>>())?;
    made.set_item("cost", plan.cost_s)?;
    made.set_item("whole", plan.whole_s)?;
    made.set_item("epsilon", plan.epsilon)?;
    made.set_item("first", plan.first)?;
    made.set_item("expanded", plan.expanded)?;
    Ok(made.unbind())
}
