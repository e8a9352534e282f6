//! Steps that the planner lists: taken while they hold.

use geometry::PlanarPose;
use planning::footsteps::{FootstepPlan, ListedStep, NoFootsteps, PlannedFootstep};
use robot::Side;

use super::Footsteps;
use crate::machine::Tick;

/// What became of the planner's lists.
#[derive(Debug, Clone, Default)]
pub(super) struct PlannersList {
    /// Whether the steps that are taken are of a list.
    pub(super) followed: bool,
    /// The list that was begun last, whole.
    begun: Vec<ListedStep>,
    /// The first step of what was refused last, and why.
    refused: Option<(ListedStep, String)>,
}

impl PlannersList {
    /// Why a list was refused last.
    pub(super) fn refusal(&self) -> Option<&str> {
        self.refused.as_ref().map(|(_, why)| why.as_str())
    }

    /// Whether a list that begins so was refused just now: it is not tried again.
    fn is_refused(&self, first: &ListedStep, within_m: f64) -> bool {
        self.refused.as_ref().is_some_and(|(refused, _)| {
            refused.side == first.side && refused.pose.distance_m(&first.pose) < within_m
        })
    }
}

impl Footsteps {
    /// What the planner lists on from where the feet stand: nothing of what was taken already, nor of a list that does not hold.
    pub(super) fn listed_on<'a>(&self, tick: &Tick<'a>) -> &'a [ListedStep] {
        let listed = Self::all_listed(tick);
        let soles = Self::soles(tick);
        let near_m = 0.5 * self.layer.limits().sole.width_m;
        let taken = |step: &ListedStep| soles[step.side.index()].distance_m(&step.pose) < near_m;
        // Of a list that was begun, what is taken is past.
        let past = (listed == self.list.begun).then(|| listed.iter().rposition(taken));
        let rest = &listed[past.flatten().map_or(0, |last| last + 1)..];
        match rest.first() {
            Some(first) if !self.list.is_refused(first, near_m) => rest,
            _ => &[],
        }
    }

    /// All that the planner lists now.
    fn all_listed<'a>(tick: &Tick<'a>) -> &'a [ListedStep] {
        let way = tick.situation.plan.and_then(|plan| plan.way.as_ref().ok());
        way.map_or(&[][..], |path| &path.footsteps)
    }

    /// Whether the planner lists steps that begin here.
    pub(super) fn is_at_list(&self, tick: &Tick<'_>) -> bool {
        let first = self.listed_on(tick).first();
        first.is_some_and(|step| step.pose.distance_m(&tick.pose) < self.config.stop_before)
    }

    /// The steps on from feet that stand here: those that the planner lists, or those of its list that were begun; where there are none, or one of
    /// them does not hold, others, of which those that were planned before may be kept.
    pub(super) fn plan_next(
        &mut self,
        tick: &Tick<'_>,
        feet: [PlanarPose; 2],
        first: Option<Side>,
        planned: &[PlannedFootstep],
    ) -> Result<FootstepPlan, NoFootsteps> {
        let begun = || {
            let steps = planned.iter().map(|step| ListedStep {
                side: step.side,
                pose: step.pose,
            });
            steps.collect()
        };
        let listed: Vec<ListedStep> = match first {
            Some(_) if self.list.followed => begun(),
            Some(_) => Vec::new(),
            None => self.listed_on(tick).to_vec(),
        };
        self.list.followed = false;
        if let Some(begins) = listed.first() {
            let goal = tick.situation.goal;
            match (self.layer).follow(self.ground.map(), &feet, &listed, goal) {
                Ok(plan) => {
                    self.list.followed = true;
                    if first.is_none() {
                        self.list.begun = Self::all_listed(tick).to_vec();
                    }
                    self.planned = (Some(Ok(plan.clone())), self.planned.1 + 1);
                    return Ok(plan);
                }
                Err(why) => self.list.refused = Some((*begins, why.to_string())),
            }
        }
        let planned = if listed.is_empty() { planned } else { &[] };
        self.plan_from(tick, feet, first, planned)
    }
}
