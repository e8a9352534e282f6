//! A world model of the user's.

use std::ops::RangeInclusive;

use geometry::{Grid, Lattice, Map, Pose, Robot};
use mapping::{FloorView, Insertion, MapError, Surface, WorldModel};
use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::intern;
use pyo3::prelude::*;
use segmentation::Planes;

use super::{FARTHEST_M, attribute, check_within, forget_if, sentence, something, unlike};
use crate::products::{PyPlanes, flat};

struct PythonWorldModel {
    object: Py<PyAny>,
    view: FloorView,
    /// Whether the robot found itself elsewhere since the last frame.
    elsewhere: bool,
}

/// Wraps an object with the methods of `treadwell.protocols.WorldModel`.
pub(crate) fn world_model(object: Py<PyAny>) -> Box<dyn WorldModel> {
    let view = FloorView::new(
        Lattice {
            origin_m: [0.0; 2],
            cell_m: 1.0,
        },
        Grid::filled(0, 0, Surface::Unknown),
        0,
    );
    Box::new(PythonWorldModel {
        object,
        view,
        elsewhere: false,
    })
}

impl PythonWorldModel {
    fn ask(
        &mut self,
        py: Python<'_>,
        planes: &Planes,
        map_from_robot: &Pose<Map, Robot>,
    ) -> PyResult<bool> {
        let pose = flat(map_from_robot);
        let object = self.object.bind(py);
        forget_if(&mut self.elsewhere, object)?;
        let used = object.call_method1(intern!(py, "insert"), (PyPlanes(planes.clone()), pose))?;
        read_view(&object.call_method0(intern!(py, "view"))?, &mut self.view)?;
        used.extract()
            .map_err(|_| unlike("insert()", &used, "bool"))
    }
}

/// Cells that a view can have at most: 80 m by 80 m of the usual size.
const MOST_CELLS: usize = 4_000_000;

const CELL_SIDES_M: RangeInclusive<f64> = 0.001..=10.0;

fn read_lattice(object: &Bound<'_, PyAny>) -> PyResult<Lattice> {
    let origin_m: [f64; 2] = attribute(object, ("view()", "origin"), "(x, y), m")?;
    let cell_m: f64 = attribute(object, ("view()", "cell"), "a float, m")?;
    check_within("origin", origin_m, FARTHEST_M)?;
    if !CELL_SIDES_M.contains(&cell_m) {
        return Err(PyValueError::new_err(format!(
            "cell must be from {} to {} m, got {cell_m:?}",
            CELL_SIDES_M.start(),
            CELL_SIDES_M.end()
        )));
    }
    Ok(Lattice { origin_m, cell_m })
}

pub(crate) fn read_view(object: &Bound<'_, PyAny>, into: &mut FloorView) -> PyResult<()> {
    something(object, "view()", "a FloorMap")?;
    let kind: PyReadonlyArray2<'_, u8> =
        attribute(object, ("view()", "kind"), "uint8 (rows, cols)")?;
    let height: PyReadonlyArray2<'_, f32> =
        attribute(object, ("view()", "height"), "float32 (rows, cols)")?;
    let (kind, height) = (kind.as_array(), height.as_array());
    if kind.dim() != height.dim() {
        return Err(PyValueError::new_err(format!(
            "kind and height must have one shape, got {:?} and {:?}",
            kind.dim(),
            height.dim()
        )));
    }
    let (rows, cols) = kind.dim();
    if rows * cols > MOST_CELLS {
        return Err(PyValueError::new_err(format!(
            "a view may have {MOST_CELLS} cells at most, got {rows} x {cols}"
        )));
    }
    into.lattice = read_lattice(object)?;
    if (into.cells.rows(), into.cells.cols()) != (rows, cols) {
        // A model in Python says of each floor how high it is: as far as is known, all of them are level.
        *into = FloorView::new(into.lattice, Grid::filled(cols, rows, Surface::Unknown), 0);
    }
    for ((slot, &kind), &height) in into.cells.values_mut().iter_mut().zip(kind).zip(height) {
        *slot = match kind {
            0 => Surface::Unknown,
            1 | 2 if height.is_nan() || f64::from(height.abs()) > FARTHEST_M => {
                return Err(PyValueError::new_err(format!(
                    "height must be finite where kind is 1 or 2, got {height:?}"
                )));
            }
            1 => Surface::Floor(height),
            2 => Surface::Obstacle(height),
            other => {
                return Err(PyValueError::new_err(format!(
                    "kind must be 0, 1 or 2, got {other}"
                )));
            }
        };
    }
    read_sightings(object, into)
}

/// Reads in how many frames each cell was seen as floor; of a model that does not count, all that
/// it knows is as good as what was seen often.
fn read_sightings(object: &Bound<'_, PyAny>, into: &mut FloorView) -> PyResult<()> {
    let counts = into.sightings.values_mut().iter_mut();
    if !object.hasattr(intern!(object.py(), "sightings"))? {
        for (count, cell) in counts.zip(into.cells.values()) {
            *count = match cell {
                Surface::Unknown => 0,
                Surface::Floor(_) | Surface::Obstacle(_) => u16::MAX,
            };
        }
        return Ok(());
    }
    let found: PyReadonlyArray2<'_, u16> =
        attribute(object, ("view()", "sightings"), "uint16 (rows, cols)")?;
    let (found, shape) = (found.as_array(), (into.cells.rows(), into.cells.cols()));
    if found.dim() != shape {
        return Err(PyValueError::new_err(format!(
            "kind and sightings must have one shape, got {shape:?} and {:?}",
            found.dim()
        )));
    }
    for (count, &found) in counts.zip(found) {
        *count = found;
    }
    Ok(())
}

impl WorldModel for PythonWorldModel {
    fn insert(
        &mut self,
        planes: &Planes,
        map_from_robot: &Pose<Map, Robot>,
    ) -> Result<Insertion, MapError> {
        let used = Python::attach(|py| self.ask(py, planes, map_from_robot))
            .map_err(|error| MapError::Failed(sentence(&error)))?;
        Ok(Insertion {
            changed: self.view.cells.area(),
            height_shift_m: None,
            used,
        })
    }

    fn view(&self) -> &FloorView {
        &self.view
    }

    fn forget(&mut self) {
        self.elsewhere = true;
    }
}
