//! What was seen of the ground outside of the window while it was in it: how far it is from the window's border to the goal.
//!
//! Without this the robot would hope for a way that it found closed as soon as that has left the window, and go to and fro for ever. So
//! would one whose way leads out of the window and back into it, around a wall that is longer, as soon as the goal comes in sight.

mod ground;
mod way;

use terrain::Terrain;

use crate::{Goal, tuning::OutsideWindowTuning};
use ground::{GroundOutside, cell_at};
use way::WayToGoal;

/// The ground around as it was when it was seen last.
#[derive(Debug, Clone, Default)]
pub(crate) struct OutsideWindow {
    tuning: OutsideWindowTuning,
    ground: GroundOutside,
    way: WayToGoal,
    goal: Option<Goal>,
    plans: u32,
    field: Field,
}

/// What the field over the ground says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Field {
    /// No more than the straight line does.
    #[default]
    Straight,
    /// How far it is to a goal outside of the window.
    Outside,
    /// How far it is to a goal in the window from its border.
    Around,
}

impl OutsideWindow {
    /// Nothing is known yet.
    pub(crate) fn new(tuning: OutsideWindowTuning) -> Self {
        Self {
            tuning,
            ..Self::default()
        }
    }

    /// Forgets what was seen.
    pub(crate) fn forget(&mut self) {
        *self = Self::new(self.tuning.clone());
    }

    /// Takes in what the window shows to a robot that stands at a place, m. Afterwards the field leads to the goal.
    pub(crate) fn look(&mut self, terrain: &Terrain, robot_m: [f64; 2], goal: &Goal) {
        if self.ground.take_in(terrain, robot_m, self.tuning.near) {
            (self.field, self.goal) = (Field::Straight, None);
        }
        self.plans = self.plans.saturating_add(1);
        let inside = terrain.index_at([goal.x_m, goal.y_m]).is_some();
        let is_old = self.goal != Some(*goal) || self.plans >= self.tuning.plans;
        if inside && (is_old || self.field == Field::Outside) {
            self.field = Field::Straight;
        } else if !inside && (is_old || self.field == Field::Around) {
            (self.goal, self.plans) = (Some(*goal), 0);
            self.field = Field::Straight;
            if self.ground.is_blocked_outside(terrain) {
                self.field = Field::Outside;
                self.way.begin(&self.ground, terrain, false, goal);
            }
        }
    }

    /// Takes the ways into account that lead out of the window and back into it, to a goal that lies in it.
    pub(crate) fn look_around(&mut self, terrain: &Terrain, goal: &Goal) {
        if self.field == Field::Around {
            return;
        }
        (self.goal, self.plans) = (Some(*goal), 0);
        self.field = Field::Around;
        self.way.begin(&self.ground, terrain, true, goal);
    }

    /// Length of the way from a place to the goal, m, as far as is known: the straight line where nothing is; infinite where no way leads
    /// around. A way to a goal outside of the window is a long one from where the robot has no room, as at a wall at the border.
    pub(crate) fn left_m(&self, at_m: [f64; 2], goal: &Goal) -> f64 {
        let straight_m = geometry::hypot(goal.x_m - at_m[0], goal.y_m - at_m[1]);
        let has_field = self.field != Field::Straight;
        let known_m = self
            .ground
            .lattice
            .filter(|_| has_field)
            .and_then(|lattice| {
                let length_m = self.way.length_m(cell_at(&lattice, at_m)?, lattice.cell_m);
                let shut_m = match self.field {
                    Field::Around => f64::INFINITY,
                    Field::Straight | Field::Outside => straight_m + self.tuning.shut,
                };
                Some(length_m.unwrap_or(shut_m))
            });
        known_m
            .filter(|m| m.is_finite() || self.field == Field::Around)
            .map_or(straight_m, |known_m| known_m.max(straight_m))
    }
}

#[cfg(test)]
mod tests;
