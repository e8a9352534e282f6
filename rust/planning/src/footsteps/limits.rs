//! What the legs of a robot do in a step, and how long that takes.

use geometry::{PlanarPose, wrap_angle};
use robot::Side;
use terrain::footholds::SoleSize;

/// What a robot's steps are limited by. It follows from its body and its gait.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepLimits {
    /// Its soles.
    pub sole: SoleSize,
    /// Between the middles of the soles when they are side by side, m.
    pub stance_width_m: f64,
    /// Least gap between the soles, m.
    pub foot_gap_m: f64,
    /// Longest walked step: from beside the standing foot forward, m.
    pub max_forward_m: f64,
    /// Longest walked step backward, m.
    pub max_backward_m: f64,
    /// Largest extra distance between the feet in a side step, m.
    pub max_sideways_m: f64,
    /// How far a walked step goes both forward and to the side, as the sum of its shares of both.
    pub walked_both: f64,
    /// Largest turn of one foot against the other, rad.
    pub max_turn_rad: f64,
    /// Longest careful step forward or backward, m.
    pub careful_forward_m: f64,
    /// Largest extra distance between the feet in a careful step, m.
    pub careful_sideways_m: f64,
    /// Largest extra distance between the feet in the highest careful step down, m.
    pub careful_sideways_down_m: f64,
    /// Highest careful step up or down, m.
    pub careful_rise_m: f64,
    /// Most that the foot of a careful step is raised or lowered from where it stood, m.
    pub careful_lift_m: f64,
    /// How much higher than the higher end of its step a foot is lifted, m: of a walked one and of a careful one.
    pub clearance_m: [f64; 2],
    /// Time of a walked step, s.
    pub walked_s: f64,
    /// Shortest time of a careful step's foot in the air, s.
    pub careful_air_s: f64,
    /// The rest of the time of a careful step, s.
    pub careful_ground_s: f64,
    /// Speed over the ground of the foot of a long careful step, m/s.
    pub careful_speed_mps: f64,
    /// Speed at which the foot of a high careful step rises, m/s.
    pub careful_lift_mps: f64,
    /// Radius of the upright cylinder that holds body and arms, m.
    pub body_radius_m: f64,
    /// Height above the lower foot from which that cylinder must be free, m.
    pub body_from_m: f64,
}

impl StepLimits {
    /// The fastest that the robot walks, m/s.
    pub fn speed_mps(&self) -> f64 {
        self.max_forward_m / self.walked_s
    }

    /// Time of a careful step whose foot goes so far over the ground and changes its height by so much, s.
    pub fn careful_s(&self, way_m: f64, rise_m: f64) -> f64 {
        let lift_m = rise_m.abs() + self.clearance_m[1];
        let air_s = (way_m / self.careful_speed_mps).max(lift_m / self.careful_lift_mps);
        air_s.max(self.careful_air_s) + self.careful_ground_s
    }

    /// Whether a foot goes so far, m, in one step of a walk: from as far behind the other one as it then is ahead of it, from one side step to none,
    /// and turning with the robot's middle.
    pub fn walks_so_far(&self, way_m: f64) -> bool {
        let aside_m = self.max_sideways_m.min(self.careful_sideways_m);
        let ahead_m = 2.0 * self.max_forward_m + 0.5 * self.stance_width_m * self.max_turn_rad;
        way_m < geometry::hypot(ahead_m, aside_m) + ROUNDING
    }

    /// Where the foot of one side is beside the other one, at the same heading.
    pub fn beside(&self, standing: &PlanarPose, side: Side) -> PlanarPose {
        standing.compose(&PlanarPose::new(
            0.0,
            side.sign() * self.stance_width_m,
            0.0,
        ))
    }

    /// Where the robot's middle is when the foot of this side stands at a place.
    pub fn middle_of(&self, foot: &PlanarPose, side: Side) -> PlanarPose {
        foot.compose(&PlanarPose::new(
            0.0,
            -0.5 * side.sign() * self.stance_width_m,
            0.0,
        ))
    }

    /// Least and largest distance of the soles' middles across the standing foot when they differ by this heading, m.
    pub fn across_m(&self, turn_rad: f64) -> [f64; 2] {
        let (sin, cos) = libm::sincos(turn_rad.abs());
        let nearest_m =
            0.5 * (self.sole.width_m * (1.0 + cos) + self.sole.length_m * sin) + self.foot_gap_m;
        [
            nearest_m,
            (self.stance_width_m + self.max_sideways_m).max(nearest_m),
        ]
    }

