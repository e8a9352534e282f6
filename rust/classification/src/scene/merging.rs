//! Patches merged to planes, the likeliest pair first (agglomeration as in Feng, Taguchi and Kamat, ICRA 2014, section III; the test
//! is of ours: in inverse depth, where the noise is the same everywhere).

use std::collections::{BTreeSet, BinaryHeap};

use super::plane_sums::PatchSums;

/// What two patches may differ by and still be one plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SamePlane {
    /// Pixels that err alike tell as much as one.
    pub(crate) alike: f64,
    /// Squared noises by which the two fits may differ by chance.
    pub(crate) gate: f64,
    /// Noises by which the smaller patch may lie off the plane of both.
    pub(crate) misfit: f64,
}

impl SamePlane {
    /// How much worse one plane fits than two, as a share of what is allowed.
    fn strain(&self, a: &MergingPatch, b: &MergingPatch) -> f64 {
        let both = a.sums.joined(&b.sums).cost();
        let smaller = a.sums.count().min(b.sums.count());
        (both - a.cost - b.cost) / (self.gate * self.alike + self.misfit * self.misfit * smaller)
    }
}

struct MergingPatch {
    sums: PatchSums,
    cost: f64,
    beside: BTreeSet<usize>,
    /// How often it was merged: what was said of it before is void.
    age: usize,
}

/// A pair that may be merged; the one with the least strain is the greatest.
#[derive(PartialEq)]
struct MergingPair {
    strain: f64,
    patches: [usize; 2],
    ages: [usize; 2],
}

impl Eq for MergingPair {}

impl Ord for MergingPair {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        let by_strain = other.strain.total_cmp(&self.strain);
        by_strain.then_with(|| other.patches.cmp(&self.patches))
    }
}

impl PartialOrd for MergingPair {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

/// Which patch each became a part of (the one of least index), after all pairs were merged that are one plane.
pub(crate) fn merged(same: &SamePlane, sums: &[PatchSums], pairs: &[[usize; 2]]) -> Vec<usize> {
    let mut patches: Vec<MergingPatch> = (sums.iter())
        .map(|sums| MergingPatch {
            sums: *sums,
            cost: sums.cost(),
            beside: BTreeSet::new(),
            age: 0,
        })
        .collect();
    for &[a, b] in pairs {
        let _ = patches[a].beside.insert(b);
        let _ = patches[b].beside.insert(a);
    }
    let mut part_of: Vec<usize> = (0..sums.len()).collect();
    let mut waiting = BinaryHeap::new();
    let offer =
        |patches: &[MergingPatch], waiting: &mut BinaryHeap<MergingPair>, a: usize, b: usize| {
            let strain = same.strain(&patches[a], &patches[b]);
            if strain < 1.0 {
                waiting.push(MergingPair {
                    strain,
                    patches: [a, b],
                    ages: [patches[a].age, patches[b].age],
                });
            }
        };
    for &[a, b] in pairs {
        offer(&patches, &mut waiting, a.min(b), a.max(b));
    }
    while let Some(MergingPair {
        patches: [a, b],
        ages,
        ..
    }) = waiting.pop()
    {
        if ages != [patches[a].age, patches[b].age] {
            continue;
        }
        let others = std::mem::take(&mut patches[b].beside);
        patches[b].age += 1;
        part_of[b] = a;
        for other in others {
            let _ = patches[other].beside.remove(&b);
            if other != a {
                let _ = patches[other].beside.insert(a);
                let _ = patches[a].beside.insert(other);
            }
        }
        patches[a].sums = patches[a].sums.joined(&patches[b].sums);
        patches[a].cost = patches[a].sums.cost();
        patches[a].age += 1;
        let beside: Vec<usize> = patches[a].beside.iter().copied().collect();
        for other in beside {
            offer(&patches, &mut waiting, a.min(other), a.max(other));
        }
    }
    // Each became part of one of lower index: in this order that one's own whole is known.
    for at in 0..part_of.len() {
        part_of[at] = part_of[part_of[at]];
    }
    part_of
}
