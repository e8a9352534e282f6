//! Ankles that yield: a sole that meets an edge turns until it lies on what is under it.
//!
//! After the foot torque control of Kajita et al., "Biped walking stabilization based on linear inverted pendulum tracking" (IROS
//! 2010): a foot whose centre of pressure is not where it is to push turns the side up that carries too much. Here it does so only
//! beyond a dead band, which a level floor hardly ever leaves.

use nalgebra::{UnitQuaternion, Vector2, Vector3};
use robot::{Body, Side};

use crate::config::GaitConfig;
use crate::phase::{Bearing, CarefulLanding, FootPose, GaitPhase};
use crate::support::{Pressure, sole_corners};

/// How the soles are turned against the level.
#[derive(Debug, Clone)]
pub(crate) struct Ankles {
    config: GaitConfig,
    corners: [[Vector2<f64>; 4]; 2],
    soles: [TiltedSole; 2],
}

#[derive(Debug, Clone, Copy, Default)]
struct TiltedSole {
    load_n: f64,
    /// What of the moment of its load is not wanted.
    excess_nm: Vector2<f64>,
    /// How far its toes, and how far its left side is turned up, rad.
    tilt_rad: Vector2<f64>,
}

impl Ankles {
    /// Both soles level.
    pub(crate) fn new(config: &GaitConfig, body: &Body) -> Self {
        Self {
            config: config.clone(),
            corners: sole_corners(body),
            soles: [TiltedSole::default(); 2],
        }
    }

    /// Takes in the forces at the soles' corners, N, where the `feet` were told to push as in `pressure`.
    pub(crate) fn update(
        &mut self,
        phase: &GaitPhase,
        feet: &[FootPose; 2],
        pressure: &Pressure,
        forces_n: &[[f64; 4]; 2],
        passed_s: f64,
    ) {
        for side in Side::BOTH {
            let index = side.index();
            let (sole, corners) = (&mut self.soles[index], &self.corners[index]);
            let lands = landing_foot(phase, side);
            let (x, y) = lands.map_or_else(
                || {
                    let point = &pressure.point[index];
                    feet[index].planar.inverse().apply(point.x, point.y)
                },
                |foot| (middle_m(&foot.bearing, corners), 0.0),
            );
            let arms = corners.map(|corner| corner - Vector2::new(x, y));
            let smooth_s = self.config.tuning.ankles.smooth_time;
            sole.feel(&arms, &forces_n[index], passed_s / smooth_s);
            if sole.load_n > self.config.landing_load {
                let careful = on_careful_steps(phase);
                let uneven = is_uneven(phase, feet);
                if !(careful && uneven) {
                    sole.forget(self.config.ankle_leak, passed_s);
                }
                if !careful || uneven && (lands.is_some() || comes_to_carry(phase, side)) {
                    sole.give_way(&self.config, passed_s);
                }
            } else if matches!(phase, GaitPhase::Single { swing, .. } if swing.side == side) {
                sole.forget(self.config.tuning.ankles.level_rate, passed_s);
            }
        }
    }

    /// From a sole as its ankle turns it to a level one.
    pub(crate) fn level_from_sole(&self, side: Side) -> UnitQuaternion<f64> {
        let tilt = &self.soles[side.index()].tilt_rad;
        UnitQuaternion::from_scaled_axis(Vector3::new(tilt.y, -tilt.x, 0.0))
    }
}

/// Whether a careful step comes or is under way: the list says what bears, and there the ankles only hold, but on uneven ground those of a
/// foot that comes to carry.
fn on_careful_steps(phase: &GaitPhase) -> bool {
    let (GaitPhase::Double {
        next: Some(swing), ..
    }
    | GaitPhase::Single { swing, .. }) = phase
    else {
        return false;
    };
    swing.manner.is_careful()
}

/// Where this foot lands, when it was found on the ground on a careful step: it is to lie flat before it carries.
fn landing_foot(phase: &GaitPhase, side: Side) -> Option<&FootPose> {
    match phase {
        GaitPhase::Single { swing, .. } if swing.side == side => {
            matches!(swing.landing, CarefulLanding::Found(_)).then_some(&swing.to)
        }
        GaitPhase::Single { .. } | GaitPhase::Standing | GaitPhase::Double { .. } => None,
    }
}

