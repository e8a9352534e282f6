//! Small corrections of the feet's heights: sharing the load while both stand, yielding to an early landing, reaching for a late one.

use robot::Side;

use crate::config::GaitConfig;
use crate::phase::{CarefulLanding, FootPose, GaitPhase, Manner};
use crate::swing;

/// Heights that are added to the planned ones.
#[derive(Debug, Clone, Default)]
pub struct FeetControl {
    config: GaitConfig,
    tilt_m: f64,
    landed: [f64; 2],
    held: Option<Held>,
    /// The foot that came down last, until it has found the ground.
    seeks: Option<Side>,
    flying: Option<(Side, f64)>,
    /// How much higher than told a foot stands that walked in a list, m, until it is put down carefully.
    yielded: [Option<f64>; 2],
}

/// A foot that landed before its time; its height is taken over when it is placed next.
#[derive(Debug, Clone, Copy)]
struct Held {
    side: Side,
    height_m: Option<f64>,
}

impl FeetControl {
    /// Without any correction yet.
    pub fn new(config: &GaitConfig) -> Self {
        Self {
            config: config.clone(),
            ..Self::default()
        }
    }

    /// Takes in the loads on the feet. While both stand, the one with more than its share yields upwards, the other one down;
    /// a foot that finds the ground before its time stays at that height, and one that has left it again seeks it as both are to carry.
    pub fn update(
        &mut self,
        phase: &GaitPhase,
        share: &[f64; 2],
        loads_n: &[f64; 2],
        weight_n: f64,
        passed_s: f64,
    ) {
        let config = &self.config;
        let forget = 1.0 - (config.load_leak * passed_s).min(1.0);
        self.tilt_m *= forget;
        for height in &mut self.landed {
            *height *= forget;
        }
        if let GaitPhase::Single {
            elapsed_s,
            duration_s,
            swing,
        } = phase
        {
            let landed = !swing.manner.is_careful()
                && loads_n[swing.side.index()] > config.landing_load
                && elapsed_s / duration_s > config.tuning.stumble.landing_share;
            if landed && self.held.is_none() {
                self.held = Some(Held {
                    side: swing.side,
                    height_m: None,
                });
            }
            self.seeks = (!swing.manner.is_careful() && self.held.is_none()).then_some(swing.side);
            return;
        }
        if let Some(held) = self.held.take() {
            let index = held.side.index();
            let high = self.landed[index] > config.tuning.stumble.hangs;
            let hangs = high && loads_n[index] <= config.landing_load;
            self.seeks = hangs.then_some(held.side);
        }
        let error = 0.5 * ((loads_n[0] - loads_n[1]) - (share[0] - share[1]) * weight_n);
        self.tilt_m = (self.tilt_m + config.load_gain * error * passed_s)
            .clamp(-config.load_limit, config.load_limit);
        self.seek(loads_n, passed_s);
    }

    /// Lowers a foot that should have landed until it carries something.
    fn seek(&mut self, loads_n: &[f64; 2], passed_s: f64) {
        let Some(index) = self.seeks.map(Side::index) else {
            return;
        };
        let config = &self.config;
        let lower_m = self.landed[index] - config.late_speed * passed_s;
        if loads_n[index] > config.landing_load || lower_m < -config.late_depth {
            self.seeks = None;
        } else {
            self.landed[index] = lower_m;
        }
    }

    /// The foot's place with the corrections. A careful landing takes over where the foot was found; what it was told until then
    /// is left slowly.
    pub fn place(&mut self, phase: &GaitPhase, mut foot: FootPose, side: Side) -> FootPose {
        let index = side.index();
        match phase {
            GaitPhase::Single {
                swing, elapsed_s, ..
            } if swing.side == side => {
                let careful = swing.manner.is_careful();
                self.flying = careful.then_some((side, foot.z_m));
                if careful && swing.landing == CarefulLanding::Seeking(0.0) {
                    let share = elapsed_s / self.config.tuning.listed.level_time;
                    let left = 1.0 - swing::minimum_jerk(share);
                    self.landed[index] =
                        self.yielded[index].map_or(0.0, |height_m| height_m * left);
                } else if !careful && (swing.manner == Manner::Placed || self.walked(side)) {
                    self.yielded[index] = Some(self.landed[index]);
                }
            }
            _ => {
                if let Some((_, told_m)) = self.flying.take_if(|(flying, _)| *flying == side) {
                    self.landed[index] = told_m - foot.z_m;
                    self.yielded[index] = None;
                } else if self.walked(side) {
                    self.yielded[index] = Some(self.landed[index]);
                }
            }
        }
        if let Some(held) = self.held.as_mut().filter(|held| held.side == side) {
            let height_m = *held.height_m.get_or_insert(foot.z_m);
            self.landed[index] = height_m - foot.z_m;
        }
        foot.z_m += side.sign() * 0.5 * self.tilt_m + self.landed[index];
        foot
    }

