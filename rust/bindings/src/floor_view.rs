//! The floor, obstacle and unknown view of the map as Python sees it: copied when it is asked for.

use geometry::{Grid, Lattice};
use mapping::Surface;
use numpy::{IntoPyArray, PyArray2, PyArray3, PyArrayMethods, ToPyArray};
use pyo3::prelude::*;

use crate::components::read_view;
use crate::error::bad_setting;

/// The floor, obstacle and unknown view of the map.
#[pyclass(frozen, name = "FloorView", module = "treadwell._core")]
pub(crate) struct PyFloorView(pub(crate) mapping::FloorView);

/// Corner, side of a cell, kinds, heights and sightings of a view: see the properties of `FloorView`.
pub(crate) type Floor<'py> = (
    (f64, f64),
    f64,
    Bound<'py, PyArray2<u8>>,
    Bound<'py, PyArray2<f32>>,
    Bound<'py, PyArray2<u16>>,
);

/// What `FloorView` has but for gradients, at once and without a copy of the view.
pub(crate) fn floor<'py>(py: Python<'py>, view: &mapping::FloorView) -> PyResult<Floor<'py>> {
    let origin = view.lattice.origin_m.into();
    let arrays = (kinds(py, view)?, heights(py, view)?, sightings(py, view)?);
    Ok((origin, view.lattice.cell_m, arrays.0, arrays.1, arrays.2))
}

fn shape(view: &mapping::FloorView) -> [usize; 2] {
    [view.cells.rows(), view.cells.cols()]
}

fn kinds<'py>(py: Python<'py>, view: &mapping::FloorView) -> PyResult<Bound<'py, PyArray2<u8>>> {
    let kind = |surface: &Surface| match surface {
        Surface::Unknown => 0,
        Surface::Floor(_) => 1,
        Surface::Obstacle(_) => 2,
    };
    let flat: Vec<u8> = view.shown().cells.values().iter().map(kind).collect();
    flat.into_pyarray(py).reshape(shape(view))
}

fn heights<'py>(py: Python<'py>, view: &mapping::FloorView) -> PyResult<Bound<'py, PyArray2<f32>>> {
    let height = |surface: &Surface| match *surface {
        Surface::Unknown => f32::NAN,
        Surface::Floor(height) | Surface::Obstacle(height) => height,
    };
    let flat: Vec<f32> = view.shown().cells.values().iter().map(height).collect();
    flat.into_pyarray(py).reshape(shape(view))
}

fn sightings<'py>(
    py: Python<'py>,
    view: &mapping::FloorView,
) -> PyResult<Bound<'py, PyArray2<u16>>> {
    view.sightings.values().to_pyarray(py).reshape(shape(view))
}

#[pymethods]
impl PyFloorView {
    fn __repr__(&self) -> String {
        let [rows, cols] = shape(&self.0);
        let cells = self.0.cells.values();
        let floor = (cells.iter()).filter(|cell| matches!(cell, Surface::Floor(_)));
        let blocked = (cells.iter()).filter(|cell| matches!(cell, Surface::Obstacle(_)));
        format!(
            "<FloorView of {rows} x {cols} cells of {} m: {} floor, {} obstacle>",
            self.0.lattice.cell_m,
            floor.count(),
            blocked.count()
        )
    }

    /// (2,) m: lower-left corner of cell (0, 0) in the map frame.
    #[getter]
    fn origin(&self) -> (f64, f64) {
        self.0.lattice.origin_m.into()
    }

    /// Side of a cell, m.
    #[getter]
    fn cell(&self) -> f64 {
        self.0.lattice.cell_m
    }

    /// (rows, cols) uint8: 0 unknown, 1 floor, 2 obstacle; rows along +y.
    #[getter]
    fn kind<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u8>>> {
        kinds(py, &self.0)
    }

    /// (rows, cols) float32: height in the map frame, m; NaN where unknown.
    #[getter]
    fn height<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        heights(py, &self.0)
    }

    /// (rows, cols, 2) float32: how much each cell's floor rises per metre along x and y of the map; 0 where it is level.
    #[getter]
    fn gradient<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f32>>> {
        let [rows, cols] = shape(&self.0);
        let flat: Vec<f32> = self
            .0
            .gradients
            .values()
            .iter()
            .flatten()
            .copied()
            .collect();
        flat.into_pyarray(py).reshape([rows, cols, 2])
    }

    /// (rows, cols) uint16: in how many frames each cell was seen as floor.
    #[getter]
    fn sightings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u16>>> {
        sightings(py, &self.0)
    }

    /// A view of an object that has `origin`, `cell`, `kind` and `height` as this one, and may have `sightings`; a copy.
    #[staticmethod]
    fn of(py: Python<'_>, view: &Bound<'_, PyAny>) -> PyResult<Self> {
        let lattice = Lattice {
            origin_m: [0.0; 2],
            cell_m: 1.0,
        };
        let mut made = mapping::FloorView::new(lattice, Grid::filled(0, 0, Surface::Unknown), 0);
        read_view(view, &mut made).map_err(|error| bad_setting(py, &error.value(py)))?;
        Ok(Self(made))
    }

    /// Shows the same view in a frame whose axes are parallel: this one's origin lies at (x, y, z) m of it. A copy.
    fn moved(&self, by: [f64; 3]) -> Self {
        let mut view = self.0.shown().into_owned();
        view.felt.clear();
        view.lattice.origin_m = [0, 1].map(|axis| view.lattice.origin_m[axis] + by[axis]);
        for surface in view.cells.values_mut() {
            if let Surface::Floor(height) | Surface::Obstacle(height) = surface {
                *height = (f64::from(*height) + by[2]) as f32;
            }
        }
        Self(view)
    }

    /// (rows, cols) float32, m: from each cell's middle to that of the nearest cell that blocks; infinite where none does. An obstacle
    /// blocks, and floor beside which another lies lower by more than a cell's side.
    fn clearance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        self.0
            .clearance_m()
            .into_pyarray(py)
            .reshape(shape(&self.0))
    }

    /// (rows, cols) bool: where a robot of a radius, m, may have its middle that stands at height `z`, m, and steps up and down by no more
    /// than `rise`, m. An obstacle blocks, and floor of another level, however flat; cells that nobody saw are passable, or not.
    #[pyo3(signature = (z, rise, radius, *, unknown=true))]
    fn passable<'py>(
        &self,
        py: Python<'py>,
        z: f64,
        rise: f64,
        radius: f64,
        unknown: bool,
    ) -> PyResult<Bound<'py, PyArray2<bool>>> {
        for (name, value) in [("rise", rise), ("radius", radius)] {
            if !(value.is_finite() && value >= 0.0) {
                let said = format!("{name} must be finite and >= 0, got {value:?}");
                return Err(bad_setting(py, &said));
            }
        }
        if !z.is_finite() {
            return Err(bad_setting(py, &format!("z must be finite, got {z:?}")));
        }
        let passable = self.0.passable(z, rise, radius, unknown);
        passable.into_pyarray(py).reshape(shape(&self.0))
    }
}
