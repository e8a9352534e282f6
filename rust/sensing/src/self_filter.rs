//! Takes out of a scan what the robot sees of itself: its arms, knees and feet are no obstacles.

use geometry::{Camera, Pose, Torso};
use nalgebra::{Point3, Vector3};
use robot::{Body, LinkPoses, Side};
use settings::{ConfigError, NOT_NEGATIVE, POSITIVE, Table, settings};

use crate::Scan;

settings! {
    /// What of a depth image counts as the robot itself.
    pub struct SelfFilterConfig("navigation.self_filter") {
        /// Radius of limbs around the line from joint to joint.
        limb_radius: f64 = 0.03, "m", NOT_NEGATIVE;
        /// What else counts as the robot around its surface: the camera's pose is wrong by degrees.
        margin: f64 = 0.05, "m", NOT_NEGATIVE;
        /// Numbers of the filter that few will want to turn.
        tuning: SelfFilterTuning;
    }
}

settings! {
    /// Of which capsules the robot's body is made, and how they are seen.
    pub struct SelfFilterTuning("navigation.self_filter.tuning") {
        /// Limbs that are no longer are points inside another link's capsule, and have none.
        shortest: f64 = 0.002, "m", NOT_NEGATIVE;
        /// How far a limb's last link reaches, in the distance of its centre of mass.
        last_link: f64 = 2.0, "1", POSITIVE;
        /// Capsules that come nearer to the camera than this may be anywhere in the picture.
        nearest_depth: f64 = 0.02, "m", POSITIVE;
    }
}

/// A line with a radius, fixed to a link.
#[derive(Debug, Clone, PartialEq)]
struct Capsule {
    link: usize,
    ends: [Point3<f64>; 2],
    radius_m: f64,
}

/// Masks the robot's own body.
///
/// The body is a set of capsules: one from each link's origin to those of its children, one through each sole along
/// its length, and one from the origin of every other last link to twice its centre of mass. What carries the camera
/// does not count: it cannot stand before its own lens. A point is the robot's when it is within radius and margin of
/// a capsule, so nothing farther than the margin from the capsules' surface is ever taken out.
#[derive(Debug, Clone)]
pub struct SelfFilter {
    capsules: Vec<Capsule>,
    nearest_m: f64,
}

impl SelfFilter {
    /// The capsules of this body.
    pub fn new(body: &Body, config: &SelfFilterConfig) -> Result<Self, ConfigError> {
        config.check()?;
        let tuning = &config.tuning;
        let description = body.description();
        let mut capsules = Vec::new();
        let mut add = |link: usize, from: Point3<f64>, to: Point3<f64>, radius_m: f64| {
            if (to - from).norm() > tuning.shortest {
                capsules.push(Capsule {
                    link,
                    ends: [from, to],
                    radius_m: radius_m + config.margin,
                });
            }
        };
        for side in Side::BOTH {
            let sole = &description.legs.get(side).sole;
            let center = Point3::from(sole.position);
            let half = Vector3::x() * ((sole.length - sole.width).max(0.0) / 2.0);
            let radius_m = sole.width / 2.0;
            add(body.sole_link(side), center - half, center + half, radius_m);
        }
        for (i, link) in description.links.iter().enumerate() {
            if link.name == description.camera.link {
                continue;
            }
            if let Some(parent) = link.parent {
                let end = Point3::from(link.position);
                add(parent, Point3::origin(), end, config.limb_radius);
            }
            let is_last = description
                .links
                .iter()
                .all(|other| other.parent != Some(i));
            if is_last && Side::BOTH.iter().all(|&side| body.sole_link(side) != i) {
                let end = Point3::from(Vector3::from(link.center_of_mass) * tuning.last_link);
                add(i, Point3::origin(), end, config.limb_radius);
            }
        }
        Ok(Self {
            capsules,
            nearest_m: tuning.nearest_depth,
        })
    }

    /// Sets to *not seen* what belongs to the robot and returns the number of pixels. `links` are the poses at the
    /// exposure; `torso_from_camera` is the camera by the joints, or better corrected by the ground.
    pub fn mask(
        &self,
        scan: &mut Scan,
        links: &LinkPoses,
        torso_from_camera: &Pose<Torso, Camera>,
    ) -> usize {
        let camera_from_torso = torso_from_camera.inner.inverse();
        let mut masked = 0;
        for capsule in &self.capsules {
            let Some(pose) = links.torso_from_link.get(capsule.link) else {
                continue;
            };
            let camera_from_link = camera_from_torso * pose;
            let ends = capsule.ends.map(|end| camera_from_link * end);
            masked += mask_capsule(scan, &ends, capsule.radius_m, self.nearest_m);
        }
        scan.valid -= masked;
        masked
    }
}

