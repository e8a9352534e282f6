//! A localizer of the user's.

use geometry::{Pose, Robot};
use localization::{Estimate, Localizer, LocalizerError};
use mapping::FloorView;
use proprioception::BodyState;
use pyo3::intern;
use pyo3::prelude::*;
use segmentation::Planes;

use super::{FARTHEST_M, check_within, sentence};
use crate::products::{PyBodyState, PyFloorView, PyPlanes};

struct PythonLocalizer(Py<PyAny>);

/// Wraps an object with the methods of `treadwell.protocols.Localizer`.
pub(crate) fn localizer(object: Py<PyAny>) -> Box<dyn Localizer> {
    Box::new(PythonLocalizer(object))
}

impl PythonLocalizer {
    /// Place x, y and z, m, and yaw, rad.
    fn pose(&self, py: Python<'_>, body: &BodyState) -> PyResult<[f64; 4]> {
        let argument = (PyBodyState(body.clone()),);
        let pose: [f64; 4] = self
            .0
            .call_method1(py, intern!(py, "estimate"), argument)?
            .extract(py)?;
        check_within("estimate", pose, FARTHEST_M)?;
        Ok(pose)
    }
}

impl Localizer for PythonLocalizer {
    fn correct(
        &mut self,
        body: &BodyState,
        planes: &Planes,
        view: &FloorView,
    ) -> Result<(), LocalizerError> {
        Python::attach(|py| {
            let arguments = (
                PyBodyState(body.clone()),
                PyPlanes(planes.clone()),
                PyFloorView(view.clone()),
            );
            self.0
                .call_method1(py, intern!(py, "correct"), arguments)
                .map(|_| ())
                .map_err(|error| LocalizerError::Failed(sentence(&error)))
        })
    }

    fn estimate(&mut self, body: &BodyState) -> Result<Estimate, LocalizerError> {
        let [x, y, z, yaw] = Python::attach(|py| self.pose(py, body))
            .map_err(|error| LocalizerError::Failed(sentence(&error)))?;
        let map_from_robot = Pose::<_, Robot>::from_yaw(x, y, z, yaw);
        Ok(Estimate {
            time_ns: body.time_ns,
            map_from_robot,
            map_from_odometry: map_from_robot * body.odometry_from_robot.inverse(),
            lost: false,
        })
    }
}
