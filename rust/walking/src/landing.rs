//! Careful landings: a foot stands when its force says so, goes on down where the ground is deeper than told, and goes back where
//! there is none or something is in its way.

use behaviour::Misstep;

use crate::config::GaitConfig;
use crate::felt::KnownGround;
use crate::gait::Gait;
use crate::phase::{CarefulLanding, FootPose, GaitPhase, Manner, Swing};
use crate::swing;
use crate::task::Task;

impl Gait {
    /// Puts down a foot whose time in the air is over, where it was told.
    pub(crate) fn land_in_time(&mut self, swing: &Swing, task: Task<'_>, ground: &KnownGround) {
        if swing.manner == Manner::Placed {
            let index = swing.side.index();
            self.listed.landed += 1;
            self.listed.height_error_m = match ground {
                KnownGround::Felt(felt) if felt.loads_n[index] > self.config.landing_load => {
                    felt.soles_m[index].z - swing.to.z_m
                }
                KnownGround::Felt(_) | KnownGround::AsTold => 0.0,
            };
        }
        self.land(swing, swing.to, task);
    }

    /// What a careful foot does after `passed_s` more. Until it is found on the ground the clock stands when it should have been:
    /// up to then the weight is where the other foot can keep it.
    pub(crate) fn go_carefully(
        &mut self,
        before_s: f64,
        passed_s: f64,
        task: Task<'_>,
        ground: &KnownGround,
    ) {
        let GaitPhase::Single {
            elapsed_s,
            duration_s,
            swing,
        } = &mut self.phase
        else {
            return;
        };
        let over = *elapsed_s >= *duration_s;
        let KnownGround::Felt(felt) = ground else {
            if over {
                let (swing, at) = (*swing, swing.foot(*elapsed_s, &self.config));
                self.land_carefully(&swing, at, task);
            }
            return;
        };
        let swing_s = swing.in_air_s(&self.config);
        let touches = felt.loads_n[swing.side.index()] > self.config.landing_load;
        if let CarefulLanding::Found(height_m) = swing.landing {
            if over {
                let (swing, at) = (*swing, felt.found(swing, *elapsed_s, &self.config));
                self.land_carefully(&swing, at, task);
            } else if !touches {
                // It has bounced, or hangs in the play of its joints with one corner down: it is to lie flat before it carries.
                swing.landing =
                    CarefulLanding::Found(height_m - self.config.press_speed * passed_s);
            }
        } else if touches && felt.bears(swing, before_s, &self.config) {
            swing.landing = CarefulLanding::Found(swing.foot(before_s, &self.config).z_m);
        } else if swing.manner == Manner::Careful
            && felt.obstructs(swing, before_s, touches, &self.config)
        {
            if !(touches && swing.stop_short(before_s, &self.config)) {
                self.take_back(Misstep::Obstructed);
            }
        } else if *elapsed_s >= swing_s {
            *elapsed_s = swing_s;
            let tuning = &self.config.tuning.landing;
            if felt.short_m[swing.side.index()] > tuning.short {
                // The hips come down, or never far enough: then the ground is out of reach.
                swing.landing = match swing.landing {
                    CarefulLanding::Short(waited_s) if waited_s >= tuning.short_time => {
                        return self.find_no_ground(task);
                    }
                    CarefulLanding::Short(waited_s) => CarefulLanding::Short(waited_s + passed_s),
                    CarefulLanding::Seeking(0.0) => CarefulLanding::Short(passed_s),
                    below => below,
                };
                return;
            }
            let below_m = match swing.landing {
                CarefulLanding::Seeking(below_m) => below_m + self.config.probe_speed * passed_s,
                CarefulLanding::Short(_) | CarefulLanding::Found(_) => 0.0,
            };
            swing.landing = CarefulLanding::Seeking(below_m);
            if below_m >= self.config.probe_depth {
                self.find_no_ground(task);
            }
        }
    }

    fn find_no_ground(&mut self, task: Task<'_>) {
        match self.phase {
            // It stood there before: nothing better is known.
            GaitPhase::Single { swing, .. } if swing.manner == Manner::Back => {
                self.land_carefully(&swing, swing.to, task);
            }
            _ => self.take_back(Misstep::NoGround),
        }
    }

    /// Gives the list up and turns the foot round.
    fn take_back(&mut self, misstep: Misstep) {
        self.listed.misstep = Some(misstep);
        self.turn_round(Manner::Back);
    }

