//! Where the pixels of two regions lie side by side.

use crate::picture::Picture;

/// Pixels that are searched together for those that differ from their neighbours.
const CHUNK: usize = 16;

/// How often regions touch. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct RegionContacts {
    regions: usize,
    // By pair of regions.
    pairs: Vec<(u32, f32)>,
    // Not zero where a pixel and one behind or below it have other labels.
    differs: Vec<u16>,
}

impl RegionContacts {
    /// How often the pixels of two regions touch, the one with the lower number first, and the sum of `sigma / g` there.
    pub(super) fn between(&self, i: usize, j: usize) -> (u32, f32) {
        self.pairs[i * self.regions + j]
    }

    /// Counts where pixels of two regions are `reach` columns or rows apart, or fewer.
    pub(super) fn count(
        &mut self,
        picture: Picture<'_>,
        regions: usize,
        labels: &[u16],
        reach: usize,
    ) {
        self.regions = regions;
        self.pairs.clear();
        self.pairs.resize(regions * regions, (0, 0.0));
        let steps = || (1..=reach).chain((1..=reach).map(|rows| rows * picture.width));
        self.differs.clear();
        self.differs.resize(labels.len(), 0);
        for step in steps() {
            let beside = labels.get(step..).unwrap_or_default();
            let pairs = labels.iter().zip(beside);
            for (differs, (&label, &other)) in self.differs.iter_mut().zip(pairs) {
                // All bits where the other one has a region: no branch keeps the processor from taking many at once.
                let seen = u16::from(other > 0).wrapping_neg();
                *differs |= (label ^ other) & seen;
            }
        }
        for at in places_of_some(&self.differs) {
            let label = labels[at];
            if label == 0 {
                continue;
            }
            for other in steps().map(|step| labels.get(at + step).copied().unwrap_or_default()) {
                if other != 0 && other != label {
                    let (low, high) = (label.min(other), label.max(other));
                    let (i, j) = (usize::from(low) - 1, usize::from(high) - 1);
                    let contact = &mut self.pairs[i * regions + j];
                    contact.0 += 1;
                    contact.1 += picture.sigma_px[at] / picture.g[at];
                }
            }
        }
    }
}

/// Where values are not 0, in order. Most are: they are passed over by the chunk.
pub(super) fn places_of_some(values: &[u16]) -> impl Iterator<Item = usize> {
    let chunks = values.chunks(CHUNK).enumerate();
    let some = chunks.filter(|(_, chunk)| chunk.iter().fold(0, |all, value| all | value) > 0);
    some.flat_map(|(index, chunk)| {
        let places = chunk.iter().enumerate().filter(|(_, value)| **value > 0);
        places.map(move |(i, _)| index * CHUNK + i)
    })
}
