//! Where the search for slopes begins.

use nalgebra::Vector3;

use super::{memory::SlopeMemory, tuning::SlopeTuning};
use crate::{picture::SeenPicture, regions::tilted::PlaneSums};

/// Pixels where slopes may be, and the planes there: windows that a tilted plane explains better than a level surface does, with the
/// tilt that is remembered where there is one.
pub(super) fn seeds(
    seen: SeenPicture<'_>,
    memory: &SlopeMemory,
    tuning: &SlopeTuning,
) -> Vec<(usize, Vector3<f64>)> {
    let (rules, stride) = (&tuning.seeds, tuning.seeds.stride);
    let width = seen.picture.width;
    let height = seen.picture.disparity_px.len() / width;
    let half = (width / (2 * rules.across)).max(1);
    let (across, down) = (width / half, height / half);
    let mut quarters = vec![PlaneSums::default(); across * down];
    for row in (0..down * half).step_by(stride) {
        for col in (row / stride % stride..across * half).step_by(stride) {
            if let Some([x, y, g, d]) = seen.terms(row * width + col) {
                quarters[row / half * across + col / half].add([x, y, g], d);
            }
        }
    }
    // Each pixel that is looked at stands for so many.
    let each = (stride * stride) as f64;
    let mut found = Vec::new();
    for row in 0..down.saturating_sub(1) {
        for col in 0..across.saturating_sub(1) {
            let mut sums = quarters[row * across + col];
            for beside in [1, across, across + 1] {
                sums.join(&quarters[row * across + col + beside]);
            }
            let (plane, least) = if memory.is_sure(&tuning.memory) {
                (sums.tilted(&memory.tilt), rules.remembered_sure)
            } else {
                (sums.plane(), rules.sure)
            };
            let Some(plane) = plane.filter(|plane| tuning.gradients.hold(plane)) else {
                continue;
            };
            let alike = tuning.alike;
            let sure = each * (sums.level_cost(alike) - sums.cost(&plane, alike));
            if sure > least {
                found.push((sure, (row + 1) * half * width + (col + 1) * half, plane));
            }
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.truncate(rules.most);
    found
        .into_iter()
        .map(|(_, at, plane)| (at, plane))
        .collect()
}
