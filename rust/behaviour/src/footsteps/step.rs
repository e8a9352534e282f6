//! The state `step`: the feet move, and what they do next is planned while they do.

use geometry::PlanarPose;
use planning::footsteps::{FootstepPlan, StepManner};
use robot::Side;
use terrain::ground_map::SoleOnGround;

use super::Footsteps;
use super::progress::Since;
use super::route::{LastSteps, after};
use crate::climbing::stepper::{self, Stepped};
use crate::machine::Tick;
use crate::{Footstep, Misstep, Motion};

impl Footsteps {
    /// One tick while the feet move.
    pub(super) fn step(&mut self, tick: &Tick<'_>) -> Motion {
        let landed = tick.situation.stepping.landed;
        let ahead = landed + self.config.look_ahead;
        let holds = &self.stepper.holds;
        if let Some(hold) = holds.get(ahead).or(holds.last()) {
            let place_m = tick.in_robot([hold.pose.x_m, hold.pose.y_m]);
            self.head.turn_to(place_m, tick.passed_s);
        }
        if self.stepper.has_begun() && landed > self.planned_at {
            self.planned_at = landed;
            self.feel(tick);
            self.plan_on(tick, landed);
        }
        match self.stepper.advance(tick.situation, tick.passed_s) {
            Stepped::Running => {}
            Stepped::Missed(misstep, landed) => self.after_misstep(tick, misstep, landed),
            Stepped::Idle | Stepped::Done | Stepped::Stuck => self.after_list(tick),
        }
        self.stepper.motion()
    }

    /// Plans on from where the feet will be once the step under way has landed.
    fn plan_on(&mut self, tick: &Tick<'_>, landed: usize) {
        let Some(&under_way) = self.stepper.holds.get(landed) else {
            return;
        };
        let (feet, told_from_map) = self.feet_after(tick, landed, &under_way);
        let mut soles = self.standing(tick);
        let foot = under_way.side.index();
        soles[foot] = SoleOnGround {
            pose: feet[foot],
            height_m: under_way.height_m as f32,
            slope: under_way.slope.map(|rise| rise as f32),
            ..soles[foot]
        };
        self.read_ground(tick, &soles);
        let mut holds: Vec<Footstep> = self.stepper.holds[..=landed].to_vec();
        let planned = self.last.from(landed + 1, &told_from_map);
        match self.plan_next(tick, feet, Some(under_way.side.other()), &planned) {
            Ok(plan) if !self.list.followed && self.may_walk_on(tick) && self.only_walks(&plan) => {
                self.last = LastSteps::default();
                holds.extend(self.closing(&under_way));
            }
            Ok(plan) => {
                let _ = self.gets_on(Since::Step, &plan);
                let next = plan
                    .steps
                    .iter()
                    .take(self.config.run)
                    .map(|step| self.told(step));
                holds.extend(next.map(|hold| Footstep {
                    pose: told_from_map.compose(&hold.pose),
                    ..hold
                }));
                self.last = LastSteps {
                    steps: plan.steps,
                    told_from_map,
                    first: landed + 1,
                };
            }
            Err(_) => {}
        }
        self.stepper.replace(holds);
    }

    /// Where the feet will be in the map, and how to tell the walker of a place there.
    fn feet_after(
        &self,
        tick: &Tick<'_>,
        landed: usize,
        under_way: &Footstep,
    ) -> ([PlanarPose; 2], PlanarPose) {
        let told_from_map = self.told_from_map(tick, under_way.side.other(), landed);
        let lands = told_from_map.inverse().compose(&under_way.pose);
        let feet = after(&Self::soles(tick), under_way.side, lands);
        (feet, told_from_map)
    }

    /// How to tell the walker of a place in the map: by what it was told of the foot that stands after so many steps, wherever that came to stand.
    pub(super) fn told_from_map(
        &self,
        tick: &Tick<'_>,
        standing: Side,
        landed: usize,
    ) -> PlanarPose {
        let mut before = self.stepper.holds[..landed].iter().rev();
        let told = before.find(|hold| hold.side == standing);
        let stands = Self::soles(tick)[standing.index()];
        told.map_or_else(PlanarPose::default, |told| {
            told.pose.compose(&stands.inverse())
        })
    }

    /// The step that puts the other foot beside one that lands, where there is ground at its height.
    fn closing(&self, landing: &Footstep) -> Option<Footstep> {
        let side = landing.side.other();
        let pose = self.layer.limits().beside(&landing.pose, side);
        let height_m = self.height_under_m(&pose)?;
        let level = (height_m - landing.height_m).abs() < self.layer.walk_height_m();
        level.then_some(Footstep {
            side,
            pose,
            height_m,
            slope: [0.0; 2],
            bearing_m: landing.bearing_m,
            manner: StepManner::Walked,
        })
    }

    /// Whether the next steps of a plan are those of a walk.
    fn only_walks(&self, plan: &FootstepPlan) -> bool {
        let mut next = plan.steps.iter().take(self.config.run);
        next.all(|step| step.manner == StepManner::Walked)
    }

    /// All steps of the list landed: the robot walks on where it may, else it looks.
    fn after_list(&mut self, tick: &Tick<'_>) {
        if self.may_walk_on(tick) && self.stands_to_walk(tick) {
            self.begin_walk(tick);
        } else {
            let plan = self.planned.0.as_ref().and_then(|plan| plan.as_ref().ok());
            self.begin_look(tick, plan.and_then(|plan| plan.exit_m));
        }
    }

    fn after_misstep(&mut self, tick: &Tick<'_>, misstep: Misstep, landed: usize) {
        if let Some(hold) = self.stepper.holds.get(landed) {
            self.failed.note(*hold, misstep);
        }
        if let Some(reason) = stepper::given_up(misstep) {
            self.refuse(reason);
            return;
        }
        self.last = LastSteps::default();
        if self.failed.count() > self.config.tries as usize {
            self.refuse(match misstep {
                Misstep::NoGround => {
                    "blocked: a foot found no ground where steps were planned".to_owned()
                }
                Misstep::Obstructed | Misstep::Buckled(_) => {
                    "blocked: something was in the way of a foot".to_owned()
                }
            });
            return;
        }
        self.begin_look(tick, None);
    }

    /// Whether the feet stand side by side on one level.
    pub(super) fn stands_to_walk(&self, tick: &Tick<'_>) -> bool {
        let [left, right] = Self::soles(tick);
        let limits = self.layer.limits();
        let apart = limits.beside(&right, Side::Left).relative(&left);
        let near_m = self.config.side_by_side;
        let [left_m, right_m] = tick.situation.soles.map(|sole| sole.height_m);
        geometry::hypot(apart.x_m, apart.y_m) < near_m && (left_m - right_m).abs() < near_m
    }
}
