//! A segmenter alone: for depth images that come from elsewhere than from an episode.

use std::time::Instant;

use numpy::{PyArray2, PyArrayMethods};
use pilot::SEGMENTERS;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use segmentation::{Planes, Segmenter, SegmenterNeeds};
use sensing::{Intrinsics, Scan};

use crate::error::{bad_setting, failed, parse, run};
use crate::pose::rigid;
use crate::products::PyPlanes;

/// Finds the planes of depth images, frame by frame, as the pilot's segmenter of that name does. It follows the ground from frame
/// to frame: pictures of another place want another one.
#[pyclass(name = "Segmenter", module = "treadwell._core")]
pub(crate) struct PySegmenter {
    segmenter: Box<dyn Segmenter>,
    scan: Scan,
    /// Time that the core itself took for the last picture, s.
    #[pyo3(get)]
    seconds: f64,
}

#[pymethods]
impl PySegmenter {
    /// A segmenter of the list, for a pinhole camera: `focal` in pixels, `baseline` in metres between the eyes, the axis through the
    /// image's middle. `settings` is JSON, a table a name: `{"ground": {"noise_floor": 0.2}}`.
    #[new]
    #[expect(
        clippy::too_many_arguments,
        reason = "one keyword argument of Python's each"
    )]
    #[pyo3(signature = (name, *, width, height, focal, baseline, settings="{}"))]
    fn new(
        py: Python<'_>,
        name: &str,
        width: usize,
        height: usize,
        focal: f64,
        baseline: f64,
        settings: &str,
    ) -> PyResult<Self> {
        let seen = [focal, baseline].iter().all(|v| v.is_finite() && *v > 0.0);
        if width == 0 || height == 0 || !seen {
            return Err(bad_setting(
                py,
                &"a camera's width, height, focal and baseline must be > 0",
            ));
        }
        let camera = Intrinsics {
            width,
            height,
            focal_px: focal,
            baseline_m: baseline,
        };
        let needs = SegmenterNeeds {
            tables: &parse(py, settings)?,
            camera,
        };
        let make = SEGMENTERS
            .find(name)
            .map_err(|error| bad_setting(py, &error))?;
        let segmenter = make(&needs).map_err(|error| bad_setting(py, &error))?;
        Ok(Self {
            segmenter,
            scan: Scan::new(camera),
            seconds: 0.0,
        })
    }

    /// The planes of a depth image, (h, w) float32, metres along the optical axis, NaN for not seen; `robot_from_camera`, (4, 4), is
    /// where the camera is believed to be.
    fn segment(
        &mut self,
        py: Python<'_>,
        depth: &Bound<'_, PyArray2<f32>>,
        robot_from_camera: &Bound<'_, PyArray2<f64>>,
    ) -> PyResult<PyPlanes> {
        let Self {
            segmenter,
            scan,
            seconds,
        } = self;
        let size = (scan.camera.height, scan.camera.width);
        let depth = depth.readonly();
        let depths_m = depth.as_array();
        if depths_m.dim() != size {
            return Err(PyValueError::new_err(format!(
                "depth must be {size:?}, got {:?}",
                depths_m.dim()
            )));
        }
        let robot_from_camera = rigid(&robot_from_camera.readonly())?;
        let started = Instant::now();
        scan.read_depths(depths_m.iter().copied(), robot_from_camera)
            .map_err(|error| failed(py, &error))?;
        let mut planes = Planes::new(depths_m.len());
        run(py, || segmenter.segment(scan, &mut planes))?.map_err(|error| failed(py, &error))?;
        *seconds = started.elapsed().as_secs_f64();
        Ok(PyPlanes(planes))
    }
}
