//! A height field: two triangles a cell over a base box, with sides that are closed down to it.

use crate::error::SceneError;
use crate::eye::Triple;
use crate::view::Around;

/// A tolerance of cells at their borders, so that no ray slips between two.
const SLACK: f64 = 1e-9;

/// Heights over a rectangle, made once; bodies share it.
#[derive(Debug, Clone)]
pub struct HeightField {
    /// Row along +y, column along +x, share of the greatest height.
    heights: Vec<f64>,
    rows: usize,
    columns: usize,
    /// Half of its sides, m.
    half: [f64; 2],
    /// The greatest height and how far the base reaches down, m.
    top: f64,
    base: f64,
    /// Sides of a cell, m.
    cell: [f64; 2],
}

impl HeightField {
    /// Heights are shares of `size_m[2]`, row by row; `size_m` is half of the sides along x and y, the greatest height, and the
    /// base's thickness. Refuses what cannot be used, as the `index`th of the scene.
    pub fn new(
        index: usize,
        heights: &[f32],
        columns: usize,
        size_m: [f64; 4],
    ) -> Result<Self, SceneError> {
        let not_finite = |what: String| Err(SceneError::NotFinite { what });
        if !size_m.iter().all(|size| size.is_finite() && *size >= 0.0) {
            return not_finite(format!("a size of height field {index}"));
        }
        if let Some(bad) = heights.iter().position(|height| !height.is_finite()) {
            return not_finite(format!("height {bad} of height field {index}"));
        }
        let rows = heights.len().checked_div(columns).unwrap_or(0);
        if rows < 2 || columns < 2 || rows * columns != heights.len() {
            return Err(SceneError::Rectangle { field: index });
        }
        let across = |half: f64, count: usize| 2.0 * half / (count - 1) as f64;
        Ok(Self {
            heights: heights.iter().map(|height| f64::from(*height)).collect(),
            rows,
            columns,
            half: [size_m[0], size_m[1]],
            top: size_m[2],
            base: size_m[3],
            cell: [across(size_m[0], columns), across(size_m[1], rows)],
        })
    }

    /// The box around it.
    pub(crate) fn around(&self) -> Around {
        Around {
            centre: [0.0, 0.0, (self.top - self.base) / 2.0],
            half: [
                self.half[0],
                self.half[1],
                f64::midpoint(self.top, self.base),
            ],
        }
    }

    /// How near a ray from a place meets it; 0 for not at all, or where all of it is behind what is known.
    pub(crate) fn met(&self, place: Triple, ray: Triple, known: f64) -> f64 {
        let mut depth = f64::INFINITY;
        let whole = self.within(place, ray, -self.base, self.top);
        if whole.is_none_or(|(begin, _)| begin * known > 1.0) {
            return 0.0;
        }
        if let Some((begin, end)) = self.within(place, ray, -self.base, 0.0) {
            depth = if begin >= 0.0 { begin } else { end };
        }
        if let Some((begin, end)) = self.within(place, ray, 0.0, self.top) {
            depth = depth.min(self.surface(place, ray, begin.max(0.0), end));
            depth = depth.min(self.sides(place, ray, begin, end));
        }
        if depth.is_finite() { 1.0 / depth } else { 0.0 }
    }

