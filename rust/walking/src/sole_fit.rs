//! What of the gait follows from soles that are narrower than those of `qrio` made as large as the robot.
//!
//! Everything else follows from the robot's size alone. But soles are as wide as they are, and what holds a walking robot from falling
//! aside is half of one: an error of the divergent component of motion grows by `exp(omega T)` until the next foot stands (Englsberger
//! et al., "Three-dimensional bipedal walking control using Divergent Component of Motion", IROS 2013, equation 5).

use robot::{Body, Side};

use crate::config::GaitConfig;

impl GaitConfig {
    /// Sets what `[gait]` does not say: a quicker step, after which an error has grown as much less as the sole is narrower; the same of
    /// the shift of the weight between careful steps, where an ankle comes to its end meanwhile and its foot bears on an edge alone; a
    /// margin and a side step that are the same share of the sole; a speed of the centre of mass in which a foot that lands turned is no
    /// jump, for half a sole is all that holds what such a jump asks for; a foot that goes down again as soon as it hangs; the weight
    /// further in, but less so in careful steps, in which a foot carries for longer than a fall to either side takes; and feet nearer to
    /// each other, for what a step does wrong goes with how far the weight sways, and with how far a leg is thrown aside. `omega`: of the
    /// pendulum, 1/s; `toes_up_rad`: how much further than in the upright stance the ankles bend.
    pub(crate) fn fit_soles(
        &mut self,
        body: &Body,
        said: &serde_json::Value,
        omega: f64,
        toes_up_rad: f64,
    ) {
        let description = body.description();
        let width_m = Side::BOTH
            .map(|side| description.legs.get(side).sole.width)
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        let scaled_m = self.tuning.sole_fit.width;
        let share = width_m / scaled_m;
        if description.size() == settings::Scale::ONE || share >= 1.0 {
            return;
        }
        let is_said = |key: &str| said.get(key).is_some();
        if !is_said("step_time") {
            let quickest_s = self.tuning.sole_fit.quickest * self.step_time;
            let step_s = (self.step_time + libm::log(share) / omega).max(quickest_s);
            if !is_said("double_support") {
                self.double_support *= step_s / self.step_time;
            }
            self.step_time = step_s;
        }
        if toes_up_rad < self.tuning.sole_fit.short_ankle && !is_said("climb_double_support") {
            let quickest_s = self.tuning.sole_fit.quickest_shift * self.climb_double_support;
            let shift_s = self.climb_double_support + libm::log(share) / omega;
            self.climb_double_support = shift_s.max(quickest_s);
        }
        if !is_said("sole_margin") {
            self.sole_margin *= share;
        }
        if !is_said("max_sideways") {
            self.max_sideways *= share;
        }
        if said.pointer("/tuning/stumble/hangs").is_none() {
            self.tuning.stumble.hangs = 0.0;
        }
        if said.pointer("/tuning/catching/carried").is_none() {
            self.tuning.catching.carried = self.tuning.sole_fit.carried;
        }
        if said.pointer("/tuning/balance/turned").is_none() {
            self.tuning.balance.turned = 1.0;
        }
        let room_m = (0.5 * width_m - self.sole_margin).max(0.0);
        if !is_said("support_inward") {
            let lacks_m = 0.5 * (scaled_m - width_m);
            let inward_m = self.support_inward + self.tuning.sole_fit.inward * lacks_m;
            self.support_inward = inward_m.min(room_m);
        }
        if !is_said("climb_inward") {
            let most_m = self.tuning.sole_fit.careful * 0.5 * width_m;
            self.climb_inward = Some(self.support_inward.min(most_m));
        }
        if !is_said("stance_width") {
            let enough_m = self.tuning.sole_fit.apart * room_m + 2.0 * self.support_inward;
            let least_m = self.tuning.sole_fit.narrowest * self.stance_width;
            self.stance_width = enough_m.clamp(least_m, self.stance_width);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_biped::description;

    /// The gait of a biped twice as large whose soles are so wide, with what its file says of the gait.
    fn gait(width_m: f64, said: serde_json::Value) -> GaitConfig {
        gait_with_ankles(width_m, 1.0, said)
    }

    /// The gait of such a biped whose ankles bend so much further than in the upright stance.
    fn gait_with_ankles(width_m: f64, toes_up_rad: f64, said: serde_json::Value) -> GaitConfig {
        let mut body = description();
        for name in ["left_ankle_pitch", "right_ankle_pitch"] {
            let at = body.joints.iter().position(|joint| joint == name).unwrap();
            let least_rad = body.stand[at] - toes_up_rad;
            let mut joints = body.links.iter_mut().filter_map(|link| link.joint.as_mut());
            joints.find(|joint| joint.name == name).unwrap().range[0] = least_rad;
        }
        body.scale = 2.0;
        for sole in [&mut body.legs.left.sole, &mut body.legs.right.sole] {
            sole.width = width_m;
        }
        body.gait = said;
        GaitConfig::read(&Body::new(body).unwrap()).unwrap().0
    }

    #[test]
    fn soles_as_wide_as_the_robot_is_large_change_nothing_and_narrower_ones_quicken_its_step() {
        let nothing = serde_json::Value::Null;
        let (wide, scaled) = (gait(0.2, nothing.clone()), gait(0.15, nothing.clone()));
        assert_eq!(wide, scaled);
        let narrow = gait(0.1, nothing);
        assert!(narrow.step_time < scaled.step_time);
        assert_eq!(narrow.climb_double_support, scaled.climb_double_support);
        assert!(narrow.sole_margin < scaled.sole_margin);
        assert!(narrow.support_inward > scaled.support_inward);
        assert!(narrow.max_sideways < scaled.max_sideways);
        let turned = |gait: &GaitConfig| gait.tuning.balance.turned;
        assert_eq!((turned(&scaled), turned(&narrow)), (0.0, 1.0));
        assert!(scaled.tuning.stumble.hangs > 0.0 && narrow.tuning.stumble.hangs == 0.0);
        assert_eq!(scaled.climb_inward, None);
        let (narrowest, least) = (gait(0.04, serde_json::Value::Null), 0.02);
        let careful = narrowest.climb_inward.unwrap();
        assert!(careful < narrowest.support_inward);
        assert!((careful - narrowest.tuning.sole_fit.careful * least).abs() < 1e-12);
    }

    #[test]
    fn however_narrow_a_sole_is_it_carries_on_itself_and_the_legs_clear_each_other() {
        let nothing = serde_json::Value::Null;
        let (least, upright) = (gait(0.02, nothing.clone()), gait(0.15, nothing));
        assert!(least.support_inward <= 0.01 - least.sole_margin);
        let share = least.stance_width / upright.stance_width;
        assert!((share - least.tuning.sole_fit.narrowest).abs() < 1e-12);
    }

    #[test]
    fn in_a_shift_between_careful_steps_an_error_grows_as_much_less_as_the_sole_is_narrower() {
        let short = |width_m| gait_with_ankles(width_m, 0.3, serde_json::Value::Null);
        let (scaled, narrow) = (short(0.15), short(0.12));
        let grown = |gait: &GaitConfig, omega: f64| libm::exp(omega * gait.climb_double_support);
        // By the same pendulum as the step: what the one is quicker by the other is, too.
        let omega = libm::log(0.8) / (narrow.step_time - scaled.step_time);
        assert!((grown(&narrow, omega) / grown(&scaled, omega) - 0.8).abs() < 1e-9);
        let narrowest = short(0.01);
        let share = narrowest.climb_double_support / scaled.climb_double_support;
        assert!((share - narrowest.tuning.sole_fit.quickest_shift).abs() < 1e-12);
    }

    #[test]
    fn what_the_file_says_stays() {
        let said = serde_json::json!({"step_time": 0.7, "support_inward": 0.0, "sole_margin": 0.02,
                "max_sideways": 0.1, "stance_width": 0.2, "climb_double_support": 0.4});
        let narrow = gait(0.1, said);
        assert_eq!(
            (narrow.step_time, narrow.support_inward, narrow.sole_margin),
            (0.7, 0.0, 0.02)
        );
        assert_eq!((narrow.max_sideways, narrow.stance_width), (0.1, 0.2));
        assert_eq!(narrow.climb_double_support, 0.4);
    }
}
