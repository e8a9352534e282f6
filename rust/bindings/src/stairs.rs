//! Stairs, climbs and footsteps as Python sees them: frozen, map frame, metres and radians.

use behaviour::{Footstep, Misstep, Motion, StepManner, Stepping};
use geometry::{Map, PlanarPose, Point};
use planning::{Climb, Step};
use pyo3::exceptions::PyValueError;
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

fn flat_fit(fit: EdgeFit) -> FlatFit {
    (fit.frames, fit.place_sigma_m, fit.heading_sigma_rad)
}

/// (side, x m, y m, yaw rad, height m, bearing from m, bearing to m, manner, slope): `treadwell.protocols.Footstep`.
pub(crate) type FlatFootstep = (String, f64, f64, f64, f64, f64, f64, String, (f64, f64));

/// The steps that the feet are told to take; empty where they are told something else.
pub(crate) fn flat_footsteps(motion: &Motion) -> Vec<FlatFootstep> {
    match motion {
        Motion::Footsteps(listed) => listed.iter().map(flat_footstep).collect(),
        Motion::Stand | Motion::Walk(_) => Vec::new(),
    }
}

fn flat_footstep(step: &Footstep) -> FlatFootstep {
    let (side, manner) = (
        side_name(step.side).to_owned(),
        step.manner.name().to_owned(),
    );
    let (PlanarPose { x_m, y_m, yaw_rad }, [from_m, to_m]) = (step.pose, step.bearing_m);
    let height_m = step.height_m;
    (
        side,
        x_m,
        y_m,
        yaw_rad,
        height_m,
        from_m,
        to_m,
        manner,
        step.slope.into(),
    )
}

/// A footstep that Python lists.
pub(crate) fn footstep(flat: FlatFootstep) -> Result<Footstep, String> {
    let (side, x_m, y_m, yaw_rad, height_m, from_m, to_m, manner, slope) = flat;
    Ok(Footstep {
        side: self::side(&side)?,
        manner: self::manner(&manner)?,
        pose: PlanarPose { x_m, y_m, yaw_rad },
        height_m,
        slope: slope.into(),
        bearing_m: [from_m, to_m],
    })
}

/// How Python names a side.
pub(crate) const fn side_name(side: Side) -> &'static str {
    match side {
        Side::Left => "left",
        Side::Right => "right",
    }
}

/// A side as Python names it.
pub(crate) fn side(name: &str) -> Result<Side, String> {
    match name {
        "left" => Ok(Side::Left),
        "right" => Ok(Side::Right),
        other => Err(format!("a side must be left or right, got {other}")),
    }
}

/// How a step is taken, as Python names it.
fn manner(name: &str) -> Result<StepManner, String> {
    let known = [StepManner::Walked, StepManner::Careful];
    known
        .into_iter()
        .find(|manner| manner.name() == name)
        .ok_or_else(|| format!("a footstep's manner must be walked or careful, got {name}"))
}

/// The stairs that are seen or remembered.
#[pyclass(frozen, get_all, name = "Staircase", module = "treadwell._core")]
#[derive(Clone)]
pub(crate) struct PyStaircase {
    /// Frames merged since the robot last stepped.
    frames: u32,
    /// The stairs, nearest first; no two overlap.
    stairs: Vec<PyStair>,
}

#[pymethods]
impl PyStaircase {
    /// No stairs.
    #[new]
    const fn new() -> Self {
        Self {
            frames: 0,
            stairs: Vec::new(),
        }
    }

    fn __repr__(&self) -> String {
        let (stairs, frames) = (self.stairs.len(), self.frames);
        format!("<Staircase of {stairs} stairs, from {frames} frames>")
    }
}

impl From<&Staircase> for PyStaircase {
    fn from(staircase: &Staircase) -> Self {
        Self {
            frames: staircase.frames,
            stairs: staircase.stairs.iter().map(PyStair::from).collect(),
        }
    }
}

/// One surface to step on: a step, a sill, a landing, or the lower ground at the foot of a staircase.
#[pyclass(frozen, get_all, name = "Stair", module = "treadwell._core")]
#[derive(Clone)]
pub(crate) struct PyStair {
    /// ((x, y, z), (x, y, z)) m: left and right end of the edge that is crossed onto it.
    front: FlatEdge,
    /// ((x, y, z), (x, y, z)) m: left and right end of the edge that is crossed off it.
    back: FlatEdge,
    /// (x, y, z) m: mean of the points that were seen on it.
    reference: FlatPoint,
    /// Height in the map frame, m.
    height: f64,
    /// From the front to the back edge through the reference point, m.
    depth: f64,
    /// (left, right) m: room beyond the edges' ends.
    margins: (f64, f64),
    /// Points that were seen on it, in all frames.
    support: usize,
    /// Steps taken since it was last seen.
    steps_ago: u32,
    /// From how near it was seen: the least distance of its front edge's middle, m.
    seen_from: f64,
    /// (frames, standard deviation across itself m, of its heading rad) of the fitted front edge, or None.
    front_fit: Option<FlatFit>,
    /// Fit of the back edge, as of the front one; None also where the view ended there.
    back_fit: Option<FlatFit>,
}

