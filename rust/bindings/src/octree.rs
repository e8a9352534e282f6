//! The octree alone: maps from points, from OctoMap's files and into them, and the rays in them.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use mapping::Update;
use numpy::ndarray::ArrayView1;
use numpy::{AllowTypeChange, IntoPyArray, PyArray1, PyArray2, PyArrayLike2, PyArrayMethods};
use pyo3::prelude::*;
use volume::octree::{Cast, Leaf, Octree, OctreeConfig, Sighting};

use crate::components::unlike;
use crate::error::{bad_setting, parse, run};
use crate::world_model::rays;

/// Rows of three metres each, and one number a row.
pub(crate) type Rows<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<f64>>);

/// Occupancy of the space around the origin, as OctoMap keeps it.
#[pyclass(name = "Octree", module = "treadwell._core")]
pub(crate) struct PyOctree {
    /// Shared with the cores that were told it as their map.
    tree: Arc<Octree>,
    /// Time that the core itself took for the last frame, s.
    #[pyo3(get)]
    seconds: f64,
}

#[pymethods]
impl PyOctree {
    /// A tree of which nothing is known, with voxels of `resolution`, m. `settings` is JSON: `p_hit`, `p_miss`, `p_min`, `p_max`.
    #[new]
    #[pyo3(signature = (resolution=0.04, *, settings="{}"))]
    fn new(py: Python<'_>, resolution: f64, settings: &str) -> PyResult<Self> {
        let config = OctreeConfig {
            resolution,
            ..parse(py, settings)?
        };
        let tree = Octree::new(config).map_err(|error| bad_setting(py, &error))?;
        Ok(Self::of(tree))
    }

    /// Reads a file of OctoMap's, `.bt` or `.ot`.
    #[staticmethod]
    fn read(py: Python<'_>, path: &str) -> PyResult<Self> {
        let tree = run(py, || Octree::read(Path::new(path)))?;
        let tree = tree.map_err(|error| bad_setting(py, &error))?;
        Ok(Self::of(tree))
    }

    /// Writes a file that OctoMap reads, of the format that its name ends in: `.bt` or `.ot`.
    fn write(&self, py: Python<'_>, path: &str) -> PyResult<()> {
        let tree = &self.tree;
        run(py, || tree.write(Path::new(path)))?.map_err(|error| bad_setting(py, &error))
    }

    /// Takes in a frame's points, (n, 3) m, all seen from `eye`; what is further than `max_range` clears the way up to it. Points
    /// that are no numbers are left out. A voxel changes once a frame, and a hit wins, or by `each_point`. Returns how many points
    /// were left out since they lie beyond the 2^16 voxels along each axis; it is an `InputError` where they all do, and the eye.
    #[pyo3(signature = (points, eye, *, max_range=f64::INFINITY, each_point=false))]
    fn insert(
        &mut self,
        py: Python<'_>,
        points: &Bound<'_, PyAny>,
        eye: [f64; 3],
        max_range: f64,
        each_point: bool,
    ) -> PyResult<usize> {
        let points = triples("points", points)?;
        if max_range <= 0.0 || max_range.is_nan() {
            return Err(bad_setting(py, &"max_range must be > 0"));
        }
        let update = if each_point {
            Update::PerPoint
        } else {
            Update::PerFrame
        };
        let tree = Arc::make_mut(&mut self.tree);
        let started = Instant::now();
        let beyond = run(py, || {
            let rays: Vec<_> = rays(eye, &points, max_range).map(|(_, ray)| ray).collect();
            tree.insert(eye, &rays, update)
        })?
        .map_err(|error| bad_setting(py, &error))?;
        self.seconds = started.elapsed().as_secs_f64();
        Ok(beyond)
    }

    /// Makes the voxels of points, (n, 3) m, occupied: a map that is told, not seen. Points that are no numbers are left out, and
    /// those beyond the 2^16 voxels along each axis: their number is returned; it is an `InputError` where all are.
    fn occupy(&mut self, py: Python<'_>, points: &Bound<'_, PyAny>) -> PyResult<usize> {
        let points = triples("points", points)?;
        let tree = Arc::make_mut(&mut self.tree);
        run(py, || tree.occupy(&points))?.map_err(|error| bad_setting(py, &error))
    }