    /// Where a ray enters and leaves the box between two heights; `None` where it does not, or before it begins.
    fn within(&self, place: Triple, ray: Triple, low: f64, high: f64) -> Option<(f64, f64)> {
        let lower = [-self.half[0], -self.half[1], low];
        let upper = [self.half[0], self.half[1], high];
        let (mut begin, mut end) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            if ray[axis] == 0.0 {
                if place[axis] < lower[axis] || place[axis] > upper[axis] {
                    return None;
                }
                continue;
            }
            let over = 1.0 / ray[axis];
            let a = (lower[axis] - place[axis]) * over;
            let b = (upper[axis] - place[axis]) * over;
            begin = begin.max(a.min(b));
            end = end.min(a.max(b));
        }
        (begin <= end && end >= 0.0).then_some((begin, end))
    }

    /// Where a ray first meets the surface between two depths; infinite for nowhere.
    fn surface(&self, place: Triple, ray: Triple, begin: f64, end: f64) -> f64 {
        // In cells from the field's corner.
        let from = [0, 1].map(|i| (place[i] + self.half[i]) / self.cell[i]);
        let along = [0, 1].map(|i| ray[i] / self.cell[i]);
        let counts = [self.columns - 1, self.rows - 1];
        let mut at = [0, 1].map(|i| {
            let cell = (from[i] + begin * along[i]).floor().max(0.0) as usize;
            cell.min(counts[i] - 1)
        });
        loop {
            let met = self.cell(at, from, along, [place[2], ray[2]]);
            if met < f64::INFINITY {
                return met;
            }
            // Where the ray leaves the cell, along x and along y.
            let leave = [0, 1].map(|i| {
                let border = if along[i] > 0.0 { at[i] + 1 } else { at[i] };
                let depth = (border as f64 - from[i]) / along[i];
                if along[i] == 0.0 {
                    f64::INFINITY
                } else {
                    depth
                }
            });
            let axis = usize::from(leave[1] < leave[0]);
            let last = if along[axis] > 0.0 {
                counts[axis] - 1
            } else {
                0
            };
            if leave[axis] > end || leave[axis] == f64::INFINITY || at[axis] == last {
                return f64::INFINITY;
            }
            at[axis] = if along[axis] > 0.0 {
                at[axis] + 1
            } else {
                at[axis] - 1
            };
        }
    }

    /// Where a ray meets the triangles of a cell; infinite for nowhere. `height` is its height at the eye, and a metre on.
    fn cell(&self, at: [usize; 2], from: [f64; 2], along: [f64; 2], height: [f64; 2]) -> f64 {
        let corner = at[1] * self.columns + at[0];
        let near = self.heights[corner] * self.top;
        let right = self.heights[corner + 1] * self.top;
        let up = self.heights[corner + self.columns] * self.top;
        let far = self.heights[corner + self.columns + 1] * self.top;
        let [x, y] = [from[0] - at[0] as f64, from[1] - at[1] as f64];
        let mut first = f64::INFINITY;
        // Right of the diagonal, then left of it: slopes along x and y, a cell.
        for (slopes, side) in [
            ([right - near, far - right], 1.0),
            ([far - up, up - near], -1.0),
        ] {
            let above = height[0] - near - slopes[0] * x - slopes[1] * y;
            let climbs = height[1] - slopes[0] * along[0] - slopes[1] * along[1];
            let depth = -above / climbs;
            let [x, y] = [x + depth * along[0], y + depth * along[1]];
            let within = |share: f64| (-SLACK..=1.0 + SLACK).contains(&share);
            let on = within(x) && within(y) && side * (x - y) >= -SLACK;
            if depth >= 0.0 && depth < first && on {
                first = depth;
            }
        }
        first
    }

    /// Where a ray meets one of the four sides, below the surface's edge; infinite for nowhere.
    fn sides(&self, place: Triple, ray: Triple, begin: f64, end: f64) -> f64 {
        let mut first = f64::INFINITY;
        for depth in [begin, end] {
            let point = [0, 1, 2].map(|i| place[i] + depth * ray[i]);
            if depth < 0.0 {
                continue;
            }
            for axis in 0..2 {
                let away = (point[axis].abs() - self.half[axis]).abs();
                if away <= SLACK * self.half[axis] && point[2] < self.edge(axis, point) {
                    first = first.min(depth);
                }
            }
        }
        first
    }

    /// Height of the surface's edge above a point of the side across `axis`.
    fn edge(&self, axis: usize, point: Triple) -> f64 {
        let other = 1 - axis;
        let (strides, counts) = ([1, self.columns], [self.columns, self.rows]);
        let line = if point[axis] > 0.0 {
            (counts[axis] - 1) * strides[axis]
        } else {
            0
        };
        let place = (point[other] + self.half[other]) / self.cell[other];
        let cell = (place.floor().max(0.0) as usize).min(counts[other] - 2);
        let [a, b] = [cell, cell + 1].map(|cell| self.heights[line + cell * strides[other]]);
        (a + (b - a) * (place - cell as f64)) * self.top
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ramp along x from 0 to 1 m, 4 m long and 2 m wide, on a base 0.5 m thick.
    fn ramp() -> HeightField {
        let heights: Vec<f32> = (0..15).map(|i| (i % 5) as f32 / 4.0).collect();
        HeightField::new(0, &heights, 5, [2.0, 1.0, 1.0, 0.5]).unwrap()
    }

    #[test]
    fn a_ramp_is_met_from_above_at_its_height_and_from_below_at_its_base() {
        let ramp = ramp();
        for x in [-1.9, -0.3, 0.77, 1.99] {
            let depth = 1.0 / ramp.met([x, 0.3, 3.0], [0.0, 0.0, -1.0], 0.0);
            assert!(
                (depth - (3.0 - (x + 2.0) / 4.0)).abs() < 1e-12,
                "{x}: {depth}"
            );
            assert_eq!(ramp.met([x, 0.3, -1.0], [0.0, 0.0, 1.0], 0.0), 2.0);
        }
        assert_eq!(ramp.met([2.1, 0.0, 3.0], [0.0, 0.0, -1.0], 0.0), 0.0);
    }

    #[test]
    fn a_slanted_ray_goes_over_cells_until_it_meets_the_surface() {
        // Down the slope of 1 in 2 from above the foot: (x + 2) / 4 = 1.5 - (x + 2) / 2 at x = 0.
        let depth = 1.0 / ramp().met([-2.0, -0.9, 1.5], [1.0, 0.2, -0.5], 0.0);
        assert!((depth - 2.0).abs() < 1e-12, "{depth}");
    }

    #[test]
    fn the_high_side_is_closed_and_above_the_low_one_a_ray_comes_in() {
        let ramp = ramp();
        assert_eq!(ramp.met([4.0, 0.0, 0.5], [-1.0, 0.0, 0.0], 0.0), 0.5);
        let depth = 1.0 / ramp.met([-4.0, 0.0, 0.5], [1.0, 0.0, 0.0], 0.0);
        assert!((depth - 4.0).abs() < 1e-12, "{depth}");
        // The side along the ramp ends at the ramp's height.
        assert_eq!(ramp.met([1.0, -2.0, 0.74], [0.0, 1.0, 0.0], 0.0), 1.0);
        assert_eq!(ramp.met([1.0, -2.0, 0.76], [0.0, 1.0, 0.0], 0.0), 0.0);
    }

    #[test]
    fn what_lies_behind_something_nearer_is_not_looked_for() {
        let before = [4.0, 0.0, 0.5];
        assert_eq!(ramp().met(before, [-1.0, 0.0, 0.0], 0.4), 0.5);
        assert_eq!(ramp().met(before, [-1.0, 0.0, 0.0], 0.6), 0.0);
    }

    #[test]
    fn a_field_that_is_no_rectangle_of_numbers_is_refused() {
        let refused = |heights: &[f32], columns, size| {
            HeightField::new(1, heights, columns, size)
                .unwrap_err()
                .to_string()
        };
        let whole = "height field 1 is no rectangle of 2 x 2 heights or more";
        assert_eq!(refused(&[0.0; 5], 2, [1.0; 4]), whole);
        assert_eq!(refused(&[0.0; 4], 0, [1.0; 4]), whole);
        let nan = refused(&[0.0, 0.0, f32::NAN, 0.0], 2, [1.0; 4]);
        assert_eq!(nan, "height 2 of height field 1 is no finite number");
        assert!(refused(&[0.0; 4], 2, [1.0, -1.0, 1.0, 1.0]).contains("size"));
    }
}
