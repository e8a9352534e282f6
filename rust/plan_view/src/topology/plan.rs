//! Planning by the diagram: to it, along it, and from it to the goal (004, section 36.2.3).

use geometry::Dijkstra;

use super::nearest::NONE;
use super::skeleton::Skeleton;
use super::{VoronoiGraph, length_m};

/// A way to a goal by the diagram.
#[derive(Debug, Clone, PartialEq)]
pub struct GraphPlan {
    /// Centres of the cells from the start's to the goal's, metres.
    pub path_m: Vec<[f64; 2]>,
    /// Which of them lie on the diagram; before them the way leads to it, after them away from it.
    pub along: std::ops::Range<usize>,
    /// Length, metres.
    pub length_m: f64,
    /// Least distance to a cell that is not free, centre to centre, metres.
    pub clearance_m: f64,
}

impl VoronoiGraph {
    /// The shortest way along the diagram between two points, all of it at least this far from everything, centre to centre, in metres.
    /// None where there is no way at all with that clearance, on the diagram or off it.
    pub fn plan(&self, start_m: [f64; 2], goal_m: [f64; 2], clearance_m: f64) -> Option<GraphPlan> {
        let least = clearance_m / self.lattice.cell_m;
        let wide =
            |at: usize| f64::from(self.skeleton.nearest.squared[at]) >= (least * least).max(1.0);
        let (start, goal) = (self.index_at(start_m)?, self.index_at(goal_m)?);
        if !wide(start) || !wide(goal) {
            return None;
        }
        let (to, mut from) = (
            retraction(&self.skeleton, start),
            retraction(&self.skeleton, goal),
        );
        let along = shortest(&self.skeleton, *to.last()?, *from.last()?, wide)?;
        let first = to.len() - 1;
        let mut cells = to;
        let _ = cells.pop();
        cells.extend(&along);
        let last = cells.len();
        let _ = from.pop();
        cells.extend(from.iter().rev());
        let path_m: Vec<[f64; 2]> = cells.iter().map(|&at| self.center_of(at)).collect();
        Some(GraphPlan {
            length_m: length_m(&path_m),
            path_m,
            along: first..last,
            clearance_m: cells
                .iter()
                .map(|&at| self.clearance_of(at))
                .fold(f64::INFINITY, f64::min),
        })
    }
}

/// From a cell to the diagram, never nearer to anything.
fn retraction(skeleton: &Skeleton, from: usize) -> Vec<usize> {
    let mut cells = vec![from];
    let mut at = skeleton.towards[from];
    while at != NONE {
        cells.push(at as usize);
        at = skeleton.towards[at as usize];
    }
    cells
}

/// The shortest way on the diagram over cells that are wide enough.
fn shortest(
    skeleton: &Skeleton,
    from: usize,
    to: usize,
    wide: impl Fn(usize) -> bool,
) -> Option<Vec<usize>> {
    let mut costs = vec![f32::INFINITY; skeleton.kept.len()];
    let mut before = vec![NONE; skeleton.kept.len()];
    let steps = |at: u32| {
        let at = at as usize;
        let around: Vec<_> = skeleton
            .neighbours(at)
            .filter(|&beside| wide(beside))
            .map(|beside| {
                let straight = beside.abs_diff(at) == 1 || beside.abs_diff(at) == skeleton.cols;
                (
                    beside as u32,
                    if straight {
                        1.0
                    } else {
                        std::f32::consts::SQRT_2
                    },
                )
            })
            .collect();
        around.into_iter()
    };
    let mut search = Dijkstra::default();
    search.begin_at(&mut costs, to as u32, 0.0);
    search.run(&mut costs, steps, |node, next| before[node as usize] = next);
    if costs[from].is_infinite() {
        return None;
    }
    let mut cells = vec![from];
    while cells.last() != Some(&to) {
        cells.push(before[*cells.last()?] as usize);
    }
    Some(cells)
}
