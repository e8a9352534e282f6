//! Ways over a floor of the user's, by a planner of the list.

use geometry::{Goal, Map, Pose, Robot};
use numpy::PyArray2;
use pilot::Ways;
use pyo3::prelude::*;
use stairs::{Onward, Staircase};

use crate::error::{bad_setting, failed, parse, run};
use crate::floor_view::PyFloorView;
use crate::products::FlatPose;
use crate::range_map::PyRangeMap;
use crate::stairs::PyClimb;

/// Points of a way (n, 2) m or None, `word: sentence` where there is none, what it costs, its legs that are climbed, and where it ends.
type FoundWay<'py> = (
    Option<Bound<'py, PyArray2<f64>>>,
    Option<String>,
    f64,
    Vec<PyClimb>,
    Option<&'static str>,
);

/// Plans ways for one robot. `settings` is JSON: the tables of `[navigation]`.
#[pyclass(name = "Ways", module = "treadwell._core")]
pub(crate) struct PyWays(Ways);

#[pymethods]
impl PyWays {
    #[new]
    #[pyo3(signature = (planner, description_json, settings="{}"))]
    fn new(
        py: Python<'_>,
        planner: &str,
        description_json: &str,
        settings: &str,
    ) -> PyResult<Self> {
        let (robot, tables) = (parse(py, description_json)?, parse(py, settings)?);
        let made = Ways::new(planner, &tables, robot);
        made.map(Self).map_err(|error| bad_setting(py, &error))
    }

    /// The way over a floor from `start` (x m, y m, z m, yaw rad) to a goal's disc (x m, y m, radius m, height m or None), by the stairs that
    /// `seen` knows, if it is given.
    #[pyo3(signature = (view, start, goal, seen=None))]
    fn plan<'py>(
        &mut self,
        py: Python<'py>,
        view: &PyFloorView,
        start: FlatPose,
        goal: (f64, f64, f64, Option<f64>),
        seen: Option<&Bound<'_, PyRangeMap>>,
    ) -> PyResult<FoundWay<'py>> {
        let none = Staircase::default();
        let seen = seen.map(Bound::borrow);
        let stairs = (seen.as_deref())
            .and_then(PyRangeMap::seen_stairs)
            .unwrap_or(&none);
        let start = Pose::<Map, Robot>::from_yaw(start.0, start.1, start.2, start.3);
        let (x_m, y_m, radius_m, height_m) = goal;
        let goal = Goal {
            x_m,
            y_m,
            radius_m,
            height_m,
        };
        let (ways, view) = (&mut self.0, &view.0);
        let plan = run(py, || ways.plan(view, stairs, &start, &goal))?
            .map_err(|error| failed(py, &error))?;
        match plan.way {
            Ok(path) => {
                let rows: Vec<Vec<f64>> = path.points_m.iter().map(|at| at.to_vec()).collect();
                let climbs = path.climbs.iter().map(PyClimb::from).collect();
                let points = PyArray2::from_vec2(py, &rows)?;
                Ok((
                    Some(points),
                    None,
                    path.cost_m,
                    climbs,
                    Some(path.end.name()),
                ))
            }
            Err(no) => {
                let why = format!("{}: {}", no.refusal.word(), no.sentence);
                Ok((None, Some(why), f64::INFINITY, Vec::new(), None))
            }
        }
    }

    /// Why no foot is put on a stair that is `rise` higher than the ground before it and `width` wide, with an edge (depth behind the front
    /// edge, change of height there) behind it or none; all m. None where feet fit.
    #[pyo3(signature = (rise, width, edge=None))]
    fn unfit(&self, rise: f64, width: f64, edge: Option<(f64, f64)>) -> Option<String> {
        let onward = edge.map_or(Onward::Level, |(depth_m, rise_m)| Onward::Edge {
            depth_m,
            rise_m,
        });
        let no = self.0.footing(rise, width, onward).err()?;
        Some(format!("{}: {}", no.refusal.word(), no.sentence))
    }
}
