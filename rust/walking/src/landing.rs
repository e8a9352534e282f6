//! Careful landings: a foot stands when its force says so, goes on down where the ground is deeper than told, and goes back where
//! there is none or something is in its way.

use behaviour::Misstep;
use nalgebra::{Vector2, Vector3};

use crate::GaitConfig;
use crate::gait::{FootPose, Gait, Landing, Manner, Phase, Swing};
use crate::swing::{self, SINKING};
use crate::task::Task;

/// Share of the time after which a careful foot has left the ground for sure.
const HIGH: f64 = 0.25;

/// How far a foot may be behind its path, s.
const LAG_S: f64 = 0.02;

/// How short a leg may be while its foot is still sent further down, m: the hips come down more slowly than a foot.
const SHORT_M: f64 = 0.001;

/// How far before what it met a foot then comes down, m.
const CLEAR_M: f64 = 0.003;

/// What is known of the ground under a foot in the air.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ground {
    /// It is taken to be as told: for looking ahead.
    AsTold,
    /// What the feet feel.
    Felt(Felt),
}

/// What the feet feel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Felt {
    /// Load on each sole, N.
    pub loads_n: [f64; 2],
    /// Centre of each sole by joints and attitude, in the plan, m.
    pub soles_m: [Vector3<f64>; 2],
    /// How far each leg was from reaching where its foot was put, m.
    pub short_m: [f64; 2],
    /// Centre of pressure on each sole, from its middle forward and to the left, m; the middle of one that carries nothing.
    pub pressed_m: [Vector2<f64>; 2],
}

impl Gait {
    /// What a careful foot does after `passed_s` more. Until it is found on the ground the clock stands when it should have been:
    /// up to then the weight is where the other foot can keep it.
    pub(crate) fn go_carefully(
        &mut self,
        before_s: f64,
        passed_s: f64,
        task: Task<'_>,
        ground: &Ground,
    ) {
        let Phase::Single {
            elapsed_s,
            duration_s,
            swing,
        } = &mut self.phase
        else {
            return;
        };
        let over = *elapsed_s >= *duration_s;
        let Ground::Felt(felt) = ground else {
            if over {
                let (swing, at) = (*swing, swing.foot(*elapsed_s, &self.config));
                self.land_carefully(&swing, at, task);
            }
            return;
        };
        let swing_s = swing.in_air_s(&self.config);
        let touches = felt.loads_n[swing.side.index()] > self.config.landing_load;
        if let Landing::Found(height_m) = swing.landing {
            if over {
                let (swing, at) = (*swing, felt.found(swing, *elapsed_s, &self.config));
                self.land_carefully(&swing, at, task);
            } else if !touches {
                // It has bounced, or hangs in the play of its joints with one corner down: it is to lie flat before it carries.
                swing.landing = Landing::Found(height_m - self.config.press_speed * passed_s);
            }
        } else if touches && felt.bears(swing, before_s, &self.config) {
            swing.landing = Landing::Found(swing.foot(before_s, &self.config).z_m);
        } else if swing.manner == Manner::Careful
            && felt.obstructs(swing, before_s, touches, &self.config)
        {
            if !(touches && swing.stop_short(before_s, &self.config)) {
                self.take_back(Misstep::Obstructed);
            }
        } else if *elapsed_s >= swing_s {
            *elapsed_s = swing_s;
            if felt.short_m[swing.side.index()] > SHORT_M {
                return;
            }
            let below_m = match swing.landing {
                Landing::Seeking(below_m) => below_m + self.config.probe_speed * passed_s,
                Landing::Found(_) => 0.0,
            };
            swing.landing = Landing::Seeking(below_m);
            if below_m >= self.config.probe_depth {
                self.find_no_ground(task);
            }
        }
    }

    fn find_no_ground(&mut self, task: Task<'_>) {
        match self.phase {
            // It stood there before: nothing better is known.
            Phase::Single { swing, .. } if swing.manner == Manner::Back => {
                self.land_carefully(&swing, swing.to, task);
            }
            _ => self.take_back(Misstep::NoGround),
        }
    }

