//! The simulated cameras' errors: from exact depth to what is measured.

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use simulated_senses::{
    CameraPose, Pinhole, StereoConfig, StereoErrors, StructuredLightConfig, StructuredLightErrors,
    TruePicture,
};

use crate::error::{bad_setting, run};

/// What turns exact depth into a camera's.
#[pyclass(name = "DepthErrors", module = "treadwell._core")]
pub(crate) struct PyDepthErrors {
    model: Model,
    picture: TruePicture,
    size: [usize; 2],
}

/// The two kinds of cameras.
enum Model {
    Stereo(Box<StereoErrors>),
    StructuredLight(Box<StructuredLightErrors>),
}

#[pymethods]
impl PyDepthErrors {
    /// A stereo camera's, for bodies of these textures, (n,) from 0 (blank) to 1. `settings` is JSON, the table `camera.stereo`;
    /// `pattern` seeds what is the same for the same picture, `noise` what is new in each frame.
    #[staticmethod]
    #[expect(
        clippy::too_many_arguments,
        reason = "one keyword argument of Python's each"
    )]
    #[pyo3(signature = (textures, *, width, height, focal, settings, pattern, noise))]
    fn stereo(
        py: Python<'_>,
        textures: &Bound<'_, PyArray1<f64>>,
        width: usize,
        height: usize,
        focal: f64,
        settings: &str,
        pattern: u64,
        noise: u64,
    ) -> PyResult<Self> {
        let pinhole = pinhole(py, width, height, focal)?;
        let config: StereoConfig =
            serde_json::from_str(settings).map_err(|error| bad_setting(py, &error))?;
        let textures = textures.readonly().as_array().to_vec();
        let model = StereoErrors::new(config, &pinhole, &textures, pattern, noise)
            .map_err(|error| bad_setting(py, &error))?;
        Ok(Self::of(Model::Stereo(Box::new(model)), &pinhole))
    }

    /// A structured-light camera's. `settings` is JSON, the table `camera.structured_light`; `noise` seeds them.
    #[staticmethod]
    #[pyo3(signature = (*, width, height, focal, settings, noise))]
    fn structured_light(
        py: Python<'_>,
        width: usize,
        height: usize,
        focal: f64,
        settings: &str,
        noise: u64,
    ) -> PyResult<Self> {
        let pinhole = pinhole(py, width, height, focal)?;
        let config: StructuredLightConfig =
            serde_json::from_str(settings).map_err(|error| bad_setting(py, &error))?;
        let model = StructuredLightErrors::new(config, &pinhole, noise)
            .map_err(|error| bad_setting(py, &error))?;
        Ok(Self::of(Model::StructuredLight(Box::new(model)), &pinhole))
    }

    /// (h, w) float32: what is measured of exact depths, (h, w) m along the axis, NaN for none, of the bodies (h, w), -1 for none,
    /// from `position` (3,) and `rotation` (3, 3), world from optical frame.
    fn see<'py>(
        &mut self,
        py: Python<'py>,
        depth: &Bound<'py, PyArray2<f64>>,
        body: &Bound<'py, PyArray2<i32>>,
        position: [f64; 3],
        rotation: &Bound<'py, PyArray2<f64>>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let view = viewpoint(position, rotation)?;
        let mut picture = self.picture.clone();
        picture
            .read(&values("depth", depth)?, &values("geom", body)?)
            .map_err(|error| PyValueError::new_err(error.to_string()))?;
        self.measured(py, &picture, &view, self.size)
    }
}

impl PyDepthErrors {
    fn of(model: Model, pinhole: &Pinhole) -> Self {
        Self {
            model,
            picture: TruePicture::new(pinhole),
            size: [pinhole.height, pinhole.width],
        }
    }

    pub(crate) fn measured<'py>(
        &mut self,
        py: Python<'py>,
        picture: &TruePicture,
        view: &CameraPose,
        size: [usize; 2],
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let depth = PyArray2::<f32>::zeros(py, size, false);
        let mut written = depth.readwrite();
        let depth_m = written.as_slice_mut().map_err(|_| by_row("depth"))?;
        let model = &mut self.model;
        run(py, || match model {
            Model::Stereo(errors) => errors.see(picture, view, depth_m),
            Model::StructuredLight(errors) => errors.see(picture, depth_m),
        })?
        .map_err(|error| PyValueError::new_err(error.to_string()))?;
        drop(written);
        Ok(depth)
    }
}

pub(crate) fn pinhole(
    py: Python<'_>,
    width: usize,
    height: usize,
    focal: f64,
) -> PyResult<Pinhole> {
    Pinhole::new(width, height, focal).map_err(|error| bad_setting(py, &error))
}

pub(crate) fn viewpoint(
    position: [f64; 3],
    rotation: &Bound<'_, PyArray2<f64>>,
) -> PyResult<CameraPose> {
    let rotation = values("rotation", rotation)?;
    let rotation = rotation
        .try_into()
        .map_err(|_| PyValueError::new_err("rotation must be 3 x 3"))?;
    Ok(CameraPose {
        position_m: position,
        rotation,
    })
}

/// An array's values row by row, wherever they lie in memory.
pub(crate) fn values<T: numpy::Element + Copy>(
    name: &str,
    array: &Bound<'_, PyArray2<T>>,
) -> PyResult<Vec<T>> {
    let array = array
        .try_readonly()
        .map_err(|error| PyValueError::new_err(format!("{name}: {error}")))?;
    Ok(array.as_array().iter().copied().collect())
}

pub(crate) fn by_row(name: &str) -> PyErr {
    PyValueError::new_err(format!("{name} must lie row by row in memory"))
}
