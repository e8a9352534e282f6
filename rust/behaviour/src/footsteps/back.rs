//! Back to where the robot came from, where no step leads on.

use planning::footsteps::StepManner;
use robot::Side;
use terrain::ground_map::SoleOnGround;

use super::{Footsteps, LastSteps, State};
use crate::machine::Tick;
use crate::{Footstep, Misstep};

/// Where both feet stood, left and right, one after the other, the last one here.
#[derive(Debug, Clone, Default)]
pub(super) struct Stances {
    stood: Vec<[SoleOnGround; 2]>,
    /// How often the robot went back.
    backs: u32,
}

impl Stances {
    /// The feet stand here; `apart_m` is how far a foot moves at least.
    pub(super) fn stand(&mut self, feet: [SoleOnGround; 2], apart_m: f64) {
        let moved = |other: &[SoleOnGround; 2]| {
            let mut both = feet.iter().zip(other);
            both.any(|(foot, other)| foot.pose.distance_m(&other.pose) > apart_m)
        };
        match self.stood.last_mut() {
            Some(last) if !moved(last) => *last = feet,
            _ => self.stood.push(feet),
        }
    }

    /// The foot that goes back to where it stood before the feet stood as they do, and where that was; no more often than `most` times.
    pub(super) fn back(&mut self, apart_m: f64, most: u32) -> Option<(Side, SoleOnGround)> {
        let [.., before, here] = self.stood.as_slice() else {
            return None;
        };
        let apart = |side: &Side| {
            let foot = side.index();
            before[foot].pose.distance_m(&here[foot].pose) > apart_m
        };
        let mut moved = Side::BOTH.into_iter().filter(apart);
        // Both moved: there is no step back that was taken as one.
        let (Some(side), None) = (moved.next(), moved.next()) else {
            return None;
        };
        if self.backs >= most {
            return None;
        }
        let to = before[side.index()];
        self.backs += 1;
        let _ = self.stood.pop();
        Some((side, to))
    }

    /// The robot walks: what was before counts no more.
    pub(super) fn forget(&mut self) {
        self.stood.clear();
    }
}

impl Footsteps {
    /// Takes the last step back, where that is known, and steps no more on where it led; whether it does.
    pub(super) fn step_back(&mut self, tick: &Tick<'_>) -> bool {
        let apart_m = 0.5 * self.layer.limits().sole.width_m;
        let Some((side, to)) = self.stances.back(apart_m, self.config.backs) else {
            return false;
        };
        let stands = self.standing(tick);
        let here = stands[side.index()];
        let hold = |sole: &SoleOnGround| Footstep {
            side,
            manner: StepManner::Careful,
            pose: sole.pose,
            height_m: f64::from(sole.height_m),
            slope: sole.slope.map(f64::from),
            bearing_m: [-sole.half_m[0], sole.half_m[0]],
        };
        // Once may be a matter of balance.
        for _ in 0..2 {
            self.failed.note(hold(&here), Misstep::NoGround);
        }
        self.felt
            .retain(|sole| sole.pose.distance_m(&here.pose) > apart_m);
        let back = hold(&to);
        let other_m = f64::from(stands[side.other().index()].height_m);
        let ground_m = other_m.min(back.height_m);
        self.stepper.start(vec![back], &tick.pose, ground_m);
        self.machine.gets_on();
        self.looks = 0;
        self.planned_at = 0;
        self.last = LastSteps::default();
        self.enter(State::Step);
        true
    }
}

#[cfg(test)]
mod tests {
    use geometry::PlanarPose;

    use super::*;

    fn sole(x_m: f64, y_m: f64) -> SoleOnGround {
        SoleOnGround {
            pose: PlanarPose::new(x_m, y_m, 0.0),
            half_m: [0.05, 0.04],
            height_m: 0.0,
            slope: [0.0; 2],
        }
    }

    fn stand(x_m: [f64; 2]) -> [SoleOnGround; 2] {
        [sole(x_m[0], 0.04), sole(x_m[1], -0.04)]
    }

    #[test]
    fn the_robot_goes_back_step_by_step_the_way_it_came_and_so_often_only() {
        let mut stances = Stances::default();
        for x_m in [[0.0, 0.0], [0.1, 0.0], [0.1, 0.005], [0.1, 0.2], [0.3, 0.2]] {
            stances.stand(stand(x_m), 0.03);
        }
        let mut back = |most: u32| {
            let (side, to) = stances.back(0.03, most)?;
            Some((side, to.pose.x_m))
        };
        assert_eq!(back(9), Some((Side::Left, 0.1)));
        assert_eq!(back(9), Some((Side::Right, 0.005)));
        assert_eq!(back(2), None);
        assert_eq!(back(9), Some((Side::Left, 0.0)));
        assert_eq!(back(9), None);
        stances.stand(stand([0.2, 0.0]), 0.03);
        stances.stand(stand([0.5, 0.4]), 0.03);
        assert_eq!(stances.back(0.03, 9), None);
        stances.forget();
        assert_eq!(stances.back(0.03, 9), None);
    }
}