    /// Gives the list up and turns the foot round.
    fn take_back(&mut self, misstep: Misstep) {
        if let Phase::Single {
            elapsed_s, swing, ..
        } = self.phase
        {
            let here = swing.foot(elapsed_s, &self.config);
            let back = Swing::new(swing.side, Manner::Back, here, swing.from);
            self.listed.misstep = Some(misstep);
            self.phase = Phase::Single {
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
        let here = self.foot(elapsed_s, config).planar;
        let arrives = here.distance_m(&self.planned.planar) <= config.brush_distance
            && elapsed_s < SINKING * self.in_air_s(config);
        if arrives {
            let way_m = here.distance_m(&self.from.planar);
            let back_share = CLEAR_M / way_m.max(CLEAR_M);
            self.to.planar = swing::part_way(&here, &self.from.planar, back_share);
        }
        arrives
    }
}

impl Felt {
    /// Where the foot that has found ground stands: as told, at the height that joints and attitude say.
    fn found(&self, swing: &Swing, elapsed_s: f64, config: &GaitConfig) -> FootPose {
        FootPose {
            z_m: self.soles_m[swing.side.index()].z,
            ..swing.foot(elapsed_s, config)
        }
    }

    /// Whether a load means the ground: not on the way there, nor on another level that the foot comes down on. The level that it left
    /// is known, and the foot is above it for sure where joints and attitude say so: a swaying robot touches early.
    fn bears(&self, swing: &Swing, elapsed_s: f64, config: &GaitConfig) -> bool {
        let told_m = swing.foot(elapsed_s, config).z_m - swing.to.z_m;
        let felt_m = self.soles_m[swing.side.index()].z - swing.to.z_m;
        let knows = (swing.to.z_m - swing.from.z_m).abs() <= config.known_height;
        let above = told_m > config.obstructed_height || knows && felt_m > config.known_height;
        let level = swing.manner == Manner::Back || !above;
        level && elapsed_s >= SINKING * swing.in_air_s(config)
    }

    /// Whether something is in the foot's way: a load on it before it comes down where it should, or a place far from where it
    /// should be.
    fn obstructs(&self, swing: &Swing, elapsed_s: f64, touches: bool, config: &GaitConfig) -> bool {
        let share = elapsed_s / swing.in_air_s(config);
        let told = swing.foot(elapsed_s, config);
        let sole = &self.soles_m[swing.side.index()];
        let off_m = (sole.x - told.planar.x_m).hypot(sole.y - told.planar.y_m);
        let ahead = swing.foot(elapsed_s + LAG_S, config);
        let lag_m = ahead.planar.distance_m(&told.planar);
        share >= HIGH && (touches || off_m > config.obstructed_distance + lag_m)
    }
}

#[cfg(test)]
mod tests {
    use robot::Side;

    use super::*;
    use crate::test_biped::{config, foot_at, on_its_way};

    /// How far the left foot, found on the ground, goes down in a tenth of a second with this load on it, m.
    fn pressed_m(load_n: f64) -> f64 {
        let (from, to) = (foot_at(0.0, 0.0425), foot_at(0.1, 0.0425));
        let mut swing = Swing::new(Side::Left, Manner::Careful, from, to);
        swing.landing = Landing::Found(0.002);
        let mut gait = on_its_way(swing, foot_at(0.0, -0.0425), 0.9);
        let felt = Felt {
            loads_n: [load_n, 50.0],
            soles_m: [Vector3::zeros(); 2],
            short_m: [0.0; 2],
            pressed_m: [Vector2::zeros(); 2],
        };
        for _ in 0..10 {
            gait.advance(0.01, Task::Steps(&[]), &Ground::Felt(felt));
        }
        0.002 - gait.foot(Side::Left).z_m
    }

    #[test]
    fn a_foot_that_was_found_on_the_ground_presses_until_it_carries_something() {
        let most_m = 0.1 * config().press_speed;
        assert!((pressed_m(0.2) - most_m).abs() < 1e-9);
        assert_eq!(pressed_m(config().landing_load + 1.0), 0.0);
    }
}
