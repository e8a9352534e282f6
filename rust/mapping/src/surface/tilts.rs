//! How the floors of the cells are tilted: the extension to slopes that section VI of 000 leaves open.
//!
//! The camera often makes level strips of a slope, and hardly ever a slope of a level floor. So a frame that shows a slope counts for
//! several that do not, and a strip leaves the height of a cell alone that is known to be a slope's.

use geometry::Grid;

use super::FloorSlopeTuning;

/// Rise per metre along the map's axes.
type Gradient = [f32; 2];

/// What is level.
pub(super) const LEVEL: Gradient = [0.0; 2];

/// The gradients of the floors.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tilts {
    /// The gradient of a slope, and how sure it is that there is one.
    known: Grid<(Gradient, u8)>,
    /// The gradients that the frame shows which is being inserted.
    frame: Grid<Gradient>,
    tuning: FloorSlopeTuning,
}

impl Tilts {
    /// So many cells along each side, all level.
    pub(super) fn new(cells: usize, tuning: FloorSlopeTuning) -> Self {
        Self {
            known: Grid::filled(cells, cells, (LEVEL, 0)),
            frame: Grid::filled(cells, cells, LEVEL),
            tuning,
        }
    }

    /// Moves the window by whole cells.
    pub(super) fn shift(&mut self, cols: i32, rows: i32) {
        self.known.shift(cols, rows, &(LEVEL, 0));
    }

    /// The gradient of the cell that is stored at an index; nothing where it is level or not known.
    pub(super) fn gradient_at(&self, index: usize) -> Gradient {
        match self.known.values()[index] {
            (gradient, sure) if sure > 0 => gradient,
            _ => LEVEL,
        }
    }

    /// Takes note of what a frame shows of a cell.
    pub(super) fn see(&mut self, index: usize, gradient: Gradient) {
        self.frame.values_mut()[index] = gradient;
    }

    /// How much of its height a cell keeps in equation (9), where it would keep `nu` of that of a level floor.
    pub(super) fn share_kept(&self, index: usize, nu: f32) -> f32 {
        match (
            self.gradient_at(index) != LEVEL,
            self.frame.values()[index] != LEVEL,
        ) {
            (true, false) => 1.0,
            (false, true) => 0.0,
            _ => nu,
        }
    }

    /// Equation (9) for the gradient that the frame shows of a cell. `same`: whether it is the surface that the cell held before.
    pub(super) fn merge(&mut self, index: usize, same: bool, nu: f32) {
        let measured = self.frame.values()[index];
        let (stored, sure) = &mut self.known.values_mut()[index];
        if !same {
            *sure = 0;
        }
        if measured == LEVEL {
            *sure = sure.saturating_sub(1);
            return;
        }
        let share = if *sure > 0 { nu } else { 0.0 };
        for (stored, measured) in stored.iter_mut().zip(measured) {
            *stored = share * *stored + (1.0 - share) * measured;
        }
        *sure = (*sure + self.tuning.seen).min(self.tuning.most_sure);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NU: f32 = 0.9;
    const HERE: usize = 9;
    const SLOPE: Gradient = [0.1, -0.05];

    fn seen(frames: &[Gradient]) -> Tilts {
        let mut tilts = Tilts::new(4, FloorSlopeTuning::default());
        for &gradient in frames {
            tilts.see(HERE, gradient);
            tilts.merge(HERE, true, NU);
        }
        tilts
    }

    #[test]
    fn level_strips_do_not_take_a_slope_away_but_a_level_floor_does() {
        let frames = [&[SLOPE; 3][..], &[LEVEL; 11]].concat();
        assert_eq!(seen(&frames).gradient_at(HERE), SLOPE);
        let frames = [&[SLOPE; 3][..], &[LEVEL; 12]].concat();
        assert_eq!(seen(&frames).gradient_at(HERE), LEVEL);
        let frames = [&[SLOPE; 100][..], &[LEVEL; 40]].concat();
        assert_eq!(seen(&frames).gradient_at(HERE), LEVEL);
    }

    #[test]
    fn a_strip_leaves_the_height_of_a_slope_and_a_slope_replaces_that_of_a_strip() {
        let mut slope = seen(&[SLOPE]);
        assert_eq!(slope.share_kept(HERE, NU), NU);
        slope.see(HERE, LEVEL);
        assert_eq!(slope.share_kept(HERE, NU), 1.0);
        let mut level = seen(&[LEVEL]);
        assert_eq!(level.share_kept(HERE, NU), NU);
        level.see(HERE, SLOPE);
        assert_eq!(level.share_kept(HERE, NU), 0.0);
    }

    #[test]
    fn another_surface_in_its_place_is_no_slope() {
        let mut tilts = seen(&[SLOPE; 9]);
        tilts.see(HERE, LEVEL);
        tilts.merge(HERE, false, NU);
        assert_eq!(tilts.gradient_at(HERE), LEVEL);
    }
}
