//! Test support: a small biped with a head, and a world in which its joints follow their targets at once.

use std::collections::BTreeMap;

use behaviour::Command;
use geometry::{PlanarPose, Pose};
use nalgebra::{UnitQuaternion, Vector3};
use proprioception::BodyState;
use robot::{
    Body, CameraMount, Description, Extent, Head, ImuMount, JointDescription, Leg, Legs,
    LinkDescription, LinkPoses, Side, Sole, StereoDescription,
};
use sensing::Observation;

use crate::config::GaitConfig;
use crate::dcm_walker::DcmWalker;
use crate::footsteps::FootstepPlanner;
use crate::gait::Gait;
use crate::phase::{FootPose, GaitPhase, Swing};
use crate::relief::Slopes;
use crate::targets::JointTargets;
use crate::walker::{Walker, WalkerSenses};

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];
const LEG: [(&str, [f64; 3]); 6] = [
    ("hip_yaw", Z),
    ("hip_roll", X),
    ("hip_pitch", Y),
    ("knee", Y),
    ("ankle_pitch", Y),
    ("foot", X),
];
/// Bend of the hips in the stance, rad; the knees bend twice as much.
const BEND_RAD: f64 = 0.47;

fn link(
    name: &str,
    parent: usize,
    position: [f64; 3],
    mass: f64,
    axis: [f64; 3],
) -> LinkDescription {
    LinkDescription {
        name: name.to_owned(),
        parent: Some(parent),
        position,
        orientation: [1.0, 0.0, 0.0, 0.0],
        mass,
        center_of_mass: [0.0; 3],
        inertia: [1e-4, 1e-4, 1e-4, 0.0, 0.0, 0.0],
        joint: Some(JointDescription {
            name: name.to_owned(),
            axis,
            anchor: [0.0; 3],
            range: [-2.5, 2.5],
            peak_torque: 6.0,
            no_load_speed: 7.0,
            kp: 150.0,
            kv: 3.0,
            follows: None,
            ratio: 1.0,
            offset: 0.0,
        }),
    }
}

/// Two legs of 100 + 105 mm, a trunk, a head that nods and carries a camera that looks down by 0.2 rad at zero.
pub(crate) fn description() -> Description {
    let mut root = link("pelvis", 0, [0.0; 3], 3.0, Z);
    (root.parent, root.joint) = (None, None);
    root.center_of_mass = [-0.005, 0.0, 0.12];
    let mut links = vec![root];
    for (side, sign) in [("left", 1.0), ("right", -1.0)] {
        for (i, (name, axis)) in LEG.into_iter().enumerate() {
            let position = match i {
                0 => [0.0, sign * 0.0425, 0.0],
                3 => [0.0, 0.0, -0.1],
                4 => [0.0, 0.0, -0.105],
                _ => [0.0; 3],
            };
            let parent = if i == 0 { 0 } else { links.len() - 1 };
            links.push(link(&format!("{side}_{name}"), parent, position, 0.2, axis));
        }
    }
    links.push(link("pan", 0, [0.0, 0.0, 0.2], 0.1, Z));
    links.push(link("tilt", 13, [0.0, 0.0, 0.04], 0.4, Y));
    links.push(link("left_arm", 0, [0.0, 0.1, 0.15], 0.0, Y));
    let joints: Vec<String> = links
        .iter()
        .filter_map(|link| link.joint.as_ref().map(|joint| joint.name.clone()))
        .collect();
    let bent = [0.0, 0.0, -BEND_RAD, 2.0 * BEND_RAD, -BEND_RAD, 0.0];
    let stand = [&bent[..], &bent[..], &[0.0, 0.0, 0.0]].concat();
    Description {
        name: "biped".to_owned(),
        scale: 1.0,
        joints,
        stand,
        torso: "pelvis".to_owned(),
        legs: Legs {
            left: leg("left"),
            right: leg("right"),
        },
        head: Head {
            pan: Some("pan".to_owned()),
            tilt: Some("tilt".to_owned()),
            eye_height: 0.45,
            eye_ahead: 0.04,
        },
        arms_rest: BTreeMap::new(),
        arms_raised: BTreeMap::from([("left_arm".to_owned(), -2.0)]),
        imu: imu(),
        camera: camera(),
        body: Extent {
            radius: 0.14,
            height: 0.5,
            depth: None,
            width: None,
            foot_side: 0.06,
        },
        play: 0.0,
        gait: serde_json::Value::Null,
        links,
    }
}

