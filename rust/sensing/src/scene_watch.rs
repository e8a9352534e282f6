//! Two pictures held against the way that body and legs tell between them: a robot that was carried off, a camera that was turned.

mod config;
mod picture_fit;

use geometry::{Camera, Odometry, Pose, Robot};

pub use config::SceneWatchConfig;

use crate::{Scan, SenseFault};
use picture_fit::{EarlierPicture, PictureFit};

/// What two pictures tell of each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Claim {
    Carried,
    Turned,
}

/// Watches the scene. Claim: what stands still is where the picture before had it, for body and legs tell how the camera moved.
#[derive(Debug, Clone)]
pub struct SceneWatch {
    config: SceneWatchConfig,
    before: Option<EarlierPicture>,
    begin_ns: Option<u64>,
    claimed: Option<(Claim, u16)>,
    /// By which share of them the floor's disparities are off; kept to be reused.
    floor_off: Vec<f64>,
    carried: Option<SenseFault>,
    turned: Option<SenseFault>,
}

impl SceneWatch {
    /// Before the first picture.
    pub const fn new(config: SceneWatchConfig) -> Self {
        Self {
            config,
            before: None,
            begin_ns: None,
            claimed: None,
            floor_off: Vec::new(),
            carried: None,
            turned: None,
        }
    }

    /// That the robot was carried off, if it was.
    pub const fn carried(&self) -> Option<&SenseFault> {
        self.carried.as_ref()
    }

    /// That the camera was turned against the head, or measures otherwise than before, if so.
    pub const fn turned(&self) -> Option<&SenseFault> {
        self.turned.as_ref()
    }

    /// Takes in a picture, of which the robot itself was taken out, with where the robot was by the legs, and how far its torso was tilted, rad.
    pub fn look(
        &mut self,
        scan: &Scan,
        odometry_from_robot: &Pose<Odometry, Robot>,
        tilt_rad: f64,
    ) {
        if tilt_rad > self.config.upright {
            (self.before, self.begin_ns, self.claimed) = (None, None, None);
            return;
        }
        let odometry_from_camera = *odometry_from_robot * scan.robot_from_camera;
        let begin_ns = *self.begin_ns.get_or_insert(scan.exposure_ns);
        let settled = seconds(begin_ns, scan.exposure_ns) > self.config.settling;
        if settled && let Some(before) = self.before.take() {
            self.compare(&before, scan, &odometry_from_camera);
            self.before = Some(before);
        }
        if self.claimed.is_none() {
            self.keep(scan, &odometry_from_camera);
        }
    }

    /// Holds a picture against one before; what enough of them claim is believed.
    fn compare(
        &mut self,
        before: &EarlierPicture,
        scan: &Scan,
        odometry_from_camera: &Pose<Odometry, Camera>,
    ) {
        let pictures = self.claimed.map_or(0, |(_, pictures)| pictures);
        let between = f64::from(1 + pictures);
        let before_from_now = (before.odometry_from_camera.inverse() * *odometry_from_camera).inner;
        let passed_s = seconds(before.exposure_ns, scan.exposure_ns);
        let close = passed_s <= between * self.config.apart
            && before_from_now.rotation.angle() <= between * self.config.turn;
        let fit = close.then(|| {
            let (config, scratch) = (&self.config, &mut self.floor_off);
            PictureFit::of(scan, before, &before_from_now, config, scratch)
        });
        let claim = fit.and_then(|fit| self.claim(&fit));
        self.claimed = claim.map(|claim| match self.claimed {
            Some((same, pictures)) if same == claim => (claim, pictures + 1),
            _ => (claim, 1),
        });
        if let Some((claim, pictures)) = self.claimed
            && pictures >= self.config.pictures
        {
            self.believe(claim);
            self.claimed = None;
        }
    }

    fn believe(&mut self, claim: Claim) {
        let (fault, which, what) = match claim {
            Claim::Carried => (
                &mut self.carried,
                "legs and camera",
                "contradict each other: nothing that was seen a moment ago is where the legs have it; the robot was carried off",
            ),
            Claim::Turned => (
                &mut self.turned,
                "the depth camera",
                "sees the whole floor elsewhere than a moment ago: it was turned against the head, or measures otherwise",
            ),
        };
        let _ = fault.get_or_insert_with(|| SenseFault::new(which, what));
    }

    /// Keeps a picture to hold others against. Allocates nothing but for the first.
    fn keep(&mut self, scan: &Scan, odometry_from_camera: &Pose<Odometry, Camera>) {
        let picture = self.before.get_or_insert_with(|| EarlierPicture {
            disparity_px: Vec::new(),
            odometry_from_camera: *odometry_from_camera,
            robot_from_camera: scan.robot_from_camera,
            exposure_ns: 0,
        });
        picture.disparity_px.clone_from(&scan.disparity_px);
        picture.odometry_from_camera = *odometry_from_camera;
        picture.robot_from_camera = scan.robot_from_camera;
        picture.exposure_ns = scan.exposure_ns;
    }

    fn claim(&self, fit: &PictureFit) -> Option<Claim> {
        let config = &self.config;
        let compared = fit.compared as f64;
        if compared < config.shared * config.points as f64 {
            return None;
        }
        let (came, went) = (fit.nearer as f64, fit.farther as f64);
        let kept = fit.kept as f64;
        if came.min(went) >= config.changed * compared && kept <= config.kept * (kept + went) {
            return Some(Claim::Carried);
        }
        let [least, middle] = fit.floor_off;
        let turned = config.turned..config.turned_most;
        (least > config.floor_off && turned.contains(&middle)).then_some(Claim::Turned)
    }
}

fn seconds(from_ns: u64, until_ns: u64) -> f64 {
    until_ns.saturating_sub(from_ns) as f64 * 1e-9
}