    /// Whether a foot walked to where it is in a list.
    const fn walked(&self, side: Side) -> bool {
        self.yielded[side.index()].is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::phase::{Manner, Swing};
    use crate::test_biped::config;

    #[test]
    fn a_foot_that_touched_early_and_hangs_as_both_are_to_carry_goes_down_again() {
        let lowers_m = |load_n: f64, hangs: f64| {
            let mut config = config();
            config.tuning.stumble.hangs = hangs;
            let mut control = FeetControl::new(&config);
            let foot = FootPose::default();
            let swing = Swing::new(Side::Left, Manner::Walk, foot, foot);
            let phase = |share: f64| GaitPhase::Single {
                elapsed_s: share * 0.35,
                duration_s: 0.35,
                swing,
            };
            control.update(&phase(0.8), &[0.0, 1.0], &[20.0, 50.0], 70.0, 0.01);
            for z_m in [0.01, 0.0] {
                let _ = control.place(&phase(0.8), FootPose { z_m, ..foot }, Side::Left);
            }
            let before_m = control.landed[0];
            let both = GaitPhase::Double {
                elapsed_s: 0.0,
                duration_s: 0.15,
                from: nalgebra::Vector2::zeros(),
                next: None,
            };
            for _ in 0..3 {
                control.update(&both, &[0.5, 0.5], &[load_n, 70.0], 70.0, 0.01);
            }
            before_m - control.landed[0]
        };
        assert!((lowers_m(0.0, 0.0) - 3.0 * 0.01 * config().late_speed).abs() < 2e-4);
        assert!(lowers_m(30.0, 0.0).abs() < 2e-4);
        assert!(lowers_m(0.0, 0.02).abs() < 2e-4);
    }

    #[test]
    fn the_foot_with_too_much_load_yields_upwards() {
        let mut control = FeetControl::new(&config());
        for _ in 0..10 {
            control.update(&GaitPhase::Standing, &[0.5, 0.5], &[50.0, 20.0], 70.0, 0.01);
        }
        let [left, right] = Side::BOTH.map(|side| {
            control
                .place(&GaitPhase::Standing, FootPose::default(), side)
                .z_m
        });
        assert!(left > 0.0 && right < 0.0);
        assert!(left - right <= config().load_limit);
    }

    #[test]
    fn a_foot_that_walked_onto_a_bump_in_a_list_is_lifted_carefully_without_a_jump() {
        let mut control = FeetControl::new(&config());
        let place = FootPose::default();
        let swings = |manner, elapsed_s| GaitPhase::Single {
            elapsed_s,
            duration_s: 0.45,
            swing: Swing::new(Side::Left, manner, place, place),
        };
        let walked = swings(Manner::Placed, 0.4);
        control.update(&walked, &[0.0, 1.0], &[10.0, 60.0], 70.0, 0.01);
        let bump = FootPose {
            z_m: 0.004,
            ..place
        };
        let _ = control.place(&walked, bump, Side::Left);
        let mut stands = 0.0;
        for _ in 0..2 {
            stands = control.place(&GaitPhase::Standing, place, Side::Left).z_m;
            control.update(&GaitPhase::Standing, &[0.5, 0.5], &[35.0, 35.0], 70.0, 0.0);
        }
        assert!((stands - 0.004).abs() < 1e-9, "{stands}");
        let heights: Vec<f64> = (0..12u32)
            .map(|tick| {
                let lifted = swings(Manner::Careful, 0.01 * f64::from(tick));
                control.place(&lifted, place, Side::Left).z_m
            })
            .collect();
        assert_eq!((heights[0], heights[11]), (stands, 0.0));
        assert!(
            heights.windows(2).all(|pair| pair[0] - pair[1] < 0.001),
            "{heights:?}"
        );
    }

    #[test]
    fn a_foot_that_finds_no_ground_goes_on_down_until_it_carries() {
        let mut control = FeetControl::new(&config());
        let place = FootPose::default();
        let swing = Swing::new(Side::Left, Manner::Walk, place, place);
        let comes_down = GaitPhase::Single {
            elapsed_s: 0.44,
            duration_s: 0.45,
            swing,
        };
        control.update(&comes_down, &[0.0, 1.0], &[0.0, 70.0], 70.0, 0.01);
        let both = GaitPhase::Double {
            elapsed_s: 0.0,
            duration_s: 0.15,
            from: nalgebra::Vector2::zeros(),
            next: None,
        };
        let mut height_m = |load_n: f64| {
            control.update(&both, &[0.0, 1.0], &[load_n, 70.0 - load_n], 70.0, 0.01);
            control.place(&both, place, Side::Left).z_m
        };
        let heights: Vec<f64> = (0..7).map(|_| height_m(0.0)).collect();
        assert!(heights.is_sorted_by(|before, after| after < before));
        assert!(heights[6] < -0.008, "{heights:?}");
        let found = height_m(20.0);
        assert!((0..20).all(|_| height_m(10.0) >= found));
    }

    #[test]
    fn a_foot_that_finds_the_ground_early_stays_at_that_height() {
        let mut control = FeetControl::new(&config());
        let place = FootPose::default();
        let swing = Swing::new(Side::Left, Manner::Walk, place, place);
        let mut at = |elapsed_s: f64, height_m: f64, load_n: f64| {
            let phase = GaitPhase::Single {
                elapsed_s,
                duration_s: 0.45,
                swing,
            };
            control.update(&phase, &[0.0, 1.0], &[load_n, 60.0], 70.0, 0.01);
            let foot = FootPose {
                z_m: height_m,
                ..FootPose::default()
            };
            control.place(&phase, foot, Side::Left).z_m
        };
        assert_eq!(at(0.10, 0.02, 20.0), 0.02);
        assert_eq!(at(0.38, 0.006, 20.0), 0.006);
        assert!((at(0.39, 0.004, 20.0) - 0.006).abs() < 1e-12);
        assert!((at(0.40, 0.002, 20.0) - 0.006).abs() < 1e-12);
    }
}