impl From<&Stair<Map>> for PyStair {
    fn from(stair: &Stair<Map>) -> Self {
        Self {
            front: flat_edge(&stair.front),
            back: flat_edge(&stair.back),
            reference: flat_point(&stair.reference),
            height: stair.height_m(),
            depth: stair.depth_m(),
            margins: (stair.left_margin_m, stair.right_margin_m),
            support: stair.support,
            steps_ago: stair.steps_ago,
            seen_from: stair.seen_from_m,
            front_fit: stair.front_fit.map(flat_fit),
            back_fit: stair.back_fit.map(flat_fit),
        }
    }
}

/// A leg of a path that is climbed: steps one behind the other.
#[pyclass(frozen, get_all, name = "Climb", module = "treadwell._core")]
#[derive(Clone)]
pub(crate) struct PyClimb {
    /// (first, last): indices of the path's points from which the first step is taken and at which the last one ends.
    span: (usize, usize),
    /// The steps in their order.
    steps: Vec<PyStep>,
}

impl From<&Climb> for PyClimb {
    fn from(climb: &Climb) -> Self {
        Self {
            span: (climb.from_point, climb.to_point),
            steps: climb.steps.iter().map(PyStep::from).collect(),
        }
    }
}

/// One step up or down on the way.
#[pyclass(frozen, get_all, name = "Step", module = "treadwell._core")]
#[derive(Clone)]
pub(crate) struct PyStep {
    /// The stair that is stepped on.
    stair: PyStair,
    /// Change of height onto it, m.
    rise: f64,
    /// (x, y) m: where the way crosses its front edge.
    crossing: (f64, f64),
}

impl From<&Step> for PyStep {
    fn from(step: &Step) -> Self {
        Self {
            stair: PyStair::from(&step.stair),
            rise: step.rise_m,
            crossing: step.crossing_m.into(),
        }
    }
}

/// How the listed footsteps go.
#[pyclass(frozen, get_all, name = "Stepping", module = "treadwell._core")]
#[derive(Clone, Copy)]
pub(crate) struct PyStepping {
    /// Steps of the present or the last list that landed.
    pub(crate) landed: usize,
    /// How much higher than told the last one landed, m.
    pub(crate) height_error: f64,
    /// Whether a walking foot came upon a level that nobody told it of.
    stumbled: bool,
    /// "no_ground" or "obstructed" when a step was taken back and the list given up, else None.
    pub(crate) misstep: Option<&'static str>,
}

#[pymethods]
impl PyStepping {
    /// What a walker of the user's says of its steps.
    #[new]
    #[pyo3(signature = (landed=0, height_error=0.0, *, stumbled=false, misstep=None))]
    fn new(
        landed: usize,
        height_error: f64,
        stumbled: bool,
        misstep: Option<&str>,
    ) -> PyResult<Self> {
        let misstep = match misstep {
            None => None,
            Some("no_ground") => Some(Misstep::NoGround),
            Some("obstructed") => Some(Misstep::Obstructed),
            Some("left_leg_buckled") => Some(Misstep::Buckled(Side::Left)),
            Some("right_leg_buckled") => Some(Misstep::Buckled(Side::Right)),
            Some(other) => {
                return Err(PyValueError::new_err(format!(
                    "misstep must be no_ground, obstructed, left_leg_buckled, right_leg_buckled or None, got {other}"
                )));
            }
        };
        if !height_error.is_finite() {
            return Err(PyValueError::new_err(format!(
                "height_error must be finite, got {height_error:?}"
            )));
        }
        Ok(Stepping {
            landed,
            height_error_m: height_error,
            misstep,
            stumbled,
        }
        .into())
    }
}

impl From<PyStepping> for Stepping {
    fn from(stepping: PyStepping) -> Self {
        Self {
            landed: stepping.landed,
            height_error_m: stepping.height_error,
            stumbled: stepping.stumbled,
            misstep: stepping.misstep.map(|misstep| match misstep {
                "no_ground" => Misstep::NoGround,
                "left_leg_buckled" => Misstep::Buckled(Side::Left),
                "right_leg_buckled" => Misstep::Buckled(Side::Right),
                _ => Misstep::Obstructed,
            }),
        }
    }
}

impl From<Stepping> for PyStepping {
    fn from(stepping: Stepping) -> Self {
        Self {
            landed: stepping.landed,
            height_error: stepping.height_error_m,
            stumbled: stepping.stumbled,
            misstep: stepping.misstep.map(|misstep| match misstep {
                Misstep::NoGround => "no_ground",
                Misstep::Obstructed => "obstructed",
                Misstep::Buckled(Side::Left) => "left_leg_buckled",
                Misstep::Buckled(Side::Right) => "right_leg_buckled",
            }),
        }
    }
}