fn leg(side: &str) -> Leg {
    Leg {
        joints: LEG.map(|(name, _)| format!("{side}_{name}")).to_vec(),
        sole: Sole {
            link: format!("{side}_foot"),
            position: [0.0, 0.0, -0.045],
            length: 0.105,
            width: 0.075,
        },
        sensors: None,
    }
}

fn imu() -> ImuMount {
    ImuMount {
        link: "pelvis".to_owned(),
        position: [0.0; 3],
        orientation: [1.0, 0.0, 0.0, 0.0],
    }
}

/// Looks down by 0.2 rad at zero.
fn camera() -> CameraMount {
    // z forward, x right, y down; then nodding.
    let optical = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), 0.2)
        * UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(0.5, -0.5, 0.5, -0.5));
    CameraMount {
        link: "tilt".to_owned(),
        position: [0.03, 0.0, 0.0],
        orientation: [optical.w, optical.i, optical.j, optical.k],
        width: 8,
        height: 8,
        focal: 8.0,
        period: 0.08,
        pool: 1,
        stereo: stereo(),
    }
}

fn stereo() -> StereoDescription {
    serde_json::from_value(serde_json::json!({
        "baseline": 0.06, "window": 5, "quantum": 0.125, "min_disparity": 1.5, "max_disparity": 24.0,
    }))
    .unwrap()
}

/// The default gait for the biped.
pub(crate) fn config() -> GaitConfig {
    GaitConfig::read(&biped()).unwrap().0
}

pub(crate) fn biped() -> Body {
    Body::new(description()).unwrap()
}

/// The biped with hips like a NAO's: yaw axes that slant by 45 degrees, one motor for both.
pub(crate) fn shared_hip_description() -> Description {
    let mut shared = description();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    for (link, axis) in [(1, [0.0, half, -half]), (7, [0.0, half, half])] {
        shared.links[link].joint.as_mut().unwrap().axis = axis;
    }
    shared.links[7].joint.as_mut().unwrap().follows = Some("left_hip_yaw".to_owned());
    shared
}

/// The biped's gait whose one foot is on its way, for this share of its time in the air already.
pub(crate) fn on_its_way(swing: Swing, other: FootPose, share: f64) -> Gait {
    let (config, body) = (config(), biped());
    let mut feet = [swing.from, other];
    if swing.side == Side::Right {
        feet.swap(0, 1);
    }
    let mut gait = Gait::new(&config, FootstepPlanner::new(&config, &body), feet);
    gait.phase = GaitPhase::Single {
        elapsed_s: share * swing.in_air_s(&config),
        duration_s: swing.single_support_s(&config),
        swing,
    };
    gait
}

/// A foot on the level at this place of the plan, m; the biped stands on two that are 85 mm apart.
pub(crate) fn foot_at(x_m: f64, y_m: f64) -> FootPose {
    FootPose {
        planar: PlanarPose::new(x_m, y_m, 0.0),
        ..FootPose::default()
    }
}

/// A world without inertia: joints are where their targets are, the torso is level, the feet that stand carry what they shall
/// carry, and one that comes down on the ground feels it.
pub(crate) struct Ideal {
    pub(crate) body: Body,
    pub(crate) walker: DcmWalker,
    pub(crate) targets: JointTargets,
    /// Height of the ground at a place, m; where the robot starts it is 0.
    pub(crate) ground_m: fn(f64, f64) -> f64,
    /// Levels ahead, in their order: from this x on, this height, m.
    pub(crate) ground_beyond: Vec<(f64, f64)>,
    /// What the walker is told of the ground's slopes.
    pub(crate) slopes: Option<&'static dyn Slopes>,
    time_ns: u64,
}

impl Ideal {
    pub(crate) fn new() -> Self {
        Self::of(biped())
    }