/// Whether a foot stands, or is to land, on ground that is told to be tilted: the other one may, too.
fn is_uneven(phase: &GaitPhase, feet: &[FootPose; 2]) -> bool {
    let swing = match phase {
        GaitPhase::Single { swing, .. } => Some(&swing.to),
        GaitPhase::Standing | GaitPhase::Double { .. } => None,
    };
    (feet.iter().chain(swing)).any(|foot| foot.gradient != Vector2::zeros())
}

/// Whether the weight comes to this foot, for a careful step of the other one.
fn comes_to_carry(phase: &GaitPhase, side: Side) -> bool {
    matches!(phase, GaitPhase::Double { next: Some(swing), .. } if swing.side != side)
}

/// The middle of what bears of a sole with sensors at these corners, m forward of its own.
fn middle_m(bearing: &Bearing, corners: &[Vector2<f64>; 4]) -> f64 {
    let half_m = corners.iter().map(|corner| corner.x).fold(0.0, f64::max);
    let [rear_m, front_m] = bearing.on_sole_m(half_m, 0.0);
    0.5 * (rear_m + front_m)
}

impl TiltedSole {
    /// Takes in forces, smoothed: `passed` since the last ones, in time constants. `arms`: from the wanted centre of pressure to each
    /// corner, m.
    fn feel(&mut self, arms: &[Vector2<f64>; 4], forces_n: &[f64; 4], passed: f64) {
        let share = passed.min(1.0);
        let load_n: f64 = forces_n.iter().sum();
        let parts = arms.iter().zip(forces_n);
        let excess_nm: Vector2<f64> = parts.map(|(arm, force)| arm * *force).sum();
        self.load_n += (load_n - self.load_n) * share;
        self.excess_nm += (excess_nm - self.excess_nm) * share;
    }

    fn forget(&mut self, rate: f64, passed_s: f64) {
        self.tilt_rad *= 1.0 - (rate * passed_s).min(1.0);
    }

