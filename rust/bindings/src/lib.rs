//! The Python module `treadwell._core`: converts and forwards, decides nothing. One file a class.

mod clearance;
mod components;
mod distance;
mod error;
mod legs;
mod observation;
mod octree;
mod pilot;
mod pose;
mod products;
mod ranges;
mod segmenter;
mod situation;
mod stairs;
mod walker;
mod world_model;

use pyo3::prelude::*;

#[pymodule]
mod _core {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::clearance::swept_clearance;
    #[pymodule_export]
    use super::distance::squared_distances;
    #[pymodule_export]
    use super::legs::PyLegs;
    #[pymodule_export]
    use super::octree::PyOctree;
    #[pymodule_export]
    use super::pilot::{PyPilot, PyTick};
    #[pymodule_export]
    use super::products::{PyBodyState, PyFloorView, PyPlanes};
    #[pymodule_export]
    use super::ranges::PyRangeField;
    #[pymodule_export]
    use super::segmenter::PySegmenter;
    #[pymodule_export]
    use super::situation::{PyGoal, PyScan, PySituation};
    #[pymodule_export]
    use super::stairs::{PyClimb, PyStair, PyStaircase, PyStep, PyStepping};
    #[pymodule_export]
    use super::walker::PyWalker;
    #[pymodule_export]
    use super::world_model::{PyOccupancyGrid, PyWorldModel};

    /// Version of the core; equal to the package's.
    #[pyfunction]
    fn version() -> &'static str {
        env!("CARGO_PKG_VERSION")
    }
}