    pub(crate) fn of(body: Body) -> Self {
        let walker = DcmWalker::new(&body).unwrap();
        let targets = JointTargets {
            positions_rad: body.description().stand.clone(),
            ..JointTargets::default()
        };
        Self {
            body,
            walker,
            targets,
            ground_m: |_, _| 0.0,
            ground_beyond: Vec::new(),
            slopes: None,
            time_ns: 0,
        }
    }

    /// One tick.
    pub(crate) fn tick(&mut self, command: &Command) {
        let weight = self.body.mass_kg() * 9.81;
        let mut loads = self.walker.pressure.share.map(|share| share * weight);
        if let Some(stance) = self.walker.support() {
            let sole = self.sole_beside(stance);
            let beyond = self
                .ground_beyond
                .iter()
                .rfind(|(from_m, _)| sole.x > *from_m);
            let ground_m = beyond.map_or_else(
                || (self.ground_m)(sole.x, sole.y),
                |(_, height_m)| *height_m,
            );
            if sole.z < ground_m + 1e-4 {
                loads[stance.other().index()] = 10.0;
            }
        }
        let observation = Observation {
            time_ns: self.time_ns,
            joint_positions_rad: self.targets.positions_rad.clone(),
            joint_velocities_radps: vec![0.0; self.body.joint_count()],
            angular_velocity_radps: [0.0; 3],
            specific_force_mps2: [0.0, 0.0, 9.81],
            foot_forces_n: Side::BOTH.map(|side| self.corner_forces_n(side, loads[side.index()])),
            depth: None,
        };
        let state = BodyState {
            time_ns: self.time_ns,
            odometry_from_torso_rotation: UnitQuaternion::identity(),
            angular_velocity_radps: Vector3::zeros(),
            links: self.links(),
            foot_loads_n: loads,
            support: Side::Left,
            stands_level: true,
            on_slope: false,
            odometry_from_robot: Pose::identity(),
            robot_from_torso: Pose::identity(),
        };
        self.time_ns += 10_000_000;
        self.targets = self
            .walker
            .step(
                command,
                &WalkerSenses {
                    body: &self.body,
                    observation: &observation,
                    state: &state,
                    slopes: self.slopes,
                },
            )
            .unwrap()
            .clone();
    }

    /// How a stiff sole shares a load that acts where the walker pushes: front left, front right, rear left, rear right, N.
    fn corner_forces_n(&self, side: Side, load_n: f64) -> [f64; 4] {
        let sole = &self.body.description().legs.get(side).sole;
        let point = self.walker.pressure.point[side.index()];
        let place = self.walker.foot_in_plan(side).planar.inverse();
        let (x_m, y_m) = place.apply(point.x, point.y);
        let front = (0.5 + x_m / sole.length).clamp(0.0, 1.0);
        let left = (0.5 + y_m / sole.width).clamp(0.0, 1.0);
        let (rear, right) = (1.0 - front, 1.0 - left);
        [front * left, front * right, rear * left, rear * right].map(|share| share * load_n)
    }

    /// Centre of the sole of the foot that does not stand, in the walker's plan, m.
    pub(crate) fn sole_beside(&self, stance: Side) -> Vector3<f64> {
        let links = self.links();
        let torso_from_stance = self.body.torso_from_sole(&links, stance);
        let other = self.body.torso_from_sole(&links, stance.other());
        let apart = torso_from_stance.inverse() * other;
        let foot = self.walker.foot_in_plan(stance);
        let (x, y) = foot.planar.apply(apart.translation.x, apart.translation.y);
        Vector3::new(x, y, foot.z_m + apart.translation.z)
    }

    /// Poses of the links at the targets.
    pub(crate) fn links(&self) -> LinkPoses {
        let mut links = LinkPoses::default();
        self.body
            .pose_links(&self.targets.positions_rad, &mut links)
            .unwrap();
        links
    }
}

/// What only tests ask a walker for.
impl DcmWalker {
    /// Whether the list that was given last is behind the robot: all its steps landed, or it was given up.
    pub(crate) fn list_is_over(&self) -> bool {
        self.list.is_over(&self.gait)
    }

    /// Where a foot stands, or left, in the walker's own frame, which drifts against the world's.
    pub(crate) const fn foot_in_plan(&self, side: Side) -> &FootPose {
        &self.gait.feet[side.index()]
    }
}
