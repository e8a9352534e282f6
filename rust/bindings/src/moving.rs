//! Recordings without what moved.

use dynamic_scenes::{MovingConfig, PictureShape, RangeView, StaticPoints, ViewsConfig};
use geometry::{Camera, Map, PlanarPose, Point, Pose};
use numpy::{IntoPyArray, PyArray2, PyArrayMethods, ndarray};
use plan_view::{PlanarBeam, PlanarScan};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error::{bad_setting, parse, run};
use crate::pose::rigid;

/// Finds in a whole recording what is static, (004, Figs 36.20 and 36.21). `settings` is JSON: `[navigation.moving]`.
#[pyclass(name = "MovingFilter", module = "treadwell._core")]
pub(crate) struct PyMovingFilter {
    filter: StaticPoints,
    views: ViewsConfig,
    /// Rows and columns of each frame, and pixels a side of the blocks that are one point.
    frames: Vec<([usize; 2], usize)>,
}

#[pymethods]
impl PyMovingFilter {
    #[new]
    #[pyo3(signature = (settings="{}"))]
    fn new(py: Python<'_>, settings: &str) -> PyResult<Self> {
        let tables: MovingConfig = parse(py, settings)?;
        let filter = StaticPoints::new(tables.views.clone(), tables.clusters, tables.gone);
        Ok(Self {
            filter: filter.map_err(|error| bad_setting(py, &error))?,
            views: tables.views,
            frames: Vec::new(),
        })
    }

    /// Takes in a depth picture, later than the last, s: depths (h, w) float32 m, NaN where nothing was seen, `map_from_camera` (4, 4), focal lengths and axis
    /// in pixels, how high the ground is, m, and of how many pixels a side the blocks are that are one.
    #[expect(clippy::too_many_arguments, reason = "one argument of Python's each")]
    #[pyo3(signature = (time, depth, map_from_camera, *, focal, centre, ground, pool=1))]
    fn insert_picture(
        &mut self,
        time: f64,
        depth: &Bound<'_, PyArray2<f32>>,
        map_from_camera: &Bound<'_, PyArray2<f64>>,
        focal: [f64; 2],
        centre: [f64; 2],
        ground: f64,
        pool: usize,
    ) -> PyResult<()> {
        let depth = depth.readonly();
        let depth = depth.as_array();
        let [rows, cols]: [usize; 2] = depth.dim().into();
        if pool == 0 || focal.iter().any(|px| px.is_nan() || *px <= 0.0) {
            return Err(PyValueError::new_err("pool and focal must be > 0"));
        }
        let size = [rows, cols].map(|size| size / pool);
        // Of a block the nearest that it saw.
        let nearest = |at: usize| {
            let (row, col) = (at / size[1] * pool, at % size[1] * pool);
            let block =
                (row..row + pool).flat_map(|row| (col..col + pool).map(move |col| [row, col]));
            let seen = block.map(|at| depth[at]).filter(|depth_m| *depth_m > 0.0);
            seen.fold(f32::NAN, f32::min)
        };
        let depths_m: Vec<f32> = (0..size[0] * size[1]).map(nearest).collect();
        let side = pool as f64;
        let shape = PictureShape {
            size_px: [size[1], size[0]],
            focal_px: focal.map(|px| px / side),
            centre_px: centre.map(|px| (px + 0.5) / side - 0.5),
        };
        let pose: Pose<Map, Camera> = rigid(&map_from_camera.readonly())?;
        let point = |(at, &depth_m): (usize, &f32)| {
            let depth = f64::from(depth_m);
            let [x, y] = [at % size[1], at / size[1]];
            let [x, y] = [(x, 0), (y, 1)]
                .map(|(px, axis)| (px as f64 - shape.centre_px[axis]) / shape.focal_px[axis]);
            let at = (pose * Point::<Camera>::new(x * depth, y * depth, depth)).inner;
            ([at.x, at.y, at.z], at.z - ground)
        };
        let points = depths_m.iter().enumerate().map(point).collect();
        let view = RangeView::of_picture(time, &pose, shape, depths_m);
        self.filter.insert(view, points);
        self.frames.push(([rows, cols], pool));
        Ok(())
    }

    /// Takes in a scan of a laser, later than the last, s: points (n, 2) m in the map, NaN for nothing seen, all from `eye`, m.
    fn insert_scan(
        &mut self,
        time: f64,
        points: &Bound<'_, PyArray2<f64>>,
        eye: [f64; 2],
    ) -> PyResult<()> {
        let points = points.readonly();
        let rows = points.as_array();
        if rows.ncols() != 2 {
            return Err(PyValueError::new_err("points must be (n, 2)"));
        }
        let places: Vec<[f64; 2]> = rows
            .rows()
            .into_iter()
            .map(|row| [row[0], row[1]])
            .collect();
        let beam = |at_m: &[f64; 2]| {
            let off = [at_m[0] - eye[0], at_m[1] - eye[1]];
            let range_m = geometry::hypot(off[0], off[1]);
            let bearing_rad = libm::atan2(off[1], off[0]);
            PlanarBeam::new(bearing_rad, range_m.is_finite().then_some(range_m))
        };
        let scan = PlanarScan {
            map_from_sensor: PlanarPose::new(eye[0], eye[1], 0.0),
            beams: places.iter().map(beam).collect(),
        };
        let view = RangeView::of_scan(time, &scan, &self.views);
        // A laser's points stand above the ground, by how much is not known.
        let above = |[x_m, y_m]: [f64; 2]| ([x_m, y_m, 0.0], f64::INFINITY);
        self.filter
            .insert(view, places.iter().copied().map(above).collect());
        self.frames.push(([1, places.len()], 1));
        Ok(())
    }

    /// Of each frame (rows, columns) whether what was seen is static; a scan is one row. True where nothing was seen.
    fn are_static<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyArray2<bool>>>> {
        let found = run(py, || self.filter.are_static())?;
        let frames = found.iter().zip(&self.frames);
        let array = |(kept, &([rows, cols], pool)): (&Vec<bool>, &([usize; 2], usize))| {
            let [block_rows, block_cols] = [rows / pool, cols / pool];
            let whole = ndarray::Array2::from_shape_fn([rows, cols], |(row, col)| {
                let (row, col) = (row / pool, col / pool);
                row >= block_rows || col >= block_cols || kept[row * block_cols + col]
            });
            whole.into_pyarray(py)
        };
        Ok(frames.map(array).collect())
    }
}
