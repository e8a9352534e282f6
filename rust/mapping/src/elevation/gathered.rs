//! What one frame says of the height of each cell: one measurement a cell, and none of a height in between two surfaces.

use super::HeightEstimate;

/// A point of the frame in a cell of the window.
#[derive(Debug, Clone, Copy, PartialEq)]
struct CellPoint {
    /// Where its cell is stored, row by row.
    cell: u32,
    /// Height in the map frame, m.
    height_m: f32,
    /// Variance of the height, m².
    variance_m2: f32,
}

/// Sums over the points of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Sums {
    points: u32,
    /// Of the inverse variances, 1/m².
    weight: f32,
    /// Of the heights above the first point's, each with its weight, 1/m.
    weighted: f32,
    first_m: f32,
    low_m: f32,
    high_m: f32,
    /// Where the cell's points begin among those that were sorted, once they are.
    begin: u32,
}

const NOTHING: Sums = Sums {
    points: 0,
    weight: 0.0,
    weighted: 0.0,
    first_m: 0.0,
    low_m: f32::INFINITY,
    high_m: f32::NEG_INFINITY,
    begin: 0,
};

/// What a frame measured of a thing in a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellMeasurement {
    /// Where the cell is stored, row by row.
    pub cell: usize,
    /// The highest surface of it that enough points lie on. It is as sure as one point is: what makes a frame's points wrong, the tilt of
    /// the sensor above all, makes them wrong alike.
    pub surface: HeightEstimate,
    /// Height of the lowest point of what the surface is on, m.
    pub low_m: f32,
    /// Points in the cell.
    pub points: u32,
}

/// The points of one frame, sorted into cells. Reused from frame to frame.
#[derive(Debug, Clone, Default)]
pub struct Gathered {
    points: Vec<CellPoint>,
    sums: Vec<Sums>,
    touched: Vec<u32>,
    /// Points of the cells that hold more than one surface.
    mixed: Vec<CellPoint>,
    heights_m: Vec<(f32, f32)>,
}

/// What a surface is among the points of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceRule {
    /// Points further apart than so many standard deviations are not all of one level surface.
    pub gate: f32,
    /// Share of the cell's points that lie on a surface at least, and two of them: fewer are mismatches.
    pub share: f32,
    /// Points with more room than this between them, m, are of two things one above the other.
    pub gap_m: f32,
}

impl Gathered {
    /// Begins a frame over so many cells.
    pub fn begin(&mut self, cells: usize) {
        for &cell in &self.touched {
            if let Some(sums) = self.sums.get_mut(cell as usize) {
                *sums = NOTHING;
            }
        }
        if self.sums.len() != cells {
            self.sums.clear();
            self.sums.resize(cells, NOTHING);
        }
        self.touched.clear();
        self.points.clear();
    }

    /// Takes in a point of the cell that is stored at an index: its height, m, and how sure that is, m².
    #[inline]
    pub fn add(&mut self, cell: usize, height_m: f32, variance_m2: f32) {
        let sums = &mut self.sums[cell];
        if sums.points == 0 {
            sums.first_m = height_m;
            self.touched.push(cell as u32);
        }
        let weight = 1.0 / variance_m2;
        sums.points += 1;
        sums.weight += weight;
        sums.weighted += weight * (height_m - sums.first_m);
        sums.low_m = sums.low_m.min(height_m);
        sums.high_m = sums.high_m.max(height_m);
        self.points.push(CellPoint {
            cell: cell as u32,
            height_m,
            variance_m2,
        });
    }

    /// The cells with points in the frame, each with how many.
    pub fn counts(&self) -> impl Iterator<Item = (usize, u32)> {
        let cells = self.touched.iter().map(|&cell| cell as usize);
        cells.map(|cell| (cell, self.sums[cell].points))
    }

    /// Whether a cell has points in the frame.
    #[inline]
    pub fn holds(&self, cell: usize) -> bool {
        self.sums[cell].points > 0
    }

    /// What the frame measured in each of its cells, told to `take`; of things one above the other the lower one first.
    pub fn measure(&mut self, rule: SurfaceRule, mut take: impl FnMut(CellMeasurement)) {
        self.sort_mixed(rule);
        for &cell in &self.touched {
            let sums = self.sums[cell as usize];
            let variance_m2 = sums.points as f32 / sums.weight;
            let mut tell = |height_m, low_m| {
                take(CellMeasurement {
                    cell: cell as usize,
                    surface: HeightEstimate {
                        height_m,
                        variance_m2,
                    },
                    low_m,
                    points: sums.points,
                });
            };
            if !is_mixed(&sums, rule.gate) {
                tell(sums.first_m + sums.weighted / sums.weight, sums.low_m);
                continue;
            }
            let points = &self.mixed[sums.begin as usize..][..sums.points as usize];
            self.heights_m.clear();
            let heights = points
                .iter()
                .map(|point| (point.height_m, point.variance_m2));
            self.heights_m.extend(heights);
            self.heights_m.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
            let things = self
                .heights_m
                .chunk_by(|low, high| high.0 - low.0 <= rule.gap_m);
            for thing in things {
                tell(highest_surface(thing, variance_m2.sqrt(), rule), thing[0].0);
            }
        }
    }

