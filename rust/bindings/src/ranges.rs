//! Rays through a map that does not change, as the localizer `monte_carlo` casts them.

use std::sync::Arc;

use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use volume::{LANES, Lanes, RangeField, SolidError, SolidVoxels};

use crate::error::{bad_setting, run};
use crate::octree::{PyOctree, must_be_rays, triples};

/// How far rays get among the occupied voxels of an octree.
#[pyclass(name = "RangeField", module = "treadwell._core")]
pub(crate) struct PyRangeField(RangeField);

#[pymethods]
impl PyRangeField {
    /// Of an octree as it is now.
    #[new]
    fn new(py: Python<'_>, octree: &PyOctree) -> PyResult<Self> {
        let tree = octree.tree();
        run(py, || {
            Ok(Self(RangeField::new(&Arc::new(SolidVoxels::occupied(
                &tree,
            )?))))
        })?
        .map_err(|error: SolidError| bad_setting(py, &error))
    }

    /// For rays from (n, 3) m along unit vectors (n, 3): how far it is to where each enters an occupied voxel, (n,) m, infinity
    /// where there is none within `max_range`. Eight rays at a time are followed side by side.
    fn cast<'py>(
        &self,
        py: Python<'py>,
        origins: &Bound<'_, PyAny>,
        directions: &Bound<'_, PyAny>,
        max_range: f64,
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let origins = triples("origins", origins)?;
        let directions = triples("directions", directions)?;
        must_be_rays(py, &origins, &directions, max_range)?;
        let (field, mut ends_m) = (&self.0, vec![0.0; origins.len()]);
        let cast = || {
            for (first, ends_m) in ends_m.chunks_mut(LANES).enumerate() {
                let ray = |lane: usize| first * LANES + lane.min(ends_m.len() - 1);
                let of = |a: usize, rows: &[[f64; 3]]| {
                    std::array::from_fn::<f64, LANES, _>(|lane| rows[ray(lane)][a])
                };
                let from = field.in_voxels(&std::array::from_fn(|a| of(a, &origins)));
                let along = std::array::from_fn(|a| of(a, &directions).map(|v| v as f32).into());
                let reach_m = Lanes::splat(max_range as f32);
                let found_m = field.cast_side_by_side(&from, &along, reach_m).to_array();
                ends_m.copy_from_slice(&found_m[..ends_m.len()]);
            }
        };
        run(py, cast)?;
        Ok(ends_m.into_pyarray(py))
    }
}
