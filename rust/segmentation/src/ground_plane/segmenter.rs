//! What a segmenter does with a scan, step by step.

use nalgebra::Vector2;
use sensing::Scan;

use super::reference::PoseReference;
use crate::camera_pose::Levelled;
use crate::ground_plane::grounded::Grounded;
use crate::planes::{KnownFloor, Planes, SegmentError, Segmenter};
use crate::regions::{Finder, Look};

impl<F: Finder> Grounded<F> {
    /// Shows the surfaces of the picture that was read as if the joints had the camera's pose right.
    fn show_uncorrected(&mut self, scan: &Scan, planes: &mut Planes) {
        let by_joints = Levelled::new(&self.camera, scan.robot_from_camera, Vector2::zeros());
        for look in [Look::First, Look::Again] {
            self.surfaces.find(&by_joints.view, look);
        }
        self.surfaces.refit(&by_joints.view);
        planes.exposure_ns = scan.exposure_ns;
        (planes.ground, planes.reliable) = (None, true);
        self.fill_product(&by_joints, 0.0, false, planes);
    }
}

impl<F: Finder> Segmenter for Grounded<F> {
    fn segment(&mut self, scan: &Scan, planes: &mut Planes) -> Result<(), SegmentError> {
        self.segment_known(scan, &|_, _| None, planes)
    }

    fn segment_known(
        &mut self,
        scan: &Scan,
        known: &KnownFloor<'_>,
        planes: &mut Planes,
    ) -> Result<(), SegmentError> {
        let expected = self.surfaces.labels.len();
        for found in [scan.disparity_px.len(), planes.labels.len()] {
            if found != expected {
                return Err(SegmentError::WrongSize { expected, found });
            }
        }
        self.surfaces.read(scan);
        self.on_slope = scan.on_slope;
        if !self.config.correct {
            self.show_uncorrected(scan, planes);
            return Ok(());
        }
        let (mut levelled, reference) = self.level_and_refer(&scan.robot_from_camera, known);
        let predicted = levelled.predicted;
        let turn = levelled.turn().scaled_axis().xy();
        let (mut ground, mut rise_m) = (None, 0.0);
        let searched = self.searching();
        match reference {
            PoseReference::Ground {
                region,
                rise_m: rise,
            } => {
                (ground, rise_m) = (Some(region), rise);
                self.surfaces.parts.roughness.learn(region);
                self.correction
                    .found(&predicted, &turn, rise_m, levelled.near);
            }
            PoseReference::Known { rise_m: rise } => {
                rise_m = rise;
                self.correction.found(&predicted, &turn, rise_m, false);
            }
            PoseReference::Level => self.correction.confirmed(),
            PoseReference::None => {
                if self.searching() || !self.is_straight(&levelled) {
                    // Nothing to hold on to: what is seen is shown where the joints have it.
                    levelled = Levelled::new(&self.camera, predicted, Vector2::zeros());
                    self.surfaces.find(&levelled.view, Look::Again);
                    self.surfaces.refit(&levelled.view);
                }
                self.correction.missed_one(self.config.forget_frames);
            }
        }
        planes.exposure_ns = scan.exposure_ns;
        planes.ground = ground;
        planes.reliable = self
            .correction
            .holds(self.config.hold_frames, self.config.hold_level_frames);
        self.fill_product(&levelled, rise_m, searched, planes);
        Ok(())
    }
}