    /// Sends a foot that is on its way back to where it left, in this manner.
    pub(crate) fn turn_round(&mut self, manner: Manner) {
        if let GaitPhase::Single {
            elapsed_s, swing, ..
        } = self.phase
        {
            let here = swing.foot(elapsed_s, &self.config);
            let back = Swing::new(swing.side, manner, here, swing.from);
            self.phase = GaitPhase::Single {
                elapsed_s: 0.0,
                duration_s: back.single_support_s(&self.config),
                swing: back,
            };
        }
    }

    fn land_carefully(&mut self, swing: &Swing, at: FootPose, task: Task<'_>) {
        if swing.manner == Manner::Careful {
            let error_m = at.z_m - swing.to.z_m;
            self.listed.landed += 1;
            self.listed.height_error_m = error_m;
            self.listed.ground_m += error_m;
        }
        self.land(swing, at, task);
    }
}

impl Swing {
    /// Lets a foot that meets the next riser as it arrives land just before it, and says whether it may: whether that is near
    /// enough to where it was told.
    fn stop_short(&mut self, elapsed_s: f64, config: &GaitConfig) -> bool {
        let clear_m = config.tuning.landing.clear;
        let here = self.foot(elapsed_s, config).planar;
        let arrives = here.distance_m(&self.planned.planar) <= config.brush_distance
            && elapsed_s < swing::sinking(&config.tuning.swing) * self.in_air_s(config);
        if arrives {
            let way_m = here.distance_m(&self.from.planar);
            let back_share = clear_m / way_m.max(clear_m);
            self.to.planar = swing::part_way(&here, &self.from.planar, back_share);
        }
        arrives
    }
}

#[cfg(test)]
mod tests {
    use robot::Side;

    use super::*;
    use crate::felt::Felt;
    use crate::test_biped::{config, foot_at, on_its_way};
    use nalgebra::{Vector2, Vector3};

    /// How far the left foot, found on the ground, goes down in a tenth of a second with this load on it, m.
    fn pressed_m(load_n: f64) -> f64 {
        let (from, to) = (foot_at(0.0, 0.0425), foot_at(0.1, 0.0425));
        let mut swing = Swing::new(Side::Left, Manner::Careful, from, to);
        swing.landing = CarefulLanding::Found(0.002);
        let mut gait = on_its_way(swing, foot_at(0.0, -0.0425), 0.9);
        let felt = Felt {
            loads_n: [load_n, 50.0],
            soles_m: [Vector3::zeros(); 2],
            short_m: [0.0; 2],
            pressed_m: [Vector2::zeros(); 2],
            touched_m: [Vector3::zeros(); 2],
        };
        for _ in 0..10 {
            gait.advance(0.01, Task::Steps(&[]), &KnownGround::Felt(felt));
        }
        0.002 - gait.foot(Side::Left).z_m
    }

    #[test]
    fn a_foot_that_was_found_on_the_ground_presses_until_it_carries_something() {
        let most_m = 0.1 * config().press_speed;
        assert!((pressed_m(0.2) - most_m).abs() < 1e-9);
        assert_eq!(pressed_m(config().landing_load + 1.0), 0.0);
    }

    #[test]
    fn a_leg_that_stays_too_short_for_the_ground_takes_its_foot_back() {
        let (from, to) = (foot_at(0.0, 0.0425), foot_at(0.1, 0.0425));
        let swing = Swing::new(Side::Left, Manner::Careful, from, to);
        let mut gait = on_its_way(swing, foot_at(0.0, -0.0425), 1.0);
        let felt = Felt {
            loads_n: [0.0, 50.0],
            soles_m: [Vector3::new(0.1, 0.0425, 0.0), Vector3::zeros()],
            short_m: [0.01, 0.0],
            pressed_m: [Vector2::zeros(); 2],
            touched_m: [Vector3::zeros(); 2],
        };
        let ticks = (config().tuning.landing.short_time / 0.01) as usize;
        let mut advance = |ticks: usize| {
            for _ in 0..ticks {
                gait.advance(0.01, Task::Steps(&[]), &KnownGround::Felt(felt));
            }
            gait.listed.misstep
        };
        assert_eq!(advance(ticks), None);
        assert_eq!(advance(10), Some(Misstep::NoGround));
    }
}
