//! A localizer of the user's.

use geometry::{Pose, Robot};
use localization::{Estimate, Localizer, LocalizerError};
use mapping::FloorView;
use proprioception::BodyState;
use pyo3::intern;
use pyo3::prelude::*;
use segmentation::Planes;
use sensing::Scan;

use super::{FARTHEST_M, check_within, sentence, unlike};
use crate::floor_view::PyFloorView;
use crate::products::{PyBodyState, PyPlanes};
use crate::situation::PyScan;

struct PythonLocalizer {
    object: Py<PyAny>,
    /// Whether it has a method `see`: a scan is copied for nobody else.
    sees: bool,
}

/// Wraps an object with the methods of `treadwell.protocols.Localizer`.
pub(crate) fn localizer(object: Py<PyAny>) -> Box<dyn Localizer> {
    let sees = Python::attach(|py| object.bind(py).hasattr(intern!(py, "see")));
    Box::new(PythonLocalizer {
        sees: sees.unwrap_or(false),
        object,
    })
}

impl PythonLocalizer {
    /// Place x, y and z, m, and yaw, rad.
    fn pose(&self, py: Python<'_>, body: &BodyState) -> PyResult<[f64; 4]> {
        let argument = (PyBodyState(body.clone()),);
        let object = self.object.bind(py);
        let answer = object.call_method1(intern!(py, "estimate"), argument)?;
        let pose: [f64; 4] = (answer.extract()).map_err(|_| {
            unlike(
                "estimate()",
                &answer,
                "four numbers (x m, y m, z m, yaw rad)",
            )
        })?;
        check_within("estimate", pose, FARTHEST_M)?;
        Ok(pose)
    }
}

impl Localizer for PythonLocalizer {
    fn see(&mut self, scan: &Scan) -> Result<(), LocalizerError> {
        if !self.sees {
            return Ok(());
        }
        Python::attach(|py| {
            self.object
                .call_method1(py, intern!(py, "see"), (PyScan(scan.clone()),))
                .map(|_| ())
                .map_err(|error| LocalizerError::Failed(sentence(&error)))
        })
    }

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
            self.object
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