    /// Whether the foot of one side can be put there in one step, seen from the foot that stands: carefully, and also as it walks.
    pub fn reach(&self, step: &PlanarPose, side: Side) -> Option<StepReach> {
        let turn_rad = wrap_angle(step.yaw_rad);
        self.reach_across(step, side, self.across_m(turn_rad))
    }

    /// [`Self::reach`] where least and largest distance across are known ([`Self::across_m`]) and the turn is not beyond half a circle.
    pub(super) fn reach_across(
        &self,
        step: &PlanarPose,
        side: Side,
        [nearest_m, farthest_m]: [f64; 2],
    ) -> Option<StepReach> {
        let turn_rad = wrap_angle(step.yaw_rad);
        let across_m = side.sign() * step.y_m;
        let between =
            |value: f64, least: f64, most: f64| value > least - ROUNDING && value < most + ROUNDING;
        let forward_m = self.careful_forward_m;
        let within = between(turn_rad, -self.max_turn_rad, self.max_turn_rad)
            && between(across_m, nearest_m, farthest_m)
            && between(step.x_m, -forward_m, forward_m);
        let walked = self.is_walked(step.x_m, across_m);
        let careful = self.stretch(step.x_m, across_m) < 1.0 + ROUNDING;
        match (within, walked, careful) {
            (true, true, true) => Some(StepReach::Walking),
            (true, true, false) => Some(StepReach::WalkingOnly),
            (true, false, true) => Some(StepReach::Careful),
            _ => None,
        }
    }
}

impl StepLimits {
    /// Whether a step so far forward and so far across, m, is one of a walk. Out of a stance that is wider than a careful step's the weight would not
    /// get over one foot in time for such a step, nor out of one that is both wide and long.
    fn is_walked(&self, x_m: f64, across_m: f64) -> bool {
        let most_wider_m = self.max_sideways_m.min(self.careful_sideways_m);
        let wider_m = (across_m - self.stance_width_m).max(0.0);
        let farthest_m = if x_m < 0.0 {
            self.max_backward_m
        } else {
            self.max_forward_m
        };
        let shares = [x_m.abs() / farthest_m, wider_m / most_wider_m];
        let within = shares.iter().all(|&share| share < 1.0 + ROUNDING);
        within && shares[0] + shares[1] < self.walked_both + ROUNDING
    }

    /// How far the legs are stretched by a careful step so far forward and so far across, m, as a share of what they can: both at once they do as
    /// far as an ellipse goes.
    fn stretch(&self, x_m: f64, across_m: f64) -> f64 {
        let wider_m = (across_m - self.stance_width_m).max(0.0);
        geometry::hypot(
            x_m / self.careful_forward_m,
            wider_m / self.careful_sideways_m,
        )
    }

    /// Whether a careful step seen from the foot that stands is not too far for one that goes down so far, m.
    pub(super) fn reaches_down(&self, step: &PlanarPose, side: Side, down_m: f64) -> bool {
        let share = (down_m / self.careful_rise_m).clamp(0.0, 1.0);
        let sideways_m = self.careful_sideways_m
            + share * (self.careful_sideways_down_m - self.careful_sideways_m);
        let wider_m = (side.sign() * step.y_m - self.stance_width_m).max(0.0);
        geometry::hypot(step.x_m / self.careful_forward_m, wider_m / sideways_m) < 1.0 + ROUNDING
    }

    /// The farthest place within reach towards one that may be beyond: forward and across, m.
    pub(super) fn pulled_in(&self, x_m: f64, across_m: f64) -> [f64; 2] {
        if self.is_walked(x_m, across_m) {
            return [x_m, across_m];
        }
        let share = 1.0 / self.stretch(x_m, across_m).max(1.0);
        let aside_m = (across_m - self.stance_width_m).max(0.0);
        [x_m * share, across_m - aside_m * (1.0 - share)]
    }
}

/// What a pose may be off that was composed and seen from another one again: m, and rad.
const ROUNDING: f64 = 1e-9;

/// How far a step goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StepReach {
    /// No farther than the robot walks.
    Walking,
    /// Only a careful step goes there.
    Careful,
    /// No careful step goes there: it is wider than those are.
    WalkingOnly,
}
