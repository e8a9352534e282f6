//! A place at which a foot met something.

use geometry::{Cell, Lattice};

/// A place at which a foot met something, in the map frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeltPlace {
    /// A point of what was met, m.
    pub at_m: [f64; 2],
    /// In which direction the foot came upon it, rad.
    pub heading_rad: f64,
    /// It is at least so high, m.
    pub top_m: f64,
    /// How high the ground is that the foot came from, m.
    pub ground_m: f64,
    /// Half of the sole that met it, across the way that it came, m.
    pub half_width_m: f64,
    /// The thing that it is a part of, as the map numbers them.
    pub thing: usize,
}

impl FeltPlace {
    /// The points between which the sole met it, m: its left and its right.
    pub fn ends_m(&self) -> [[f64; 2]; 2] {
        let (sin, cos) = libm::sincos(self.heading_rad);
        [self.half_width_m, -self.half_width_m]
            .map(|aside_m| [self.at_m[0] - sin * aside_m, self.at_m[1] + cos * aside_m])
    }

    /// What was met, for people.
    pub fn told(&self) -> String {
        let [x_m, y_m] = self.at_m;
        let mm = (1e3 * (self.top_m - self.ground_m)).round();
        format!(
            "a foot met something at ({x_m:.2}, {y_m:.2}) that is {mm} mm high or more and was not seen"
        )
    }

    /// The cells that the sole met it in, each once.
    pub fn cells(&self, lattice: Lattice) -> impl Iterator<Item = Cell> + use<> {
        let [[left_x, left_y], [right_x, right_y]] = self.ends_m();
        let pieces = 4 * (self.half_width_m / lattice.cell_m).ceil().max(1.0) as usize;
        let mut last = None;
        let cells = (0..=pieces).map(move |piece| {
            let share = piece as f64 / pieces as f64;
            lattice.cell_at(
                left_x + share * (right_x - left_x),
                left_y + share * (right_y - left_y),
            )
        });
        cells.filter(move |cell| last.replace(*cell) != Some(*cell))
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) const MET: FeltPlace = FeltPlace {
        at_m: [0.5, 0.1],
        heading_rad: 0.0,
        top_m: 0.014,
        ground_m: 0.0,
        half_width_m: 0.04,
        thing: 0,
    };

    #[test]
    fn a_sole_meets_the_cells_across_its_way_each_once() {
        let lattice = Lattice {
            origin_m: [0.0, 0.0],
            cell_m: 0.04,
        };
        let cells: Vec<Cell> = MET.cells(lattice).collect();
        assert_eq!(
            cells,
            [3, 2, 1].map(|row| Cell::new(12, row)),
            "from the left to the right"
        );
        let sideways = FeltPlace {
            heading_rad: std::f64::consts::FRAC_PI_2,
            ..MET
        };
        let cells: Vec<Cell> = sideways.cells(lattice).collect();
        assert!(cells.iter().all(|cell| cell.row == 2) && cells.len() == 3);
    }
}
