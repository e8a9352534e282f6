//! Eight guesses side by side.

use volume::{LANES, Lanes};

use super::particle::TorsoPose;

/// Where eight torsos would be, and how turned.
pub(super) struct Guesses {
    /// Rows of the rotations.
    rows: [[[f64; 3]; 3]; LANES],
    /// Rows of the rotations in single precision, guess beside guess.
    rows_beside: [[Lanes; 3]; 3],
    places_m: [[f64; 3]; LANES],
}

impl Guesses {
    pub(super) fn of(poses: &[TorsoPose; LANES]) -> Self {
        let rows = poses.map(|pose| {
            let turn = pose.isometry().rotation.to_rotation_matrix();
            std::array::from_fn(|a| [turn[(a, 0)], turn[(a, 1)], turn[(a, 2)]])
        });
        let beside = |row: usize, col: usize| {
            Lanes::from(rows.map(|rows: [[f64; 3]; 3]| rows[row][col] as f32))
        };
        Self {
            rows_beside: std::array::from_fn(|row| std::array::from_fn(|col| beside(row, col))),
            rows,
            places_m: poses.map(|pose| pose.place_m),
        }
    }

    /// A direction in the torsos' frames as seen in the map, axis by axis.
    #[inline]
    pub(super) fn turned(&self, direction: &[f64; 3]) -> [Lanes; 3] {
        let [x, y, z] = direction.map(|along| Lanes::splat(along as f32));
        self.rows_beside
            .map(|row| row[0] * x + row[1] * y + row[2] * z)
    }

    /// A place in the torsos' frames as seen in the map, axis by axis, m.
    #[inline]
    pub(super) fn placed(&self, at_m: &[f64; 3]) -> [[f64; LANES]; 3] {
        std::array::from_fn(|a| {
            std::array::from_fn(|lane| {
                let row = &self.rows[lane][a];
                self.places_m[lane][a] + row[0] * at_m[0] + row[1] * at_m[1] + row[2] * at_m[2]
            })
        })
    }
}
