//! The list of footsteps that was given last, kept until it is done, and what the legs have to do for it.

use behaviour::{Footstep, Motion};

use crate::{gait::Gait, relief::Relief, task::Task};

/// The list of footsteps that was given last.
///
/// A list is new when it is not that of the tick before: after any other motion, or, once the one before is done and the robot
/// stands, when it differs from it. In the midst of a list another one takes its place when it begins with the same steps, up to the
/// one that a foot is on its way to; one that ends before ends it with that step; any other is left alone until then.
#[derive(Debug, Clone, Default)]
pub struct StepList {
    /// What is taken.
    steps: Vec<Footstep>,
    /// What was given for it: the same, or fewer steps than had been begun.
    given: Vec<Footstep>,
    state: ListState,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum ListState {
    /// Something else is asked for.
    #[default]
    Idle,
    /// The robot comes to stand first.
    Waiting,
    /// Steps are taken, or were.
    Begun,
}

impl StepList {
    /// Takes in the motion of a tick. `gait` gets a new list's frame, which is the robot's now.
    pub fn take(&mut self, motion: &Motion, gait: &mut Gait, robot: ListFrame) {
        if gait.is_standing() && !matches!(motion, Motion::Walk(_)) {
            gait.recover();
        }
        let Motion::Footsteps(steps) = motion else {
            self.state = ListState::Idle;
            return;
        };
        let done = self.is_over(gait) && gait.is_standing();
        let new = match self.state {
            ListState::Idle => true,
            ListState::Waiting => false,
            ListState::Begun => done && *steps != self.given,
        };
        if new && steps.iter().all(is_finite) {
            self.take_over(steps, 0);
            self.state = ListState::Waiting;
            gait.begin_list(robot.planar, robot.ground_m);
        } else if self.state == ListState::Begun
            && !done
            && let Some(kept) = self.kept_by(steps, gait)
        {
            self.take_over(steps, kept);
        }
        if self.state == ListState::Waiting && gait.is_standing() {
            self.state = ListState::Begun;
        }
    }

    /// Takes these steps from now on, behind so many of those that were taken until now.
    fn take_over(&mut self, steps: &[Footstep], kept: usize) {
        self.given.clear();
        self.given.extend_from_slice(steps);
        self.steps.truncate(kept);
        self.steps.extend(steps.iter().skip(kept));
    }

    /// How many steps are taken or on their way where these may take their place: they begin with the same, or end before.
    fn kept_by(&self, steps: &[Footstep], gait: &Gait) -> Option<usize> {
        let begun = gait.stepping().landed + 1;
        let same = begun.min(steps.len());
        let begins = steps.get(..same) == self.steps.get(..same);
        let comes = self.steps.len() > begun;
        let ends = steps.len() < begun && self.steps.len() == begun;
        ((comes || ends) && begins && steps.iter().all(is_finite)).then_some(begun)
    }

    /// Whether all steps of the list landed, or it was given up.
    pub fn is_over(&self, gait: &Gait) -> bool {
        gait.list_is_done(self.steps.len())
    }

    /// What is to be done at this tick for this motion, on this ground.
    pub fn task<'a>(&'a self, motion: &Motion, gait: &Gait, relief: Relief<'a>) -> Task<'a> {
        match motion {
            Motion::Walk(velocity) if !gait.has_stumbled() => Task::Walk(*velocity, relief),
            Motion::Footsteps(_) if self.state == ListState::Begun && !gait.gave_up() => {
                Task::Steps(&self.steps)
            }
            Motion::Stand | Motion::Walk(_) | Motion::Footsteps(_) => Task::Stand(relief),
        }
    }
}

/// The robot's frame in the walker's plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ListFrame {
    /// Place and heading.
    pub planar: geometry::PlanarPose,
    /// Height of the ground that carries, m.
    pub ground_m: f64,
}

fn is_finite(step: &Footstep) -> bool {
    let ([from_m, to_m], [ahead, left]) = (step.bearing_m, step.slope);
    let pose = &step.pose;
    let numbers = [
        pose.x_m,
        pose.y_m,
        pose.yaw_rad,
        step.height_m,
        from_m,
        to_m,
        ahead,
        left,
    ];
    numbers.iter().all(|number| number.is_finite())
}
