//! Careful landings: a foot stands when its force says so, goes on down where the ground is deeper than told, and goes back where
//! there is none or something is in its way.

use behaviour::Misstep;
use nalgebra::Vector3;

use crate::gait::{FootPose, Gait, Landing, Manner, Phase, Swing};
use crate::swing::SINKING;
use crate::task::Task;

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
}

impl Gait {
    /// What a careful foot does after `passed_s` more.
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
        *elapsed_s = elapsed_s.min(*duration_s);
        let touches = felt.loads_n[swing.side.index()] > self.config.landing_load;
        let sinks = before_s > SINKING * self.config.climb_swing_time;
        let down = before_s >= self.config.climb_swing_time;
        match &mut swing.landing {
            Landing::Seeking(_) if sinks && touches => {
                swing.landing = Landing::Found(swing.foot(before_s, &self.config).z_m);
            }
            Landing::Seeking(below_m) if down => {
                *below_m += self.config.probe_speed * passed_s;
                if *below_m >= self.config.probe_depth {
                    let swing = *swing;
                    self.find_no_ground(&swing, task);
                }
            }
            Landing::Found(_) if over => {
                let (swing, found_m) = (*swing, felt.soles_m[swing.side.index()].z);
                let at = FootPose {
                    z_m: found_m,
                    ..swing.foot(*elapsed_s, &self.config)
                };
                self.land_carefully(&swing, at, task);
            }
            _ => {}
        }
    }

    fn find_no_ground(&mut self, swing: &Swing, task: Task<'_>) {
        if swing.manner == Manner::Back {
            // It stood there before: nothing better is known.
            self.land_carefully(swing, swing.to, task);
        } else {
            self.take_back(Misstep::NoGround);
        }
    }

    /// Gives the list up and turns the foot round.
    fn take_back(&mut self, misstep: Misstep) {
        if let Phase::Single {
            elapsed_s, swing, ..
        } = &self.phase
        {
            let here = swing.foot(*elapsed_s, &self.config);
            self.listed.misstep = Some(misstep);
            self.phase = Phase::Single {
                elapsed_s: 0.0,
                duration_s: Manner::Back.single_support_s(&self.config),
                swing: Swing::new(swing.side, Manner::Back, here, swing.from),
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
