//! World models alone: for frames that come from elsewhere than from an episode.

use std::time::Instant;

use geometry::{Camera, Lattice, Map, Pose, Robot};
use mapping::{FogConfig, WorldModel, WorldModelNeeds};
use numpy::ndarray::Dimension;
use numpy::{
    IntoPyArray, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray, PyUntypedArrayMethods,
};
use pilot::WORLD_MODELS;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use settings::Table as _;
use volume::{OccupancyGrid, Picture, Placement, ProbabilityTable, Ray, Size};

use crate::error::{bad_setting, failed, parse, run};
use crate::floor_view::PyFloorView;
use crate::pose::rigid;
use crate::products::{FlatPose, PyPlanes};

/// Keeps a map of the planes of frames, as the pilot's world model of that name does.
#[pyclass(name = "WorldModel", module = "treadwell._core")]
pub(crate) struct PyWorldModel {
    model: Box<dyn WorldModel>,
    /// Time that the core itself took for the last frame, s.
    #[pyo3(get)]
    seconds: f64,
}

#[pymethods]
impl PyWorldModel {
    /// A world model of the list. `settings` is JSON, a table a name: `{"fog": {"cell": 0.02}}`.
    #[new]
    #[pyo3(signature = (name, *, settings="{}"))]
    fn new(py: Python<'_>, name: &str, settings: &str) -> PyResult<Self> {
        let needs = WorldModelNeeds {
            tables: &parse(py, settings)?,
            known_map: None,
            headroom_m: None,
        };
        let make = WORLD_MODELS
            .find(name)
            .map_err(|error| bad_setting(py, &error))?;
        let model = make(&needs).map_err(|error| bad_setting(py, &error))?;
        Ok(Self {
            model,
            seconds: 0.0,
        })
    }

    /// Takes in a frame, seen by a robot at `pose`: x, y, z in metres and yaw in the map; whether it was used.
    fn insert(&mut self, py: Python<'_>, planes: &PyPlanes, pose: FlatPose) -> PyResult<bool> {
        let (x, y, z, yaw) = pose;
        let map_from_robot = Pose::<Map, Robot>::from_yaw(x, y, z, yaw);
        let (model, planes) = (&mut self.model, &planes.0);
        let started = Instant::now();
        let insertion = run(py, || model.insert(planes, &map_from_robot))?
            .map_err(|error| failed(py, &error))?;
        self.seconds = started.elapsed().as_secs_f64();
        Ok(insertion.used)
    }

    /// The map's view; a copy.
    fn view(&self) -> PyFloorView {
        PyFloorView(self.model.view().clone())
    }
}

/// The occupancy grid of the world model `fog`, without floors.
#[pyclass(name = "OccupancyGrid", module = "treadwell._core")]
pub(crate) struct PyOccupancyGrid {
    grid: OccupancyGrid,
    config: FogConfig,
    size: Size,
    /// Time that the core itself took for the last frame, s.
    #[pyo3(get)]
    seconds: f64,
}

#[pymethods]
impl PyOccupancyGrid {
    /// A grid of (columns, rows, layers) whose lowest corner is at `corner`, m. `settings` is JSON, as `[navigation.fog]`.
    #[new]
    #[pyo3(signature = (size, corner, *, settings="{}"))]
    fn new(
        py: Python<'_>,
        size: (usize, usize, usize),
        corner: [f64; 3],
        settings: &str,
    ) -> PyResult<Self> {
        let config: FogConfig = parse(py, settings)?;
        config.check().map_err(|error| bad_setting(py, &error))?;
        let (cols, rows, layers) = size;
        let holds = [cols, rows].iter().all(|n| (1..=2000).contains(n));
        if !holds || !(1..=64).contains(&layers) || corner.iter().any(|at| !at.is_finite()) {
            return Err(PyValueError::new_err(
                "size must be 1 to 2000 columns and rows and 1 to 64 layers, the corner finite",
            ));
        }
        let placement = Placement {
            lattice: Lattice {
                origin_m: [corner[0], corner[1]],
                cell_m: config.cell,
            },
            bottom_m: corner[2],
            layer_m: config.layer,
        };
        let table = ProbabilityTable::new(config.p_sense, config.p_occ, config.p_min, config.p_max);
        let size = Size { cols, rows, layers };
        Ok(Self {
            grid: OccupancyGrid::new(size, placement, table),
            config,
            size,
            seconds: 0.0,
        })
    }

    /// Takes in a frame's points, (n, 3) m, all seen from `eye`; what is further than `max_range` clears the way up to it. Returns
    /// how many points lie outside the grid; it is an `InputError` where they all do, and the eye.
    fn insert(
        &mut self,
        py: Python<'_>,
        points: &Bound<'_, PyArray2<f64>>,
        eye: [f64; 3],
    ) -> PyResult<usize> {
        let points = points.readonly();
        let flat = by_row(&points)?;
        if points.as_array().ncols() != 3 {
            return Err(PyValueError::new_err("points must be (n, 3)"));
        }
        let (points, _) = flat.as_chunks::<3>();
        if !eye.iter().all(|at| at.is_finite()) {
            return Err(PyValueError::new_err("the eye must be finite"));
        }
        let outside = self.outside(py, eye, points)?;
        let (grid, config) = (&mut self.grid, &self.config);
        let rays = rays(eye, points, config.max_range).map(|(_, ray)| ray);
        let started = Instant::now();
        let _area = run(py, || {
            grid.insert(eye, rays, config.update, config.clearing)
        })?;
        self.seconds = started.elapsed().as_secs_f64();
        Ok(outside)
    }

