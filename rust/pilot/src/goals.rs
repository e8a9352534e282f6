//! Where to go, one place after the other.

use planning::Goal;
use settings::{ConfigError, require};

use crate::GoalSettings;

/// The via points in order, the goal last.
#[derive(Debug, Clone)]
pub(crate) struct Goals {
    places: Vec<Goal>,
    /// How many were passed.
    pub(crate) passed: usize,
}

impl Goals {
    pub(crate) fn new(settings: &[GoalSettings]) -> Result<Self, ConfigError> {
        require(!settings.is_empty(), "goal", "one place or more", "none")?;
        for goal in settings {
            let finite = goal.position.iter().all(|value| value.is_finite());
            require(
                finite,
                "goal.position",
                "finite",
                format!("{:?}", goal.position),
            )?;
            let holds = goal.radius.is_finite() && goal.radius > 0.0;
            require(holds, "goal.radius", "> 0", goal.radius)?;
            let height_m = goal.height.unwrap_or(0.0);
            require(height_m.is_finite(), "goal.height", "finite", height_m)?;
        }
        Ok(Self {
            places: settings.iter().copied().map(Goal::from).collect(),
            passed: 0,
        })
    }

    /// The place that is pursued now.
    pub(crate) fn current(&self) -> &Goal {
        &self.places[self.passed]
    }

    /// Whether it is the last.
    pub(crate) fn is_last(&self) -> bool {
        self.passed + 1 == self.places.len()
    }

    /// Goes for the next place; stays at the last.
    pub(crate) fn advance(&mut self) {
        if !self.is_last() {
            self.passed += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(x: f64) -> GoalSettings {
        GoalSettings {
            position: [x, 0.0],
            height: None,
            radius: 0.1,
        }
    }

    #[test]
    fn the_places_come_in_order_and_the_last_stays() {
        let mut goals = Goals::new(&[place(1.0), place(2.0)]).unwrap();
        assert!(goals.current().x_m == 1.0 && !goals.is_last());
        goals.advance();
        assert!(goals.current().x_m == 2.0 && goals.is_last());
        goals.advance();
        assert!(goals.current().x_m == 2.0);
    }

    #[test]
    fn a_goal_without_a_radius_is_refused_by_name() {
        let error = Goals::new(&[GoalSettings {
            radius: 0.0,
            ..place(1.0)
        }])
        .unwrap_err();
        assert_eq!(error.to_string(), "goal.radius must be > 0, got 0");
    }

    #[test]
    fn a_goal_that_cannot_be_reached_for_want_of_a_number_is_refused_by_name() {
        let error = Goals::new(&[GoalSettings {
            height: Some(f64::NAN),
            ..place(1.0)
        }])
        .unwrap_err();
        assert_eq!(error.to_string(), "goal.height must be finite, got NaN");
        let error = Goals::new(&[GoalSettings {
            radius: f64::INFINITY,
            ..place(1.0)
        }])
        .unwrap_err();
        assert_eq!(error.to_string(), "goal.radius must be > 0, got inf");
    }
}
