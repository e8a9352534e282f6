//! Where a laser took its scans: matched to local maps, loops closed.

use geometry::{PlanarPose, hypot};
use numpy::{PyArray2, ToPyArray, ndarray};
use plan_view::{PlanarBeam, PlanarScan};
use pyo3::prelude::*;
use scan_matching::{
    LocalMapsConfig, LoopsConfig, PoseGraphConfig, ScanMatchConfig, ScanSlam, ScanSlamConfig,
};

use crate::error::{bad_setting, parse, run};
use crate::plan_view::places;

/// The tables that a user may set.
#[derive(serde::Deserialize, Default)]
#[serde(default, deny_unknown_fields)]
struct SlamTables {
    scan_matcher: ScanMatchConfig,
    local_maps: LocalMapsConfig,
    loops: LoopsConfig,
    pose_graph: PoseGraphConfig,
}

/// Finds where a laser took its scans. `settings` is JSON: the tables `scan_matcher`, `local_maps`, `loops` and `pose_graph` of `[plan_view]`.
#[pyclass(name = "ScanSlam", module = "treadwell._core")]
pub(crate) struct PyScanSlam(ScanSlam);

#[pymethods]
impl PyScanSlam {
    #[new]
    #[pyo3(signature = (settings="{}"))]
    fn new(py: Python<'_>, settings: &str) -> PyResult<Self> {
        let tables: SlamTables = parse(py, settings)?;
        let config = ScanSlamConfig {
            matching: tables.scan_matcher,
            local_maps: tables.local_maps,
            loops: tables.loops,
            graph: tables.pose_graph,
        };
        let slam = ScanSlam::new(config).map_err(|error| bad_setting(py, &error))?;
        Ok(Self(slam))
    }

    /// Takes in a scan: points (n, 2), m in the laser's frame, NaN for nothing seen, and where odometry says that it was taken: x, y, m, and heading,
    /// rad. Of that only the step from the last one counts.
    fn insert(
        &mut self,
        py: Python<'_>,
        points: &Bound<'_, PyArray2<f64>>,
        odometry: [f64; 3],
    ) -> PyResult<()> {
        let beam = |at_m: [f64; 2]| {
            let range_m = hypot(at_m[0], at_m[1]);
            if range_m.is_finite() {
                PlanarBeam::new(libm::atan2(at_m[1], at_m[0]), Some(range_m))
            } else {
                PlanarBeam::new(0.0, None)
            }
        };
        let scan = PlanarScan {
            map_from_sensor: PlanarPose::new(odometry[0], odometry[1], odometry[2]),
            beams: places(points)?.into_iter().map(beam).collect(),
        };
        let slam = &mut self.0;
        run(py, || slam.insert(&scan))?.map_err(|error| bad_setting(py, &error))
    }

    /// Solves for all poses a last time.
    fn finish(&mut self, py: Python<'_>) -> PyResult<()> {
        let slam = &mut self.0;
        run(py, || slam.finish())
    }

    /// Where the scans were taken, (n, 3): x, y, m, and heading, rad, in the frame in which odometry placed the first.
    fn poses<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        let poses = self.0.poses();
        let rows = ndarray::Array2::from_shape_fn((poses.len(), 3), |(row, at)| {
            [poses[row].x_m, poses[row].y_m, poses[row].yaw_rad][at]
        });
        rows.to_pyarray(py)
    }

    /// How many local maps there are, loops are closed, and scans fit nowhere near, so that odometry was believed.
    fn counts(&self) -> [usize; 3] {
        let slam = &self.0;
        [
            slam.local_maps().count(),
            slam.closed_loops(),
            slam.unmatched(),
        ]
    }
}
