//! Footsteps of a list: where they are in the plan, and how they went.

use behaviour::{Footstep, StepManner, Stepping};
use geometry::PlanarPose;
use nalgebra::Vector2;
use robot::Side;

use crate::gait::Gait;
use crate::listed::Listed;
use crate::phase::{Bearing, FootPose, Manner, Swing};

impl Gait {
    /// Begins a list that is relative to this frame.
    pub(crate) fn begin_list(&mut self, origin: PlanarPose, ground_m: f64) {
        self.listed = Listed {
            origin,
            ground_m,
            ..Listed::default()
        };
    }

    /// Whether the list of `count` steps is behind the robot.
    pub(crate) fn list_is_done(&self, count: usize) -> bool {
        self.listed.landed >= count || self.gave_up()
    }

    /// Whether the list was given up.
    pub(crate) const fn gave_up(&self) -> bool {
        self.listed.misstep.is_some()
    }

    /// How the list goes.
    pub fn stepping(&self) -> Stepping {
        Stepping {
            landed: self.listed.landed,
            height_error_m: self.listed.height_error_m,
            misstep: self.listed.misstep,
            stumbled: self.listed.stumbled,
        }
    }

    /// The next step of the list, `ahead` others left out; within reach of the foot that stands.
    pub(crate) fn listed_swing(
        &self,
        feet: &[FootPose; 2],
        steps: &[Footstep],
        ahead: usize,
    ) -> Option<Swing> {
        let step = steps.get(self.listed.landed + ahead)?;
        let side: Side = step.side;
        let (stance, from) = (&feet[side.other().index()], feet[side.index()]);
        let [from_m, to_m] = step.bearing_m;
        let planar = self.listed.origin.compose(&step.pose);
        let (sin, cos) = libm::sincos(planar.yaw_rad);
        let [ahead, left] = step.slope;
        let told = FootPose {
            planar,
            z_m: self.listed.ground_m + step.height_m,
            bearing: Bearing { from_m, to_m },
            gradient: Vector2::new(cos * ahead - sin * left, sin * ahead + cos * left),
        };
        if step.manner == StepManner::Walked
            && let Some(to) = self.walked_to(stance, &from, told, side)
        {
            return Some(Swing::new(side, Manner::Placed, from, to));
        }
        let most = self.config.climb_rise;
        let to = FootPose {
            planar: self
                .planner
                .within_climb(&stance.planar, &told.planar, side),
            z_m: told.z_m.clamp(stance.z_m - most, stance.z_m + most),
            ..told
        };
        Some(Swing::new(side, Manner::Careful, from, to))
    }

    /// Where a foot that walks lands that is told to go there; `None` where that is another level, too far for a walk, or out of a stance that no
    /// walk has.
    fn walked_to(
        &self,
        stance: &FootPose,
        from: &FootPose,
        told: FootPose,
        side: Side,
    ) -> Option<FootPose> {
        let tuning = &self.config.tuning.listed;
        let planar = self.planner.within_walk(&stance.planar, &told.planar, side);
        let level = |foot: &FootPose| (told.z_m - foot.z_m).abs() <= tuning.level;
        let near = planar.distance_m(&told.planar) <= tuning.shortened;
        // Out of a longer or wider stance than a walk's the weight does not get over one foot in time.
        let other = side.other();
        let walked = self
            .planner
            .within_walk(&from.planar, &stance.planar, other);
        let near = near && walked.distance_m(&stance.planar) <= tuning.shortened;
        (level(stance) && level(from) && near).then_some(FootPose { planar, ..told })
    }
}
