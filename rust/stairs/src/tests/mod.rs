//! What recognition must do as a whole, on synthetic scenes through the real segmenter.

mod exact;
mod frames;
mod prisms;
mod remembered;
mod slopes;

use geometry::{Camera, Map, Pose, Robot};
use segmentation::finders::{ScanLine, ScanLineConfig};
use segmentation::{GroundConfig, Planes, Segmenter};
use sensing::Scan;

use crate::synthetic::{Block, CAMERA, Noise, Scene, camera_pose};
use crate::{Recognizer, Staircase, StairsConfig};

/// The sensor's noise, px.
const SIGMA: f64 = 0.125;

/// A robot that stands and looks.
struct Looker {
    segmenter: ScanLine,
    recognizer: Recognizer,
    planes: Planes,
    noise: Noise,
    sigma_px: f64,
}

impl Looker {
    /// Has seen open floor, and tracks the ground.
    fn new(seed: u64, sigma_px: f64) -> Self {
        Self::with(StairsConfig::default(), seed, sigma_px)
    }

    fn with(config: StairsConfig, seed: u64, sigma_px: f64) -> Self {
        let mut looker = Self {
            segmenter: ScanLine::new(&ScanLineConfig::default(), GroundConfig::default(), CAMERA)
                .unwrap(),
            recognizer: Recognizer::new(config, CAMERA).unwrap(),
            planes: Planes::new(CAMERA.width * CAMERA.height),
            noise: Noise::new(seed),
            sigma_px,
        };
        for _ in 0..10 {
            let _ = looker.look(
                &Scene::floor(),
                &camera_pose(0.0, 0.75),
                &Pose::identity(),
                0,
            );
        }
        looker
    }

    fn look(
        &mut self,
        scene: &Scene,
        camera: &Pose<Robot, Camera>,
        map_from_robot: &Pose<Map, Robot>,
        steps: u64,
    ) -> &Staircase {
        let scan: Scan = scene.scan(camera, *camera, self.sigma_px, &mut self.noise);
        self.segmenter.segment(&scan, &mut self.planes).unwrap();
        self.recognizer
            .update(&scan, &self.planes, map_from_robot, steps)
            .unwrap()
    }
}
