//! How near the next surface of a map that does not change is.

use super::SolidVoxels;

/// No distance: there is no voxel of the kind.
const NONE: f64 = 1e20;

/// For each voxel the signed Euclidean distance of its centre from the nearest surface, m: positive in free space, negative in
/// what is solid; surfaces are the faces between the two.
#[derive(Debug, Clone)]
pub struct DistanceField {
    per_m: f64,
    corner_m: [f64; 3],
    size: [usize; 3],
    distances_m: Vec<f32>,
}

impl DistanceField {
    /// The field of these voxels.
    pub fn new(voxels: &SolidVoxels) -> Self {
        // With a border of free voxels, so that whatever is solid has a surface.
        let size = voxels.size.map(|count| count + 2);
        let mut solid = vec![false; size.iter().product()];
        for (row, values) in voxels.solid.chunks_exact(voxels.size[0]).enumerate() {
            let (y, z) = (row % voxels.size[1], row / voxels.size[1]);
            let first = ((z + 1) * size[1] + y + 1) * size[0] + 1;
            solid[first..first + values.len()].copy_from_slice(values);
        }
        let to_solid = squared_distances(&solid, size, true);
        let to_free = squared_distances(&solid, size, false);
        let side_m = voxels.resolution_m;
        // Half a voxel lies between a centre and the face.
        let distances_m = (to_solid.iter().zip(&to_free))
            .map(|(&out, &inside)| {
                let voxels = out.sqrt() - inside.sqrt();
                (side_m * (voxels - 0.5 * voxels.signum())) as f32
            })
            .collect();
        Self {
            per_m: 1.0 / side_m,
            corner_m: voxels.corner_m([0; 3]).map(|low| low - side_m),
            size,
            distances_m,
        }
    }

    /// Signed distance of a place from the nearest surface, m, between the eight centres about it. Beyond the outermost centres it
    /// is the one there and how far beyond the place is. Allocates nothing.
    #[inline]
    pub fn distance_m(&self, place_m: [f64; 3]) -> f64 {
        let (mut low, mut share, mut beyond2) = ([0; 3], [0.0; 3], 0.0);
        for a in 0..3 {
            let at = (place_m[a] - self.corner_m[a]) * self.per_m - 0.5;
            let inside = at.max(0.0).min((self.size[a] - 1) as f64);
            beyond2 += (at - inside) * (at - inside);
            low[a] = (inside as usize).min(self.size[a] - 2);
            share[a] = inside - low[a] as f64;
        }
        let strides = [1, self.size[0], self.size[0] * self.size[1]];
        let first = low[0] + low[1] * strides[1] + low[2] * strides[2];
        let at = |offset: usize| f64::from(self.distances_m[first + offset]);
        let along_x = |offset: usize| mix(at(offset), at(offset + 1), share[0]);
        let in_layer = |offset: usize| mix(along_x(offset), along_x(offset + strides[1]), share[1]);
        let distance_m = mix(in_layer(0), in_layer(strides[2]), share[2]);
        distance_m + distance_m.signum() * beyond2.sqrt() / self.per_m
    }
}

#[inline]
fn mix(a: f64, b: f64, share: f64) -> f64 {
    a + (b - a) * share
}

/// For each voxel the squared distance to the nearest one that is solid, or that is not, in voxels squared; one axis after the other
/// (Felzenszwalb and Huttenlocher 2012).
fn squared_distances(solid: &[bool], [cols, rows, layers]: [usize; 3], kind: bool) -> Vec<f64> {
    let mut squares: Vec<f64> = (solid.iter())
        .map(|&is| if is == kind { 0.0 } else { NONE })
        .collect();
    let mut envelope = LowerEnvelope::new(cols.max(rows).max(layers));
    for row in 0..rows * layers {
        envelope.transform(&mut squares, row * cols, 1, cols);
    }
    for layer in 0..layers {
        for col in 0..cols {
            envelope.transform(&mut squares, layer * rows * cols + col, cols, rows);
        }
    }
    for column in 0..cols * rows {
        envelope.transform(&mut squares, column, cols * rows, layers);
    }
    squares
}

/// The lower envelope of parabolas along one line of voxels.
struct LowerEnvelope {
    line: Vec<f64>,
    /// Places of the parabolas.
    at: Vec<usize>,
    /// Place from which on each of the parabolas is the lowest.
    from: Vec<f64>,
}

