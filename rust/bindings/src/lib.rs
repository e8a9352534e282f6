//! The Python module `treadwell._core`: converts and forwards, decides nothing. One file a class.

mod body_senses;
mod classes;
mod clearance;
mod components;
mod costs;
mod depth_camera;
mod depth_errors;
mod distance;
mod error;
mod floor_view;
mod footsteps;
mod landmarks;
mod learners;
mod legs;
mod lists;
mod mesh_files;
mod mesh_textures;
mod monte_carlo;
mod moving;
mod observation;
mod octree;
mod pilot;
mod plan_view;
mod pose;
mod products;
mod range_map;
mod ranges;
mod scan_matching;
mod scene;
mod segmenter;
mod servos;
mod situation;
mod slip;
mod stairs;
mod topology;
mod truth;
mod walker;
mod walker_senses;
mod ways;
mod world_model;

use pyo3::prelude::*;

/// Puts everything into a module. A core of the user's own calls it for its `_core`, after it added its components.
pub fn fill(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(classes::ground_points, module)?)?;
    module.add_function(wrap_pyfunction!(classes::point_classes, module)?)?;
    module.add_function(wrap_pyfunction!(clearance::swept_clearance, module)?)?;
    module.add_function(wrap_pyfunction!(distance::distances, module)?)?;
    module.add_function(wrap_pyfunction!(distance::squared_distances, module)?)?;
    module.add_function(wrap_pyfunction!(plan_view::find_lines, module)?)?;
    module.add_function(wrap_pyfunction!(plan_view::split_and_merge, module)?)?;
    module.add_function(wrap_pyfunction!(landmarks::standing_things, module)?)?;
    module.add_function(wrap_pyfunction!(slip::gait_statistics, module)?)?;
    module.add_function(wrap_pyfunction!(mesh_files::mesh_file, module)?)?;
    module.add_function(wrap_pyfunction!(mesh_textures::textured_mesh, module)?)?;
    module.add_function(wrap_pyfunction!(version, module)?)?;
    module.add_function(wrap_pyfunction!(lists::components, module)?)?;
    module.add_function(wrap_pyfunction!(lists::tables, module)?)?;
    module.add_function(wrap_pyfunction!(lists::parameters, module)?)?;
    module.add_class::<body_senses::PyBodySenses>()?;
    module.add_class::<depth_camera::PyDepthCamera>()?;
    module.add_class::<depth_errors::PyDepthErrors>()?;
    module.add_class::<costs::PyGroundCosts>()?;
    module.add_class::<footsteps::PyFootstepLayer>()?;
    module.add_class::<landmarks::PyEmbedding>()?;
    module.add_class::<landmarks::PyFastSlam>()?;
    module.add_class::<learners::PyLocalRegression>()?;
    module.add_class::<learners::PyPathWeights>()?;
    module.add_class::<legs::PyLegs>()?;
    module.add_class::<octree::PyOctree>()?;
    module.add_class::<pilot::PyPilot>()?;
    module.add_class::<pilot::PyTick>()?;
    module.add_class::<monte_carlo::PyMonteCarlo>()?;
    module.add_class::<moving::PyMovingFilter>()?;
    module.add_class::<plan_view::PyOccupancyMap>()?;
    module.add_class::<scan_matching::PyScanSlam>()?;
    module.add_class::<topology::PyVoronoiGraph>()?;
    module.add_class::<products::PyBodyState>()?;
    module.add_class::<floor_view::PyFloorView>()?;
    module.add_class::<products::PyPlanes>()?;
    module.add_class::<range_map::PyRangeMap>()?;
    module.add_class::<ranges::PyRangeField>()?;
    module.add_class::<scene::PySceneLabels>()?;
    module.add_class::<segmenter::PySegmenter>()?;
    module.add_class::<servos::PyPhysics>()?;
    module.add_class::<servos::PyServos>()?;
    module.add_class::<situation::PyGoal>()?;
    module.add_class::<situation::PyScan>()?;
    module.add_class::<situation::PySituation>()?;
    module.add_class::<slip::PySlipSense>()?;
    module.add_class::<stairs::PyClimb>()?;
    module.add_class::<stairs::PyStair>()?;
    module.add_class::<stairs::PyStaircase>()?;
    module.add_class::<stairs::PyStep>()?;
    module.add_class::<stairs::PyStepping>()?;
    module.add_class::<truth::PySurfaces>()?;
    module.add_class::<truth::PyTrueStance>()?;
    module.add_class::<walker::PyWalker>()?;
    module.add_class::<walker_senses::PyCommand>()?;
    module.add_class::<walker_senses::PyProprioception>()?;
    module.add_class::<ways::PyWays>()?;
    module.add_class::<world_model::PyOccupancyGrid>()?;
    module.add_class::<world_model::PyWorldModel>()
}

/// Version of the core; equal to the package's.
#[pyfunction]
const fn version() -> &'static str {
    env!("CARGO_PKG_VERSION")
}

/// The module itself.
#[cfg(feature = "module")]
#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    fill(module)
}
