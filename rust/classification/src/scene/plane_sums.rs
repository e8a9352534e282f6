//! Sums over pixels for the best plane through them, in inverse depth.

use nalgebra::{Matrix3, Vector3};

/// What a plane is fitted to.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct PatchSums {
    moments: Matrix3<f64>,
    products: Vector3<f64>,
    squares: f64,
}

impl PatchSums {
    /// Adds a pixel by its ray and its inverse depth over the noise.
    pub(crate) fn add(&mut self, ray: &Vector3<f64>, inverse_depth: f64) {
        self.moments += ray * ray.transpose();
        self.products += ray * inverse_depth;
        self.squares += inverse_depth * inverse_depth;
    }

    /// Both together.
    pub(crate) fn joined(&self, other: &Self) -> Self {
        Self {
            moments: self.moments + other.moments,
            products: self.products + other.products,
            squares: self.squares + other.squares,
        }
    }

    /// Number of pixels.
    pub(crate) fn count(&self) -> f64 {
        self.moments[(2, 2)]
    }

    /// The plane of least squares: its scalar product with a ray is the inverse depth there. None where the pixels lie in a line.
    pub(crate) fn plane(&self) -> Option<Vector3<f64>> {
        let plane = self.moments.try_inverse()? * self.products;
        plane.iter().all(|value| value.is_finite()).then_some(plane)
    }

    /// Sum of what that plane leaves over, squared; of pixels in a line more than any.
    pub(crate) fn cost(&self) -> f64 {
        let left = |plane: Vector3<f64>| (self.squares - self.products.dot(&plane)).max(0.0);
        self.plane().map_or(f64::INFINITY, left)
    }
}
