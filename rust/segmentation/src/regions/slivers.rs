//! Slivers along the edges of steps: where the matching window sees two treads at once, the disparities in between may
//! look like a thin surface of a height in between.

use settings::{POSITIVE, SHARE, settings, within};

use crate::{picture::View, regions::region::Region};

settings! {
    /// When a thin surface at the edge of a step is none.
    pub struct SliverTuning("navigation.ground.tuning.slivers") {
        /// A surface between two others is no tread when it is less deep than this on average.
        depth: f64 = 0.04, "m", POSITIVE;
        /// Share of a surface's columns in which it lies between two others, above which it may be a sliver.
        between: f64 = 0.6, "1", SHARE;
        /// Most pixels without a region between a sliver and its neighbours.
        gap: usize = 3, "1", within(0.0, 1000.0);
        /// Every so many columns of the image are looked down.
        stride: usize = 2, "1", within(1.0, 100.0);
    }
}

/// What the columns of the image say of one region.
#[derive(Debug, Clone, Copy, Default)]
struct SliverColumns {
    runs: u32,
    between: u32,
    depth_m: f64,
}

/// A run of one region's pixels down a column.
#[derive(Debug, Clone, Copy)]
struct ColumnRun {
    region: usize,
    first: usize,
    last: usize,
}

/// Finds slivers. Keeps its buffer.
#[derive(Debug, Clone, Default)]
pub(crate) struct Slivers {
    tuning: SliverTuning,
    columns: Vec<SliverColumns>,
}

impl Slivers {
    /// Nothing seen yet.
    pub(crate) fn new(tuning: SliverTuning) -> Self {
        Self {
            tuning,
            ..Self::default()
        }
    }

    /// Looks down one column every few for what lies between what; of an image so many times `finer` down fewer.
    pub(crate) fn find(
        &mut self,
        labels: &[u16],
        [width, finer]: [usize; 2],
        view: &View,
        regions: &[Region],
    ) {
        self.columns.clear();
        self.columns.resize(regions.len(), SliverColumns::default());
        for col in (0..width).step_by(self.tuning.stride * finer) {
            let (mut above, mut here): (Option<ColumnRun>, Option<ColumnRun>) = (None, None);
            for (row, &label) in labels.iter().skip(col).step_by(width).enumerate() {
                let Some(region) = usize::from(label).checked_sub(1) else {
                    continue;
                };
                if regions[region].q == 0.0 {
                    continue;
                }
                match &mut here {
                    Some(run) if run.region == region => run.last = row,
                    _ => {
                        let below = ColumnRun {
                            region,
                            first: row,
                            last: row,
                        };
                        if let Some(run) = here {
                            self.add(view, regions, col, run, [above, Some(below)]);
                        }
                        (above, here) = (here, Some(below));
                    }
                }
            }
            if let Some(run) = here {
                self.add(view, regions, col, run, [above, None]);
            }
        }
    }

    /// Whether a region is a sliver.
    pub(crate) fn contains(&self, region: usize) -> bool {
        let columns = self.columns[region];
        let runs = f64::from(columns.runs);
        f64::from(columns.between) > self.tuning.between * runs
            && columns.depth_m < self.tuning.depth * runs
    }

    fn add(
        &mut self,
        view: &View,
        regions: &[Region],
        col: usize,
        run: ColumnRun,
        beside: [Option<ColumnRun>; 2],
    ) {
        let (q, gap) = (regions[run.region].q, self.tuning.gap);
        let columns = &mut self.columns[run.region];
        let place = |row: usize| {
            let depth = 1.0 / (q * view.g.at(col, row));
            [view.x.at(col, row) * depth, view.y.at(col, row) * depth]
        };
        let (far, near) = (place(run.first), place(run.last + 1));
        columns.runs += 1;
        columns.depth_m +=
            geometry::hypot(f64::from(far[0] - near[0]), f64::from(far[1] - near[1]));
        if let [Some(above), Some(below)] = beside {
            let close = run.first - above.last <= gap + 1 && below.first - run.last <= gap + 1;
            let others = (regions[above.region].q, regions[below.region].q);
            let between = others.0.min(others.1) < q && q < others.0.max(others.1);
            columns.between += u32::from(close && between);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::synthetic::{CAMERA, camera_pose};

    /// Whether a strip of `rows` rows between two treads is a sliver, at this place between their heights (0 to 1).
    fn sliver(rows: usize, share: f32) -> bool {
        let rotation = camera_pose(0.0, 0.8).inner.rotation;
        let view = View::new(&CAMERA, &rotation.to_rotation_matrix());
        let region = |below_m: f32| Region {
            q: 1.0 / below_m,
            ..Region::default()
        };
        let regions = [region(0.44), region(0.44 + 0.03 * share), region(0.47)];
        let labels: Vec<u16> = (0..CAMERA.width * CAMERA.height)
            .map(|at| match at / CAMERA.width {
                0..30 => 1,
                row if row < 30 + rows => 2,
                _ => 3,
            })
            .collect();
        let mut slivers = Slivers::default();
        slivers.find(&labels, [CAMERA.width, 1], &view, &regions);
        assert!(!slivers.contains(0) && !slivers.contains(2));
        slivers.contains(1)
    }

    #[test]
    fn a_thin_strip_between_two_treads_is_a_sliver_a_tread_is_not() {
        assert!(sliver(3, 0.5));
        assert!(!sliver(12, 0.5));
    }

    #[test]
    fn a_thin_strip_above_or_below_both_its_neighbours_is_none() {
        assert!(!sliver(3, 1.5));
        assert!(!sliver(3, -0.5));
    }
}
