//! A small biped: two legs and a waist.

use std::collections::BTreeMap;

use robot::{
    Body, CameraMount, Description, Extent, Head, ImuMount, JointDescription, Leg, Legs,
    LinkDescription, Sole, StereoDescription,
};

/// How far each hip is from the middle, m.
pub(crate) const HIP_Y_M: f64 = 0.0425;

fn link(
    name: &str,
    parent: Option<usize>,
    position: [f64; 3],
    axis: Option<[f64; 3]>,
) -> LinkDescription {
    LinkDescription {
        name: name.to_owned(),
        parent,
        position,
        orientation: [1.0, 0.0, 0.0, 0.0],
        mass: 0.5,
        center_of_mass: [0.0; 3],
        inertia: [1e-4, 1e-4, 1e-4, 0.0, 0.0, 0.0],
        joint: axis.map(|axis| JointDescription {
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

/// Two legs of 100 + 100 mm and a waist that carries the inertial measurement unit.
pub fn biped() -> Body {
    let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let mut links = vec![link("pelvis", None, [0.0; 3], None)];
    for (side, sign) in [("left", 1.0), ("right", -1.0)] {
        let parts = [
            ("hip_yaw", [0.0, sign * HIP_Y_M, 0.0], z),
            ("hip_roll", [0.0; 3], x),
            ("hip_pitch", [0.0; 3], y),
            ("knee", [0.0, 0.0, -0.1], y),
            ("ankle_pitch", [0.0, 0.0, -0.1], y),
            ("foot", [0.0; 3], x),
        ];
        for (i, (name, position, axis)) in parts.into_iter().enumerate() {
            let parent = if i == 0 { 0 } else { links.len() - 1 };
            links.push(link(
                &format!("{side}_{name}"),
                Some(parent),
                position,
                Some(axis),
            ));
        }
    }
    links.push(link("waist", Some(0), [0.0, 0.0, 0.05], Some(y)));
    let leg = |side: &str| Leg {
        joints: [
            "hip_yaw",
            "hip_roll",
            "hip_pitch",
            "knee",
            "ankle_pitch",
            "foot",
        ]
        .map(|name| format!("{side}_{name}"))
        .to_vec(),
        sole: Sole {
            link: format!("{side}_foot"),
            position: [0.0, 0.0, -0.04],
            length: 0.105,
            width: 0.075,
        },
        sensors: None,
    };
    describe(links, leg("left"), leg("right"))
}

fn describe(links: Vec<LinkDescription>, left: Leg, right: Leg) -> Body {
    let joints: Vec<String> = links
        .iter()
        .filter_map(|l| l.joint.as_ref())
        .map(|j| j.name.clone())
        .collect();
    Body::new(Description {
        name: "biped".to_owned(),
        scale: 1.0,
        stand: vec![0.0; joints.len()],
        joints,
        links,
        torso: "waist".to_owned(),
        legs: Legs { left, right },
        head: Head {
            pan: Some("waist".to_owned()),
            tilt: Some("waist".to_owned()),
            eye_height: 0.45,
            eye_ahead: 0.04,
        },
        arms_rest: BTreeMap::new(),
        arms_raised: BTreeMap::new(),
        imu: ImuMount {
            link: "waist".to_owned(),
            position: [0.0; 3],
            orientation: [1.0, 0.0, 0.0, 0.0],
        },
        camera: CameraMount {
            link: "waist".to_owned(),
            position: [0.0; 3],
            orientation: [1.0, 0.0, 0.0, 0.0],
            width: 88,
            height: 72,
            focal: 100.0,
            period: 0.08,
            pool: 1,
            stereo: StereoDescription {
                baseline: 0.06,
                window: 5,
            },
        },
        body: Extent {
            radius: 0.14,
            height: 0.58,
            depth: None,
            width: None,
            foot_side: 0.06,
        },
        play: 0.0,
        gait: serde_json::Value::Null,
    })
    .unwrap()
}
