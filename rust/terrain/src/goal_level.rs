//! The level of a goal that is told without a height: the one that its middle is seen to lie on.

use geometry::{Goal, same_level};
use mapping::{FloorView, Surface};
use settings::{settings, within};
use stairs::LevelsConfig;

use crate::StandingAt;

/// The goal's middle is looked at in so many places each way: one at its middle, and one to each side.
const PLACES: usize = 3;

settings! {
    /// Which level a goal lies on that is told without a height.
    pub struct GoalLevelConfig("navigation.terrain.goal_level") {
        /// The goal's middle is looked at in places that lie this far apart.
        spacing: f64 = 0.06, "m", within(0.0, 1.0);
    }
}

/// What is known of the goal's level.
#[derive(Debug, Clone, Copy, Default)]
pub struct GoalLevel {
    told: Option<Goal>,
    height_m: Option<f64>,
    /// No way leads there: any place in the disc will do.
    out_of_reach: bool,
}

impl GoalLevel {
    /// The goal, with the height that its middle is seen at where that is not the level that the robot is on. What was seen
    /// once holds until the middle is seen to lie elsewhere.
    pub fn of(
        &mut self,
        goal: &Goal,
        view: &FloorView,
        stand: &StandingAt,
        (config, levels): (&GoalLevelConfig, &LevelsConfig),
    ) -> Goal {
        if self.told != Some(*goal) {
            *self = Self {
                told: Some(*goal),
                ..Self::default()
            };
        }
        if goal.height_m.is_some() || self.out_of_reach {
            return *goal;
        }
        if let Some(seen_m) = seen_m(goal, view, config.spacing) {
            let is_at = |height_m: f64| same_level(seen_m, height_m, levels.told);
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
    pub const fn give_up(&mut self, goal: &Goal) -> Goal {
        self.out_of_reach = true;
        *goal
    }

    /// Whether a goal on a level that was only seen was handed out.
    pub const fn is_seen(&self) -> bool {
        self.height_m.is_some() && !self.out_of_reach
    }
}

/// Height of the level floor around the goal's middle, m, where most of it is seen.
fn seen_m(goal: &Goal, view: &FloorView, spacing_m: f64) -> Option<f64> {
    let mut heights_m = [0.0; PLACES * PLACES];
    let mut count = 0;
    for place in 0..PLACES * PLACES {
        let [row, col] = [place / PLACES, place % PLACES].map(|i| i as f64 - 1.0);
        let at_m = [goal.x_m + spacing_m * col, goal.y_m + spacing_m * row];
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Floor, stand};

    #[test]
    fn a_goal_has_the_level_that_it_is_seen_on_until_no_way_leads_there() {
        let config = (&GoalLevelConfig::default(), &LevelsConfig::default());
        let goal = Goal {
            x_m: 0.5,
            y_m: 0.0,
            radius_m: 0.15,
            height_m: None,
        };
        let mut floor = Floor::new();
        let mut level = GoalLevel::default();
        let same = level.of(&goal, &floor.view, &stand(), config);
        assert_eq!((same.height_m, level.is_seen()), (None, false));
        floor.paint([0.3, -0.3], [0.8, 0.3], Surface::Floor(0.125));
        let above = level.of(&goal, &floor.view, &stand(), config);
        assert_eq!((above.height_m, level.is_seen()), (Some(0.125), true));
        floor.paint([0.3, -0.3], [0.8, 0.3], Surface::Unknown);
        assert_eq!(level.of(&goal, &floor.view, &stand(), config), above);
        assert_eq!(level.give_up(&goal), goal);
        assert_eq!(level.of(&goal, &floor.view, &stand(), config), goal);
    }
}
