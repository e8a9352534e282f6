//! Scans laid onto lines: their poses moved a little so that walls that are seen again lie on each other.

use geometry::PlanarPose;
use settings::{ConfigError, POSITIVE, Table, at_least, settings};

use super::finder::{LineError, LineFinder};
use super::line::PlanarLine;
use super::search::FoundLines;
use crate::pose_step::PoseStep;
use crate::scan::PlanarScan;

settings! {
    /// How scans whose poses are nearly right are laid onto the lines of all of them.
    pub struct AlignmentConfig("plan_view.alignment") {
        /// Standard deviation of a pose's position along each axis, as it is given.
        position_sigma: f64 = 0.02, "m", POSITIVE;
        /// Standard deviation of its heading.
        heading_sigma: f64 = 0.01, "rad", POSITIVE;
        /// Standard deviation of points off their line.
        sigma: f64 = 0.03, "m", POSITIVE;
        /// Points this far off the nearest line count a quarter; further off ever less.
        far: f64 = 0.04, "m", POSITIVE;
        /// Points of a scan that tell as much as one alone: what is seen side by side errs together.
        together: f64 = 8.0, "1", at_least(1.0);
        /// Least-squares steps for a scan, each from the nearest lines anew.
        steps: usize = 4, "1", at_least(1.0);
        /// Times that the lines are found anew with the scans laid onto those before.
        rounds: usize = 5, "1", at_least(1.0);
    }
}

/// Lays scans onto lines.
#[derive(Debug, Clone)]
pub struct LineAlignment {
    config: AlignmentConfig,
}

impl LineAlignment {
    /// With settings.
    pub fn new(config: AlignmentConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self { config })
    }

    /// Lines of scans and the scans' poses together: the lines are found, each scan is laid onto them from the pose that it was given, and so on.
    /// The lines are those of the poses that come with them, in the order of the scans.
    pub fn find(
        &self,
        finder: &LineFinder,
        scans: &[PlanarScan],
    ) -> Result<(FoundLines, Vec<PlanarPose>), LineError> {
        let mut placed = scans.to_vec();
        let ends = |placed: &[PlanarScan]| -> Vec<_> {
            placed.iter().flat_map(PlanarScan::ends_m).collect()
        };
        let mut found = finder.find(&ends(&placed))?;
        for _ in 0..self.config.rounds {
            let lines = found.mixture.lines();
            for (scan, given) in placed.iter_mut().zip(scans) {
                scan.map_from_sensor = self.align(scan, &given.map_from_sensor, lines);
            }
            found = finder.find(&ends(&placed))?;
        }
        let poses = placed.iter().map(|scan| scan.map_from_sensor);
        Ok((found, poses.collect()))
    }

    /// The pose at which a scan lies best on lines, from where it is: least squares of the distances to the nearest lines, what is far off counting
    /// little, and of how far the pose is from the one that was given.
    pub fn align(&self, scan: &PlanarScan, given: &PlanarPose, lines: &[PlanarLine]) -> PlanarPose {
        let forms: Vec<_> = lines.iter().map(PlanarLine::normal_form).collect();
        let mut scan = scan.clone();
        for _ in 0..self.config.steps {
            let Some(pose) = self.step(&scan, given, &forms) else {
                break;
            };
            scan.map_from_sensor = pose;
        }
        scan.map_from_sensor
    }

    /// The pose after a step of Gauss and Newton. None where the numbers do not tell.
    fn step(
        &self,
        scan: &PlanarScan,
        given: &PlanarPose,
        forms: &[[f64; 3]],
    ) -> Option<PlanarPose> {
        let (config, pose) = (&self.config, scan.map_from_sensor);
        let own = config.together * config.sigma * config.sigma;
        let [place, heading] =
            [config.position_sigma, config.heading_sigma].map(|sigma| own / (sigma * sigma));
        let mut step = PoseStep::default();
        let held = [[place, 0.0, 0.0], [0.0, place, 0.0], [0.0, 0.0, heading]];
        step.hold(&pose, given, &held);
        for [x_m, y_m] in scan.ends_m() {
            let off = |form: &[f64; 3]| x_m * form[0] + y_m * form[1] - form[2];
            let nearest = forms
                .iter()
                .min_by(|one, other| off(one).abs().total_cmp(&off(other).abs()))?;
            let off_m = off(nearest);
            let [cos, sin, _] = *nearest;
            let (right_m, up_m) = (x_m - pose.x_m, y_m - pose.y_m);
            let share = off_m / config.far;
            let weight = 1.0 / ((1.0 + share * share) * (1.0 + share * share));
            step.add(weight, [cos, sin, right_m * sin - up_m * cos], off_m);
        }
        step.taken(&pose)
    }
}
