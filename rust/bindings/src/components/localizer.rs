//! A localizer of the user's.

use geometry::{Pose, Robot};
use localization::{BodyState, Estimate, Localizer, LocalizerError};
use mapping::FloorView;
use pyo3::intern;
use pyo3::prelude::*;
use segmentation::Planes;

use super::sentence;
use crate::products::{PyBodyState, PyFloorView, PyPlanes};

struct PythonLocalizer(Py<PyAny>);

/// Wraps an object with the methods of `treadwell.protocols.Localizer`.
pub(crate) fn localizer(object: Py<PyAny>) -> Box<dyn Localizer> {
    Box::new(PythonLocalizer(object))
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
        let [x, y, z, yaw]: [f64; 4] = Python::attach(|py| {
            self.0
                .call_method1(py, intern!(py, "estimate"), (PyBodyState(body.clone()),))
                .and_then(|pose| pose.extract(py))
                .map_err(|error| LocalizerError::Failed(sentence(&error)))
        })?;
        if ![x, y, z, yaw].iter().all(|value| value.is_finite()) {
            return Err(LocalizerError::Failed(format!(
                "estimate must be finite, got {:?}",
                [x, y, z, yaw]
            )));
        }
        let map_from_robot = Pose::<_, Robot>::from_yaw(x, y, z, yaw);
        Ok(Estimate {
            time_ns: body.time_ns,
            map_from_robot,
            map_from_odometry: map_from_robot * body.odometry_from_robot.inverse(),
            lost: false,
        })
    }
}
