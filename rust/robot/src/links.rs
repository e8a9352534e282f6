//! The links of a body and the joints between them, from a robot's description.

use std::collections::BTreeMap;

use nalgebra::{Isometry3, Point3, Quaternion, Translation3, Unit, UnitQuaternion, Vector3};

use crate::{BodyError, Description};

/// A joint of one axis that turns a link.
#[derive(Debug, Clone)]
pub(crate) struct Hinge {
    pub(crate) index: usize,
    pub(crate) axis: Unit<Vector3<f64>>,
    pub(crate) anchor: Vector3<f64>,
}

/// A joint without a motor of its own: gears or rods tie it to one that has one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Follower {
    /// Its index.
    pub joint: usize,
    /// Index of the joint whose motor turns it.
    pub leader: usize,
    /// How far it turns for each radian of the leader.
    pub ratio: f64,
    /// Its angle where the leader's is zero, rad.
    pub offset_rad: f64,
}

impl Follower {
    /// Its angle at one of the leader's, rad.
    pub fn angle_rad(&self, leader_rad: f64) -> f64 {
        self.offset_rad + self.ratio * leader_rad
    }

    /// The leader's angle at one of its own, rad.
    pub fn leader_rad(&self, angle_rad: f64) -> f64 {
        (angle_rad - self.offset_rad) / self.ratio
    }
}

/// A rigid part of the body, fixed to its parent or turned against it.
#[derive(Debug, Clone)]
pub(crate) struct Link {
    pub(crate) parent: Option<usize>,
    pub(crate) parent_from_link_at_zero: Isometry3<f64>,
    pub(crate) hinge: Option<Hinge>,
    pub(crate) mass_kg: f64,
    pub(crate) center_of_mass: Point3<f64>,
}

/// A pose from a place and a quaternion.
pub(crate) fn isometry(position: [f64; 3], wxyz: [f64; 4]) -> Isometry3<f64> {
    let [w, x, y, z] = wxyz;
    Isometry3::from_parts(
        Translation3::from(position),
        UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)),
    )
}

/// The index of a name; `role` says who asks, for the error.
pub(crate) fn find(
    names: &BTreeMap<String, usize>,
    kind: &'static str,
    role: &str,
    name: &str,
) -> Result<usize, BodyError> {
    names
        .get(name)
        .copied()
        .ok_or_else(|| BodyError::UnknownName {
            role: role.to_owned(),
            kind,
            name: name.to_owned(),
            available: names.keys().cloned().collect::<Vec<_>>().join(", "),
        })
}

/// Joints without a motor of their own.
pub(crate) fn find_followers(
    description: &Description,
    joint_index: &BTreeMap<String, usize>,
) -> Result<Vec<Follower>, BodyError> {
    let joints = description
        .links
        .iter()
        .filter_map(|link| link.joint.as_ref());
    let mut followers = Vec::new();
    for joint in joints {
        if let Some(leader) = &joint.follows {
            let role = format!("joint `{}` follows", joint.name);
            let pair = [&joint.name, leader].map(|name| find(joint_index, "joint", &role, name));
            let [follower, leader] = pair;
            if !(joint.ratio.is_finite() && joint.ratio != 0.0 && joint.offset.is_finite()) {
                return Err(BodyError::BadValue {
                    what: role,
                    allowed: "a ratio other than 0 and a finite offset",
                    found: format!("{} and {}", joint.ratio, joint.offset),
                });
            }
            followers.push(Follower {
                joint: follower?,
                leader: leader?,
                ratio: joint.ratio,
                offset_rad: joint.offset,
            });
        }
    }
    Ok(followers)
}

/// The links of a description, each behind its parent.
pub(crate) fn build_links(
    description: &Description,
    joint_index: &BTreeMap<String, usize>,
) -> Result<Vec<Link>, BodyError> {
    let mut links = Vec::with_capacity(description.links.len());
    for (i, link) in description.links.iter().enumerate() {
        let bad = |what: &str, allowed: &'static str, found: String| BodyError::BadValue {
            what: format!("link `{}`: {what}", link.name),
            allowed,
            found,
        };
        if link.parent.is_none() != (i == 0) || link.parent.is_some_and(|parent| parent >= i) {
            return Err(bad(
                "parent",
                "a link before it",
                format!("{:?}", link.parent),
            ));
        }
        if !(link.mass.is_finite() && link.mass >= 0.0) {
            return Err(bad("mass", ">= 0", link.mass.to_string()));
        }
        let hinge = match &link.joint {
            None => None,
            Some(joint) => {
                let axis = Unit::try_new(Vector3::from(joint.axis), 1e-9).ok_or_else(|| {
                    bad("joint axis", "longer than 0", format!("{:?}", joint.axis))
                })?;
                let index = find(joint_index, "joint", "links", &joint.name)?;
                Some(Hinge {
                    index,
                    axis,
                    anchor: Vector3::from(joint.anchor),
                })
            }
        };
        links.push(Link {
            parent: link.parent,
            parent_from_link_at_zero: isometry(link.position, link.orientation),
            hinge,
            mass_kg: link.mass,
            center_of_mass: Point3::from(link.center_of_mass),
        });
    }
    if links.is_empty() {
        return Err(BodyError::BadValue {
            what: "links".to_owned(),
            allowed: "one or more",
            found: "none".to_owned(),
        });
    }
    Ok(links)
}
