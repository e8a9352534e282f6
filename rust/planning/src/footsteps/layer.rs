//! The layer of footsteps: from a height map, both feet and a goal to steps.

use geometry::{Goal, PlanarPose};
use mapping::HeightMap;
use robot::Side;
use settings::{ConfigError, Table};
use terrain::footholds::{Foothold, Footholds, HighBlocks};

use super::config::FootstepsConfig;
use super::goal_field::GoalField;
use super::limits::StepLimits;
use super::plan::{FootstepPlan, NoFootsteps, PlannedFootstep};
use super::space::{FootstepSpace, START};
use super::spots::{Spots, StandingFoot};
use super::step_table::StepTable;
use super::unseen::Unseen;
use crate::search::ara_star::{AraStar, SearchProgress};

/// Plans footsteps for one robot. Its arrays are used again.
#[derive(Debug, Clone)]
pub struct FootstepLayer {
    config: FootstepsConfig,
    limits: StepLimits,
    search: AraStar,
    field: GoalField,
    spots: Spots,
    tables: Option<LatticeTables>,
}

/// Where a plan begins, and what it makes of what was not seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FootstepQuestion {
    /// Where the feet stand, left and right, in the map.
    pub feet: [PlanarPose; 2],
    /// The foot that moves first; `None`: either.
    pub first: Option<Side>,
    /// What is made of ground that was not seen.
    pub unseen: Unseen,
}

/// What depends on the size of the cells alone: steps between them, and the cells under a sole.
#[derive(Debug, Clone)]
struct LatticeTables {
    cell_m: f64,
    steps: StepTable,
    footholds: Footholds,
}

impl LatticeTables {
    fn new(config: &FootstepsConfig, limits: &StepLimits, cell_m: f64) -> Self {
        let steps = StepTable::new(config, limits, cell_m);
        let foothold = config.foothold.clone();
        // Feet stand in the middles of cells.
        let on = ([0.0; 2], cell_m);
        let footholds = Footholds::new(foothold, limits.sole, steps.yaws_rad(), on);
        Self {
            cell_m,
            steps,
            footholds,
        }
    }
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
        })
    }

    /// What the robot's steps are limited by.
    pub const fn limits(&self) -> &StepLimits {
        &self.limits
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
        question: &FootstepQuestion,
        goal: &Goal,
    ) -> Result<FootstepPlan, NoFootsteps> {
        let &FootstepQuestion {
            feet,
            first,
            unseen,
        } = question;
        self.refuse_what_is_no_question(map, &feet, goal)?;
        let blocks = HighBlocks::new(map);
        let settings = (&self.config, &self.limits);
        let middle = self.limits.middle_of(&feet[0], Side::Left);
        if !self
            .field
            .find((map, &blocks), settings, (&middle, goal), unseen)
        {
            return Err(NoFootsteps::UnseenGoal);
        }
        let Self {
            config,
            limits,
            search,
            field,
            spots,
            tables,
        } = self;
        let cell_m = map.lattice.cell_m;
        let tables = match tables {
            Some(tables) if tables.cell_m == cell_m => tables,
            _ => tables.insert(LatticeTables::new(config, limits, cell_m)),
        };
        let start = stand(map, tables, &feet)?;
        spots.clear();
        let mut space = FootstepSpace {
            map,
            blocks: &blocks,
            config,
            limits,
            field,
            goal: *goal,
            unseen,
            first,
            table: &mut tables.steps,
            footholds: &mut tables.footholds,
            start,
            spots,
            expanded: 0,
        };
        let mut best: Option<FootstepPlan> = None;
        let found = |space: &mut FootstepSpace<'_>, progress: &SearchProgress| {
            if let Some(steps) = space.steps_to(progress.last) {
                take_better(&mut best, (steps, space.exit(progress.last)), progress);
            }
        };
        let leads_on = field.remaining_s(middle.x_m, middle.y_m).is_finite();
        if leads_on {
            let _ = search.run_in(&mut space, START, &config.search(), found);
        }
        let expanded = space.expanded;
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

/// How both feet stand where they do, whatever the map says of that: there they are.
fn stand(
    map: &HeightMap,
    tables: &mut LatticeTables,
    feet: &[PlanarPose; 2],
) -> Result<[StandingFoot; 2], NoFootsteps> {
    let mut foot = |side: Side| {
        let pose = feet[side.index()];
        let cell = map.lattice.cell_at(pose.x_m, pose.y_m);
        let heading = tables.steps.nearest(pose.yaw_rad);
        let read = tables.footholds.read(map, cell, heading).ok();
        let on_height = |height_m: f32| Foothold {
            height_m,
            slope: [0.0; 2],
            bearing_m: [0.0; 2],
            bearing_share: 0.0,
        };
        let foothold = read.or_else(|| map.height_m(cell).map(on_height));
        let foothold = foothold.ok_or(NoFootsteps::UnseenStart(side))?;
        Ok(StandingFoot {
            side,
            pose,
            cell,
            heading,
            foothold,
        })
    };
    Ok([foot(Side::Left)?, foot(Side::Right)?])
}

/// Keeps the better plan of two, and what the first one cost.
fn take_better(
    best: &mut Option<FootstepPlan>,
    (steps, exit_m): (Vec<PlannedFootstep>, Option<[f64; 2]>),
    progress: &SearchProgress,
) {
    let cost_s = steps.iter().map(|step| step.cost_s).sum();
    let first = best
        .as_ref()
        .map_or((cost_s, progress.expanded), |plan| plan.first);
    // What a plan costs that ends before the goal does not tell how good it is.
    if best
        .as_ref()
        .is_none_or(|plan| exit_m.is_some() || cost_s <= plan.cost_s)
    {
        *best = Some(FootstepPlan {
            steps,
            exit_m,
            whole_s: progress.cost,
            cost_s,
            epsilon: progress.epsilon,
            first,
            expanded: progress.expanded,
        });
    }
}
