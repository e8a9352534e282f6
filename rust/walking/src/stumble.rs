//! A walking foot comes upon a level that nobody told it of: it goes back off it, and the walk ends.
//!
//! Floors differ by up to 10 mm, which the walk takes as it comes; from there to the least step that the camera tells apart, feet
//! are all that a robot has.

use behaviour::Misstep;
use geometry::PlanarPose;
use nalgebra::Vector2;
use robot::Side;

use crate::felt::Felt;
use crate::gait::Gait;
use crate::met::Met;
use crate::phase::{FootPose, GaitPhase, Manner, Swing};
use crate::swing;

impl Gait {
    /// What a foot has met since this was asked last.
    pub(crate) const fn take_met(&mut self) -> Option<Met> {
        self.listed.met.take()
    }

    /// Whether a walk has ended because of what it met.
    pub(crate) const fn has_stumbled(&self) -> bool {
        self.listed.stumbled
    }

    /// Lets a new walk begin.
    pub(crate) const fn recover(&mut self) {
        self.listed.stumbled = false;
    }

    /// What a foot of a walk feels on its way.
    pub(crate) fn feel_the_way(&mut self, before_s: f64, felt: &Felt) {
        let GaitPhase::Single {
            elapsed_s, swing, ..
        } = self.phase
        else {
            return;
        };
        if self.meets_a_level(&swing, before_s, felt) {
            self.listed.stumbled = true;
            self.listed.met = Some(self.met(&swing, elapsed_s, felt));
            self.listed.met_last = self.listed.met;
            if swing.manner == Manner::Placed {
                self.listed.misstep = Some(Misstep::Obstructed);
            }
            self.go_off(&swing, elapsed_s, felt);
        }
    }

    /// Whether a foot has come upon something that is higher than the floor may be.
    fn meets_a_level(&self, swing: &Swing, elapsed_s: f64, felt: &Felt) -> bool {
        let index = swing.side.index();
        let share = elapsed_s / swing.in_air_s(&self.config);
        let above_m = felt.soles_m[index].z - swing.to.z_m;
        swing.manner.is_walked()
            && share > self.config.tuning.landing.left_share
            && felt.loads_n[index] > self.config.landing_load
            && above_m > self.config.stumble_height
            && !self.leaves_what_it_met(swing)
    }

    /// Whether a foot goes back from where it met something last: it may still lie on it.
    fn leaves_what_it_met(&self, swing: &Swing) -> bool {
        self.listed.met_last.is_some_and(|met| {
            let away_m = |foot: &FootPose| foot.planar.distance_m(&met.at);
            away_m(&swing.from) < away_m(&swing.to).min(self.reach_of_touch_m())
        })
    }

    /// How far from the middle of a sole what it touches may be, m.
    fn reach_of_touch_m(&self) -> f64 {
        self.planner.half_sole_m().norm() + self.config.tuning.stumble.clear
    }

    /// Whether a foot lies where one met something last, or may touch it.
    pub(crate) fn lies_on_what_it_met(&self, side: Side) -> bool {
        let feet = [self.feet[side.index()], self.foot(side)];
        self.listed.met_last.is_some_and(|met| {
            let near = |foot: FootPose| foot.planar.distance_m(&met.at) < self.reach_of_touch_m();
            feet.into_iter().any(near)
        })
    }

    /// What a foot on its way has come upon: the middle of pressure on the sole lies on it.
    fn met(&self, swing: &Swing, elapsed_s: f64, felt: &Felt) -> Met {
        let touched_m = felt.touched_m[swing.side.index()];
        let yaw_rad = swing.foot(elapsed_s, &self.config).planar.yaw_rad;
        let from = &swing.from.planar;
        let came_rad = libm::atan2(touched_m.y - from.y_m, touched_m.x - from.x_m);
        let (sin, cos) = libm::sincos(came_rad - yaw_rad);
        let half = self.planner.half_sole_m();
        Met {
            at: PlanarPose::new(touched_m.x, touched_m.y, came_rad),
            height_m: touched_m.z - swing.to.z_m,
            half_width_m: half.x * sin.abs() + half.y * cos.abs(),
        }
    }

