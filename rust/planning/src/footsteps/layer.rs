//! The layer of footsteps: from a height map, both feet and a goal to steps.

use std::time::Instant;

use geometry::{Goal, PlanarPose};
use mapping::HeightMap;
use robot::Side;
use settings::{ConfigError, Table};
use terrain::footholds::HighBlocks;

use super::config::FootstepsConfig;
use super::goal_field::GoalField;
use super::lattice_tables::{LatticeTables, stand};
use super::limits::StepLimits;
use super::plan::{FootstepPlan, NoFootsteps};
use super::question::FootstepQuestion;

use super::spots::Spots;
use super::unseen::Unseen;
use crate::search::ara_star::AraStar;

/// Plans footsteps for one robot. Its arrays are used again.
#[derive(Debug, Clone)]
pub struct FootstepLayer {
    pub(super) config: FootstepsConfig,
    pub(super) limits: StepLimits,
    pub(super) search: AraStar,
    pub(super) field: GoalField,
    pub(super) spots: Spots,
    pub(super) tables: Option<LatticeTables>,
    pub(super) times: PlanTimes,
    /// When it began to plan last.
    pub(super) began: Instant,
}

/// How long planning took. Nothing that decides reads it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanTimes {
    /// Until a first plan was found, s; NaN where none was.
    pub first_s: f64,
    /// Until the best was, or none, s.
    pub best_s: f64,
}

impl FootstepLayer {
    /// For a robot whose steps are limited like this.
    ///
    /// # Errors
    ///
    /// A setting is out of its bounds.
    pub fn new(config: FootstepsConfig, limits: StepLimits) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            config,
            limits,
            search: AraStar::default(),
            field: GoalField::default(),
            spots: Spots::default(),
            tables: None,
            times: PlanTimes {
                first_s: f64::NAN,
                best_s: f64::NAN,
            },
            began: Instant::now(),
        })
    }

    /// What the robot's steps are limited by.
    pub const fn limits(&self) -> &StepLimits {
        &self.limits
    }

    /// How long it took to plan last.
    pub const fn times(&self) -> PlanTimes {
        self.times
    }

    /// Ground whose height differs by no more is walked on, m.
    pub const fn walk_height_m(&self) -> f64 {
        self.config.walk_height
    }

    /// Both feet side by side around a place, left and right.
    pub fn feet_around(&self, middle: &PlanarPose) -> [PlanarPose; 2] {
        Side::BOTH.map(|side| {
            let half_m = 0.5 * side.sign() * self.limits.stance_width_m;
            middle.compose(&PlanarPose::new(0.0, half_m, 0.0))
        })
    }

    /// Steps from where the feet stand, left and right in the map, until the middle between them is within the goal's radius and they stand
    /// side by side.
    ///
    /// # Errors
    ///
    /// Why there are none.
    pub fn plan(
        &mut self,
        map: &HeightMap,
        feet: [PlanarPose; 2],
        goal: &Goal,
    ) -> Result<FootstepPlan, NoFootsteps> {
        let question = FootstepQuestion {
            feet,
            first: None,
            unseen: Unseen::Closed,
            vain_m: &[],
            planned: &[],
        };
        self.plan_over(map, &question, goal)
    }

    /// [`Self::plan`] over ground of which not all was seen: where the way leads over such, a plan ends before it.
    ///
    /// # Errors
    ///
    /// Why there are no steps.
    pub fn plan_over(
        &mut self,
        map: &HeightMap,
        question: &FootstepQuestion<'_>,
        goal: &Goal,
    ) -> Result<FootstepPlan, NoFootsteps> {
        let feet = question.feet;
        self.refuse_what_is_no_question(map, &feet, goal)?;
        self.began = Instant::now();
        let blocks = HighBlocks::new(map);
        let settings = (&self.config, &self.limits);
        let middle = self.limits.middle_of(&feet[0], Side::Left);
        if !self
            .field
            .find((map, &blocks), settings, (&middle, goal), question)
        {
            return Err(NoFootsteps::UnseenGoal);
        }
        let leads_on = self.field.remaining_s(middle.x_m, middle.y_m).is_finite();
        let cell_m = map.lattice.cell_m;
        if (self.tables.as_ref()).is_none_or(|tables| tables.cell_m != cell_m) {
            self.tables = Some(LatticeTables::new(&self.config, &self.limits, cell_m));
        }
        let tables = self.tables.as_mut();
        let start = tables.map(|tables| stand(map, tables, &feet)).transpose()?;
        self.times.first_s = f64::NAN;
        let (best, expanded) = match start {
            Some(feet) if leads_on => self.best_steps((map, &blocks), (feet, question), goal),
            _ => (None, 0),
        };
        self.times.best_s = self.began.elapsed().as_secs_f64();
        match best {
            Some(plan) => Ok(FootstepPlan { expanded, ..plan }),
            None => Err(self.why_none(leads_on, expanded)),
        }
    }

    const fn why_none(&self, leads_on: bool, expanded: usize) -> NoFootsteps {
        if !leads_on {
            NoFootsteps::NoWay {
                rise_m: self.limits.careful_rise_m,
            }
        } else if expanded >= self.config.most_expansions {
            NoFootsteps::GivenUp(expanded)
        } else {
            NoFootsteps::NoSteps(expanded)
        }
    }

    fn refuse_what_is_no_question(
        &self,
        map: &HeightMap,
        feet: &[PlanarPose; 2],
        goal: &Goal,
    ) -> Result<(), NoFootsteps> {
        let numbers = feet
            .iter()
            .flat_map(|foot| [foot.x_m, foot.y_m, foot.yaw_rad]);
        let mut numbers = numbers.chain([goal.x_m, goal.y_m, goal.radius_m]);
        if !numbers.all(f64::is_finite) {
            return Err(NoFootsteps::NotFinite);
        }
        let most_m = 0.5 * self.limits.sole.width_m;
        let least_m = self.limits.sole.length_m / self.config.sole_cells as f64;
        let got_m = map.lattice.cell_m;
        if (least_m..=most_m).contains(&got_m) {
            Ok(())
        } else {
            Err(NoFootsteps::Cells {
                least_m,
                most_m,
                got_m,
            })
        }
    }
}
