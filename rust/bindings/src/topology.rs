//! Places of a map and the ways between them: the generalized Voronoi diagram as a graph.

use geometry::{Grid, Lattice};
use numpy::{
    IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyUntypedArrayMethods, ToPyArray, ndarray,
};
use plan_view::{VoronoiGraph, VoronoiGraphConfig};
use pyo3::prelude::*;

use crate::error::{bad_setting, parse, run};

/// The generalized Voronoi diagram of the cells that are free, (rows, cols) bool, as a graph; `origin`, m, is the lower-left corner of the
/// first cell. `settings` is JSON: `[plan_view.topology]`.
#[pyclass(name = "VoronoiGraph", module = "treadwell._core")]
pub(crate) struct PyVoronoiGraph(VoronoiGraph);

/// Rows of two numbers each.
fn pairs<'py, T: numpy::Element + Copy>(
    py: Python<'py>,
    rows: &[[T; 2]],
) -> Bound<'py, PyArray2<T>> {
    ndarray::Array2::from_shape_fn((rows.len(), 2), |(row, at)| rows[row][at]).to_pyarray(py)
}

#[pymethods]
impl PyVoronoiGraph {
    #[new]
    #[pyo3(signature = (free, cell, origin, settings="{}"))]
    fn new(
        py: Python<'_>,
        free: &Bound<'_, PyArray2<bool>>,
        cell: f64,
        origin: [f64; 2],
        settings: &str,
    ) -> PyResult<Self> {
        let config: VoronoiGraphConfig = parse(py, settings)?;
        let free = free.readonly();
        let mut grid = Grid::filled(free.shape()[1], free.shape()[0], false);
        for (cell, &is_free) in grid.values_mut().iter_mut().zip(free.as_array()) {
            *cell = is_free;
        }
        let lattice = Lattice {
            origin_m: origin,
            cell_m: cell,
        };
        let graph = run(py, || VoronoiGraph::new(config, lattice, &grid))?;
        graph.map(Self).map_err(|error| bad_setting(py, &error))
    }

    /// Where each place is, (n, 2) m; from there to the nearest cell that is not free, (n,) m; and how many ways begin there, (n,).
    #[expect(
        clippy::type_complexity,
        reason = "a tuple of arrays, as Python gets it"
    )]
    fn places<'py>(
        &self,
        py: Python<'py>,
    ) -> (
        Bound<'py, PyArray2<f64>>,
        Bound<'py, PyArray1<f64>>,
        Bound<'py, PyArray1<u32>>,
    ) {
        let places = self.0.places();
        let positions: Vec<_> = places.iter().map(|place| place.position_m).collect();
        let clearances: Vec<_> = places.iter().map(|place| place.clearance_m).collect();
        let degrees: Vec<_> = places.iter().map(|place| place.degree as u32).collect();
        (
            pairs(py, &positions),
            clearances.into_pyarray(py),
            degrees.into_pyarray(py),
        )
    }

    /// Each way: the numbers of the two places that it joins, its least clearance, m, and its points from the first to the second, (k, 2) m.
    fn ways<'py>(&self, py: Python<'py>) -> Vec<([usize; 2], f64, Bound<'py, PyArray2<f64>>)> {
        let each = self.0.ways().iter();
        each.map(|way| (way.places, way.clearance_m, pairs(py, &way.path_m)))
            .collect()
    }

    /// The shortest way along the diagram between two points, (k, 2) m, nowhere nearer to a cell that is not free than `clearance`, m; None
    /// where no way keeps that.
    fn plan<'py>(
        &self,
        py: Python<'py>,
        start: [f64; 2],
        goal: [f64; 2],
        clearance: f64,
    ) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let plan = run(py, || self.0.plan(start, goal, clearance))?;
        Ok(plan.map(|plan| pairs(py, &plan.path_m)))
    }

    /// The number of the room that each cell lies in, (rows, cols), from 1 on, 0 for none; and of each doorway where its middle is,
    /// (m, 2) m, its width, (m,) m, and the numbers of the rooms that it joins, (m, 2).
    #[expect(
        clippy::type_complexity,
        reason = "a tuple of arrays, as Python gets it"
    )]
    fn rooms<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(
        Bound<'py, PyArray2<u32>>,
        Bound<'py, PyArray2<f64>>,
        Bound<'py, PyArray1<f64>>,
        Bound<'py, PyArray2<u32>>,
    )> {
        let rooms = run(py, || self.0.rooms())?;
        let shape = (rooms.room_of.rows(), rooms.room_of.cols());
        let cells = rooms.room_of.values();
        let room_of =
            ndarray::Array2::from_shape_fn(shape, |(row, col)| cells[row * shape.1 + col]);
        let middles: Vec<_> = rooms.doorways.iter().map(|door| door.position_m).collect();
        let widths: Vec<_> = rooms.doorways.iter().map(|door| door.width_m).collect();
        let joined: Vec<_> = rooms.doorways.iter().map(|door| door.rooms).collect();
        Ok((
            room_of.to_pyarray(py),
            pairs(py, &middles),
            widths.into_pyarray(py),
            pairs(py, &joined),
        ))
    }

    /// Whether another graph has as many places, joined alike.
    fn is_like(&self, other: &Self) -> bool {
        self.0.is_like(&other.0)
    }
}
