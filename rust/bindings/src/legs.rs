//! The legs' inverse kinematics alone, and the gait that a robot's folder asks for: what can be reached, before anything walks.

use geometry::PlanarPose;
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector2, Vector3};
use numpy::{PyArray1, ToPyArray};
use pyo3::prelude::*;
use robot::{Body, Side};
use walking::GaitConfig;
use walking::descent::Descent;
use walking::leg::LegSolver;
use walking::phase::{FootPose, Manner, Swing};

use crate::error::{bad_setting, parse};
use crate::stairs::side;

/// Two legs and their gait.
#[pyclass(frozen, name = "Legs", module = "treadwell._core")]
pub(crate) struct PyLegs {
    legs: [LegSolver; 2],
    gait: GaitConfig,
    descent: Descent,
}

fn index(py: Python<'_>, name: &str) -> PyResult<usize> {
    let side = side(name).map_err(|error| bad_setting(py, &error))?;
    Ok(side.index())
}

#[pymethods]
impl PyLegs {
    #[new]
    fn new(py: Python<'_>, description_json: &str) -> PyResult<Self> {
        let body =
            Body::new(parse(py, description_json)?).map_err(|error| bad_setting(py, &error))?;
        let (gait, stance) = GaitConfig::read(&body).map_err(|error| bad_setting(py, &error))?;
        let leg = |side| {
            LegSolver::new(&body, side, gait.max_extension, &gait.tuning.leg)
                .map_err(|error| bad_setting(py, &error))
        };
        Ok(Self {
            descent: Descent::read(&body, &gait, &stance.rest)
                .map_err(|error| bad_setting(py, &error))?,
            legs: [leg(Side::Left)?, leg(Side::Right)?],
            gait,
        })
    }

    /// Joint angles (n,) rad from the hip down that put the sole of `side` at (x m, y m, z m) in the torso's frame, level and
    /// turned by `yaw` rad; and whether length and ranges let it get there.
    #[pyo3(signature = (side, place, yaw=0.0))]
    fn solve<'py>(
        &self,
        py: Python<'py>,
        side: &str,
        place: (f64, f64, f64),
        yaw: f64,
    ) -> PyResult<(Bound<'py, PyArray1<f64>>, bool)> {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw);
        let pose = Isometry3::from_parts(Translation3::new(place.0, place.1, place.2), turn);
        let leg = &self.legs[index(py, side)?];
        let found = leg.solve(&pose, leg.rest_rad());
        let angles_rad = &found.angles_rad[..leg.joints().len()];
        Ok((angles_rad.to_pyarray(py), found.reached))
    }

    /// How far ahead of its sole's middle the other foot carries while that of `side` goes to (x m, y m, z m) from there, m.
    fn carries_ahead(&self, py: Python<'_>, side: &str, place: (f64, f64, f64)) -> PyResult<f64> {
        let (x_m, y_m, z_m) = place;
        let to = FootPose {
            planar: PlanarPose::new(x_m, y_m, 0.0),
            z_m,
            ..FootPose::default()
        };
        let stance = FootPose::default();
        let side = Side::BOTH[index(py, side)?];
        let swing = Swing::new(side, Manner::Careful, stance, to);
        Ok(self.descent.ahead_m(&Vector2::zeros(), &stance, &swing))
    }

    /// Of one leg: where its hip is in the torso's frame (x, y, z), thigh, shank, and the ankle's height over the sole, m.
    fn lengths(&self, py: Python<'_>, side: &str) -> PyResult<([f64; 3], f64, f64, f64)> {
        let leg = &self.legs[index(py, side)?];
        let (thigh_m, shank_m) = leg.lengths_m();
        Ok(((*leg.hip()).into(), thigh_m, shank_m, leg.ankle_height_m()))
    }

    /// Of one leg: why its angles are found by Newton's method, where the closed form does not hold, and which turn of the sole
    /// (`"roll"`, `"pitch"` or `"yaw"`) its five joints leave open.
    fn solved_by(
        &self,
        py: Python<'_>,
        side: &str,
    ) -> PyResult<(Option<String>, Option<&'static str>)> {
        let leg = &self.legs[index(py, side)?];
        Ok((leg.not_closed().map(str::to_owned), leg.left_open()))
    }

    /// `[gait]` with its defaults, as JSON.
    #[getter]
    fn gait_json(&self) -> String {
        settings::Setting::written(&self.gait).to_string()
    }
}