    /// Takes the foot back along its way until nothing of it is over the edge that it met; where all of it is, it stays.
    fn go_off(&mut self, swing: &Swing, elapsed_s: f64, felt: &Felt) {
        let index = swing.side.index();
        let tuning = &self.config.tuning.stumble;
        let here = swing.foot(elapsed_s, &self.config);
        let back = swing.from.planar;
        let way_m = here.planar.distance_m(&back);
        let (x, y) = here.planar.inverse().apply(back.x_m, back.y_m);
        let ahead = Vector2::new(-x, -y) / way_m.max(1e-6);
        let half = self.planner.half_sole_m();
        let reach_m = half.dot(&ahead.abs());
        let over_m = 2.0 * (reach_m - felt.pressed_m[index].dot(&ahead)).max(0.0);
        let mut to = here;
        if over_m > tuning.stands_share * 2.0 * reach_m {
            to.z_m = felt.soles_m[index].z;
        } else {
            let share = ((over_m + tuning.clear) / way_m.max(1e-6)).min(1.0);
            to.planar = swing::part_way(&here.planar, &back, share);
            to.z_m = self.feet[swing.side.other().index()].z_m;
        }
        let swing = Swing::new(swing.side, Manner::Retreat, here, to);
        self.phase = GaitPhase::Single {
            elapsed_s: 0.0,
            duration_s: swing.single_support_s(&self.config),
            swing,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::felt::KnownGround;
    use crate::relief::Relief;
    use crate::task::Task;
    use crate::test_biped::{foot_at, on_its_way};
    use behaviour::Velocity;
    use nalgebra::Vector3;
    use robot::Side;

    const AHEAD: Velocity = Velocity {
        x_mps: 0.1,
        y_mps: 0.0,
        yaw_radps: 0.0,
    };

    /// The left foot on its way 60 mm ahead, most of it behind it.
    fn walking() -> Gait {
        let (from, to) = (foot_at(-0.03, 0.0425), foot_at(0.03, 0.0425));
        let swing = Swing::new(Side::Left, Manner::Walk, from, to);
        on_its_way(swing, foot_at(0.0, -0.0425), 0.65)
    }

    /// The left sole lies on something of this height, its middle of pressure so far ahead of its own.
    fn upon(height_m: f64, pressed_m: f64) -> KnownGround {
        KnownGround::Felt(Felt {
            loads_n: [20.0, 50.0],
            soles_m: [Vector3::new(0.02, 0.0425, height_m), Vector3::zeros()],
            short_m: [0.0; 2],
            pressed_m: [Vector2::new(pressed_m, 0.0), Vector2::zeros()],
            touched_m: [
                Vector3::new(0.02 + pressed_m, 0.0425, height_m),
                Vector3::zeros(),
            ],
        })
    }

    fn landed(mut gait: Gait, ground: &KnownGround) -> Gait {
        for _ in 0..100 {
            gait.advance(0.01, Task::Walk(AHEAD, Relief::LEVEL), ground);
            if !matches!(gait.phase, GaitPhase::Single { .. }) {
                return gait;
            }
        }
        panic!("the foot never lands");
    }

    #[test]
    fn toes_on_an_unseen_step_go_back_before_its_edge_and_the_walk_is_over() {
        let before = walking();
        let toes_m = before.foot(Side::Left).planar.x_m + 0.0525;
        let gait = landed(before, &upon(0.018, 0.04));
        assert!(gait.has_stumbled());
        let met = gait.listed.met.unwrap();
        assert_eq!(met.at, PlanarPose::new(0.06, 0.0425, 0.0));
        assert_eq!((met.height_m, met.half_width_m), (0.018, 0.0375));
        // Pressed 12.5 mm behind the toes: 25 mm of the sole are over the edge.
        let back_m = toes_m - (gait.feet[0].planar.x_m + 0.0525);
        assert!(back_m > 0.025, "{back_m}");
        assert_eq!(gait.feet[0].z_m, 0.0);
    }

    #[test]
    fn a_sole_that_lies_all_on_the_step_stays_there() {
        let gait = landed(walking(), &upon(0.018, -0.005));
        assert!(gait.has_stumbled());
        assert!(gait.feet[0].planar.x_m > 0.0);
        assert_eq!(gait.feet[0].z_m, 0.018);
    }

    #[test]
    fn a_foot_that_goes_back_from_what_it_met_does_not_meet_it_again() {
        let back = |met: f64| {
            let (from, to) = (foot_at(0.03, 0.0425), foot_at(-0.03, 0.0425));
            let swing = Swing::new(Side::Left, Manner::Walk, from, to);
            let mut gait = on_its_way(swing, foot_at(0.0, -0.0425), 0.65);
            gait.listed.met_last = Some(Met {
                at: PlanarPose::new(met, 0.04, 0.0),
                height_m: 0.015,
                half_width_m: 0.04,
            });
            landed(gait, &upon(0.018, 0.04))
        };
        assert!(!back(0.08).has_stumbled());
        assert!(back(0.3).has_stumbled(), "another thing");
    }

    #[test]
    fn a_bump_that_counts_as_floor_is_walked_over() {
        let gait = landed(walking(), &upon(0.010, 0.04));
        assert!(!gait.has_stumbled() && gait.listed.met.is_none());
        assert_eq!(gait.feet[0].planar.x_m, 0.03);
    }
}
