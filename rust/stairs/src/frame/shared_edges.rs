//! Edges between two surfaces, seen from both. The labels of each run over the edge or stop before it, by as much: the
//! middle between where one ends and where the other begins, column by column, is right within millimetres.

use geometry::Robot;
use segmentation::Planes;

use crate::frame::view::PlanesView;
use crate::lines::robust_line::Row;
use crate::stair::level_edge;
use crate::{Edge, StairsConfig, StairsTuning};

/// One column's change from a surface to the next behind it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct LabelChange {
    nearer: u16,
    farther: u16,
    col: u16,
    last_row: u16,
    first_row: u16,
}

/// An edge between two regions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SharedEdge {
    /// Index of the region in front of it.
    pub(crate) nearer: usize,
    /// Index of the region behind it.
    pub(crate) farther: usize,
    /// The edge at the height of the farther one, robot frame.
    pub(crate) edge: Edge<Robot>,
}

/// Finds edges. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(crate) struct SharedEdges {
    changes: Vec<LabelChange>,
    row: Row,
    /// Edges of the last frame.
    pub(crate) edges: Vec<SharedEdge>,
}

impl SharedEdges {
    /// Reads the labels of a frame.
    pub(crate) fn read(
        &mut self,
        planes: &Planes,
        view: &PlanesView<'_>,
        width: usize,
        config: &StairsConfig,
    ) {
        self.changes.clear();
        for col in 0..width {
            self.read_column(planes, col, width, config);
        }
        self.changes.sort_unstable();
        self.edges.clear();
        let Self {
            changes,
            row,
            edges,
        } = self;
        let pairs = changes.chunk_by(|a, b| (a.nearer, a.farther) == (b.nearer, b.farther));
        edges.extend(pairs.filter_map(|pair| fit(pair, planes, view, row, &config.tuning)));
    }

    /// Follows a column from its bottom up.
    fn read_column(&mut self, planes: &Planes, col: usize, width: usize, config: &StairsConfig) {
        let level_m = |region: u16| planes.regions[usize::from(region)].floor_height_m;
        let tuning = &config.tuning.frame.shared_edges;
        let (least_run, largest_gap) = (tuning.least_run, tuning.largest_gap);
        let mut last: Option<(u16, u16)> = None;
        let (mut run, mut run_start, mut run_length) = (0, 0, 0);
        for row in (0..planes.labels.len() / width).rev() {
            let (label, row) = (planes.labels[row * width + col], row as u16);
            if label == 0 {
                continue;
            }
            if label != run {
                if level_m(label - 1).is_none() {
                    continue;
                }
                (run, run_start, run_length) = (label, row, 0);
            }
            run_length += 1;
            if run_length < least_run {
                continue;
            }
            let region = run - 1;
            if run_length == least_run
                && let Some((nearer, last_row)) = last
                && let (Some(near_m), Some(far_m)) = (level_m(nearer), level_m(region))
                && (near_m - far_m).abs() > config.own_height
                && last_row.saturating_sub(run_start) <= largest_gap
            {
                self.changes.push(LabelChange {
                    nearer,
                    farther: region,
                    col: col as u16,
                    last_row,
                    first_row: run_start,
                });
            }
            last = Some((region, row));
        }
    }
}

/// The line through the changes between two regions.
fn fit(
    pair: &[LabelChange],
    planes: &Planes,
    view: &PlanesView<'_>,
    row: &mut Row,
    tuning: &StairsTuning,
) -> Option<SharedEdge> {
    let first = pair.first()?;
    let [nearer, farther] = [first.nearer, first.farther].map(usize::from);
    let near_m = planes.regions[nearer].floor_height_m?;
    let far_m = planes.regions[farther].floor_height_m?;
    row.points.clear();
    for change in pair {
        let [last, begin] = [change.last_row, change.first_row].map(f64::from);
        let col = f64::from(change.col);
        let place = if far_m > near_m {
            // The riser is in view, its foot and its top.
            let foot = view.on_level([col, last], near_m);
            foot.zip(view.on_level([col, begin], far_m))
                .map(|(foot, top)| nalgebra::center(&foot, &top))
        } else {
            // The ray that passes over the higher surface's edge.
            view.on_level([col, f64::midpoint(last, begin)], near_m)
        };
        row.points
            .extend(place.map(|place| (usize::from(change.col), place)));
    }
    let away_m = row.points.first()?.1.coords.norm();
    let fringe_m = view.fringe_m(near_m, away_m);
    let straight = row.straight(None, fringe_m, &tuning.lines)?;
    let edge = level_edge(straight.ends, far_m);
    let least_m = tuning.frame.shared_edges.least_length;
    let least_m = least_m.max(edge.length_m() * tuning.lines.spanned);
    (straight.spanned_m > least_m).then_some(SharedEdge {
        nearer,
        farther,
        edge,
    })
}
