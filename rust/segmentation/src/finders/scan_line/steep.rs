//! Steep lines on a strip: what shows that a stack of thin horizontal pieces is a wall.

/// Sums for a straight line through disparities, weighted by the inverse square of the noise.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LineSums {
    w: f64,
    row: f64,
    row_row: f64,
    d: f64,
    row_d: f64,
    d_d: f64,
    g: f64,
    row_g: f64,
}

impl LineSums {
    /// The sums with one more row.
    pub(super) fn with(&self, row: f64, d: f64, g: f64, w: f64) -> Self {
        Self {
            w: self.w + w,
            row: self.row + w * row,
            row_row: self.row_row + w * row * row,
            d: self.d + w * d,
            row_d: self.row_d + w * row * d,
            d_d: self.d_d + w * d * d,
            g: self.g + w * g,
            row_g: self.row_g + w * row * g,
        }
    }

    /// Squared residuals, in noise, of the best line between two sums, where that line is steep: where its disparity changes by less
    /// than this share of what a horizontal surface's would.
    pub(super) fn steep_cost(&self, before: &Self, share: f64) -> Option<f64> {
        let (w, row) = (self.w - before.w, self.row - before.row);
        let (d, g) = (self.d - before.d, self.g - before.g);
        let rows = self.row_row - before.row_row - row * row / w;
        let row_d = self.row_d - before.row_d - row * d / w;
        let row_g = self.row_g - before.row_g - row * g / w;
        let steep = row_d * g < share * row_g * d;
        (steep && rows > 0.0).then(|| self.d_d - before.d_d - d * d / w - row_d * row_d / rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCALE: f64 = 6.0;

    /// Cost of the best steep line through a surface that rises by `slope` (tangent; infinite: a wall), seen by a camera
    /// 0.5 m above it that looks down by 40 to 60 degrees.
    fn cost(slope: f64) -> Option<f64> {
        let mut sums = LineSums::default();
        for row in 0..30 {
            let down = (40.0 + 20.0 * f64::from(row) / 29.0_f64).to_radians();
            // The ray's fall and way forward for a unit of depth of a camera that looks down by 50 degrees.
            let depth = libm::cos(down - 50.0_f64.to_radians());
            let (fall, forward) = (libm::sin(down) / depth, libm::cos(down) / depth);
            let d = if slope.is_infinite() {
                SCALE * forward / 0.4
            } else {
                SCALE * (fall + slope * forward) / 0.5
            };
            // What rises linearly on the image is linear in the row's tangent, here close enough to the row.
            let tangent = libm::tan(down - 50.0_f64.to_radians());
            sums = sums.with(tangent * 100.0, d, SCALE * fall, 64.0);
        }
        sums.steep_cost(&LineSums::default(), 0.3)
    }

    #[test]
    fn a_wall_is_a_steep_line() {
        assert!(cost(f64::INFINITY).is_some_and(|cost| cost < 1.0));
    }

    #[test]
    fn floors_ramps_and_the_slope_of_stairs_are_not_steep() {
        for slope in [-0.25, -0.1, 0.0, 0.1, 0.25] {
            assert_eq!(cost(slope), None, "{slope}");
        }
    }
}
