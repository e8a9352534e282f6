//! Cells of plane parameters that are voted for: two angles of the normal and the distance from the camera.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use crate::picture::Linear;

/// Votes for planes. Keeps its buffers.
#[derive(Debug, Clone)]
pub(super) struct Accumulator {
    angle_rad: f64,
    distance_m: f64,
    farthest_m: f64,
    /// Cells over the normal's angle from the horizontal plane through forward and up, over its turn in that plane, and over the distance.
    sizes: [usize; 3],
    votes: Vec<u32>,
    /// The planes that were voted for, and their cells.
    cast: Vec<(usize, Linear)>,
}

impl Accumulator {
    /// Empty, with cells of this size; planes further away than `farthest_m` get no vote.
    pub(super) fn new(angle_rad: f64, distance_m: f64, farthest_m: f64) -> Self {
        let cells = |span: f64, cell: f64| (span / cell).ceil() as usize + 1;
        let sizes = [
            cells(PI, angle_rad),
            cells(TAU, angle_rad),
            cells(farthest_m, distance_m),
        ];
        Self {
            angle_rad,
            distance_m,
            farthest_m,
            sizes,
            votes: vec![0; sizes.iter().product()],
            cast: Vec::new(),
        }
    }

    /// Takes all votes back.
    pub(super) fn clear(&mut self) {
        for (cell, _) in self.cast.drain(..) {
            self.votes[cell] = 0;
        }
    }

    /// A vote for a plane; `normal_over_distance` is its normal over its distance from the camera, 1/m.
    pub(super) fn vote(&mut self, plane: Linear, normal_over_distance: &Vector3<f64>) {
        let nearness = normal_over_distance.norm();
        // Also false for no number.
        if nearness * self.farthest_m > 1.0 {
            let normal = normal_over_distance / nearness;
            let cell = self.cell(&normal, 1.0 / nearness);
            self.votes[cell] += 1;
            self.cast.push((cell, plane));
        }
    }

    /// The pole of the angles is to the side, where the fewest planes that are walked on or into have their normals.
    fn cell(&self, normal: &Vector3<f64>, distance_m: f64) -> usize {
        let aside = (normal.y.clamp(-1.0, 1.0).asin() + PI / 2.0) / self.angle_rad;
        let turn = (normal.z.atan2(normal.x) + PI) / self.angle_rad;
        let away = distance_m / self.distance_m;
        let [i, j, k] = [aside, turn, away].map(|cells| cells as usize);
        (i * self.sizes[1] + j) * self.sizes[2] + k
    }

    /// The mean of the planes in the cell with most votes; of equals the one that was voted for first.
    pub(super) fn peak(&self) -> Option<Linear> {
        let most = self.cast.iter().map(|(cell, _)| self.votes[*cell]).max()?;
        let (best, _) = self
            .cast
            .iter()
            .find(|(cell, _)| self.votes[*cell] == most)?;
        let voters = self.cast.iter().filter(|(cell, _)| cell == best);
        let sum: Vector3<f64> = voters.map(|(_, plane)| plane.coefficients()).sum();
        Some(Linear::new(&(sum / f64::from(most))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_direction_and_distance_has_a_cell(
            x in -1.0..1.0f64, y in -1.0..1.0f64, z in -1.0..1.0f64, away in 0.001..10.0f64,
            angle in 0.03..0.5f64, distance in 0.05..0.5f64,
        ) {
            prop_assume!(x.hypot(y).hypot(z) > 0.1);
            let mut votes = Accumulator::new(angle, distance, 4.0);
            votes.vote(Linear::default(), &(Vector3::new(x, y, z).normalize() / away));
            prop_assert_eq!(votes.peak().is_some(), away < 4.0);
            votes.clear();
            prop_assert!(votes.votes.iter().all(|&count| count == 0) && votes.peak().is_none());
        }
    }

    #[test]
    fn the_peak_is_the_mean_of_those_that_agree() {
        let mut votes = Accumulator::new(0.07, 0.02, 4.0);
        let up = |distance_m: f64| Vector3::z() / distance_m;
        let plane = |origin: f64| Linear::new(&Vector3::new(0.0, 0.1, origin));
        votes.vote(plane(9.0), &up(0.43));
        votes.vote(plane(2.0), &up(0.505));
        votes.vote(plane(3.0), &up(0.515));
        assert_eq!(votes.peak(), Some(plane(2.5)));
    }

    #[test]
    fn the_corners_of_the_angles_are_cells_too() {
        let mut votes = Accumulator::new(0.03, 0.01, 4.0);
        for normal in [
            Vector3::y(),
            -Vector3::y(),
            -Vector3::x(),
            Vector3::x(),
            -Vector3::z(),
        ] {
            votes.vote(Linear::default(), &(normal / 3.999_999));
        }
        assert_eq!(votes.cast.len(), 5);
    }
}
