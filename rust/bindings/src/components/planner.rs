//! A planner of the user's.

use geometry::{Map, PlanarPose, Pose, Robot};
use mapping::{FloorView, Surface};
use numpy::PyReadonlyArray2;
use planning::footsteps::ListedStep;
use planning::{Goal, NoWay, Path, Plan, PlanError, Planner, Refusal};
use pyo3::exceptions::PyValueError;
use pyo3::intern;
use pyo3::prelude::*;
use stairs::Staircase;

use super::{
    FARTHEST_M, attribute, check_within, forget_if, listed_footsteps, sentence, something,
};
use crate::floor_view::PyFloorView;
use crate::products::flat;
use crate::situation::PyGoal;
use crate::stairs::{PyStaircase, side};

/// Points that a path can have at most: 4 km in steps of a cell.
const MOST_POINTS: usize = 100_000;

struct PythonPlanner {
    object: Py<PyAny>,
    /// Whether the robot found itself elsewhere since the last plan.
    elsewhere: bool,
}

/// Wraps an object with the method of `treadwell.protocols.Planner`.
pub(crate) fn planner(object: Py<PyAny>) -> Box<dyn Planner> {
    Box::new(PythonPlanner {
        object,
        elsewhere: false,
    })
}

impl PythonPlanner {
    fn ask(
        &mut self,
        py: Python<'_>,
        view: &FloorView,
        stairs: &Staircase,
        start: &Pose<Map, Robot>,
        goal: &Goal,
    ) -> PyResult<Plan> {
        let arguments = (
            PyFloorView(view.clone()),
            PyStaircase::from(stairs),
            flat(start),
            PyGoal::from(goal),
        );
        let object = self.object.bind(py);
        forget_if(&mut self.elsewhere, object)?;
        let plan = object.call_method1(intern!(py, "plan"), arguments)?;
        something(&plan, "plan()", "a Plan")?;
        let replanned = attribute(&plan, ("plan()", "replanned"), "bool")?;
        let path: Option<PyReadonlyArray2<'_, f64>> =
            attribute(&plan, ("plan()", "path"), "float64 (n, 2) or None")?;
        let Some(points) = path else {
            let sentence: String = attribute(&plan, ("plan()", "reason"), "str")?;
            return Ok(Plan {
                way: Err(NoWay::new(Refusal::NoPath, sentence)),
                replanned,
            });
        };
        let points = points.as_array();
        if points.ncols() != 2 || points.nrows() == 0 {
            return Err(PyValueError::new_err(format!(
                "path must be (n, 2) with n > 0, got {:?}",
                points.dim()
            )));
        }
        if points.nrows() > MOST_POINTS {
            return Err(PyValueError::new_err(format!(
                "path may have {MOST_POINTS} points at most, got {}",
                points.nrows()
            )));
        }
        check_within("path", points.iter().copied(), FARTHEST_M)?;
        let points_m: Vec<[f64; 2]> = points
            .rows()
            .into_iter()
            .map(|row| [row[0], row[1]])
            .collect();
        let footsteps = read_footsteps(&plan)?;
        Ok(Plan {
            way: Ok(Path {
                footsteps,
                ..describe(points_m, view)
            }),
            replanned,
        })
    }
}

/// Reads where the feet are to be put, of a plan that says so.
fn read_footsteps(plan: &Bound<'_, PyAny>) -> PyResult<Vec<ListedStep>> {
    if !plan.hasattr(intern!(plan.py(), "footsteps"))? {
        return Ok(Vec::new());
    }
    let wanted = "a sequence of ListedStep (side, x m, y m, yaw rad)";
    let listed: Vec<(String, f64, f64, f64)> = listed_footsteps(plan, "plan()", wanted)?;
    let mut steps = Vec::with_capacity(listed.len());
    for (name, x_m, y_m, yaw_rad) in listed {
        check_within("footsteps", [x_m, y_m, yaw_rad], FARTHEST_M)?;
        steps.push(ListedStep {
            side: side(&name).map_err(PyValueError::new_err)?,
            pose: PlanarPose::new(x_m, y_m, yaw_rad),
        });
    }
    Ok(steps)
}

/// Adds to the user's points what the core's planners say of theirs. Clearance is not known: it counts as wide.
fn describe(points_m: Vec<[f64; 2]>, view: &FloorView) -> Path {
    let unknown = points_m
        .iter()
        .map(|[x, y]| view.at(*x, *y) == Surface::Unknown)
        .collect();
    let clearance_m = vec![f64::INFINITY; points_m.len()];
    let length =
        |pair: &[[f64; 2]]| geometry::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]);
    let cost_m = points_m.windows(2).map(length).sum();
    Path {
        points_m,
        unknown,
        clearance_m,
        cost_m,
        ..Path::default()
    }
}

impl Planner for PythonPlanner {
    fn plan(
        &mut self,
        view: &FloorView,
        stairs: &Staircase,
        start: &Pose<Map, Robot>,
        goal: &Goal,
    ) -> Result<Plan, PlanError> {
        Python::attach(|py| self.ask(py, view, stairs, start, goal))
            .map_err(|error| PlanError::Failed(sentence(&error)))
    }

    fn forget(&mut self) {
        self.elsewhere = true;
    }
}
