//! One step of least squares for a pose in the plane: its normal equations, and their solution.

use geometry::{PlanarPose, wrap_angle};

/// The normal equations of a step of a pose: of x and y, m, and heading, rad. What is far off or curved adds up in any order.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PoseStep {
    normal: [[f64; 3]; 3],
    gradient: [f64; 3],
}

impl PoseStep {
    /// Adds the square of a residual, weighted: how far it is off, and how it changes with x, y and heading.
    pub fn add(&mut self, weight: f64, by: [f64; 3], off: f64) {
        self.pull(weight * off, by);
        self.curve(weight, by);
    }

    /// Adds a slope alone, along a direction of the pose.
    pub fn pull(&mut self, amount: f64, by: [f64; 3]) {
        for (slope, one) in self.gradient.iter_mut().zip(by) {
            *slope += amount * one;
        }
    }

    /// Adds a curvature alone, along a direction of the pose.
    pub fn curve(&mut self, amount: f64, by: [f64; 3]) {
        for (row, one) in self.normal.iter_mut().zip(by) {
            for (value, other) in row.iter_mut().zip(by) {
                *value += amount * one * other;
            }
        }
    }

    /// Holds the pose at another one, by the information (inverse covariance) of that: 1/m², 1/(m rad), 1/rad².
    pub fn hold(&mut self, pose: &PlanarPose, at: &PlanarPose, information: &[[f64; 3]; 3]) {
        let away = [
            pose.x_m - at.x_m,
            pose.y_m - at.y_m,
            wrap_angle(pose.yaw_rad - at.yaw_rad),
        ];
        for (row, known) in information.iter().enumerate() {
            for (column, &value) in known.iter().enumerate() {
                self.normal[row][column] += value;
                self.gradient[row] += value * away[column];
            }
        }
    }

    /// The second derivatives: the information that has come together.
    pub const fn information(&self) -> &[[f64; 3]; 3] {
        &self.normal
    }

    /// Makes the step shorter, and turns it into the way down: a share of the diagonal is added to it.
    #[must_use]
    pub fn damped(mut self, share: f64) -> Self {
        for axis in 0..3 {
            self.normal[axis][axis] *= 1.0 + share;
        }
        self
    }

    /// The pose after the step; none where the equations have no single solution.
    pub fn taken(&self, pose: &PlanarPose) -> Option<PlanarPose> {
        let [x_m, y_m, yaw_rad] = self.solved()?;
        Some(PlanarPose::new(
            pose.x_m - x_m,
            pose.y_m - y_m,
            wrap_angle(pose.yaw_rad - yaw_rad),
        ))
    }

    /// What is to be taken from x, y and heading, by Cramer's rule.
    fn solved(&self) -> Option<[f64; 3]> {
        let determinant = |m: [[f64; 3]; 3]| {
            m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
                - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
                + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
        };
        let whole = determinant(self.normal);
        let one = |column: usize| {
            let mut replaced = self.normal;
            for (row, &value) in replaced.iter_mut().zip(&self.gradient) {
                row[column] = value;
            }
            determinant(replaced) / whole
        };
        let solution = [one(0), one(1), one(2)];
        solution
            .iter()
            .all(|value| value.is_finite())
            .then_some(solution)
    }
}
