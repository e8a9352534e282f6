//! The steps that are planned: over the ground as it is known now, from where the feet stand.

use geometry::{Cell, CellArea, PlanarPose};
use mapping::HeightMap;
use planning::footsteps::{
    FootstepPlan, FootstepQuestion, NoFootsteps, PlannedFootstep, StepLimits, Unseen,
};
use robot::Side;
use terrain::ground_map::SoleOnGround;

use super::Footsteps;
use crate::Footstep;
use crate::machine::Tick;

/// Where feet found no ground, or met something: nothing is planned there until the robot walks again.
#[derive(Debug, Clone, Default)]
pub(super) struct Failed(Vec<PlanarPose>);

impl Failed {
    /// A foot that was to land here did not.
    pub(super) fn note(&mut self, pose: PlanarPose) {
        self.0.push(pose);
    }

    /// What was noted counts no more.
    pub(super) fn forget(&mut self) {
        self.0.clear();
    }

    /// How often a foot failed.
    pub(super) fn count(&self) -> usize {
        self.0.len()
    }

    /// Takes the ground away under soles that failed.
    fn take_from(&self, map: &mut HeightMap, limits: &StepLimits) {
        let half_m = [0.5 * limits.sole.length_m, 0.5 * limits.sole.width_m];
        for pose in &self.0 {
            for cell in cells_under(map, pose, half_m).collect::<Vec<_>>() {
                map.set(cell, f32::NAN, 0.0);
            }
        }
    }
}

/// The cells under a sole.
fn cells_under(map: &HeightMap, pose: &PlanarPose, half_m: [f64; 2]) -> impl Iterator<Item = Cell> {
    let reach_m = geometry::hypot(half_m[0], half_m[1]);
    let lattice = map.lattice;
    let area = CellArea {
        min: lattice.cell_at(pose.x_m - reach_m, pose.y_m - reach_m),
        max: lattice.cell_at(pose.x_m + reach_m, pose.y_m + reach_m),
    };
    let from_map = pose.inverse();
    area.cells().filter(move |cell| {
        let [x_m, y_m] = lattice.center_of(*cell);
        let (ahead_m, left_m) = from_map.apply(x_m, y_m);
        ahead_m.abs() <= half_m[0] && left_m.abs() <= half_m[1]
    })
}

impl Footsteps {
    /// Where the soles are in the map.
    pub(super) fn soles(tick: &Tick<'_>) -> [PlanarPose; 2] {
        tick.situation
            .soles
            .map(|sole| tick.pose.compose(&sole.pose))
    }

    /// Reads the ground around feet that stand here.
    pub(super) fn read_ground(&mut self, tick: &Tick<'_>, feet: &[PlanarPose; 2]) {
        let limits = *self.layer.limits();
        let half_m = [0.5 * limits.sole.length_m, 0.5 * limits.sole.width_m];
        let soles = [0, 1].map(|foot: usize| SoleOnGround {
            pose: feet[foot],
            half_m,
            height_m: (tick.ground_m + tick.situation.soles[foot].height_m) as f32,
        });
        let (view, stairs) = (tick.situation.view, tick.situation.stairs);
        let _ = self.ground.read(view, stairs, &soles);
        self.failed.take_from(self.ground.map_mut(), &limits);
    }

    /// Plans steps from feet that stand here, over the ground as it was read.
    pub(super) fn plan_from(
        &mut self,
        tick: &Tick<'_>,
        feet: [PlanarPose; 2],
        first: Option<Side>,
    ) -> Result<FootstepPlan, NoFootsteps> {
        // Where the robot looked in vain it goes nearer.
        let nearer = 1.0 / f64::from(1 + self.looks);
        let unseen = Unseen::Priced {
            stop_before_m: self.config.look_from * nearer,
            faces_rad: self.config.faces,
        };
        let question = FootstepQuestion {
            feet,
            first,
            unseen,
        };
        let goal = tick.situation.goal;
        self.layer.plan_over(self.ground.map(), &question, goal)
    }

    /// Height of the ground under a foot, m.
    pub(super) fn height_under_m(&self, foot: &PlanarPose) -> Option<f64> {
        let map = self.ground.map();
        let cell = map.lattice.cell_at(foot.x_m, foot.y_m);
        map.height_m(cell).map(f64::from)
    }
}

/// A planned step as the walker is told it, in the map.
pub(super) fn told(step: &PlannedFootstep) -> Footstep {
    Footstep {
        side: step.side,
        pose: step.pose,
        height_m: f64::from(step.foothold.height_m),
        bearing_m: step.foothold.bearing_m.map(f64::from),
    }
}

/// Both feet, after the one of this side has gone there.
pub(super) fn after(feet: &[PlanarPose; 2], side: Side, to: PlanarPose) -> [PlanarPose; 2] {
    let mut feet = *feet;
    feet[side.index()] = to;
    feet
}