impl LowerEnvelope {
    fn new(longest: usize) -> Self {
        Self {
            line: vec![0.0; longest],
            at: Vec::with_capacity(longest),
            from: Vec::with_capacity(longest),
        }
    }

    /// `d(p) = min_q (p - q)^2 + f(q)` in place along a line of voxels.
    fn transform(&mut self, squares: &mut [f64], first: usize, stride: usize, count: usize) {
        let Self { line, at, from } = self;
        at.clear();
        from.clear();
        for place in 0..count {
            let value = squares[first + place * stride];
            line[place] = value;
            if value >= NONE {
                continue;
            }
            let mut begin = f64::NEG_INFINITY;
            while let (Some(&last), Some(&last_from)) = (at.last(), from.last()) {
                begin = (value - line[last] + (place * place - last * last) as f64)
                    / (2 * (place - last)) as f64;
                if begin > last_from {
                    break;
                }
                let _ = (at.pop(), from.pop());
                begin = f64::NEG_INFINITY;
            }
            at.push(place);
            from.push(begin);
        }
        let mut lowest = 0;
        for place in 0..count {
            while lowest + 1 < at.len() && from[lowest + 1] < place as f64 {
                lowest += 1;
            }
            if let Some(&nearest) = at.get(lowest) {
                let off = place.abs_diff(nearest);
                squares[first + place * stride] = line[nearest] + (off * off) as f64;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SIDE_M: f64 = 0.1;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        #[test]
        fn distances_are_those_of_brute_force(
            corners in prop::collection::vec((prop::array::uniform3(-0.5..0.5f64), prop::array::uniform3(0.1..0.4f64)), 1..4),
        ) {
            let boxes: Vec<_> = corners.iter().map(|&(low, side)| [low, std::array::from_fn(|a| low[a] + side[a])]).collect();
            let voxels = SolidVoxels::of_boxes(&boxes, SIDE_M).unwrap();
            let [cols, rows, layers] = voxels.size();
            let all: Vec<[usize; 3]> = (0..layers).flat_map(|z| (0..rows).flat_map(move |y| (0..cols).map(move |x| [x, y, z]))).collect();
            for kind in [true, false] {
                let squares = squared_distances(&voxels.solid, voxels.size, kind);
                for (&here, &square) in all.iter().zip(&squares) {
                    let nearest = all.iter().filter(|&&v| voxels.is_solid(v.map(|v| v as i64)) == kind)
                        .map(|v| (0..3).map(|a| v[a].abs_diff(here[a]).pow(2)).sum::<usize>() as f64)
                        .fold(NONE, f64::min);
                    prop_assert_eq!(square, nearest);
                }
            }
        }

        #[test]
        fn before_a_wall_the_distance_is_the_one_to_its_face(height in -0.15..0.5f64, x in -0.3..0.3f64) {
            // A floor, and a small thing far above it, so that the grid is high.
            let boxes = [[[-1.0, -1.0, -0.3], [1.0, 1.0, 0.0]], [[0.9, 0.9, 1.4], [1.0, 1.0, 1.5]]];
            let field = DistanceField::new(&SolidVoxels::of_boxes(&boxes, SIDE_M).unwrap());
            let found = field.distance_m([x, 0.0, height]);
            prop_assert!((found - height).abs() < 1e-6, "{found}");
        }
    }

    #[test]
    fn beyond_the_grid_the_way_to_it_counts() {
        let floor = [[-1.0, -1.0, -0.1], [1.0, 1.0, 0.0]];
        let post = [[-1.0, -1.0, 0.0], [-0.9, -0.9, 1.0]];
        let field = DistanceField::new(&SolidVoxels::of_boxes(&[floor, post], SIDE_M).unwrap());
        assert!((field.distance_m([0.95, 0.0, 1.55]) - 1.55).abs() < 1e-6);
        // Below the floor lies another side of it.
        assert!((field.distance_m([0.5, 0.5, -0.02]) + 0.02).abs() < 1e-6);
        assert!((field.distance_m([0.5, 0.5, -0.4]) - 0.3).abs() < 1e-6);
        assert!(field.distance_m([f64::NAN, 0.5, 0.5]).is_nan());
        let flat = DistanceField::new(&SolidVoxels::of_boxes(&[floor], SIDE_M).unwrap());
        assert!((flat.distance_m([0.0, 0.0, 1.0]) - 1.0).abs() < 1e-6);
    }
}
