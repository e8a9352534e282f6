//! What the judge sees of the truth at every tick. Nothing of it enters the core.

use numpy::{PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyList;
use simulated_body::{Contact, GeomKind, Surfaces, TrueSole, TrueStance, TrueState};

use crate::servos::unfit;

/// Place (x m, y m, z m) of a sole, and its x axis seen from above.
type FlatSole = (f64, f64, f64, (f64, f64));
/// Left and right sole, and the torso's lean in rad.
type Stance = (FlatSole, FlatSole, f64);
/// Whether the soles stand, a geom that lies on a floor, and of each hit the contact, the robot's geom and the element's.
type Sorted = (bool, bool, Option<usize>, Vec<(usize, usize, usize)>);

/// Where the robot's soles truly are, and how far its torso leans.
#[pyclass(name = "TrueStance", module = "treadwell._core")]
pub(crate) struct PyTrueStance {
    stance: TrueStance,
    views: Option<Views>,
}

/// A data object of MuJoCo's, and its `xpos` and `xmat`.
type Views = (Py<PyAny>, Py<PyArray2<f64>>, Py<PyArray2<f64>>);

#[pymethods]
impl PyTrueStance {
    /// `soles`: of left and right the number of the link, and the sole's centre in the link's frame, m; `up`: the torso's own
    /// direction that points up where the robot stands.
    #[new]
    fn new(soles: [(usize, [f64; 3]); 2], torso: usize, up: [f64; 3]) -> Self {
        Self {
            stance: TrueStance { soles, torso, up },
            views: None,
        }
    }

    /// The left and the right sole, each (x m, y m, z m, (x, y) of its x axis), and the torso's lean, rad.
    fn look(&mut self, py: Python<'_>, data: &Bound<'_, PyAny>) -> PyResult<Stance> {
        let known = self.views.as_ref().is_some_and(|views| views.0.is(data));
        if !known {
            let view = |name: &str| -> PyResult<Py<PyArray2<f64>>> {
                Ok(data.getattr(name)?.cast_into::<PyArray2<f64>>()?.unbind())
            };
            self.views = Some((data.clone().unbind(), view("xpos")?, view("xmat")?));
        }
        let Some((_, xpos, xmat)) = &self.views else {
            return Err(PyValueError::new_err("there is no data"));
        };
        let (xpos, xmat) = (xpos.bind(py).readonly(), xmat.bind(py).readonly());
        let state = TrueState {
            xpos: xpos.as_slice()?,
            xmat: xmat.as_slice()?,
            ..TrueState::NOTHING
        };
        if !known {
            self.stance.fits(&state).map_err(|error| unfit(&error))?;
        }
        let [left, right] = self.stance.soles(&state).map(|sole| flat(&sole));
        Ok((left, right, self.stance.tilt_rad(&state)))
    }
}

const fn flat(sole: &TrueSole) -> FlatSole {
    let ([x, y, z], [forward_x, forward_y]) = (sole.place_m, sole.forward);
    (x, y, z, (forward_x, forward_y))
}

/// What the geoms of a course are, to sort contacts by.
#[pyclass(frozen, name = "Surfaces", module = "treadwell._core")]
pub(crate) struct PySurfaces(Surfaces);

#[pymethods]
impl PySurfaces {
    /// `geoms`: of each geom "left" or "right" of a sole's link, "robot", "ground", "walkable" or "obstacle". A sole stands on a
    /// walkable top whose normal has a z above `sole_on_top`, any other part lies on one above `lies_on_top`.
    #[new]
    fn new(geoms: &Bound<'_, PyList>, sole_on_top: f64, lies_on_top: f64) -> PyResult<Self> {
        let surface = |word: Bound<'_, PyAny>| match word.extract::<String>()?.as_str() {
            "left" => Ok(GeomKind::Foot(0)),
            "right" => Ok(GeomKind::Foot(1)),
            "robot" => Ok(GeomKind::Part),
            "ground" => Ok(GeomKind::Ground),
            "walkable" => Ok(GeomKind::Element { walkable: true }),
            "obstacle" => Ok(GeomKind::Element { walkable: false }),
            other => Err(PyValueError::new_err(format!("a geom is no {other}"))),
        };
        Ok(Self(Surfaces {
            geoms: geoms.iter().map(surface).collect::<PyResult<_>>()?,
            sole_on_top,
            lies_on_top,
        }))
    }

    /// Sorts contacts: `geoms` (n, 2) and `frames` (n, 9), whose third number is the z of the normal. Whether the left and the right
    /// sole stand, a geom that lies on a floor or None, and of each touch of an element the contact, the robot's geom, the element's.
    fn sort(
        &self,
        geoms: &Bound<'_, PyArray2<i32>>,
        frames: &Bound<'_, PyArray2<f64>>,
    ) -> PyResult<Sorted> {
        let (geoms, frames) = (geoms.readonly(), frames.readonly());
        let (geoms, frames) = (geoms.as_array(), frames.as_array());
        if geoms.ncols() != 2 || frames.ncols() < 3 {
            return Err(PyValueError::new_err(
                "contacts: geoms (n, 2) and frames (n, 9)",
            ));
        }
        let contact = |(pair, frame): (
            numpy::ndarray::ArrayView1<'_, i32>,
            numpy::ndarray::ArrayView1<'_, f64>,
        )| Contact {
            // A geom that is none, as of a flexible body, has the number -1.
            geoms: [pair[0], pair[1]].map(|geom| usize::try_from(geom).unwrap_or(usize::MAX)),
            up: frame[2],
        };
        let rows = geoms.rows().into_iter().zip(frames.rows());
        let touches = self.0.sort(rows.map(contact));
        let [left, right] = touches.standing;
        let hits = touches
            .hits
            .iter()
            .map(|&[index, ours, theirs]| (index, ours, theirs));
        Ok((left, right, touches.lying, hits.collect()))
    }
}
