//! How a list of footsteps is taken.

use crate::climbing::simulation::{Foot, Simulation};
use crate::{Footstep, Misstep};

const STEP_TICKS: u32 = 100;
const SHIFT_TICKS: u32 = 50;

impl Simulation {
    pub(super) fn take(&mut self, list: &[Footstep]) {
        if self.stands() && self.stepping.landed == 0 && !list.is_empty() {
            self.list_from = self.pose();
            self.list_ground_m = self.ground_m();
            self.stepping.misstep = None;
            self.ticks_left = SHIFT_TICKS + STEP_TICKS;
            self.standing_ticks = 0;
            return;
        }
        if self.ticks_left == 0 {
            self.standing_ticks += 1;
            return;
        }
        self.ticks_left -= 1;
        if self.ticks_left == 0
            && let Some(step) = list.get(self.stepping.landed)
        {
            self.land(step);
            let more = self.stepping.misstep.is_none() && self.stepping.landed < list.len();
            self.ticks_left = if more { STEP_TICKS } else { 0 };
        }
    }

    /// A foot comes down: on what is there, or it is taken back.
    fn land(&mut self, step: &Footstep) {
        let pose = self
            .list_from
            .compose(&step.pose)
            .compose(&self.landing_error);
        let told_m = self.list_ground_m + step.height_m;
        // The part that bears load must lie on one surface.
        let [from_m, to_m] = step.bearing_m;
        let heights = [0.8 * from_m, 0.0, 0.8 * to_m].map(|along_m| {
            let (x_m, y_m) = pose.apply(along_m, 0.0);
            self.truth_m([x_m, y_m])
        });
        let highest_m = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let carries = step.side.other();
        let bends = self.feet[carries.index()].height_m > self.feet[step.side.index()].height_m;
        if bends && self.weak {
            self.stepping.misstep = Some(Misstep::Buckled(carries));
        } else if highest_m < told_m - 0.012 {
            self.stepping.misstep = Some(Misstep::NoGround);
        } else if highest_m > told_m + 0.012 {
            self.stepping.misstep = Some(Misstep::Obstructed);
        } else {
            let lowest_m = heights.into_iter().fold(f64::INFINITY, f64::min);
            assert!(
                highest_m - lowest_m < 1e-9,
                "a foot tips at {pose:?}: {heights:?}"
            );
            let foot = Foot {
                pose,
                height_m: highest_m,
            };
            self.feet[step.side.index()] = foot;
            self.landings.push((*step, foot));
            self.stepping.landed += 1;
        }
    }
}
