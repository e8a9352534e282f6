//! What a robot's steps are limited by, from its body and its gait.

use planning::footsteps::{SoleSize, StepLimits};
use robot::{Body, Side};
use walking::leg::LegSolver;
use walking::{GaitConfig, WalkError, swing};

/// The limits of a robot's steps.
///
/// # Errors
///
/// Its `[gait]` has a setting that cannot be used, or its legs do not have the axes that the walker needs.
pub fn step_limits(body: &Body) -> Result<StepLimits, WalkError> {
    let (gait, _) = GaitConfig::read(body)?;
    let description = body.description();
    let soles = [&description.legs.left.sole, &description.legs.right.sole];
    let largest = |of: [f64; 2]| of[0].max(of[1]);
    let leg = LegSolver::new(body, Side::Left, gait.max_extension, &gait.tuning.leg)?;
    let (_, shank_m) = leg.lengths_m();
    Ok(StepLimits {
        sole: SoleSize {
            length_m: largest(soles.map(|sole| sole.length)),
            width_m: largest(soles.map(|sole| sole.width)),
        },
        stance_width_m: gait.stance_width,
        foot_gap_m: gait.foot_gap,
        max_forward_m: gait.max_forward,
        max_backward_m: gait.max_backward,
        max_sideways_m: gait.max_sideways,
        walked_both: gait.listed_both,
        max_turn_rad: gait.max_turn,
        careful_forward_m: gait.climb_forward,
        careful_sideways_m: gait.climb_sideways,
        careful_sideways_down_m: gait.climb_sideways_down,
        careful_rise_m: gait.climb_rise,
        careful_lift_m: 2.0 * gait.climb_rise,
        clearance_m: [gait.step_height, gait.climb_clearance],
        walked_s: gait.step_time,
        careful_air_s: gait.climb_swing_time,
        careful_ground_s: gait.climb_landing_time + gait.climb_double_support,
        careful_speed_mps: gait.climb_speed,
        careful_lift_mps: swing::lifting(&gait.tuning.swing) * gait.climb_lift_speed,
        body_radius_m: description.body.radius,
        // Below the knees there is nothing but shanks, over the feet.
        body_from_m: shank_m + leg.ankle_height_m(),
    })
}
