//! Where plans end that lead over what was not seen.

use super::space::FootstepSpace;
use super::spots::StandingFoot;
use super::unseen::Unseen;

impl FootstepSpace<'_> {
    /// Where a plan that ends at this node leaves what is known, m; `None` where it ends at the goal.
    pub(super) fn exit(&self, node: u32) -> Option<[f64; 2]> {
        let foot = self.foot_at(node).unwrap_or(self.start[0]);
        (!self.is_at_goal(&foot)).then(|| self.exit_from(&foot))?
    }

    fn exit_from(&self, foot: &StandingFoot) -> Option<[f64; 2]> {
        let Unseen::Priced {
            stop_before_m,
            faces_rad,
        } = self.unseen
        else {
            return None;
        };
        let [x_m, y_m] = self.table.middle_m(&foot.pose, foot.heading, foot.side);
        let exit_m = self.field.exit_within(x_m, y_m, stop_before_m)?;
        let bearing_rad = libm::atan2(exit_m[1] - y_m, exit_m[0] - x_m);
        let turn_rad = geometry::wrap_angle(bearing_rad - foot.pose.yaw_rad);
        let near = geometry::distance_m(exit_m, [x_m, y_m]) < self.limits.sole.length_m;
        (near || turn_rad.abs() <= faces_rad).then_some(exit_m)
    }

    /// What the way costs on from a foot before ground that was not seen, s.
    pub(super) fn on_from_s(&self, foot: &StandingFoot) -> Option<f64> {
        let [x_m, y_m] = self.table.middle_m(&foot.pose, foot.heading, foot.side);
        self.exit_from(foot)
            .map(|_| self.field.remaining_s(x_m, y_m))
    }
}