fn mask_capsule(scan: &mut Scan, ends: &[Point3<f64>; 2], radius_m: f64, nearest_m: f64) -> usize {
    let Some([left, right, top, bottom]) = pixels_of(scan, ends, radius_m, nearest_m) else {
        return 0;
    };
    let camera = scan.camera;
    let scale = camera.focal_px * camera.baseline_m;
    let along = ends[1] - ends[0];
    let length2 = along.norm_squared();
    // What is farther than the capsule's far end is none of it.
    let least_px = (scale / (ends[0].z.max(ends[1].z) + radius_m)) as f32;
    let mut masked = 0;
    for row in top..bottom {
        for col in left..right {
            let disparity = &mut scan.disparity_px[row * camera.width + col];
            if disparity.is_nan() || *disparity < least_px {
                continue;
            }
            let depth_m = scale / f64::from(*disparity);
            let from_end = Vector3::from(camera.ray(col, row)) * depth_m - ends[0].coords;
            let part = (from_end.dot(&along) / length2).clamp(0.0, 1.0);
            if (from_end - along * part).norm_squared() < radius_m * radius_m {
                *disparity = f32::NAN;
                masked += 1;
            }
        }
    }
    masked
}

/// Columns and rows, from and up to, that a capsule in the camera's frame may cover: all of them where it comes nearer than
/// `nearest_m`; `None` when it is out of view.
fn pixels_of(
    scan: &Scan,
    ends: &[Point3<f64>; 2],
    radius_m: f64,
    nearest_m: f64,
) -> Option<[usize; 4]> {
    let (width, height) = (scan.camera.width, scan.camera.height);
    let nearest = ends[0].z.min(ends[1].z) - radius_m;
    if ends[0].z.max(ends[1].z) + radius_m <= 0.0 {
        return None;
    }
    if nearest < nearest_m {
        return Some([0, width, 0, height]);
    }
    let (cx, cy) = scan.camera.principal_point_px();
    let span = |center: f64, a: [f64; 2], b: [f64; 2], limit: usize| {
        // A ball's silhouette lies within that of the cube around it.
        let project = |lateral: f64, depth: f64, out: f64| {
            let edge = lateral + out * radius_m;
            let depth = depth - radius_m * (out * edge).signum();
            center + scan.camera.focal_px * edge / depth
        };
        let low = project(a[0], a[1], -1.0).min(project(b[0], b[1], -1.0));
        let high = project(a[0], a[1], 1.0).max(project(b[0], b[1], 1.0));
        let low = low.floor().clamp(0.0, limit as f64) as usize;
        let high = (high.ceil() + 1.0).clamp(0.0, limit as f64) as usize;
        (low < high).then_some((low, high))
    };
    let [a, b] = ends;
    let (left, right) = span(cx, [a.x, a.z], [b.x, b.z], width)?;
    let (top, bottom) = span(cy, [a.y, a.z], [b.y, b.z], height)?;
    Some([left, right, top, bottom])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Intrinsics;
    use proptest::prelude::*;

    const CAMERA: Intrinsics = Intrinsics {
        width: 88,
        height: 72,
        focal_px: 101.2,
        baseline_m: 0.06,
    };

    fn filter_of(ends: [Point3<f64>; 2]) -> SelfFilter {
        SelfFilter {
            capsules: vec![Capsule {
                link: 0,
                ends,
                radius_m: 0.08,
            }],
            nearest_m: SelfFilterTuning::default().nearest_depth,
        }
    }

    fn links() -> LinkPoses {
        LinkPoses {
            torso_from_link: vec![nalgebra::Isometry3::identity()],
        }
    }

    proptest! {
        #[test]
        fn exactly_the_points_within_the_radius_are_taken(
            x in -0.3..0.3f64, y in -0.3..0.3f64, z in 0.0..0.8f64, dx in -0.2..0.2f64, dz in -0.2..0.2f64,
            near in 0.1..0.6f64,
        ) {
            let ends = [Point3::new(x, y, z), Point3::new(x + dx, y, z + dz)];
            let mut scan = Scan::new(CAMERA);
            for (i, value) in scan.disparity_px.iter_mut().enumerate() {
                *value = CAMERA.disparity_px(near + 0.05 * (i % 7) as f64) as f32;
            }
            scan.valid = scan.disparity_px.len();
            let before = scan.clone();
            let masked = filter_of(ends).mask(&mut scan, &links(), &Pose::identity());
            let mut expected = 0;
            for row in 0..CAMERA.height {
                for col in 0..CAMERA.width {
                    let at = row * CAMERA.width + col;
                    let depth = CAMERA.focal_px * CAMERA.baseline_m / f64::from(before.disparity_px[at]);
                    let point = Vector3::from(CAMERA.ray(col, row)) * depth;
                    let along = ends[1] - ends[0];
                    let part = ((point - ends[0].coords).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
                    let within = (point - ends[0].coords - along * part).norm() < 0.08;
                    expected += usize::from(within);
                    prop_assert_eq!(scan.disparity_px[at].is_nan(), within);
                }
            }
            prop_assert_eq!(masked, expected);
            prop_assert_eq!(scan.valid, before.valid - expected);
        }
    }

    #[test]
    fn what_lies_behind_the_camera_takes_nothing() {
        let mut scan = Scan::new(CAMERA);
        scan.disparity_px.fill(10.0);
        let ends = [Point3::new(0.0, 0.0, -0.3), Point3::new(0.0, 0.1, -0.2)];
        assert_eq!(
            filter_of(ends).mask(&mut scan, &links(), &Pose::identity()),
            0
        );
    }
}
