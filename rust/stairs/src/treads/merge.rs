//! Stair merging (003, section IV.C, Fig. 7).

use geometry::Map;

use crate::{Edge, MergingTuning, StairsConfig, treads::tread::Tread};

/// Whether two treads are the same: similar heights, and enough of the smaller one in both, or side by side.
pub(crate) fn overlap(a: &Tread, b: &Tread, config: &StairsConfig) -> bool {
    let tuning = &config.tuning.treads.merging;
    (a.height_m() - b.height_m()).abs() <= config.similar_height
        && (shared(a, b) >= tuning.shared || side_by_side(a, b, tuning))
}

/// Whether two treads are pieces of one: fronts and backs on one line and hardly a gap between.
fn side_by_side(a: &Tread, b: &Tread, tuning: &MergingTuning) -> bool {
    let one_line_m = tuning.one_line;
    let (Some(a), Some(b)) = (a.stair(), b.stair()) else {
        return false;
    };
    let on_one_line = |a: &Edge<Map>, b: &Edge<Map>| {
        let off_m = |a: &Edge<Map>, b: &Edge<Map>| {
            let ends = [b.left.inner, b.right.inner].map(|end| a.beyond_m([end.x, end.y]).abs());
            ends[0].max(ends[1])
        };
        off_m(a, b).max(off_m(b, a)) < one_line_m
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
        && gap_m(&a.front, &b.front).min(gap_m(&a.back, &b.back)) < one_line_m
}

/// Share of the smaller of two treads that lies in both.
pub(crate) fn shared(a: &Tread, b: &Tread) -> f64 {
    let (Some(a), Some(b)) = (a.outline(), b.outline()) else {
        return 0.0;
    };
    a.shared_area_m2(b) / a.area_m2().min(b.area_m2())
}

/// Whether two treads cannot both be there: the higher one covers most of the lower one, which then could not be seen. What
/// is lower and much larger lies around the higher one: hulls close over what stands on a floor.
pub(crate) fn contradict(a: &Tread, b: &Tread, tuning: &MergingTuning) -> bool {
    let lower = if a.height_m() < b.height_m() { a } else { b };
    let (Some(of_a), Some(of_b), Some(covered)) = (a.outline(), b.outline(), lower.outline())
    else {
        return false;
    };
    of_a.shared_area_m2(of_b) > tuning.covered * covered.area_m2()
}

/// Merges overlapping pairs until there are none. The set shrinks with each, so that this ends.
pub(crate) fn merge_all(treads: &mut Vec<Tread>, config: &StairsConfig) {
    while let Some((kept, gone)) = overlapping_pair(treads, config) {
        let gone = treads.swap_remove(gone);
        treads[kept].add(&gone, &config.tuning);
    }
}

/// The first pair that overlaps, the smaller index first.
fn overlapping_pair(treads: &[Tread], config: &StairsConfig) -> Option<(usize, usize)> {
    (0..treads.len()).find_map(|i| {
        let j = (i + 1..treads.len()).find(|&j| overlap(&treads[i], &treads[j], config))?;
        Some((i, j))
    })
}

#[cfg(test)]
mod tests;
