//! Stair merging (003, section IV.C, Fig. 7).

use geometry::{Map, Outline};

use crate::Edge;
use crate::tread::{Tread, quadrangle};

/// Share of the smaller of two treads that must lie in both for them to be one.
const SHARED: f64 = 0.25;

/// Edges of one stair that was seen in two pieces lie on one line, within this, m, and no further apart than this.
const ONE_LINE_M: f64 = 0.03;

/// Whether two treads are the same: similar heights, and enough of the smaller one in both, or side by side.
pub(crate) fn overlap(a: &Tread, b: &Tread, similar_height_m: f64) -> bool {
    (a.height_m() - b.height_m()).abs() <= similar_height_m
        && (shared(a, b) >= SHARED || side_by_side(a, b))
}

/// Whether two treads are pieces of one: fronts and backs on one line and hardly a gap between.
fn side_by_side(a: &Tread, b: &Tread) -> bool {
    let (Some(a), Some(b)) = (a.stair(), b.stair()) else {
        return false;
    };
    let on_one_line = |a: &Edge<Map>, b: &Edge<Map>| {
        let off_m = |a: &Edge<Map>, b: &Edge<Map>| {
            let ends = [b.left.inner, b.right.inner].map(|end| a.beyond_m([end.x, end.y]).abs());
            ends[0].max(ends[1])
        };
        off_m(a, b).max(off_m(b, a)) < ONE_LINE_M
    };
    let gap_m = |a: &Edge<Map>, b: &Edge<Map>| {
        let along = (a.left.inner - a.right.inner).normalize();
        let span =
            |edge: &Edge<Map>| [edge.right, edge.left].map(|end| along.dot(&end.inner.coords));
        let ([a_from, a_to], [b_from, b_to]) = (span(a), span(b));
        a_from.max(b_from) - a_to.min(b_to)
    };
    on_one_line(&a.front, &b.front)
        && on_one_line(&a.back, &b.back)
        && gap_m(&a.front, &b.front).min(gap_m(&a.back, &b.back)) < ONE_LINE_M
}

/// Share of the smaller of two treads that lies in both.
pub(crate) fn shared(a: &Tread, b: &Tread) -> f64 {
    let outline = |tread: &Tread| -> Option<Outline> { quadrangle(&tread.stair()?) };
    let (Some(a), Some(b)) = (outline(a), outline(b)) else {
        return 0.0;
    };
    a.shared_area_m2(&b) / a.area_m2().min(b.area_m2())
}

/// Merges overlapping pairs until there are none. The set shrinks with each, so that this ends.
pub(crate) fn merge_all(treads: &mut Vec<Tread>, similar_height_m: f64) {
    while let Some((kept, gone)) = overlapping_pair(treads, similar_height_m) {
        let gone = treads.swap_remove(gone);
        treads[kept].add(&gone);
    }
}

/// The first pair that overlaps, the smaller index first.
fn overlapping_pair(treads: &[Tread], similar_height_m: f64) -> Option<(usize, usize)> {
    (0..treads.len()).find_map(|i| {
        let j =
            (i + 1..treads.len()).find(|&j| overlap(&treads[i], &treads[j], similar_height_m))?;
        Some((i, j))
    })
}
