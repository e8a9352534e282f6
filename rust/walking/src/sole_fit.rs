//! What of the gait follows from soles that are narrower than those of `qrio` made as large as the robot.
//!
//! Everything else follows from the robot's size alone. But soles are as wide as they are, and what holds a walking robot from falling
//! aside is half of one: an error of the divergent component of motion grows by `exp(omega T)` until the next foot stands (Englsberger
//! et al., "Three-dimensional bipedal walking control using Divergent Component of Motion", IROS 2013, equation 5).

use robot::{Body, Side};

use crate::config::GaitConfig;

impl GaitConfig {
    /// Sets what `[gait]` does not say: a quicker step, after which an error has grown as much less as the sole is narrower; a margin
    /// that is the same share of the sole; and the weight further in. `omega`: of the pendulum, 1/s.
    pub(crate) fn fit_soles(&mut self, body: &Body, said: &serde_json::Value, omega: f64) {
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
        if !is_said("sole_margin") {
            self.sole_margin *= share;
        }
        if !is_said("support_inward") {
            // Farther in than so it falls that way before a careful step has landed.
            if !is_said("climb_inward") {
                self.climb_inward = Some(share * self.support_inward);
            }
            self.support_inward += self.tuning.sole_fit.inward * 0.5 * (scaled_m - width_m);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_biped::description;

    /// The gait of a biped twice as large whose soles are so wide, with what its file says of the gait.
    fn gait(width_m: f64, said: serde_json::Value) -> GaitConfig {
        let mut body = description();
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
        assert!(narrow.sole_margin < scaled.sole_margin);
        assert!(narrow.support_inward > scaled.support_inward);
    }

    #[test]
    fn what_the_file_says_stays() {
        let said =
            serde_json::json!({"step_time": 0.7, "support_inward": 0.0, "sole_margin": 0.02});
        let narrow = gait(0.1, said);
        assert_eq!(
            (narrow.step_time, narrow.support_inward, narrow.sole_margin),
            (0.7, 0.0, 0.02)
        );
    }
}
