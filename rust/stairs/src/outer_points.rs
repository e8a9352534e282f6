//! Where each column of the picture enters and leaves a surface: its near and its far side, fringes and all.

use nalgebra::Point2;
use segmentation::Planes;

use crate::line::LineSum;
use crate::view::View;

/// Points further from the side of the hull than this many fringes belong to other sides.
const WINDOW: f64 = 3.0;
/// Share of the side's length that the points must span.
const SPANNED: f64 = 0.5;
/// Least number of points.
const FEW: usize = 8;
/// Rounds of fitting.
const ROUNDS: usize = 3;
/// Columns that may be missing between two neighbours.
const MISSING: usize = 4;

/// Which side of a surface is meant, by its rows in the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Rows {
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
    points: Vec<(usize, Point2<f64>)>,
    offsets: Vec<f64>,
}

const NONE: [u16; 2] = [u16::MAX, 0];

impl OuterPoints {
    /// Reads the labels of a frame.
    pub(crate) fn read(&mut self, planes: &Planes, width: usize) {
        self.width = width;
        self.rows.clear();
        self.rows.resize(planes.regions.len() * width, NONE);
        for (row, labels) in planes.labels.chunks_exact(width).enumerate() {
            for (col, &label) in labels.iter().enumerate().filter(|(_, label)| **label > 0) {
                if let Some([high, low]) = self.rows.get_mut((usize::from(label) - 1) * width + col)
                {
                    *high = (*high).min(row as u16);
                    *low = row as u16;
                }
            }
        }
    }

    /// The side of the region that lies near `side` (its right and its left end), through the middle of its fringes, as
    /// long as before; `None` where too little of it is there.
    pub(crate) fn through(
        &mut self,
        view: &View<'_>,
        (region, which): (usize, Rows),
        (side, height_m): ([Point2<f64>; 2], f64),
        fringe_m: f64,
    ) -> Option<[Point2<f64>; 2]> {
        let [right, left] = side;
        let mut rough = LineSum::default();
        rough.add([&right, &left], 1.0);
        let mut line = rough.line()?;
        let length_m = (left - right).norm();
        self.points.clear();
        let rows = &self.rows[region * self.width..(region + 1) * self.width];
        for (col, &[high, low]) in rows.iter().enumerate().filter(|(_, rows)| **rows != NONE) {
            let row = if which == Rows::Lowest { low } else { high };
            let Some(point) = view.on_level(col, usize::from(row), height_m) else {
                continue;
            };
            let along_m = line.along.dot(&(point - right));
            let beside = along_m < -fringe_m || along_m > length_m + fringe_m;
            if !beside && line.offset_m(&point).abs() < WINDOW * fringe_m {
                self.points.push((col, point));
            }
        }
        for _ in 0..ROUNDS {
            self.offsets.clear();
            self.offsets
                .extend(self.points.iter().map(|(_, point)| line.offset_m(point)));
            let middle = self.offsets.len() / 2;
            if middle < FEW / 2 {
                return None;
            }
            let (_, &mut median_m, _) = self.offsets.select_nth_unstable_by(middle, f64::total_cmp);
            let mut sum = LineSum::default();
            let mut spanned_m = 0.0;
            let fits = |point: &Point2<f64>| (line.offset_m(point) - median_m).abs() <= fringe_m;
            let mut before: Option<(usize, Point2<f64>)> = None;
            // To the right in the picture is to the right of the side.
            for &(col, point) in self.points.iter().filter(|(_, point)| fits(point)) {
                if let Some((last_col, last)) = before
                    && col - last_col <= MISSING
                {
                    sum.add([&point, &last], 1.0);
                    spanned_m += line.along.dot(&(last - point)).abs();
                }
                before = Some((col, point));
            }
            if spanned_m < SPANNED * length_m {
                return None;
            }
            line = sum.line()?;
        }
        Some([line.nearest(&right), line.nearest(&left)])
    }
}
