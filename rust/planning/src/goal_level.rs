//! The level of a goal that is told without a height: the one that its middle is seen to lie on.

use mapping::{FloorView, Surface};

use crate::Goal;
use crate::levels::Stand;
use crate::route::LEVEL_M;

/// The goal's middle is looked at in so many places each way, this far apart, m.
const PLACES: usize = 3;
const APART_M: f64 = 0.06;

/// What is known of the goal's level.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct GoalLevel {
    told: Option<Goal>,
    height_m: Option<f64>,
    /// No way leads there: any place in the disc will do.
    out_of_reach: bool,
}

impl GoalLevel {
    /// The goal, with the height that its middle is seen at where that is not the level that the robot is on. What was seen
    /// once holds until the middle is seen to lie elsewhere.
    pub(crate) fn of(&mut self, goal: &Goal, view: &FloorView, stand: &Stand) -> Goal {
        if self.told != Some(*goal) {
            *self = Self {
                told: Some(*goal),
                ..Self::default()
            };
        }
        if goal.height_m.is_some() || self.out_of_reach {
            return *goal;
        }
        if let Some(seen_m) = seen_m(goal, view) {
            let is_at = |height_m: f64| (seen_m - height_m).abs() <= LEVEL_M;
            if !self.height_m.is_some_and(is_at) {
                self.height_m = (!is_at(stand.height_m)).then_some(seen_m);
            }
        }
        Goal {
            height_m: self.height_m,
            ..*goal
        }
    }

    /// No way leads to the level that was seen: the goal as it was told.
    pub(crate) const fn give_up(&mut self, goal: &Goal) -> Goal {
        self.out_of_reach = true;
        *goal
    }

    /// Whether a goal on a level that was only seen was handed out.
    pub(crate) const fn is_seen(&self) -> bool {
        self.height_m.is_some() && !self.out_of_reach
    }
}

/// Height of the level floor around the goal's middle, m, where most of it is seen.
fn seen_m(goal: &Goal, view: &FloorView) -> Option<f64> {
    let mut heights_m = [0.0; PLACES * PLACES];
    let mut count = 0;
    for place in 0..PLACES * PLACES {
        let [row, col] = [place / PLACES, place % PLACES].map(|i| i as f64 - 1.0);
        let at_m = [goal.x_m + APART_M * col, goal.y_m + APART_M * row];
        if let Surface::Floor(height_m) = view.at(at_m[0], at_m[1])
            && view.gradient_at(at_m[0], at_m[1]) == [0.0; 2]
        {
            heights_m[count] = f64::from(height_m);
            count += 1;
        }
    }
    let seen = &mut heights_m[..count];
    seen.sort_unstable_by(f64::total_cmp);
    (2 * count > PLACES * PLACES).then(|| seen[count / 2])
}
