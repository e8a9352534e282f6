//! What was measured in the directions around the robot: each counts the same, however long it was looked at.

use geometry::wrap_angle;

use super::tuning::MOST_DIRECTIONS;

/// Means by the direction of the camera.
#[derive(Debug, Clone, Copy)]
pub(super) struct Directions {
    told_apart: usize,
    sums: [f64; MOST_DIRECTIONS],
    counts: [u32; MOST_DIRECTIONS],
}

impl Directions {
    /// No values yet, for so many directions that are told apart.
    pub(super) const fn new(told_apart: usize) -> Self {
        Self {
            told_apart,
            sums: [0.0; MOST_DIRECTIONS],
            counts: [0; MOST_DIRECTIONS],
        }
    }

    /// Takes in a value for the direction of a heading, rad.
    pub(super) fn add(&mut self, heading_rad: f64, value: f64) {
        let turn = wrap_angle(heading_rad) / std::f64::consts::TAU + 0.5;
        let place = ((turn * self.told_apart as f64) as usize).min(self.told_apart - 1);
        self.sums[place] += value;
        self.counts[place] += 1;
    }

    /// How many directions there are values of.
    pub(super) fn count(&self) -> usize {
        self.counts.iter().filter(|&&count| count > 0).count()
    }

    /// Mean over the directions of each one's mean; nothing without any.
    pub(super) fn mean(&self) -> f64 {
        let sums = &self.sums[..self.told_apart];
        let sum: f64 = (sums.iter().zip(&self.counts))
            .map(|(sum, &count)| sum / f64::from(count.max(1)))
            .sum();
        sum / self.count().max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_counts_once_however_often_it_was_looked_at() {
        let mut directions = Directions::new(12);
        assert_eq!((directions.count(), directions.mean()), (0, 0.0));
        for _ in 0..100 {
            directions.add(0.1, 1.0);
        }
        directions.add(2.0, 0.0);
        // To both sides of pi.
        directions.add(3.1, -1.0);
        directions.add(-3.1, -1.0);
        assert_eq!((directions.count(), directions.mean()), (4, -0.25));
    }
}