    /// Turns the side up that carries too much.
    fn give_way(&mut self, config: &GaitConfig, passed_s: f64) {
        let error = self.excess_nm / self.load_n;
        let (dead, fastest, most) = (
            config.ankle_deadband,
            config.ankle_speed,
            config.ankle_limit,
        );
        let speed = error.map(|off_m| {
            let beyond_m = off_m - off_m.clamp(-dead, dead);
            (beyond_m * config.ankle_gain).clamp(-fastest, fastest)
        });
        self.tilt_rad = (self.tilt_rad + speed * passed_s).map(|tilt| tilt.clamp(-most, most));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::phase::{Manner, Swing};
    use crate::test_biped::{biped, config};
    use proptest::prelude::*;

    /// The force of 60 N at this place of the left sole as a stiff plate shares it, nothing on the right one.
    fn at(x_m: f64, y_m: f64) -> [[f64; 4]; 2] {
        let (front, left) = (0.5 + x_m / 0.105, 0.5 + y_m / 0.075);
        let (rear, right) = (1.0 - front, 1.0 - left);
        let shares = [front * left, front * right, rear * left, rear * right];
        [shares.map(|share| 60.0 * share), [0.0; 4]]
    }

    fn standing_on(forces_n: &[[f64; 4]; 2], ticks: usize) -> Ankles {
        let mut ankles = Ankles::new(&config(), &biped());
        let pressure = Pressure {
            share: [1.0, 0.0],
            point: [Vector2::zeros(); 2],
            zmp: Vector2::zeros(),
        };
        let feet = [FootPose::default(); 2];
        for _ in 0..ticks {
            ankles.update(&GaitPhase::Standing, &feet, &pressure, forces_n, 0.01);
        }
        ankles
    }

    /// How much higher a point of the left sole is than its centre, m.
    fn height_m(ankles: &Ankles, x_m: f64, y_m: f64) -> f64 {
        (ankles.level_from_sole(Side::Left) * Vector3::new(x_m, y_m, 0.0)).z
    }

    proptest! {
        #[test]
        fn the_place_that_carries_too_much_yields_upwards_within_the_limit(
            x_m in -0.05..0.05f64, y_m in -0.035..0.035f64, ticks in 1..100usize,
        ) {
            let ankles = standing_on(&at(x_m, y_m), ticks);
            prop_assert!(height_m(&ankles, x_m, y_m) >= 0.0);
            prop_assert!(height_m(&ankles, 1.0, 0.0).abs() <= libm::tan(config().ankle_limit));
            prop_assert!(height_m(&ankles, 0.0, 1.0).abs() <= libm::tan(config().ankle_limit));
        }

        #[test]
        fn a_foot_that_pushes_about_where_it_should_stays_level(x_m in -0.011..0.011f64, y_m in -0.011..0.011f64) {
            let ankles = standing_on(&at(x_m, y_m), 100);
            prop_assert!(ankles.level_from_sole(Side::Left).angle() < 1e-12);
        }
    }

    #[test]
    fn a_sole_that_only_its_front_half_carries_lowers_its_heel_by_5_mm_in_a_quarter_of_a_second() {
        let ankles = standing_on(&at(0.026, 0.0), 25);
        assert!(height_m(&ankles, -0.0525, 0.0) < -0.005);
    }

    /// The left sole after half a second of a careful step on which it comes down, or the other one does, loaded at this place of it; on
    /// ground that is told to rise so.
    fn after_a_landing(slope: f64, lands: Side, bearing: Bearing, [x_m, y_m]: [f64; 2]) -> Ankles {
        let mut ankles = Ankles::new(&config(), &biped());
        let place = FootPose {
            bearing,
            gradient: Vector2::new(slope, 0.0),
            ..FootPose::default()
        };
        let mut swing = Swing::new(lands, Manner::Careful, place, place);
        swing.landing = CarefulLanding::Found(0.0);
        let phase = GaitPhase::Single {
            elapsed_s: 0.9,
            duration_s: 1.0,
            swing,
        };
        let pressure = Pressure {
            share: [0.0, 1.0],
            point: [Vector2::zeros(); 2],
            zmp: Vector2::zeros(),
        };
        for _ in 0..50 {
            ankles.update(&phase, &[place; 2], &pressure, &at(x_m, y_m), 0.01);
        }
        ankles
    }

    #[test]
    fn a_foot_that_lands_with_care_lies_down_on_what_it_meets_and_the_other_one_holds() {
        let corner_m = [0.05, 0.03];
        let whole = after_a_landing(0.05, Side::Left, Bearing::default(), corner_m);
        assert!(height_m(&whole, 0.05, 0.0) > 0.005 && height_m(&whole, 0.0, 0.03) > 0.003);
        // Of a sole whose heel hangs over an edge the front is to carry, and its rear end is turned up where the edge alone does.
        let hangs = Bearing {
            from_m: -0.02,
            ..Bearing::default()
        };
        let edge = after_a_landing(0.05, Side::Left, hangs, [-0.02, 0.0]);
        assert!(height_m(&edge, -0.05, 0.0) > 0.005);
        let front = after_a_landing(0.05, Side::Left, hangs, [0.016, 0.0]);
        assert_eq!(front.level_from_sole(Side::Left).angle(), 0.0);
        let holds = after_a_landing(0.05, Side::Right, Bearing::default(), corner_m);
        assert_eq!(holds.level_from_sole(Side::Left).angle(), 0.0);
        // On treads, which are told to be level, the list says what bears.
        let level = after_a_landing(0.0, Side::Left, Bearing::default(), corner_m);
        assert_eq!(level.level_from_sole(Side::Left).angle(), 0.0);
    }

    #[test]
    fn a_foot_in_the_air_gets_level() {
        let mut ankles = standing_on(&at(0.05, 0.03), 50);
        let place = FootPose::default();
        let phase = GaitPhase::Single {
            elapsed_s: 0.1,
            duration_s: 0.35,
            swing: Swing::new(Side::Left, Manner::Walk, place, place),
        };
        let pressure = Pressure {
            share: [0.0, 1.0],
            point: [Vector2::zeros(); 2],
            zmp: Vector2::zeros(),
        };
        for _ in 0..35 {
            ankles.update(&phase, &[place; 2], &pressure, &[[0.0; 4]; 2], 0.01);
        }
        assert!(ankles.level_from_sole(Side::Left).angle() < 0.02);
    }
}
