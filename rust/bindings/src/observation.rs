//! Python's `Observation` to the core's, into memory that is used again.

use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::intern;
use pyo3::prelude::*;
use sensing::{Frame, Observation};

/// An observation with room for nothing yet.
pub(crate) fn empty() -> Observation {
    Observation {
        time_ns: 0,
        joint_positions_rad: Vec::new(),
        joint_velocities_radps: Vec::new(),
        angular_velocity_radps: [0.0; 3],
        specific_force_mps2: [0.0; 3],
        foot_forces_n: [[0.0; 4]; 2],
        depth: None,
    }
}

fn read_vector(
    object: &Bound<'_, PyAny>,
    name: &Bound<'_, pyo3::types::PyString>,
    into: &mut [f64],
) -> PyResult<()> {
    let array: PyReadonlyArray1<'_, f64> = object.getattr(name)?.extract()?;
    let view = array.as_array();
    if view.len() != into.len() {
        return Err(PyValueError::new_err(format!(
            "{name} must have {} values, got {}",
            into.len(),
            view.len()
        )));
    }
    for (slot, value) in into.iter_mut().zip(view) {
        *slot = *value;
    }
    Ok(())
}

fn read_joints(
    object: &Bound<'_, PyAny>,
    name: &Bound<'_, pyo3::types::PyString>,
    into: &mut Vec<f64>,
) -> PyResult<()> {
    let array: PyReadonlyArray1<'_, f64> = object.getattr(name)?.extract()?;
    into.clear();
    into.extend(array.as_array().iter());
    Ok(())
}

fn read_frame(frame: &Bound<'_, PyAny>, into: &mut Frame) -> PyResult<()> {
    let py = frame.py();
    into.exposure_ns = frame.getattr(intern!(py, "exposure_ns"))?.extract()?;
    into.arrival_ns = frame.getattr(intern!(py, "arrival_ns"))?.extract()?;
    let depth: PyReadonlyArray2<'_, f32> = frame.getattr(intern!(py, "depth"))?.extract()?;
    let view = depth.as_array();
    (into.height, into.width) = view.dim();
    into.depth_m.clear();
    into.depth_m.extend(view.iter());
    Ok(())
}

/// Reads a `treadwell.observation.Observation`. `spare` keeps the memory of the depth image between frames.
pub(crate) fn read(
    object: &Bound<'_, PyAny>,
    into: &mut Observation,
    spare: &mut Option<Frame>,
) -> PyResult<()> {
    let py = object.py();
    into.time_ns = object.getattr(intern!(py, "time_ns"))?.extract()?;
    read_joints(
        object,
        intern!(py, "joint_positions"),
        &mut into.joint_positions_rad,
    )?;
    read_joints(
        object,
        intern!(py, "joint_velocities"),
        &mut into.joint_velocities_radps,
    )?;
    read_vector(
        object,
        intern!(py, "angular_velocity"),
        &mut into.angular_velocity_radps,
    )?;
    read_vector(
        object,
        intern!(py, "specific_force"),
        &mut into.specific_force_mps2,
    )?;
    let feet: PyReadonlyArray2<'_, f64> = object.getattr(intern!(py, "foot_forces"))?.extract()?;
    let feet = feet.as_array();
    if feet.dim() != (2, 4) {
        return Err(PyValueError::new_err(format!(
            "foot_forces must be (2, 4), got {:?}",
            feet.dim()
        )));
    }
    for (slot, value) in into
        .foot_forces_n
        .as_flattened_mut()
        .iter_mut()
        .zip(feet.iter())
    {
        *slot = *value;
    }
    if let Some(frame) = into.depth.take() {
        *spare = Some(frame);
    }
    let depth = object.getattr(intern!(py, "depth"))?;
    if !depth.is_none() {
        let mut frame = spare.take().unwrap_or_else(|| Frame {
            exposure_ns: 0,
            arrival_ns: 0,
            width: 0,
            height: 0,
            depth_m: Vec::new(),
        });
        read_frame(&depth, &mut frame)?;
        into.depth = Some(frame);
    }
    Ok(())
}
