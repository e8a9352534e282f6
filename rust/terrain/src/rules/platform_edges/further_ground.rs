//! Raised ground that goes on from the level that the robot stands on: over slopes, or as far as the heights of that level are unsure.

use mapping::{FloorView, Surface};

use crate::{Terrain, cells::beside};

/// Which cells that is. Reused.
#[derive(Debug, Clone, Default)]
pub(super) struct FurtherGround {
    cells: Vec<bool>,
    next: Vec<usize>,
    heights_m: Vec<f32>,
}

impl FurtherGround {
    /// Whether it ends in a cell, beside another one without a height: where nothing was seen there, and of a slope only where the robot was
    /// so near that it would have seen more of it.
    pub(super) fn ends_at(
        &self,
        ground: usize,
        beside: usize,
        (terrain, view): (&Terrain, &FloorView),
    ) -> bool {
        let was_near = || f64::from(terrain.nearest_m[beside]) <= terrain.settings.judge_range;
        self.cells.get(ground) == Some(&true)
            && view.cells.values()[beside] == Surface::Unknown
            && (!terrain.slopes.is_near(ground) || was_near())
    }

    /// Finds the ground that goes on from cells of the robot's level without a step, where it is sloped or its heights are unsure, and from there
    /// on. It is raised by `raised_m` over `told_m`, or over as many cells as are believed.
    pub(super) fn find(
        &mut self,
        terrain: &Terrain,
        level: &[bool],
        (raised_m, told_m, lower_cells): (f64, f64, usize),
    ) {
        self.cells.clear();
        let is_unsure = || terrain.sigma_m.iter().any(|&sigma_m| sigma_m > 0.0);
        if terrain.slopes.near.is_empty() && !is_unsure() {
            return;
        }
        let lowest_m = self.lowest_m(terrain, lower_cells).min(told_m);
        let floor_m = terrain.needs.limits.floor_m as f32;
        self.cells.resize(level.len(), false);
        self.next.clear();
        let on_level = level.iter().enumerate();
        (self.next).extend(on_level.filter_map(|(index, &level)| level.then_some(index)));
        while let Some(here) = self.next.pop() {
            for there in beside(here, terrain.cols, level.len()) {
                let [from_m, to_m] = [here, there].map(|index| terrain.height_m[index]);
                let is_new = !level[there] && !self.cells[there];
                let (noise_m, slopes) = (terrain.noise_m(here, there), &terrain.slopes);
                let is_unsure = noise_m > 0.0 || slopes.is_near(here) || slopes.is_near(there);
                let leads_on = is_unsure || self.cells[here];
                // What is no number is no ground.
                let is_raised = f64::from(to_m) > lowest_m + raised_m;
                let joined = is_new && leads_on && is_raised && !terrain.blocked[there];
                if joined && slopes.step_m(here, there, to_m - from_m) <= floor_m + noise_m {
                    self.cells[there] = true;
                    self.next.push(there);
                }
            }
        }
    }

    /// The height, m, below which no more cells lie than are believed.
    fn lowest_m(&mut self, terrain: &Terrain, lower_cells: usize) -> f64 {
        let known_m = terrain.height_m.iter().filter(|height| !height.is_nan());
        self.heights_m.clear();
        self.heights_m.extend(known_m);
        let at = lower_cells.saturating_sub(1);
        if at >= self.heights_m.len() {
            return f64::INFINITY;
        }
        let (_, &mut lowest_m, _) = self.heights_m.select_nth_unstable_by(at, f32::total_cmp);
        f64::from(lowest_m)
    }
}
