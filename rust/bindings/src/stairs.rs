//! Stairs, climbs and footsteps as Python sees them: frozen, map frame, metres and radians.

use behaviour::{Footstep, Misstep, Motion, Stepping};
use geometry::{Map, Point};
use planning::{Climb, Step};
use pyo3::prelude::*;
use robot::Side;
use stairs::{Edge, EdgeFit, Stair, Staircase};

type FlatPoint = (f64, f64, f64);
type FlatEdge = (FlatPoint, FlatPoint);
type FlatFit = (u32, f64, f64);

fn flat_point(point: &Point<Map>) -> FlatPoint {
    (point.inner.x, point.inner.y, point.inner.z)
}

fn flat_edge(edge: &Edge<Map>) -> FlatEdge {
    (flat_point(&edge.left), flat_point(&edge.right))
}

fn flat_fit(fit: &EdgeFit) -> FlatFit {
    (fit.frames, fit.place_sigma_m, fit.heading_sigma_rad)
}

/// (side, x m, y m, yaw rad, height m, bearing from m, bearing to m): `treadwell.protocols.Footstep`.
pub(crate) type FlatFootstep = (String, f64, f64, f64, f64, f64, f64);

/// The steps that the feet are told to take; empty where they are told something else.
pub(crate) fn flat_footsteps(motion: &Motion) -> Vec<FlatFootstep> {
    match motion {
        Motion::Footsteps(listed) => listed.iter().map(flat_footstep).collect(),
        Motion::Stand | Motion::Walk(_) => Vec::new(),
    }
}

fn flat_footstep(step: &Footstep) -> FlatFootstep {
    let side = match step.side {
        Side::Left => "left",
        Side::Right => "right",
    };
    let (pose, [from_m, to_m]) = (step.pose, step.bearing_m);
    let side = side.to_owned();
    (
        side,
        pose.x_m,
        pose.y_m,
        pose.yaw_rad,
        step.height_m,
        from_m,
        to_m,
    )
}

/// The stairs that are seen or remembered.
#[pyclass(frozen, name = "Staircase", module = "treadwell._core")]
pub(crate) struct PyStaircase(pub(crate) Staircase);

#[pymethods]
impl PyStaircase {
    /// Frames merged since the robot last stepped.
    #[getter]
    fn frames(&self) -> u32 {
        self.0.frames
    }

    /// The stairs, nearest first; no two overlap.
    #[getter]
    fn stairs(&self) -> Vec<PyStair> {
        self.0.stairs.iter().copied().map(PyStair).collect()
    }
}

/// One surface to step on: a step, a sill, a landing, or the lower ground at the foot of a staircase.
#[pyclass(frozen, name = "Stair", module = "treadwell._core")]
pub(crate) struct PyStair(pub(crate) Stair<Map>);

#[pymethods]
impl PyStair {
    /// ((x, y, z), (x, y, z)) m: left and right end of the edge that is crossed onto it.
    #[getter]
    fn front(&self) -> FlatEdge {
        flat_edge(&self.0.front)
    }

    /// ((x, y, z), (x, y, z)) m: left and right end of the edge that is crossed off it.
    #[getter]
    fn back(&self) -> FlatEdge {
        flat_edge(&self.0.back)
    }

    /// (x, y, z) m: mean of the points that were seen on it.
    #[getter]
    fn reference(&self) -> FlatPoint {
        flat_point(&self.0.reference)
    }

    /// Height in the map frame, m.
    #[getter]
    fn height(&self) -> f64 {
        self.0.height_m()
    }

    /// From the front to the back edge through the reference point, m.
    #[getter]
    fn depth(&self) -> f64 {
        self.0.depth_m()
    }

    /// (left, right) m: room beyond the edges' ends.
    #[getter]
    fn margins(&self) -> (f64, f64) {
        (self.0.left_margin_m, self.0.right_margin_m)
    }

    /// Points that were seen on it, in all frames.
    #[getter]
    fn support(&self) -> usize {
        self.0.support
    }

    /// Steps taken since it was last seen.
    #[getter]
    fn steps_ago(&self) -> u32 {
        self.0.steps_ago
    }

    /// From how near it was seen: the least distance of its front edge's middle, m.
    #[getter]
    fn seen_from(&self) -> f64 {
        self.0.seen_from_m
    }

    /// (frames, standard deviation across itself m, of its heading rad) of the fitted front edge, or None.
    #[getter]
    fn front_fit(&self) -> Option<FlatFit> {
        self.0.front_fit.as_ref().map(flat_fit)
    }

    /// Fit of the back edge, as of the front one; None also where the view ended there.
    #[getter]
    fn back_fit(&self) -> Option<FlatFit> {
        self.0.back_fit.as_ref().map(flat_fit)
    }
}

/// A leg of a path that is climbed: steps one behind the other.
#[pyclass(frozen, name = "Climb", module = "treadwell._core")]
pub(crate) struct PyClimb(pub(crate) Climb);

#[pymethods]
impl PyClimb {
    /// (first, last): indices of the path's points from which the first step is taken and at which the last one ends.
    #[getter]
    fn span(&self) -> (usize, usize) {
        (self.0.from_point, self.0.to_point)
    }

    /// The steps in their order.
    #[getter]
    fn steps(&self) -> Vec<PyStep> {
        self.0.steps.iter().copied().map(PyStep).collect()
    }
}

/// One step up or down on the way.
#[pyclass(frozen, name = "Step", module = "treadwell._core")]
pub(crate) struct PyStep(Step);

#[pymethods]
impl PyStep {
    /// The stair that is stepped on.
    #[getter]
    fn stair(&self) -> PyStair {
        PyStair(self.0.stair)
    }

    /// Change of height onto it, m.
    #[getter]
    fn rise(&self) -> f64 {
        self.0.rise_m
    }

    /// (x, y) m: where the way crosses its front edge.
    #[getter]
    fn crossing(&self) -> (f64, f64) {
        self.0.crossing_m.into()
    }
}

/// How the listed footsteps go.
#[pyclass(frozen, name = "Stepping", module = "treadwell._core")]
pub(crate) struct PyStepping(pub(crate) Stepping);

#[pymethods]
impl PyStepping {
    /// Steps of the present or the last list that landed.
    #[getter]
    fn landed(&self) -> usize {
        self.0.landed
    }

    /// How much higher than told the last one landed, m.
    #[getter]
    fn height_error(&self) -> f64 {
        self.0.height_error_m
    }

    /// Whether a walking foot came upon a level that nobody told it of.
    #[getter]
    fn stumbled(&self) -> bool {
        self.0.stumbled
    }

    /// "no_ground" or "obstructed" when a step was taken back and the list given up, else None.
    #[getter]
    fn misstep(&self) -> Option<&'static str> {
        self.0.misstep.map(|misstep| match misstep {
            Misstep::NoGround => "no_ground",
            Misstep::Obstructed => "obstructed",
        })
    }
}
