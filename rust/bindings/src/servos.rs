//! The simulator's servos, and the physics that they drive.

use mujoco_step::{Physics, Wiring};
use numpy::{PyArray1, PyArrayMethods, PyReadwriteArray2, ToPyArray};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use simulated_body::{Motor, ServoTuning, Servos, SimulatedBodyError};

/// What the simulator was given does not fit the robot.
pub(crate) fn unfit(error: &SimulatedBodyError) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// An array's numbers, copied.
pub(crate) fn numbers(array: &Bound<'_, PyArray1<f64>>) -> Vec<f64> {
    array.readonly().as_array().to_vec()
}

/// A proportional-derivative servo with feed-forward on each joint, and the play in its gear.
#[pyclass(name = "Servos", module = "treadwell._core")]
pub(crate) struct PyServos {
    servos: Servos,
    /// (n,) rad, what each encoder reads too much: the servo goes by its encoder.
    #[pyo3(get, set)]
    encoder_offsets: Py<PyArray1<f64>>,
}

impl PyServos {
    /// How far each motor leads its joint, rad.
    pub(crate) fn lead_rad(&self) -> &[f64] {
        self.servos.lead_rad()
    }
}

#[pymethods]
impl PyServos {
    /// `limits` is a `treadwell.robot.motor_limits.MotorLimits`, `play` in rad, `timestep` of the physics in s.
    #[new]
    #[pyo3(signature = (limits, *, play, timestep))]
    fn new(limits: &Bound<'_, PyAny>, play: f64, timestep: f64) -> PyResult<Self> {
        let py = limits.py();
        let of = |name: &str| -> PyResult<Vec<f64>> {
            Ok(numbers(limits.getattr(name)?.cast::<PyArray1<f64>>()?))
        };
        let (kp, kv, peak) = (of("kp")?, of("kv")?, of("peak_torque")?);
        let (stall, no_load) = (of("stall_torque")?, of("no_load_speed")?);
        let (friction, inertia) = (of("friction")?, of("inertia")?);
        if [&kv, &peak, &stall, &no_load, &friction, &inertia]
            .iter()
            .any(|other| other.len() != kp.len())
        {
            return Err(PyValueError::new_err(
                "limits: one value a joint in each array",
            ));
        }
        let motor = |joint: usize| Motor {
            kp: kp[joint],
            kv: kv[joint],
            peak_torque_nm: peak[joint],
            stall_torque_nm: stall[joint],
            no_load_speed_radps: no_load[joint],
            friction_nm: friction[joint],
            inertia_kgm2: inertia[joint],
        };
        let motors: Vec<Motor> = (0..kp.len()).map(motor).collect();
        let servos = Servos::new(&motors, play, timestep, &ServoTuning::default());
        Ok(Self {
            servos: servos.map_err(|error| unfit(&error))?,
            encoder_offsets: vec![0.0; kp.len()].to_pyarray(py).unbind(),
        })
    }

    /// Takes what is asked for from now on, (n,) rad, rad/s and N m; False, and nothing changes, where one is not n finite numbers.
    fn command(
        &mut self,
        py: Python<'_>,
        position: &Bound<'_, PyArray1<f64>>,
        velocity: &Bound<'_, PyArray1<f64>>,
        torque: &Bound<'_, PyArray1<f64>>,
    ) -> PyResult<bool> {
        let (position, velocity, torque) = (numbers(position), numbers(velocity), numbers(torque));
        let joints = self.servos.joints();
        let good =
            |values: &[f64]| values.len() == joints && values.iter().all(|value| value.is_finite());
        if !(good(&position) && good(&velocity) && good(&torque)) {
            return Ok(false);
        }
        let offsets = numbers(self.encoder_offsets.bind(py));
        self.servos
            .command(&position, &velocity, &torque, &offsets)
            .map_err(|error| unfit(&error))?;
        Ok(true)
    }

    /// Lets the motors be weak, or whole again: (n,) what share is left of the torque that each can give.
    fn weaken(&mut self, shares: &Bound<'_, PyArray1<f64>>) -> PyResult<()> {
        let weakened = self.servos.weaken(&numbers(shares));
        weakened.map_err(|error| unfit(&error))
    }

    /// The torques (n,) N m for the coming physics step at these true joint angles (n,) rad and velocities (n,) rad/s.
    fn torques<'py>(
        &mut self,
        py: Python<'py>,
        position: &Bound<'_, PyArray1<f64>>,
        velocity: &Bound<'_, PyArray1<f64>>,
    ) -> Bound<'py, PyArray1<f64>> {
        let (position, velocity) = (numbers(position), numbers(velocity));
        let torques: Vec<f64> = self.servos.torques(&position, &velocity).collect();
        torques.to_pyarray(py)
    }

    /// The motors' angles (n,) rad, which encoders see, at joint angles (n,) rad.
    fn measured_angle<'py>(
        &self,
        py: Python<'py>,
        position: &Bound<'_, PyArray1<f64>>,
    ) -> Bound<'py, PyArray1<f64>> {
        let angles: Vec<f64> = numbers(position)
            .iter()
            .zip(self.lead_rad())
            .map(|(angle, lead)| angle + lead)
            .collect();
        angles.to_pyarray(py)
    }
}

/// MuJoCo's model and data of one episode, stepped with the servos between.
#[pyclass(name = "Physics", module = "treadwell._core")]
pub(crate) struct PyPhysics(Physics);

#[pymethods]
impl PyPhysics {
    /// `model` and `data` are MuJoCo's, made for each other. The robot's `joints` begin at `position` in `qpos` and at `velocity` in
    /// `qvel`; `motors` are pairs of a joint and of the index in `ctrl` of its motor.
    #[new]
    fn new(
        model: &Bound<'_, PyAny>,
        data: &Bound<'_, PyAny>,
        joints: usize,
        position: usize,
        velocity: usize,
        motors: Vec<(usize, usize)>,
    ) -> PyResult<Self> {
        let wiring = Wiring {
            first_position: position,
            first_velocity: velocity,
            motors,
        };
        Physics::new(model, data, wiring, joints).map(Self)
    }

    /// Steps once for each row of `controls` (steps, nu), which gets what the motors were told. False where the state is no longer
    /// finite, or MuJoCo warned. Raises `mujoco.FatalError` where it cannot step.
    fn step(
        &mut self,
        py: Python<'_>,
        servos: &mut PyServos,
        mut controls: PyReadwriteArray2<'_, f64>,
    ) -> PyResult<bool> {
        let [width, _] = self.0.widths();
        if controls.as_array().ncols() != width {
            return Err(PyValueError::new_err(format!("controls: {width} columns")));
        }
        self.0
            .step(py, &mut servos.servos, controls.as_slice_mut()?)
    }
}
