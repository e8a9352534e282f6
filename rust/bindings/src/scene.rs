//! What is in a room: groups of a depth picture's pixels, what each is, and a map of labels.

use classification::{
    DepthPicture, GroupingConfig, Groups, Label, LabelMap, LabelMapConfig, MarkovFieldConfig,
    SceneClasses, SceneGrouping, ShapesConfig, TrainedConfig,
};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, ToPyArray, ndarray};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::Deserialize;

use crate::error::{bad_setting, failed, parse, run};
use crate::pose::rigid;

/// `[classification]`, as far as it is about rooms.
#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct SceneTables {
    grouping: GroupingConfig,
    shapes: ShapesConfig,
    trained: TrainedConfig,
    label_map: LabelMapConfig,
    markov_field: MarkovFieldConfig,
}

/// Tells floor, step, wall, furniture, clutter and doors apart in depth pictures, and keeps a map of them (004, section 36.3.5).
#[pyclass(name = "SceneLabels", module = "treadwell._core")]
pub(crate) struct PySceneLabels {
    grouping: SceneGrouping,
    classes: SceneClasses,
    map: LabelMap,
    groups: Groups,
    cols: usize,
}

#[pymethods]
impl PySceneLabels {
    /// `settings` is JSON: `[classification]`. `examples`: features (n, k) of groups and labels (n,), in place of those that it knows.
    #[new]
    #[pyo3(signature = (settings="{}", examples=None))]
    fn new(
        py: Python<'_>,
        settings: &str,
        examples: Option<(Bound<'_, PyArray2<f64>>, Vec<usize>)>,
    ) -> PyResult<Self> {
        let tables: SceneTables = parse(py, settings)?;
        let bad = |error: &dyn std::fmt::Display| bad_setting(py, &error);
        let classes = match examples {
            None => SceneClasses::known(tables.shapes.clone()),
            Some((features, labels)) => {
                let features = features.readonly();
                let rows = features.as_array();
                let rows = rows.rows().into_iter().map(|row| row.to_vec());
                let rows: Vec<_> = rows.zip(labels).collect();
                SceneClasses::learned(&tables.trained, tables.shapes.clone(), &rows)
            }
        };
        Ok(Self {
            grouping: SceneGrouping::new(tables.grouping, tables.shapes)
                .map_err(|error| bad(&error))?,
            classes: classes.map_err(|error| bad(&error))?,
            map: LabelMap::new(tables.label_map, tables.markov_field)
                .map_err(|error| bad(&error))?,
            groups: Groups {
                of_pixel: Vec::new(),
                each: Vec::new(),
            },
            cols: 1,
        })
    }

    /// Takes in a picture: depth (h, w) float32 m, NaN where nothing was seen; `map_from_camera` (4, 4) of the optical frame in a map
    /// whose floor is z = 0; focal lengths and axis in pixels, standard deviation of an inverse depth, 1/m,
    /// or None: it is estimated from the picture; whether the map keeps it. False where the picture says too little.
    #[expect(clippy::too_many_arguments, reason = "one argument of Python's each")]
    #[pyo3(signature = (depth, map_from_camera, *, focal, centre, noise=None, keep=true))]
    fn insert(
        &mut self,
        py: Python<'_>,
        depth: &Bound<'_, PyArray2<f32>>,
        map_from_camera: &Bound<'_, PyArray2<f64>>,
        focal: [f64; 2],
        centre: [f64; 2],
        noise: Option<f64>,
        keep: bool,
    ) -> PyResult<bool> {
        let depth = depth.readonly();
        let depth = depth.as_array();
        let inverse: Vec<f32> = depth.iter().map(|depth| depth.recip()).collect();
        let cols = depth.ncols();
        let Some(noise) = noise.or_else(|| self.grouping.noise(cols, &inverse)) else {
            return Ok(false);
        };
        let picture = DepthPicture {
            cols,
            inverse_depths_per_m: inverse,
            focal_px: focal,
            centre_px: centre,
            sigma_per_m: noise,
            map_from_camera: rigid(&map_from_camera.readonly())?,
        };
        let Self {
            grouping,
            classes,
            map,
            groups,
            cols,
        } = self;
        *groups = run(py, || grouping.group(&picture))?.map_err(|error| failed(py, &error))?;
        *cols = picture.cols;
        if keep {
            run(py, || map.insert(&picture, groups, classes))?;
        }
        Ok(true)
    }

    /// (h, w) uint16: the group of each of the last picture's pixels, counted from 1; 0 of none.
    #[getter]
    fn groups<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u16>>> {
        image(py, self.groups.of_pixel.clone(), self.cols)
    }

    /// (h, w) uint8: the likeliest label of each of the last picture's pixels by its group alone, as in `names`; 255 of none.
    #[getter]
    fn labels<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u8>>> {
        let of_group: Vec<u8> = (self.groups.each.iter())
            .map(|group| {
                let costs = self.classes.costs(group);
                let better = |a: usize, b: usize| if costs[b] < costs[a] { b } else { a };
                (0..costs.len()).reduce(better).unwrap_or(0) as u8
            })
            .collect();
        let of_pixel = self.groups.of_pixel.iter().map(|number| {
            usize::from(*number)
                .checked_sub(1)
                .map_or(u8::MAX, |group| of_group[group])
        });
        image(py, of_pixel.collect(), self.cols)
    }

    /// (n, k): what labels are told by, of each of the last picture's groups.
    #[getter]
    fn features<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let rows: Vec<_> = self
            .groups
            .each
            .iter()
            .map(|group| self.classes.features(group))
            .collect();
        PyArray2::from_vec2(py, &rows).map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// The map: places (n, 3) m, labels (n,) uint8 as in `names`, and those by the pictures alone, before neighbours smoothed them.
    #[expect(clippy::type_complexity, reason = "three arrays")]
    fn points<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(
        Bound<'py, PyArray2<f64>>,
        Bound<'py, PyArray1<u8>>,
        Bound<'py, PyArray1<u8>>,
    )> {
        let points = run(py, || self.map.points())?.map_err(|error| bad_setting(py, &error))?;
        let places: Vec<f64> = points.iter().flat_map(|point| point.place_m).collect();
        let places = ndarray::Array2::from_shape_vec((points.len(), 3), places)
            .map_err(|error| PyValueError::new_err(error.to_string()))?;
        let labels: Vec<u8> = points.iter().map(|point| point.label as u8).collect();
        let alone: Vec<u8> = points.iter().map(|point| point.alone as u8).collect();
        Ok((
            places.into_pyarray(py),
            labels.to_pyarray(py),
            alone.to_pyarray(py),
        ))
    }

    /// What it knows of labels, as text: that of `learned.txt` in the crate `classification`.
    #[getter]
    fn learned(&self) -> String {
        self.classes.text()
    }

    /// The labels' names, in the order of their numbers.
    #[staticmethod]
    fn names() -> Vec<&'static str> {
        Label::ALL.iter().map(|label| label.name()).collect()
    }
}

/// Values of pixels as rows and columns.
fn image<T: numpy::Element>(
    py: Python<'_>,
    values: Vec<T>,
    cols: usize,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let shape = (values.len() / cols.max(1), cols);
    ndarray::Array2::from_shape_vec(shape, values)
        .map(|values| values.into_pyarray(py))
        .map_err(|error| PyValueError::new_err(error.to_string()))
}