    /// Puts the points of cells with more than one surface side by side.
    fn sort_mixed(&mut self, rule: SurfaceRule) {
        let mut count = 0;
        for &cell in &self.touched {
            let sums = &mut self.sums[cell as usize];
            if is_mixed(sums, rule.gate) {
                sums.begin = count;
                count += sums.points;
            }
        }
        self.mixed.clear();
        if count == 0 {
            return;
        }
        let nothing = CellPoint {
            cell: 0,
            height_m: 0.0,
            variance_m2: 1.0,
        };
        self.mixed.resize(count as usize, nothing);
        for point in &self.points {
            let sums = &mut self.sums[point.cell as usize];
            if is_mixed(sums, rule.gate) {
                self.mixed[sums.begin as usize] = *point;
                sums.begin += 1;
            }
        }
        for &cell in &self.touched {
            let sums = &mut self.sums[cell as usize];
            if is_mixed(sums, rule.gate) {
                sums.begin -= sums.points;
            }
        }
    }
}

/// Whether the points of a cell are further apart than those of one level surface are by noise.
#[inline]
fn is_mixed(sums: &Sums, gate: f32) -> bool {
    let apart = sums.high_m - sums.low_m;
    // As wide as the gate to either side.
    let wide = 2.0 * gate;
    apart * apart * sums.weight > wide * wide * sums.points as f32
}

/// Height of the highest surface among points that are sorted by height, each with its variance: of the points within the noise of each
/// other that are share enough, the highest.
fn highest_surface(points: &[(f32, f32)], sigma_m: f32, rule: SurfaceRule) -> f32 {
    let least = ((points.len() as f32 * rule.share).ceil() as usize)
        .clamp(2.min(points.len()), points.len());
    let band_m = rule.gate * sigma_m;
    // A wall is no surface: its top counts.
    let (mut begin, mut surface) = (points.len(), points.len() - 1..points.len());
    for end in (least..=points.len()).rev() {
        begin = begin.min(end);
        while begin > 0 && points[end - 1].0 - points[begin - 1].0 <= band_m {
            begin -= 1;
        }
        if end - begin >= least {
            surface = begin..end;
            break;
        }
    }
    let weights = |one: &(f32, f32)| 1.0 / one.1;
    let surface = &points[surface];
    let total: f32 = surface.iter().map(weights).sum();
    let mean = surface
        .iter()
        .map(|one| weights(one) * (one.0 - surface[0].0))
        .sum::<f32>()
        / total;
    surface[0].0 + mean
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const RULE: SurfaceRule = SurfaceRule {
        gate: 3.0,
        share: 0.05,
        gap_m: f32::INFINITY,
    };
    const VARIANCE_M2: f32 = 1.6e-5;

    fn measured(heights_m: &[f64], rule: SurfaceRule) -> CellMeasurement {
        things(heights_m, rule)[0]
    }

    fn things(heights_m: &[f64], rule: SurfaceRule) -> Vec<CellMeasurement> {
        let mut gathered = Gathered::default();
        gathered.begin(9);
        for &height_m in heights_m {
            gathered.add(4, height_m as f32, VARIANCE_M2);
        }
        let mut found = vec![];
        gathered.measure(rule, |one| found.push(one));
        found
    }

    #[test]
    fn a_cell_at_an_edge_has_the_height_of_the_upper_surface_and_none_in_between() {
        // Floor, riser and tread in one cell.
        let mut heights: Vec<f64> = (0..10).map(|i| 0.002 * f64::from(i % 3 - 1)).collect();
        heights.extend((0..10).map(|i| 0.005 * f64::from(i)));
        heights.extend((0..10).map(|i| 0.05 + 0.002 * f64::from(i % 3 - 1)));
        let found = measured(&heights, RULE);
        assert!((found.surface.height_m - 0.05).abs() < 0.004, "{found:?}");
        assert!((found.low_m + 0.002).abs() < 1e-6);
    }

    #[test]
    fn a_mismatch_high_up_is_no_surface() {
        let mut heights = vec![0.0; 20];
        heights.push(0.4);
        assert_eq!(measured(&heights, RULE).surface.height_m, 0.0);
    }

    #[test]
    fn with_a_gap_between_them_there_are_two_things_the_lower_one_first() {
        let rule = SurfaceRule { gap_m: 0.6, ..RULE };
        let heights: Vec<f64> = (0..20)
            .map(|i| if i % 2 == 0 { 0.0 } else { 0.7 })
            .collect();
        let found = things(&heights, rule);
        assert_eq!((found.len(), found[0].surface.height_m), (2, 0.0));
        assert!((found[1].surface.height_m - 0.7).abs() < 1e-6 && found[1].low_m > 0.69);
        assert_eq!(things(&heights, RULE).len(), 1);
        assert!((measured(&heights, RULE).surface.height_m - 0.7).abs() < 1e-6);
    }

    proptest! {
        #[test]
        fn points_of_one_surface_give_their_mean_in_each_cell_and_frames_do_not_mix(
            frames in prop::collection::vec(
                prop::collection::vec((0..3u8, -0.005..0.005f64), 1..40), 1..4),
        ) {
            let mut gathered = Gathered::default();
            for frame in &frames {
                gathered.begin(9);
                for &(col, height_m) in frame {
                    gathered.add(usize::from(col), height_m as f32, VARIANCE_M2);
                }
                let mut seen = 0;
                gathered.measure(RULE, |one| {
                    let own: Vec<f64> = frame.iter().filter(|p| usize::from(p.0) == one.cell).map(|p| p.1).collect();
                    let mean = own.iter().sum::<f64>() / own.len() as f64;
                    assert!((f64::from(one.surface.height_m) - mean).abs() < 1e-6);
                    assert!((one.surface.variance_m2 / VARIANCE_M2 - 1.0).abs() < 1e-4);
                    assert_eq!(one.points as usize, own.len());
                    seen += own.len();
                });
                prop_assert_eq!(seen, frame.len());
            }
        }
    }
}
