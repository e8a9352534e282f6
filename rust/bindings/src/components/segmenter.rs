//! A segmenter of the user's: it labels pixels and corrects the camera's pose; planes are fitted here.

use geometry::{Outline, Plane, Point};
use nalgebra::{Matrix3, Point2, Point3, SymmetricEigen, Unit, Vector3};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::intern;
use pyo3::prelude::*;
use segmentation::{PlaneRegion, Planes, SegmentError, Segmenter};
use sensing::Scan;

use super::{FARTHEST_M, attribute, check_within, sentence, something};
use crate::pose::rigid;
use crate::situation::PyScan;

struct PythonSegmenter(Py<PyAny>);

/// Wraps an object with the method of `treadwell.protocols.Segmenter`.
pub(crate) fn segmenter(object: Py<PyAny>) -> Box<dyn Segmenter> {
    Box::new(PythonSegmenter(object))
}

impl Segmenter for PythonSegmenter {
    fn segment(&mut self, scan: &Scan, planes: &mut Planes) -> Result<(), SegmentError> {
        Python::attach(|py| {
            let argument = (PyScan(scan.clone()),);
            let answer = self
                .0
                .bind(py)
                .call_method1(intern!(py, "segment"), argument)?;
            read_segmentation(&answer, scan, planes)
        })
        .map_err(|error| SegmentError::Failed(sentence(&error)))
    }
}

fn read_segmentation(answer: &Bound<'_, PyAny>, scan: &Scan, planes: &mut Planes) -> PyResult<()> {
    const OF: &str = "segment()";
    something(answer, OF, "a Segmentation")?;
    let labels: PyReadonlyArray1<'_, u16> = attribute(answer, (OF, "labels"), "uint16 (pixels,)")?;
    let heights: Vec<Option<f64>> =
        attribute(answer, (OF, "floor_heights"), "a list of float m or None")?;
    let pose: PyReadonlyArray2<'_, f64> =
        attribute(answer, (OF, "robot_from_camera"), "float64 (4, 4)")?;
    let ground: Option<usize> = attribute(answer, (OF, "ground"), "int or None")?;
    let labels = labels.as_array();
    if labels.len() != planes.labels.len() {
        let (expected, found) = (planes.labels.len(), labels.len());
        return Err(PyValueError::new_err(format!(
            "labels must have {expected} values, got {found}"
        )));
    }
    check_within(
        "floor_heights",
        heights.iter().flatten().copied(),
        FARTHEST_M,
    )?;
    if let Some(label) = labels
        .iter()
        .find(|&&label| usize::from(label) > heights.len())
    {
        let most = heights.len();
        return Err(PyValueError::new_err(format!(
            "labels must be at most {most}, got {label}"
        )));
    }
    if ground.is_some_and(|ground| ground >= heights.len()) {
        return Err(PyValueError::new_err(format!(
            "ground must be one of the {} regions that floor_heights has, counted from 0, or None; got {}",
            heights.len(),
            ground.unwrap_or_default()
        )));
    }
    planes.robot_from_camera = rigid(&pose)?;
    planes.exposure_ns = scan.exposure_ns;
    // Each point lies on its pixel's line of sight: models see through what lies before it.
    planes.camera = Some(scan.camera);
    planes.ground = ground;
    planes.reliable = attribute(answer, (OF, "reliable"), "bool")?;
    for (slot, label) in planes.labels.iter_mut().zip(labels) {
        *slot = *label;
    }
    place_points(scan, &heights, planes);
    planes.regions.clear();
    for (index, height) in heights.iter().enumerate() {
        planes.regions.push(fit(planes, index as u16 + 1, *height));
    }
    Ok(())
}

fn place_points(scan: &Scan, heights: &[Option<f64>], planes: &mut Planes) {
    let camera = scan.camera;
    for (index, disparity) in scan.disparity_px.iter().enumerate() {
        let depth = camera.focal_px * camera.baseline_m / f64::from(*disparity);
        let ray = camera.ray(index % camera.width, index / camera.width);
        let point = planes.robot_from_camera.inner * Point3::from(Vector3::from(ray) * depth);
        planes.points_in_robot_m[index] = [point.x as f32, point.y as f32, point.z as f32];
        let region = usize::from(planes.labels[index]).checked_sub(1);
        let height = region.and_then(|region| heights[region]);
        planes.floor_height_m[index] = height.map_or(f32::NAN, |height| height as f32);
    }
}

/// Total least squares through the points of a region.
fn fit(planes: &Planes, label: u16, floor_height_m: Option<f64>) -> PlaneRegion {
    let points = || {
        planes
            .labels
            .iter()
            .zip(&planes.points_in_robot_m)
            .filter(move |(found, point)| **found == label && point[0].is_finite())
            .map(|(_, point)| Vector3::from(point.map(f64::from)))
    };
    let support = points().count();
    let mean = points().sum::<Vector3<f64>>() / support.max(1) as f64;
    let scatter: Matrix3<f64> = points().map(|p| (p - mean) * (p - mean).transpose()).sum();
    let eigen = SymmetricEigen::new(scatter);
    let normal = Unit::new_normalize(
        eigen
            .eigenvectors
            .column(eigen.eigenvalues.imin())
            .into_owned(),
    );
    let camera = planes.robot_from_camera.inner.translation.vector;
    let normal = if normal.dot(&(camera - mean)) < 0.0 {
        -normal
    } else {
        normal
    };
    let boundary = floor_height_m.and_then(|_| {
        let corners: Vec<_> = points().map(|point| Point2::from(point.xy())).collect();
        Outline::hull(&corners).ok()
    });
    PlaneRegion {
        support,
        mean: Point::wrap(Point3::from(mean)),
        plane: Plane {
            normal,
            distance_m: normal.dot(&mean),
        },
        boundary,
        floor_height_m,
        roughness: None,
    }
}
