//! What a user's walker is told: the command, and what the body feels. No pose but the odometry's.

use std::collections::BTreeMap;
use std::sync::Arc;

use behaviour::{Arms, Command, Motion};
use nalgebra::Vector3;
use numpy::{PyArray1, PyArray2, ToPyArray};
use proprioception::BodyState;
use pyo3::prelude::*;
use robot::Body;
use walking::WalkerSenses;

use crate::products::matrix;
use crate::stairs::{FlatFootstep, flat_footsteps, side_name};

/// What a walker is told to do.
#[pyclass(frozen, get_all, name = "Command", module = "treadwell._core")]
pub(crate) struct PyCommand {
    /// (forward m/s, left m/s, counter-clockwise rad/s), or None: to stand, or to take the footsteps.
    velocity: Option<(f64, f64, f64)>,
    /// Steps to take one after the other: rows of `treadwell.protocols.Footstep`; empty where it is to walk or stand.
    footsteps: Vec<FlatFootstep>,
    /// (pan to the left, down from the horizon) rad: where to look.
    gaze: (f64, f64),
    /// Joint -> angle, rad: what turns the head there, at the speed that `gait.gaze_speed` allows and within the joints' ranges.
    head: BTreeMap<usize, f64>,
    /// Whether the arms are to be raised.
    arms_raised: bool,
}

impl PyCommand {
    pub(crate) fn new(command: &Command, head: BTreeMap<usize, f64>) -> Self {
        Self {
            velocity: match &command.motion {
                Motion::Walk(velocity) => {
                    Some((velocity.x_mps, velocity.y_mps, velocity.yaw_radps))
                }
                Motion::Stand | Motion::Footsteps(_) => None,
            },
            footsteps: flat_footsteps(&command.motion),
            gaze: (command.gaze.pan_rad, command.gaze.down_rad),
            head,
            arms_raised: command.arms == Arms::Raised,
        }
    }
}

/// A robot's joints, in their order.
#[derive(Debug)]
pub(crate) struct Joints {
    names: Vec<String>,
    stand_rad: Vec<f64>,
    ranges_rad: Vec<f64>,
}

impl Joints {
    pub(crate) fn of(body: &Body) -> Self {
        let description = body.description();
        let range = |joint| {
            body.hinge(joint)
                .map_or([f64::NAN; 2], |(_, one)| one.range)
        };
        Self {
            names: description.joints.clone(),
            stand_rad: description.stand.clone(),
            ranges_rad: (0..body.joint_count()).flat_map(range).collect(),
        }
    }
}

/// What the body feels at a control tick, by its own senses alone.
#[pyclass(frozen, name = "Proprioception", module = "treadwell._core")]
pub(crate) struct PyProprioception {
    state: BodyState,
    positions_rad: Vec<f64>,
    velocities_radps: Vec<f64>,
    foot_forces_n: [[f64; 4]; 2],
    contacts: [bool; 2],
    joints: Arc<Joints>,
}

impl PyProprioception {
    pub(crate) fn new(
        senses: &WalkerSenses<'_>,
        contacts: [bool; 2],
        joints: &Arc<Joints>,
    ) -> Self {
        Self {
            state: senses.state.clone(),
            positions_rad: senses.observation.joint_positions_rad.clone(),
            velocities_radps: senses.observation.joint_velocities_radps.clone(),
            foot_forces_n: senses.observation.foot_forces_n,
            contacts,
            joints: Arc::clone(joints),
        }
    }
}

#[pymethods]
impl PyProprioception {
    /// Nanoseconds since the start.
    #[getter]
    fn time_ns(&self) -> u64 {
        self.state.time_ns
    }

    /// Names of the joints, in the order of every array over joints.
    #[getter]
    fn joint_names(&self) -> Vec<String> {
        self.joints.names.clone()
    }

    /// (n,) rad: the joints in the upright stance, in which the robot starts.
    #[getter]
    fn stand<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.joints.stand_rad.to_pyarray(py)
    }

    /// (n, 2) rad: from where to where each joint turns.
    #[getter]
    fn joint_ranges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let pairs: Vec<Vec<f64>> = (self.joints.ranges_rad.chunks(2))
            .map(<[f64]>::to_vec)
            .collect();
        Ok(PyArray2::from_vec2(py, &pairs)?)
    }

    /// (n,) rad, as the encoders read.
    #[getter]
    fn joint_positions<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.positions_rad.to_pyarray(py)
    }

    /// (n,) rad/s, as the encoders read.
    #[getter]
    fn joint_velocities<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.velocities_radps.to_pyarray(py)
    }

    /// (3,): the direction of gravity in the torso's frame, of length 1; (0, 0, -1) where the torso is upright.
    #[getter]
    fn gravity<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let upright = self.state.odometry_from_torso_rotation;
        let down = upright.inverse() * -Vector3::z();
        down.as_slice().to_pyarray(py)
    }

    /// (3,) rad/s: how the torso turns, in its own frame, without the gyroscope's bias.
    #[getter]
    fn angular_velocity<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.state.angular_velocity_radps.as_slice().to_pyarray(py)
    }

    /// (4, 4): the torso by attitude and leg odometry.
    #[getter]
    fn odometry_from_torso<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        let pose = self.state.odometry_from_robot * self.state.robot_from_torso;
        matrix(py, &pose)
    }

    /// (4, 4): the robot's frame, between the soles on the ground, by leg odometry.
    #[getter]
    fn odometry_from_robot<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        matrix(py, &self.state.odometry_from_robot)
    }

    /// (2, 4) N, rows left and right; columns front left, front right, rear left, rear right.
    #[getter]
    fn foot_forces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let rows = self.foot_forces_n.map(Vec::from);
        Ok(PyArray2::from_vec2(py, &rows)?)
    }

    /// (2,) N: load on the left and the right sole.
    #[getter]
    fn foot_loads<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.state.foot_loads_n.to_pyarray(py)
    }

    /// Whether the left and the right foot bear a load: `gait.landing_load` or more.
    #[getter]
    const fn contacts(&self) -> (bool, bool) {
        (self.contacts[0], self.contacts[1])
    }

    /// The foot that carries the robot: "left" or "right".
    #[getter]
    const fn support(&self) -> &'static str {
        side_name(self.state.support)
    }
}