    /// Takes in a picture's points, (h, w, 3) m, NaN where nothing was seen. `camera`, (4, 4), is where it was taken: x to the right,
    /// y down, z forward. `focal` and `centre` are (along columns, along rows), pixels; each pixel's point lies on its line of sight.
    /// Returns how many points lie outside the grid; it is an `InputError` where they all do, and the camera.
    fn insert_picture(
        &mut self,
        py: Python<'_>,
        points: &Bound<'_, PyArray3<f64>>,
        camera: &Bound<'_, PyArray2<f64>>,
        focal: [f64; 2],
        centre: [f64; 2],
    ) -> PyResult<usize> {
        let points = points.readonly();
        let flat = by_row(&points)?;
        let (height, width, parts) = points.as_array().dim();
        if parts != 3 {
            return Err(PyValueError::new_err("points must be (h, w, 3)"));
        }
        let holds = focal.iter().all(|&px| px > 0.0 && px.is_finite());
        if !holds || !centre.iter().all(|px| px.is_finite()) {
            return Err(PyValueError::new_err(
                "focal must be > 0, and the centre finite",
            ));
        }
        let pose: Pose<Map, Camera> = rigid(&camera.readonly())?;
        let (points, _) = flat.as_chunks::<3>();
        let picture = Picture {
            size_px: [width, height],
            focal_px: focal,
            centre_px: centre,
            axes: Picture::axes_of(&pose),
        };
        let eye = pose.inner.translation.vector.into();
        let outside = self.outside(py, eye, points)?;
        let (grid, config) = (&mut self.grid, &self.config);
        let rays = rays(eye, points, config.max_range);
        let started = Instant::now();
        let _area = run(py, || {
            grid.insert_picture(eye, &picture, rays, config.update, config.clearing)
        })?;
        self.seconds = started.elapsed().as_secs_f64();
        Ok(outside)
    }

    /// (rows, columns, layers) float32: how likely each voxel is occupied.
    fn probability<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f32>>> {
        let Size { cols, rows, layers } = self.size;
        let placement = &self.grid.placement;
        let mut values = Vec::with_capacity(rows * cols * layers);
        for (row, col) in (0..rows).flat_map(|row| (0..cols).map(move |col| (row, col))) {
            let [x, y] = placement
                .lattice
                .center_of(geometry::Cell::new(col as i32, row as i32));
            values.extend((0..layers).map(|layer| {
                let z = placement.bottom_m + (layer as f64 + 0.5) * placement.layer_m;
                self.grid.probability([x, y, z]) as f32
            }));
        }
        values.into_pyarray(py).reshape([rows, cols, layers])
    }
}

impl PyOccupancyGrid {
    /// How many points lie outside the grid; refused where nothing of a frame lies in it.
    fn outside(&self, py: Python<'_>, eye: [f64; 3], points: &[[f64; 3]]) -> PyResult<usize> {
        let Placement {
            lattice,
            bottom_m,
            layer_m,
        } = self.grid.placement;
        let Size { cols, rows, layers } = self.size;
        let low = [lattice.origin_m[0], lattice.origin_m[1], bottom_m];
        let sides = [lattice.cell_m, lattice.cell_m, layer_m];
        let counts = [cols, rows, layers];
        let high: [f64; 3] =
            std::array::from_fn(|axis| low[axis] + counts[axis] as f64 * sides[axis]);
        let inside =
            |at: &[f64; 3]| (0..3).all(|axis| at[axis] >= low[axis] && at[axis] < high[axis]);
        let finite = points
            .iter()
            .filter(|at| at.iter().all(|one| one.is_finite()));
        let (mut count, mut held) = (0, inside(&eye));
        for point in finite.clone() {
            let holds = inside(point);
            held |= holds;
            count += usize::from(!holds);
        }
        match finite.clone().next() {
            Some(point) if !held => {
                let said = format!(
                    "the point at {point:?} m lies outside the grid, as all others and the eye: it goes from {low:?} to {high:?} m"
                );
                Err(bad_setting(py, &said))
            }
            _ => Ok(count),
        }
    }
}

/// The rays to the points that are numbers, each with the number of its point.
pub(crate) fn rays(
    eye_m: [f64; 3],
    points_m: &[[f64; 3]],
    max_range_m: f64,
) -> impl Iterator<Item = (usize, Ray)> {
    points_m
        .iter()
        .enumerate()
        .filter(|(_, at)| (at[0] + at[1] + at[2]).is_finite())
        .map(move |(index, &end_m)| (index, ray(eye_m, end_m, max_range_m)))
}

#[inline]
fn ray(eye_m: [f64; 3], end_m: [f64; 3], max_range_m: f64) -> Ray {
    /// A root is only taken where its rounding may decide.
    const SURELY: f64 = 1.0 - 1e-12;
    let along = [
        end_m[0] - eye_m[0],
        end_m[1] - eye_m[1],
        end_m[2] - eye_m[2],
    ];
    let squared = along[0] * along[0] + along[1] * along[1] + along[2] * along[2];
    if squared < SURELY * max_range_m * max_range_m {
        return Ray { end_m, hit: true };
    }
    let range_m = squared.sqrt();
    if range_m <= max_range_m {
        return Ray { end_m, hit: true };
    }
    let share = max_range_m / range_m;
    Ray {
        end_m: std::array::from_fn(|a| eye_m[a] + share * along[a]),
        hit: false,
    }
}

/// The values of an array as they lie in memory, which has to be row by row.
pub(crate) fn by_row<'a, D: Dimension>(
    array: &'a PyReadonlyArray<'_, f64, D>,
) -> PyResult<&'a [f64]> {
    array
        .as_slice()
        .ok()
        .filter(|_| array.is_c_contiguous())
        .ok_or_else(|| PyValueError::new_err("points must lie row by row in memory"))
}
