//! A line, and the one that lies nearest to points: total least squares (004, equations 36.7, 36.8 and 36.14 to 36.16).

/// A point that counts so often: one measured, or several that lie together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeightedPoint {
    /// In the map frame, m.
    pub at_m: [f64; 2],
    /// How many points it stands for; need not be whole.
    pub weight: f64,
}

impl WeightedPoint {
    /// A single point, m.
    pub const fn single(at_m: [f64; 2]) -> Self {
        Self { at_m, weight: 1.0 }
    }
}

/// A line without ends, by its normal (004, equation 36.8).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanarLine {
    /// Direction of the normal, counter-clockwise from x, rad.
    pub normal_rad: f64,
    /// Distance from the origin along the normal, m.
    pub distance_m: f64,
}

/// Sums of weighted points, from which their line follows.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct WeightedSums {
    weight: f64,
    mean: [f64; 2],
    /// Weighted sums of squares and products about the mean: xx, xy, yy.
    about: [f64; 3],
}

impl WeightedSums {
    /// Takes in a point, keeping sums about the mean: no digits are lost far from the origin.
    pub(crate) fn add(&mut self, at_m: [f64; 2], weight: f64) {
        if weight <= 0.0 {
            return;
        }
        self.weight += weight;
        let off = [0, 1].map(|axis| at_m[axis] - self.mean[axis]);
        let share = weight / self.weight;
        self.mean = [0, 1].map(|axis| self.mean[axis] + share * off[axis]);
        let rest = [0, 1].map(|axis| at_m[axis] - self.mean[axis]);
        self.about[0] += weight * off[0] * rest[0];
        self.about[1] += weight * off[0] * rest[1];
        self.about[2] += weight * off[1] * rest[1];
    }

    pub(crate) const fn weight(&self) -> f64 {
        self.weight
    }

    /// The line; none of points that all lie in one place.
    pub(crate) fn line(&self) -> Option<PlanarLine> {
        let [xx, xy, yy] = self.about;
        let spread = xx + yy;
        let told = self.weight > 0.0 && spread.is_finite() && spread > 0.0;
        // Of the two angles that 36.7 leaves the one at which the sum is least, not largest: atan2 of both signs as they stand.
        let normal_rad = 0.5 * libm::atan2(-2.0 * xy, yy - xx);
        told.then(|| {
            let (sin, cos) = libm::sincos(normal_rad);
            PlanarLine {
                normal_rad,
                distance_m: self.mean[0] * cos + self.mean[1] * sin,
            }
        })
    }
}

impl PlanarLine {
    /// The line with the least sum of squared distances to points (004, equations 36.7 and 36.8); none of fewer than two different ones.
    pub fn fit(points_m: impl IntoIterator<Item = [f64; 2]>) -> Option<Self> {
        Self::fit_weighted(points_m.into_iter().map(WeightedPoint::single))
    }

    /// The line with the least weighted sum, the weight of a point as its expectation to belong to the line (004, equations 36.14 to 36.16; the means are the line's own,
    /// and the `r_i` of 36.15 is that of line j).
    pub fn fit_weighted(points: impl IntoIterator<Item = WeightedPoint>) -> Option<Self> {
        let mut sums = WeightedSums::default();
        for point in points {
            sums.add(point.at_m, point.weight);
        }
        sums.line()
    }

    /// How far a point lies on the side of the normal, m; negative on the other.
    #[inline]
    pub fn signed_distance_m(&self, at_m: [f64; 2]) -> f64 {
        let (sin, cos) = libm::sincos(self.normal_rad);
        at_m[0] * cos + at_m[1] * sin - self.distance_m
    }

    /// Where along the line the foot of a point lies, m from the point that is nearest to the origin.
    #[inline]
    pub fn along_m(&self, at_m: [f64; 2]) -> f64 {
        let (sin, cos) = libm::sincos(self.normal_rad);
        at_m[1] * cos - at_m[0] * sin
    }

    /// The point of the line so far along it, m.
    pub fn point_m(&self, along_m: f64) -> [f64; 2] {
        let (sin, cos) = libm::sincos(self.normal_rad);
        [
            self.distance_m * cos - along_m * sin,
            self.distance_m * sin + along_m * cos,
        ]
    }

    /// For loops over many points: the normal's cosine and sine, and the distance.
    pub(crate) fn normal_form(&self) -> [f64; 3] {
        let (sin, cos) = libm::sincos(self.normal_rad);
        [cos, sin, self.distance_m]
    }
}
