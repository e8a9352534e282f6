//! Whether there is room: for a move before a step, for the feet on it, to walk and to turn behind it.

use mapping::Surface;
use planning::Step;

use super::{Here, StairClimbing};
use crate::climbing::flight::{ROOMY_M, SAME_HEIGHT_M, crosses_another};
use crate::climbing::footsteps::Stance;
use crate::walking::is_edge;

/// What is higher above a step than this stands on it, m.
const STANDS_ON_M: f32 = 0.04;

impl StairClimbing {
    /// Whether a move to where `first` is taken from crosses no other edge, leaves both heels on the stair that the robot stands
    /// on, and needs no large turn.
    pub(super) fn stays_on(&self, here: &Here<'_>, stance: &Stance, first: &Step) -> bool {
        const LARGEST_TURN_RAD: f64 = 0.3;
        const MARGIN_M: f64 = 0.01;
        let (stairs, to) = (here.situation.stairs, &stance.pose);
        if crosses_another(stairs, &here.pose, here.ground_m, to, first, &self.climbing) {
            return false;
        }
        let Some(on) = self.on else {
            return true;
        };
        let turn_rad = geometry::angle_between(here.pose.yaw_rad, stance.pose.yaw_rad);
        let least_m = self.climbing.set_for(on.rise_m).front_x_limit - MARGIN_M;
        let half_pair_m = 0.5 * self.feet.pair_width_m;
        turn_rad.abs() < LARGEST_TURN_RAD
            && [-half_pair_m, half_pair_m].into_iter().all(|aside_m| {
                let (x_m, y_m) = stance.pose.apply(-0.5 * self.feet.length_m, aside_m);
                on.stair.front.beyond_m([x_m, y_m]) >= least_m
            })
    }

    /// Whether something stands where the feet shall go: not the riser behind the heels or before the toes.
    pub(super) fn is_occupied(&self, here: &Here<'_>, stance: &Stance) -> bool {
        const RASTER: i32 = 4;
        let view = here.situation.view;
        let half = [0.5 * self.feet.length_m, 0.5 * self.feet.pair_width_m];
        let top_m = stance.height_m as f32 + STANDS_ON_M;
        let mut cells = Vec::new();
        for (i, j) in (-RASTER..=RASTER).flat_map(|i| (-RASTER..=RASTER).map(move |j| (i, j))) {
            let share = |k: i32| f64::from(k) / f64::from(RASTER);
            let (x_m, y_m) = stance.pose.apply(share(i) * half[0], share(j) * half[1]);
            let Surface::Obstacle(height_m) = view.at(x_m, y_m) else {
                continue;
            };
            let cell = view.lattice.cell_at(x_m, y_m);
            let obstacle = (view.lattice.center_of(cell), height_m);
            let riser = is_edge(here.situation.stairs, &obstacle);
            if height_m > top_m && !riser && !cells.contains(&cell) {
                cells.push(cell);
            }
        }
        cells.len() >= 2
    }

    /// Whether what the robot stands on, as it is known by now, has room to turn and to walk.
    pub(super) fn has_room(&self, here: &Here<'_>) -> bool {
        let at = [here.pose.x_m, here.pose.y_m];
        let roomy = |stair: &stairs::Stair<geometry::Map>| stair.depth_m() >= ROOMY_M;
        let stands_on = |stair: &&stairs::Stair<geometry::Map>| {
            (stair.height_m() - here.ground_m).abs() < SAME_HEIGHT_M
                && stair.front.beyond_m(at) > 0.0
                && stair.back.beyond_m(at) < 0.0
        };
        let mut known_now = here.situation.stairs.stairs.iter().filter(stands_on);
        self.on.is_none_or(|step| roomy(&step.stair)) || known_now.any(roomy)
    }
}
