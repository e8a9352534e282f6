//! The core's products as Python sees them: read-only, arrays moved out or copied once.

use geometry::Pose;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, ToPyArray};
use proprioception::BodyState;
use pyo3::prelude::*;

/// (x m, y m, z m, yaw rad): a pose as Python's tuple.
pub(crate) type FlatPose = (f64, f64, f64, f64);

/// A pose without roll and pitch.
pub(crate) fn flat<T, S>(pose: &Pose<T, S>) -> FlatPose {
    let origin = pose.origin().inner;
    (origin.x, origin.y, origin.z, pose.yaw_rad())
}

/// A pose as a 4 x 4 matrix.
pub(crate) fn matrix<'py, T, S>(py: Python<'py>, pose: &Pose<T, S>) -> Bound<'py, PyArray2<f64>> {
    let matrix = pose.inner.to_homogeneous();
    numpy::ndarray::Array2::from_shape_fn((4, 4), |(row, col)| matrix[(row, col)]).into_pyarray(py)
}

/// What the body itself tells: leg odometry and loads.
#[pyclass(frozen, name = "BodyState", module = "treadwell._core")]
pub(crate) struct PyBodyState(pub(crate) BodyState);

#[pymethods]
impl PyBodyState {
    fn __repr__(&self) -> String {
        let [left, right] = self.0.foot_loads_n;
        let at_s = 1e-9 * self.0.time_ns as f64;
        format!(
            "<BodyState at {at_s:.2} s: {left:.1} N on the left sole, {right:.1} N on the right>"
        )
    }

    /// Nanoseconds since the start.
    #[getter]
    fn time_ns(&self) -> u64 {
        self.0.time_ns
    }

    /// (4, 4): the robot's frame by leg odometry.
    #[getter]
    fn odometry_from_robot<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        matrix(py, &self.0.odometry_from_robot)
    }

    /// (2,) N: load on the left and the right sole.
    #[getter]
    fn foot_loads<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.0.foot_loads_n.to_pyarray(py)
    }
}

/// The planes of a frame.
#[pyclass(frozen, name = "Planes", module = "treadwell._core")]
pub(crate) struct PyPlanes(pub(crate) segmentation::Planes);

#[pymethods]
impl PyPlanes {
    fn __repr__(&self) -> String {
        let (regions, at_s) = (self.0.regions.len(), 1e-9 * self.0.exposure_ns as f64);
        let ground =
            (self.0.ground).map_or_else(|| "no ground".to_owned(), |at| format!("ground {at}"));
        let doubt = if self.0.reliable {
            ""
        } else {
            ", not reliable"
        };
        format!("<Planes at {at_s:.2} s: {regions} regions, {ground}{doubt}>")
    }

    /// When the picture was taken, nanoseconds since the start.
    #[getter]
    fn exposure_ns(&self) -> u64 {
        self.0.exposure_ns
    }

    /// (pixels,) uint16: region of each pixel plus one, 0 for none; row by row.
    #[getter]
    fn labels<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u16>> {
        self.0.labels.to_pyarray(py)
    }

    /// (pixels, 3) float32: points in the robot's frame, m; NaN where nothing was seen.
    #[getter]
    fn points_in_robot<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let flat = self.0.points_in_robot_m.as_flattened().to_pyarray(py);
        flat.reshape([self.0.points_in_robot_m.len(), 3])
    }

    /// (pixels,) float32: height of the horizontal plane that each pixel belongs to, m; NaN for none.
    #[getter]
    fn floor_height<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f32>> {
        self.0.floor_height_m.to_pyarray(py)
    }

    /// (4, 4): the camera in the robot's frame, corrected by the ground plane.
    #[getter]
    fn robot_from_camera<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        matrix(py, &self.0.robot_from_camera)
    }

    /// Whether the heights may be trusted.
    #[getter]
    fn reliable(&self) -> bool {
        self.0.reliable
    }

    /// Index of the ground among the regions, or None.
    #[getter]
    fn ground(&self) -> Option<usize> {
        self.0.ground
    }

    /// One tuple a region: support, mean (3,), normal (3,), signed distance m, floor height m or None.
    #[getter]
    #[expect(clippy::type_complexity, reason = "one row of a table")]
    fn regions(&self) -> Vec<(usize, [f64; 3], [f64; 3], f64, Option<f64>)> {
        let row = |region: &segmentation::PlaneRegion| {
            let mean = region.mean.inner;
            let normal = region.plane.normal;
            (
                region.support,
                [mean.x, mean.y, mean.z],
                [normal.x, normal.y, normal.z],
                region.plane.distance_m,
                region.floor_height_m,
            )
        };
        self.0.regions.iter().map(row).collect()
    }
}
