//! What a frame's sight lines say of the places that they pass over: no ground is higher there than the lowest of them
//! (004, section 36.3.1: visibility constraints).

/// The lowest sight lines of one frame, by direction over the ground. Reused from frame to frame.
#[derive(Debug, Clone)]
pub struct SightLines {
    cell_m: f32,
    sectors: usize,
    bins: usize,
    /// For each range over the ground and direction, those of a range side by side, the least rise per metre of a sight line that goes on at
    /// least as far.
    rises: Vec<f32>,
}

/// Directions and ranges at most: more would not fit into memory.
const MOST: usize = 4096;
/// Sides of the square around the eye by which directions are told.
const SIDES: usize = 4;
/// No sight line.
const NONE: f32 = f32::INFINITY;

impl SightLines {
    /// For cells of this side and points up to `max_range_m` away; two directions are a cell apart at the longest range.
    pub fn new(cell_m: f64, max_range_m: f64) -> Self {
        let bins = (max_range_m / cell_m).ceil() as usize;
        let sectors = (std::f64::consts::TAU * max_range_m / cell_m).ceil();
        Self {
            cell_m: cell_m as f32,
            sectors: (sectors as usize).clamp(SIDES, MOST),
            bins: bins.clamp(1, MOST),
            rises: Vec::new(),
        }
    }

    /// Begins a frame.
    pub fn begin(&mut self) {
        self.rises.clear();
        self.rises.resize(self.sectors * self.bins, NONE);
    }

    /// Takes in the sight line to a point, given from the eye, m.
    #[inline]
    pub fn add(&mut self, [x, y, z]: [f32; 3]) {
        let range_m = (x * x + y * y).sqrt();
        let bin = (range_m / self.cell_m) as usize;
        if range_m <= 0.0 {
            return;
        }
        let at = bin.min(self.bins - 1) * self.sectors + self.sector(x, y);
        let rise = z / range_m;
        if rise < self.rises[at] {
            self.rises[at] = rise;
        }
    }

    /// After the last point: a sight line tells of all places that it passed.
    pub fn finish(&mut self) {
        for bin in (1..self.bins).rev() {
            let (nearer, further) = self.rises.split_at_mut(bin * self.sectors);
            let nearer = &mut nearer[(bin - 1) * self.sectors..];
            for (rise, &beyond) in nearer.iter_mut().zip(&*further) {
                *rise = if beyond < *rise { beyond } else { *rise };
            }
        }
    }

    /// Height above the eye, m, that nothing in a cell exceeds, as far as sight lines passed over it; none where none did. It is the
    /// height at which the lowest of them enters the cell, or leaves it where it rises. The middle of the cell is given from the eye, m.
    #[inline]
    pub fn bound_m(&self, [x, y]: [f32; 2]) -> Option<f32> {
        let range_m = (x * x + y * y).sqrt();
        // Beyond the whole cell, whatever the direction: half of its diagonal, and the bin that holds that.
        let half_m = std::f32::consts::FRAC_1_SQRT_2 * self.cell_m;
        let bin = ((range_m + half_m) / self.cell_m) as usize + 1;
        if bin >= self.bins {
            return None;
        }
        let rise = self.rises[bin * self.sectors + self.sector(x, y)];
        if rise == NONE {
            return None;
        }
        let reach_m = if rise < 0.0 {
            (range_m - half_m).max(0.0)
        } else {
            range_m + half_m
        };
        Some(rise * reach_m)
    }

    /// Which direction this is: without an arc tangent, by how far along the sides of a square that stands on its corner.
    #[inline]
    fn sector(&self, x: f32, y: f32) -> usize {
        let along = y / (x.abs() + y.abs());
        let turns = if x < 0.0 {
            2.0 - along
        } else if along < 0.0 {
            SIDES as f32 + along
        } else {
            along
        };
        let sector = (turns / SIDES as f32 * self.sectors as f32) as usize;
        sector.min(self.sectors - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn lines(points: &[[f32; 3]]) -> SightLines {
        let mut lines = SightLines::new(0.04, 4.0);
        lines.begin();
        for &point in points {
            lines.add(point);
        }
        lines.finish();
        lines
    }

    #[test]
    fn a_line_bounds_the_cells_that_it_passes_and_none_beyond_its_end_or_beside_it() {
        let lines = lines(&[[2.0, 0.0, -0.5]]);
        let bound_m = lines.bound_m([1.0, 0.0]).unwrap();
        assert!(bound_m > -0.25 && bound_m < -0.24, "{bound_m}");
        assert_eq!(lines.bound_m([2.1, 0.0]), None);
        assert_eq!(lines.bound_m([1.0, 0.5]), None);
        assert_eq!(lines.bound_m([-1.0, 0.0]), None);
    }

    proptest! {
        #[test]
        fn a_bound_is_never_below_a_line_that_passes_and_is_the_lowest_of_those_in_its_direction(
            yaw in -3.1..3.1f32, near in 0.3..1.5f32, further in 0.2..2.0f32, low in -0.8..-0.2f32,
        ) {
            let (sin, cos) = libm::sincosf(yaw);
            let at = |range_m: f32, z: f32| [range_m * cos, range_m * sin, z];
            let end = at(near + further, low);
            let lines = lines(&[end, at(near + further, low + 0.2)]);
            let [x, y, _] = at(near, 0.0);
            if let Some(bound_m) = lines.bound_m([x, y]) {
                let line_m = low * near / (near + further);
                prop_assert!(bound_m >= line_m - 1e-6);
                prop_assert!(bound_m <= line_m + 0.03 * low.abs() / (near + further) + 1e-6);
            } else {
                prop_assert!(further < 0.12);
            }
        }
    }
}
