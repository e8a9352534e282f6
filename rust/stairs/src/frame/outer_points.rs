//! Where each column of the picture enters and leaves a surface: its near and its far side, fringes and all.

use geometry::Robot;
use segmentation::Planes;

use crate::frame::view::PlanesView;
use crate::lines::robust_line::Row;
use crate::stair::level_edge;
use crate::{Edge, LinesTuning, StairsTuning};

/// Which side of a surface is meant, by its rows in the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OuterRows {
    /// The lowest: the near side.
    Lowest,
    /// The highest: the far side.
    Highest,
}

/// First and last row of each region in each column. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(crate) struct OuterPoints {
    width: usize,
    // Highest and lowest row, by region and column; empty where the lowest is above the highest.
    rows: Vec<[u16; 2]>,
    row: Row,
}

/// Rows of a column in which a region does not show.
const NONE: [u16; 2] = [u16::MAX, 0];

impl OuterPoints {
    /// Reads the labels of a frame.
    pub(crate) fn read(&mut self, planes: &Planes, width: usize) {
        self.width = width;
        self.rows.clear();
        self.rows.resize(planes.regions.len() * width, NONE);
        for (row, labels) in planes.labels.chunks_exact(width).enumerate() {
            for (col, &label) in labels.iter().enumerate().filter(|(_, label)| **label > 0) {
                let at = (usize::from(label) - 1) * width + col;
                if let Some([high, low]) = self.rows.get_mut(at) {
                    *high = (*high).min(row as u16);
                    *low = row as u16;
                }
            }
        }
    }

    /// The side of the region that lies near `rough`, through the middle of its fringes, as long as before; `None` where
    /// too little of it is straight.
    pub(crate) fn through(
        &mut self,
        view: &PlanesView<'_>,
        (region, rows): (usize, OuterRows),
        rough: &Edge<Robot>,
        fringe_m: f64,
        tuning: &StairsTuning,
    ) -> Option<Edge<Robot>> {
        let (right, length_m) = (rough.right.inner.xy(), rough.length_m());
        let line = rough.line()?;
        let window_m = tuning.frame.side_window * fringe_m;
        self.gather(view, region, rows, rough.left.inner.z);
        self.row.points.retain(|(_, point)| {
            let along_m = line.along.dot(&(point - right));
            let beside = along_m < -fringe_m || along_m > length_m + fringe_m;
            !beside && line.offset_m(point).abs() < window_m
        });
        let straight = self.row.straight(Some(line), fringe_m, &tuning.lines)?;
        let ends = [&rough.right, &rough.left].map(|end| straight.line.nearest(&end.inner.xy()));
        let enough = straight.spanned_m > tuning.lines.spanned * length_m;
        enough.then(|| level_edge(ends, rough.left.inner.z))
    }

    /// The side of the region parallel to an edge, through the middle of its points, as long as the edge.
    pub(crate) fn parallel(
        &mut self,
        view: &PlanesView<'_>,
        (region, rows): (usize, OuterRows),
        edge: &Edge<Robot>,
        tuning: &LinesTuning,
    ) -> Option<Edge<Robot>> {
        self.gather(view, region, rows, edge.left.inner.z);
        let median_m = self.row.median_offset_m(&edge.line()?, tuning)?;
        Some(edge.shifted(median_m))
    }

    /// Collects the outermost points of a region, from left to right.
    fn gather(&mut self, view: &PlanesView<'_>, region: usize, which: OuterRows, height_m: f64) {
        self.row.points.clear();
        let rows = &self.rows[region * self.width..(region + 1) * self.width];
        for (col, &[high, low]) in rows.iter().enumerate().filter(|(_, rows)| **rows != NONE) {
            let row = if which == OuterRows::Lowest {
                low
            } else {
                high
            };
            let point = view.on_level([col as f64, f64::from(row)], height_m);
            self.row.points.extend(point.map(|point| (col, point)));
        }
    }
}