    /// The occupied leaves: (n, 3) m, their centres, and (n,) m, their sides.
    fn occupied<'py>(&self, py: Python<'py>) -> PyResult<Rows<'py>> {
        self.cubes(py, Leaf::is_occupied)
    }

    /// The free leaves, likewise.
    fn free<'py>(&self, py: Python<'py>) -> PyResult<Rows<'py>> {
        self.cubes(py, |leaf| !leaf.is_occupied())
    }

    /// (n,) float32: log-odds of points, (n, 3) m; NaN where nothing is known.
    fn log_odds<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'_, PyAny>,
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let points = triples("points", points)?;
        let at = |point: &[f64; 3]| self.tree.log_odds_at(*point).unwrap_or(f32::NAN);
        Ok(points.iter().map(at).collect::<Vec<_>>().into_pyarray(py))
    }

    /// For rays from (n, 3) m in directions (n, 3): the centres (n, 3) m of the first occupied voxels, and how far they are from
    /// where the rays begin, (n,) m; NaN where a ray meets none within `max_range`, or first, unless `through_unknown`, what is
    /// unknown.
    #[pyo3(signature = (origins, directions, max_range=f64::INFINITY, *, through_unknown=true))]
    fn cast_rays<'py>(
        &self,
        py: Python<'py>,
        origins: &Bound<'_, PyAny>,
        directions: &Bound<'_, PyAny>,
        max_range: f64,
        through_unknown: bool,
    ) -> PyResult<Rows<'py>> {
        let origins = triples("origins", origins)?;
        let directions = triples("directions", directions)?;
        must_be_rays(py, &origins, &directions, max_range)?;
        let (tree, max_range_m) = (&self.tree, max_range);
        let sighting = Sighting {
            max_range_m,
            through_unknown,
        };
        let cast = |(origin, direction): (&[f64; 3], &[f64; 3])| match tree
            .cast_ray(*origin, *direction, sighting)
        {
            Cast::Occupied(end) => (end, distance(end, *origin)),
            Cast::Unknown(_) | Cast::Nothing => ([f64::NAN; 3], f64::NAN),
        };
        let found = run(py, || origins.iter().zip(&directions).map(cast).unzip())?;
        rows(py, found)
    }

    fn __repr__(&self) -> String {
        format!("<Octree with voxels of {} m>", self.resolution())
    }

    /// Side of the smallest voxels, m.
    #[getter]
    fn resolution(&self) -> f64 {
        self.tree.config.resolution
    }

    /// Inner nodes and leaves.
    #[getter]
    fn nodes(&self) -> usize {
        self.tree.node_count()
    }

    /// What the tree takes.
    #[getter]
    fn size_bytes(&self) -> usize {
        self.tree.bytes()
    }
}

impl PyOctree {
    fn of(tree: Octree) -> Self {
        Self {
            tree: Arc::new(tree),
            seconds: 0.0,
        }
    }

    /// The tree, to be read.
    pub(crate) fn tree(&self) -> Arc<Octree> {
        Arc::clone(&self.tree)
    }

    fn cubes<'py>(&self, py: Python<'py>, wanted: impl Fn(&Leaf) -> bool) -> PyResult<Rows<'py>> {
        let resolution = self.tree.config.resolution;
        let cube = |leaf: Leaf| {
            let side = f64::from(leaf.edge()) * resolution;
            (self.tree.centre_m(&leaf), side)
        };
        rows(py, self.tree.leaves().filter(wanted).map(cube).unzip())
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let squared = |axis: usize| (a[axis] - b[axis]) * (a[axis] - b[axis]);
    (squared(0) + squared(1) + squared(2)).sqrt()
}

pub(crate) fn rows(
    py: Python<'_>,
    (points, numbers): (Vec<[f64; 3]>, Vec<f64>),
) -> PyResult<Rows<'_>> {
    let count = points.len();
    let points = points.into_flattened().into_pyarray(py);
    Ok((points.reshape([count, 3])?, numbers.into_pyarray(py)))
}

/// Refuses what makes no rays: as many origins as directions, and a reach.
pub(crate) fn must_be_rays(
    py: Python<'_>,
    origins: &[[f64; 3]],
    directions: &[[f64; 3]],
    max_range: f64,
) -> PyResult<()> {
    if origins.len() != directions.len() || max_range <= 0.0 || max_range.is_nan() {
        return Err(bad_setting(
            py,
            &"origins and directions must be as many, max_range > 0",
        ));
    }
    Ok(())
}

/// The rows of what numpy makes an (n, 3) array of numbers, of any type and stride.
pub(crate) fn triples(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Vec<[f64; 3]>> {
    let array: Result<PyArrayLike2<'_, f64, AllowTypeChange>, _> = given.extract();
    match &array {
        Ok(array) if array.as_array().ncols() == 3 => {
            let array = array.as_array();
            let triple = |row: ArrayView1<'_, f64>| [row[0], row[1], row[2]];
            Ok(array.rows().into_iter().map(triple).collect())
        }
        _ => {
            let error = unlike(name, given, "numbers (n, 3)");
            Err(bad_setting(given.py(), &error.value(given.py())))
        }
    }
}
