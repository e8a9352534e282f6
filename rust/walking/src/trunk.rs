//! The torso over the legs: where its hips and the centre of mass are as it leans.

use nalgebra::{UnitQuaternion, Vector2, Vector3};

/// The torso at its heading.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Trunk {
    /// From the torso upright to the plan's axes.
    pub(crate) heading: UnitQuaternion<f64>,
    /// Centre of mass in the torso, m.
    pub(crate) com: Vector3<f64>,
    /// Centres of the hips in the torso, m.
    pub(crate) hips: [Vector3<f64>; 2],
    /// How far it rolls to its right, rad.
    pub(crate) roll_rad: f64,
}

/// Where the torso is over the centre of mass.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TrunkPlace {
    /// From the centre of mass to the torso's origin over the ground, m.
    pub(crate) from_com: Vector2<f64>,
    /// Where the torso looks, a unit vector.
    pub(crate) forward: Vector2<f64>,
    /// From the torso's origin to each hip, in the plan's axes, m.
    pub(crate) hips: [Vector3<f64>; 2],
}

impl Trunk {
    /// From the torso to the plan's axes as it leans forward by this angle.
    pub(crate) fn rotation(&self, lean_rad: f64) -> UnitQuaternion<f64> {
        let mut rotation = self.heading;
        if self.roll_rad != 0.0 {
            rotation *= UnitQuaternion::from_axis_angle(&Vector3::x_axis(), self.roll_rad);
        }
        if lean_rad != 0.0 {
            rotation *= UnitQuaternion::from_axis_angle(&Vector3::y_axis(), lean_rad);
        }
        rotation
    }

    /// Where it is as it leans forward by this angle.
    pub(crate) fn place(&self, lean_rad: f64) -> TrunkPlace {
        let rotation = self.rotation(lean_rad);
        TrunkPlace {
            from_com: -(rotation * self.com).xy(),
            forward: (self.heading * Vector3::x()).xy(),
            hips: self.hips.map(|hip| rotation * hip),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_torso_that_leans_puts_its_hips_behind_the_centre_of_mass() {
        let trunk = Trunk {
            heading: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 0.3),
            com: Vector3::new(0.0, 0.0, 0.1),
            hips: [
                Vector3::new(0.0, 0.05, -0.1),
                Vector3::new(0.0, -0.05, -0.1),
            ],
            roll_rad: 0.0,
        };
        let back_m = |lean_rad| {
            let place = trunk.place(lean_rad);
            let hip = 0.5 * (place.hips[0] + place.hips[1]);
            -(place.from_com + hip.xy()).dot(&place.forward)
        };
        assert!(back_m(0.0).abs() < 1e-12);
        assert!((back_m(0.3) - 0.2 * libm::sin(0.3)).abs() < 1e-12);
        assert_eq!(trunk.rotation(0.0), trunk.heading);
    }
}
