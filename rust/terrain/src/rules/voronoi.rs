//! Rule, where users chose it: a metre costs more the further it is from the lines with most room to either side, the generalized Voronoi
//! diagram of what stands around.

use geometry::distance::{CellDistances, NOTHING_NEAR};
use settings::{NOT_NEGATIVE, POSITIVE, settings};

use crate::Terrain;

/// Steps along which a line of the diagram is crossed.
const CROSSINGS: [[i32; 2]; 4] = [[1, 0], [0, 1], [1, 1], [1, -1]];

settings! {
    /// The planner `voronoi`, beside `[navigation.a_star]`: what a way costs off the lines with most room to either side.
    pub struct VoronoiConfig("navigation.voronoi") {
        /// What a metre costs more beside an obstacle.
        cost: f64 = 8.0, "1", NOT_NEGATIVE;
        /// How slowly that falls with the distance from the obstacle.
        falloff: f64 = 0.3, "m", POSITIVE, "Dolgov et al. 2008, equation (1)";
        /// Obstacles further away than this cost nothing.
        reach: f64 = 1.0, "m", POSITIVE, "Dolgov et al. 2008, equation (1)";
        /// Obstacles that are this far apart have a line between them; those nearer than half of it, through which nobody goes, have none.
        gap: f64 = 0.2, "m", POSITIVE;
    }
}

/// The Voronoi field of Dolgov et al. (2008): 0 on the diagram's lines, 1 at an obstacle, and in a narrow place as in a wide one.
#[derive(Debug, Clone)]
pub(super) struct VoronoiField {
    config: VoronoiConfig,
    lines: Vec<bool>,
    to_lines: CellDistances,
}

impl VoronoiField {
    pub(super) fn new(config: VoronoiConfig) -> Self {
        Self {
            config,
            lines: Vec::new(),
            to_lines: CellDistances::default(),
        }
    }

    /// Adds to each cell's weight what being off the lines costs there.
    pub(super) fn apply(&mut self, terrain: &mut Terrain) {
        let (cols, cell_m) = (terrain.cols, terrain.lattice.cell_m);
        let (weights, distance) = (&mut terrain.weights, &terrain.distance);
        let gap_cells = (self.config.gap / cell_m).max(1.0);
        mark_lines(&mut self.lines, &distance.squared, cols, gap_cells);
        self.to_lines.compute(&self.lines, cols);
        let squared = distance.squared.iter().zip(&self.to_lines.squared);
        for (weight, (&to_obstacle, &to_line)) in weights.iter_mut().zip(squared) {
            let [to_obstacle_m, to_line_m] =
                [to_obstacle, to_line].map(|squared| f64::from(squared).sqrt() * cell_m);
            *weight += (self.config.cost * self.config.field(to_obstacle_m, to_line_m)) as f32;
        }
    }
}

impl VoronoiConfig {
    /// Equation (1) of Dolgov et al.
    fn field(&self, to_obstacle_m: f64, to_line_m: f64) -> f64 {
        if to_obstacle_m >= self.reach || to_obstacle_m + to_line_m <= 0.0 {
            return 0.0;
        }
        let near = self.falloff / (self.falloff + to_obstacle_m);
        let aside = to_line_m / (to_obstacle_m + to_line_m);
        near * aside * (1.0 - to_obstacle_m / self.reach).powi(2)
    }
}

/// Marks the cells between obstacles that are `gap_cells` or more apart, and none between those that are less than half as far. Of a cell
/// at p with the nearest obstacle at q, p² - d² = 2 p q - q²: where it bends, another obstacle is the nearest, and it bends by as much as those two are apart.
fn mark_lines(lines: &mut Vec<bool>, squared: &[u32], cols: usize, gap_cells: f64) {
    lines.clear();
    lines.resize(squared.len(), false);
    let rows = squared.len() / cols.max(1);
    let at = |index: usize| f64::from(squared[index]);
    for row in 1..rows.saturating_sub(1) {
        for col in 1..cols - 1 {
            let index = row * cols + col;
            if squared[index] >= NOTHING_NEAR || squared[index] == 0 {
                continue;
            }
            lines[index] = CROSSINGS.iter().any(|&[right, up]| {
                let step = (up * cols as i32 + right) as isize;
                let [ahead, behind] = [step, -step].map(|step| index.wrapping_add_signed(step));
                let length2 = f64::from(right * right + up * up);
                let bend = 2.0 * (length2 + at(index)) - at(ahead) - at(behind);
                bend >= gap_cells * length2.sqrt()
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const COLS: usize = 40;

    fn lines(obstacle: impl Fn(i32, i32) -> bool, gap_cells: f64) -> (Vec<bool>, CellDistances) {
        let cells = 0..(COLS * COLS) as i32;
        let blocked: Vec<bool> = cells
            .map(|cell| obstacle(cell % COLS as i32, cell / COLS as i32))
            .collect();
        let mut distance = CellDistances::default();
        distance.compute(&blocked, COLS);
        let mut lines = Vec::new();
        mark_lines(&mut lines, &distance.squared, COLS, gap_cells);
        (lines, distance)
    }

    #[test]
    fn between_two_walls_the_line_is_in_the_middle_and_nowhere_else() {
        let (lines, _) = lines(|_, row| row <= 5 || row >= 25, 4.0);
        for (index, &line) in lines.iter().enumerate() {
            let (col, row) = (index % COLS, index / COLS);
            if col > 0 && col + 1 < COLS {
                assert_eq!(line, row == 15, "{col} {row}");
            }
        }
    }

    #[test]
    fn one_wall_has_no_line_however_rough_it_is() {
        let (lines, _) = lines(|col, row| row <= 5 + col % 2, 5.0);
        assert!(lines.iter().all(|line| !line));
    }

    proptest! {
        #[test]
        fn a_line_has_two_obstacles_about_as_near_to_it(
            points in prop::collection::hash_set((0..40_i32, 0..40_i32), 2..12),
        ) {
            const GAP: f64 = 6.0;
            let (lines, distance) = lines(|col, row| points.contains(&(col, row)), GAP);
            for index in (0..lines.len()).filter(|&index| lines[index]) {
                let (col, row) = ((index % COLS) as i32, (index / COLS) as i32);
                let away = |&(c, r): &(i32, i32)| f64::from((c - col).pow(2) + (r - row).pow(2)).sqrt();
                let least = f64::from(distance.squared(index)).sqrt();
                // A neighbour is at most 1.5 cells away, to which another obstacle is the nearest.
                let near: Vec<_> = points.iter().filter(|point| away(point) <= least + 2.0 * 1.5).collect();
                let apart = |a: &(i32, i32), b: &(i32, i32)| f64::from((a.0 - b.0).pow(2) + (a.1 - b.1).pow(2)).sqrt();
                prop_assert!(near.iter().any(|a| near.iter().any(|b| apart(a, b) >= 0.5 * GAP)));
            }
        }

        #[test]
        fn the_field_is_a_share_that_falls_towards_the_lines(
            to_obstacle in 0.0..2.0f64, to_line in 0.0..2.0f64, nearer in 0.0..1.0f64,
        ) {
            let config = VoronoiConfig::default();
            let field = config.field(to_obstacle, to_line);
            prop_assert!((0.0..=1.0).contains(&field));
            prop_assert!(config.field(to_obstacle, nearer * to_line) <= field);
            prop_assert_eq!(config.field(to_obstacle, 0.0), 0.0);
        }
    }
}
