//! The senses of the robot's own body, read from MuJoCo's arrays where they are.

use numpy::{PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, ToPyArray};
use pyo3::prelude::*;
use simulated_body::{BodySenses, TrueState};

use crate::error::bad_setting;
use crate::servos::{PyServos, numbers, unfit};

/// Names of the arrays that are read, in the order of [`Views`].
const ARRAYS: [&str; 9] = [
    "qpos",
    "qvel",
    "xpos",
    "xmat",
    "cvel",
    "subtree_com",
    "site_xpos",
    "site_xmat",
    "sensordata",
];

/// A data object of MuJoCo's and numpy's views of its arrays; nothing is copied.
struct Views {
    data: Py<PyAny>,
    arrays: [Py<PyArrayDyn<f64>>; ARRAYS.len()],
}

impl Views {
    fn of(data: &Bound<'_, PyAny>) -> PyResult<Self> {
        let mut arrays = Vec::with_capacity(ARRAYS.len());
        for name in ARRAYS {
            arrays.push(data.getattr(name)?.cast_into::<PyArrayDyn<f64>>()?.unbind());
        }
        let arrays: Result<[_; ARRAYS.len()], _> = arrays.try_into();
        Ok(Self {
            data: data.clone().unbind(),
            arrays: arrays
                .map_err(|_| pyo3::exceptions::PyValueError::new_err("an array a name"))?,
        })
    }
}

/// Angles, velocities, angular velocity, specific force, foot forces.
type Readings<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
);

/// Encoders, inertial unit and soles.
#[pyclass(name = "BodySenses", module = "treadwell._core")]
pub(crate) struct PyBodySenses {
    senses: BodySenses,
    views: Option<Views>,
    /// (n,) rad, what each encoder reads too much. The servos are given the same array.
    #[pyo3(get)]
    encoder_offsets: Py<PyArray1<f64>>,
}

#[pymethods]
impl PyBodySenses {
    /// `settings` is JSON: where the senses are in the model's arrays, and their errors.
    #[new]
    fn new(py: Python<'_>, settings: &str, encoder_offsets: Py<PyArray1<f64>>) -> PyResult<Self> {
        let config = serde_json::from_str(settings).map_err(|error| bad_setting(py, &error))?;
        Ok(Self {
            senses: BodySenses::new(config).map_err(|error| unfit(&error))?,
            views: None,
            encoder_offsets,
        })
    }

    /// Reads all senses: angles (n,) rad and velocities (n,) rad/s of the joints, angular velocity (3,) rad/s, specific force (3,)
    /// m/s² and foot forces (2, 4) N. `data` is MuJoCo's, up to date; encoders read the angles of the motors, or without `motors`
    /// those of the joints.
    fn read<'py>(
        &mut self,
        py: Python<'py>,
        data: &Bound<'py, PyAny>,
        time_ns: u64,
        motors: Option<&Bound<'py, PyServos>>,
    ) -> PyResult<Readings<'py>> {
        let known = self.views.as_ref().is_some_and(|views| views.data.is(data));
        if !known {
            self.views = Some(Views::of(data)?);
        }
        let Some(views) = &self.views else {
            return Err(pyo3::exceptions::PyRuntimeError::new_err(
                "there is no data",
            ));
        };
        let borrowed = views
            .arrays
            .each_ref()
            .map(|array| array.bind(py).readonly());
        let state = state(&borrowed)?;
        if !known {
            self.senses.fits(&state).map_err(|error| unfit(&error))?;
        }
        let offsets = numbers(self.encoder_offsets.bind(py));
        let motors = motors.map(|servos| servos.borrow());
        let lead = motors.as_ref().map(|servos| servos.lead_rad());
        let reading = self
            .senses
            .read(&state, time_ns, lead, &offsets)
            .map_err(|error| unfit(&error))?;
        Ok((
            reading.joint_positions_rad.to_pyarray(py),
            reading.joint_velocities_radps.to_pyarray(py),
            reading.angular_velocity_radps.to_pyarray(py),
            reading.specific_force_mps2.to_pyarray(py),
            PyArray2::from_array(py, &numpy::ndarray::arr2(&reading.foot_forces_n)),
        ))
    }
}

fn state<'a>(arrays: &'a [PyReadonlyArrayDyn<'_, f64>; ARRAYS.len()]) -> PyResult<TrueState<'a>> {
    let [
        qpos,
        qvel,
        xpos,
        xmat,
        cvel,
        subtree_com,
        site_xpos,
        site_xmat,
        sensordata,
    ] = arrays;
    Ok(TrueState {
        qpos: qpos.as_slice()?,
        qvel: qvel.as_slice()?,
        xpos: xpos.as_slice()?,
        xmat: xmat.as_slice()?,
        cvel: cvel.as_slice()?,
        subtree_com: subtree_com.as_slice()?,
        site_xpos: site_xpos.as_slice()?,
        site_xmat: site_xmat.as_slice()?,
        sensordata: sensordata.as_slice()?,
    })
}
