//! Python's `Observation` to the core's, into memory that is used again.

use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyString;
use pyo3::{FromPyObject, intern};
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

fn not_so(name: &Bound<'_, PyString>, must: &str, got: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(format!("{name} must {must}, got {got}"))
}

/// The attribute `name`, as `what` says.
pub(crate) fn field<'py, T>(
    object: &Bound<'py, PyAny>,
    name: &Bound<'py, PyString>,
    what: &str,
) -> PyResult<T>
where
    T: for<'a> FromPyObject<'a, 'py>,
{
    let value = object.getattr(name)?;
    value.extract().map_err(|_| {
        let kind = value.get_type();
        let dtype = value.getattr(intern!(object.py(), "dtype"));
        let axes = value.getattr(intern!(object.py(), "ndim"));
        match (dtype, axes) {
            (Ok(dtype), Ok(axes)) => not_so(name, what, format!("{axes} axes of {dtype}")),
            _ => not_so(
                name,
                what,
                value
                    .repr()
                    .map_or(kind.to_string(), |text| text.to_string()),
            ),
        }
    })
}

const NANOSECONDS: &str = "be whole nanoseconds, 0 or more";
pub(crate) const VECTOR: &str = "be an array with 1 axis of float64";

fn read_vector(
    object: &Bound<'_, PyAny>,
    name: &Bound<'_, PyString>,
    into: &mut [f64],
) -> PyResult<()> {
    let array: PyReadonlyArray1<'_, f64> = field(object, name, VECTOR)?;
    let view = array.as_array();
    if view.len() != into.len() {
        return Err(not_so(
            name,
            &format!("have {} values", into.len()),
            view.len(),
        ));
    }
    for (slot, value) in into.iter_mut().zip(view) {
        *slot = *value;
    }
    Ok(())
}

fn read_joints(
    object: &Bound<'_, PyAny>,
    name: &Bound<'_, PyString>,
    into: &mut Vec<f64>,
) -> PyResult<()> {
    let array: PyReadonlyArray1<'_, f64> = field(object, name, VECTOR)?;
    into.clear();
    into.extend(array.as_array().iter());
    Ok(())
}

fn read_feet(object: &Bound<'_, PyAny>, into: &mut [[f64; 4]; 2]) -> PyResult<()> {
    let name = intern!(object.py(), "foot_forces");
    let feet: PyReadonlyArray2<'_, f64> =
        field(object, name, "be an array with 2 axes of float64")?;
    let feet = feet.as_array();
    if feet.dim() != (2, 4) {
        return Err(not_so(name, "be (2, 4)", format!("{:?}", feet.dim())));
    }
    for (slot, value) in into.as_flattened_mut().iter_mut().zip(feet.iter()) {
        *slot = *value;
    }
    Ok(())
}

fn read_frame(frame: &Bound<'_, PyAny>, into: &mut Frame) -> PyResult<()> {
    let py = frame.py();
    into.exposure_ns = field(frame, intern!(py, "exposure_ns"), NANOSECONDS)?;
    into.arrival_ns = field(frame, intern!(py, "arrival_ns"), NANOSECONDS)?;
    let depth: PyReadonlyArray2<'_, f32> = field(
        frame,
        intern!(py, "depth"),
        "be an array with 2 axes of float32",
    )?;
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
    into.time_ns = field(object, intern!(py, "time_ns"), NANOSECONDS)?;
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
    read_feet(object, &mut into.foot_forces_n)?;
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
