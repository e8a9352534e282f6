//! A straight line through a row of points of which some lie anywhere.

use nalgebra::Point2;

use crate::LinesTuning;
use crate::lines::line::{LineSum, StraightLine};

/// Points by their column in the picture, from left to right. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(crate) struct Row {
    /// Column and place, m.
    pub(crate) points: Vec<(usize, Point2<f64>)>,
    offsets: Vec<f64>,
}

/// The straight part of a row of points.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Straight {
    /// The line, from right to left.
    pub(crate) line: StraightLine,
    /// Its outermost points, right and left.
    pub(crate) ends: [Point2<f64>; 2],
    /// How much of it the points span, m.
    pub(crate) spanned_m: f64,
}

impl Row {
    /// The line that most points lie close to, within `fringe_m` of their median's parallel. Begins with `line`, or with
    /// all points.
    pub(crate) fn straight(
        &mut self,
        line: Option<StraightLine>,
        fringe_m: f64,
        tuning: &LinesTuning,
    ) -> Option<Straight> {
        let all = |row: &Self| {
            let (sum, ..) = row.close_to(None, f64::INFINITY, tuning)?;
            sum.line(tuning.agreement)
        };
        let first = line.or_else(|| all(self))?;
        let (mut line, mut found) = (first, None);
        for _ in 0..tuning.rounds {
            let median_m = self.median_offset_m(&line, tuning)?;
            let middle = StraightLine {
                at: line.at + line.across() * median_m,
                ..line
            };
            let (sum, ends, spanned_m) = self.close_to(Some(&middle), fringe_m, tuning)?;
            line = sum.line(tuning.agreement)?;
            found = Some(Straight {
                line,
                ends: ends.map(|end| line.nearest(&end)),
                spanned_m,
            });
        }
        found
    }

    /// Median of the points' places behind a line, m; `None` for too few points.
    pub(crate) fn median_offset_m(
        &mut self,
        line: &StraightLine,
        tuning: &LinesTuning,
    ) -> Option<f64> {
        if self.points.len() < tuning.fewest_points {
            return None;
        }
        self.offsets.clear();
        let offsets = self.points.iter().map(|(_, point)| line.offset_m(point));
        self.offsets.extend(offsets);
        let middle = self.offsets.len() / 2;
        let (_, median_m, _) = self.offsets.select_nth_unstable_by(middle, f64::total_cmp);
        Some(*median_m)
    }

    /// Sum of the pieces between neighbours that are both close to a line, the outermost of them, right and left, and the
    /// length of the pieces, m.
    fn close_to(
        &self,
        line: Option<&StraightLine>,
        fringe_m: f64,
        tuning: &LinesTuning,
    ) -> Option<(LineSum, [Point2<f64>; 2], f64)> {
        let (mut sum, mut spanned_m) = (LineSum::default(), 0.0);
        let mut ends: Option<[Point2<f64>; 2]> = None;
        let mut before: Option<(usize, Point2<f64>)> = None;
        for &(col, point) in &self.points {
            if line.is_some_and(|line| line.offset_m(&point).abs() > fringe_m) {
                continue;
            }
            // To the right in the picture is to the right of the line.
            if let Some((last_col, last)) = before
                && col - last_col <= tuning.missing_columns
            {
                sum.add([&point, &last], 1.0);
                spanned_m += (last - point).norm();
                ends = Some([point, ends.map_or(last, |[_, left]| left)]);
            }
            before = Some((col, point));
        }
        Some((sum, ends?, spanned_m))
    }
}
