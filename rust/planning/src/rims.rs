//! Rims: where a level on which stairs lie ends before unseen ground. It is stepped on over the edges of its stairs only: the way there
//! from unseen ground may be as high as a wall.

use crate::treads::Treads;

/// The cells on the levels of stairs, with those stairs' heights. Reused.
#[derive(Debug, Clone, Default)]
pub(crate) struct Rims {
    cells: Vec<(usize, f32)>,
    reached: Vec<bool>,
}

impl Rims {
    /// Finds the cells beside what was not seen, of stairs on another level than the robot's at `robot_m`, and of the floor that goes on
    /// from them: where a landing was recognised only in part, the map knows more of it. `heights_m` are the cells', row by row.
    pub(crate) fn read(
        &mut self,
        (heights_m, cols): (&[f32], usize),
        treads: &Treads,
        robot_m: f64,
        max_step_m: f64,
    ) -> impl Iterator<Item = usize> + '_ {
        let max_step_m = max_step_m as f32;
        let another = |height_m: f32| (height_m - robot_m as f32).abs() > max_step_m;
        let stairs = treads.cells().map(|cell| (cell, heights_m[cell]));
        self.cells.clear();
        self.cells
            .extend(stairs.filter(|&(_, height_m)| another(height_m)));
        self.reached.clear();
        self.reached.resize(heights_m.len(), false);
        for &(cell, _) in &self.cells {
            self.reached[cell] = true;
        }
        let mut next = 0;
        let mut rims = 0;
        while let Some(&(cell, level_m)) = self.cells.get(next) {
            let mut at_rim = false;
            for beside in beside(cell, cols, heights_m.len()) {
                let height_m = heights_m[beside];
                at_rim |= height_m.is_nan();
                let goes_on = (height_m - level_m).abs() <= max_step_m && another(height_m);
                if goes_on && !self.reached[beside] {
                    self.reached[beside] = true;
                    self.cells.push((beside, level_m));
                }
            }
            if at_rim {
                self.cells.swap(rims, next);
                rims += 1;
            }
            next += 1;
        }
        self.cells[..rims].iter().map(|&(cell, _)| cell)
    }
}

/// The cells that share a side with one.
fn beside(cell: usize, cols: usize, count: usize) -> impl Iterator<Item = usize> {
    let col = cell % cols;
    [
        (col > 0, cell.wrapping_sub(1)),
        (col + 1 < cols, cell + 1),
        (cell >= cols, cell.wrapping_sub(cols)),
        (cell + cols < count, cell + cols),
    ]
    .into_iter()
    .filter_map(|(inside, next)| inside.then_some(next))
}
