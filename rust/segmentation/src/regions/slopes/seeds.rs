//! Where the search for slopes begins.

use nalgebra::Vector3;

use super::is_slope;
use super::memory::Memory;
use super::sums::{Seen, SlopeSums};

/// Windows that the search begins with: so many across the image, half overlapping.
const SEEDS_ACROSS: usize = 4;
/// How much better than a level surface a tilted plane must explain a window, in squared noise.
const SEED_SURE: f64 = 8.0;
/// Windows that are grown, the surest first.
const MOST_SEEDS: usize = 4;

/// Pixels where slopes may be, and the planes there: windows that a tilted plane explains better than a level surface does, with the
/// tilt that is remembered where there is one.
pub(super) fn seeds(seen: Seen<'_>, memory: &Memory) -> Vec<(usize, Vector3<f64>)> {
    let width = seen.picture.width;
    let height = seen.picture.disparity_px.len() / width;
    let half = (width / (2 * SEEDS_ACROSS)).max(1);
    let (across, down) = (width / half, height / half);
    let mut quarters = vec![SlopeSums::default(); across * down];
    for row in (0..down * half).step_by(2) {
        for col in (row / 2 % 2..across * half).step_by(2) {
            quarters[row / half * across + col / half].add(seen.terms(row * width + col));
        }
    }
    let mut found = Vec::new();
    for row in 0..down.saturating_sub(1) {
        for col in 0..across.saturating_sub(1) {
            let mut sums = quarters[row * across + col];
            for beside in [1, across, across + 1] {
                sums.join(&quarters[row * across + col + beside]);
            }
            let (plane, least) = if memory.is_sure() {
                (sums.tilted(&memory.tilt), SEED_SURE / 2.0)
            } else {
                (sums.plane(), SEED_SURE)
            };
            let Some(plane) = plane.filter(is_slope) else {
                continue;
            };
            // Every fourth pixel was looked at.
            let sure = 4.0 * (sums.level_cost() - sums.cost(&plane));
            if sure > least {
                found.push((sure, (row + 1) * half * width + (col + 1) * half, plane));
            }
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.truncate(MOST_SEEDS);
    found
        .into_iter()
        .map(|(_, at, plane)| (at, plane))
        .collect()
}
