//! One episode's physics.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use simulated_body::Servos;

use crate::memory::LiveArray;

/// Where the robot's joints and motors are in MuJoCo's arrays.
#[derive(Debug, Clone)]
pub struct Wiring {
    /// Index in `qpos` of the first joint's angle; the others follow it.
    pub first_position: usize,
    /// Index in `qvel` of the first joint's velocity; the others follow it.
    pub first_velocity: usize,
    /// For each motor the joint whose servo it is, by the joint order, and its index in `ctrl`.
    pub motors: Vec<(usize, usize)>,
}

/// A model and its state, stepped.
pub struct Physics {
    /// From positions and velocities to all that follows from them: the package's `mj_step1`.
    step1: Py<PyAny>,
    /// From controls to the next positions and velocities: its `mj_step2`.
    step2: Py<PyAny>,
    /// What both are called with, model and data of Python's: as long as they live, what is pointed at does.
    owners: Py<PyTuple>,
    wiring: Wiring,
    positions: LiveArray<f64>,
    velocities: LiveArray<f64>,
    controls: LiveArray<f64>,
    warnings: LiveArray<i32>,
    angles_rad: Vec<f64>,
    speeds_radps: Vec<f64>,
}

// SAFETY: the pointers are to memory of the two owners, which any thread may use as long as one alone does; `step` borrows mutably.
unsafe impl Send for Physics {}
// SAFETY: through a shared reference it is only read, and who has one keeps `step` from being called.
unsafe impl Sync for Physics {}

impl Physics {
    /// Takes a model and a data object of Python's MuJoCo, made for each other, to step them.
    pub fn new(
        model: &Bound<'_, PyAny>,
        data: &Bound<'_, PyAny>,
        wiring: Wiring,
        joints: usize,
    ) -> PyResult<Self> {
        let py = model.py();
        let package = py.import("mujoco")?;
        for (object, class) in [(model, "MjModel"), (data, "MjData")] {
            if !object.is_instance(&package.getattr(class)?)? {
                let found = object.get_type();
                return Err(PyTypeError::new_err(format!(
                    "must be a {class}, got {found}"
                )));
            }
        }
        let physics = Self {
            step1: package.getattr("mj_step1")?.unbind(),
            step2: package.getattr("mj_step2")?.unbind(),
            owners: PyTuple::new(py, [model, data])?.unbind(),
            positions: LiveArray::of(data, "qpos")?,
            velocities: LiveArray::of(data, "qvel")?,
            controls: LiveArray::of(data, "ctrl")?,
            warnings: LiveArray::of(&data.getattr("warning")?, "number")?,
            angles_rad: vec![0.0; joints],
            speeds_radps: vec![0.0; joints],
            wiring,
        };
        let lengths = ["nq", "nv", "nu"].map(|name| model.getattr(name)?.extract::<usize>());
        let [positions, velocities, controls] = lengths;
        if physics.lengths() != [positions?, velocities?, controls?] {
            return Err(PyValueError::new_err("data is not of this model"));
        }
        physics.check(joints)?;
        Ok(physics)
    }

    /// How many numbers a row of controls has, and a row of positions.
    pub const fn widths(&self) -> [usize; 2] {
        [self.controls.len(), self.positions.len()]
    }

    const fn lengths(&self) -> [usize; 3] {
        [
            self.positions.len(),
            self.velocities.len(),
            self.controls.len(),
        ]
    }

    fn check(&self, joints: usize) -> PyResult<()> {
        let Wiring {
            first_position,
            first_velocity,
            motors,
        } = &self.wiring;
        let fits = first_position + joints <= self.positions.len()
            && first_velocity + joints <= self.velocities.len()
            && motors
                .iter()
                .all(|&(joint, control)| joint < joints && control < self.controls.len());
        if fits {
            return Ok(());
        }
        Err(PyValueError::new_err(
            "the robot's joints are not all in this model",
        ))
    }

    /// Steps once for each row of `controls`, which gets what the motors were told; `false` where a state is not finite, or MuJoCo warned.
    ///
    /// Each step is `mj_step2` and `mj_step1`: before and after, all that follows from positions and velocities is up to date. A fatal
    /// error of MuJoCo's is the exception that its package raises, `mujoco.FatalError`; nothing can be stepped on from there.
    pub fn step(
        &mut self,
        py: Python<'_>,
        servos: &mut Servos,
        controls: &mut [f64],
    ) -> PyResult<bool> {
        let width = self.controls.len().max(1);
        for row in controls.chunks_exact_mut(width) {
            self.drive(servos);
            self.controls.copy_to(row);
            for half in [&self.step2, &self.step1] {
                let _none = half.bind(py).call1(self.owners.bind(py))?;
            }
        }
        let finite = self.positions.iter().all(f64::is_finite);
        Ok(finite && self.warnings.iter().all(|count| count == 0))
    }

    /// Sets the controls to what the servos give.
    fn drive(&mut self, servos: &mut Servos) {
        let Wiring {
            first_position,
            first_velocity,
            ..
        } = self.wiring;
        let truth = self.angles_rad.iter_mut().zip(&mut self.speeds_radps);
        for (joint, (angle, speed)) in truth.enumerate() {
            *angle = self.positions.get(first_position + joint).unwrap_or(0.0);
            *speed = self.velocities.get(first_velocity + joint).unwrap_or(0.0);
        }
        let mut motors = self.wiring.motors.iter().peekable();
        for (joint, torque) in servos
            .torques(&self.angles_rad, &self.speeds_radps)
            .enumerate()
        {
            while let Some((_, control)) = motors.next_if(|motor| motor.0 == joint) {
                self.controls.set(*control, torque);
            }
        }
    }
}
