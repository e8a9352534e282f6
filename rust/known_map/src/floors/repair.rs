//! The field of costs to a target, repaired where something stands in a way or has gone.
//!
//! What leads over a place that is blocked by now is lost, and found anew from what stands around it; all else keeps its cost unless a
//! place that has opened makes it cheaper. The costs are to the bit those of a field that is made anew: each is the least of the same sums.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::{CostField, Floors, NONE};

impl Floors {
    /// Takes over places that were blocked or have opened since [`Self::aim`] or this was called; `blocked` holds for all places by now.
    pub fn repair(&self, changed: &[u32], blocked: &[bool], field: &mut CostField) {
        let is_end = |field: &CostField, place: u32| {
            field.next[place as usize] == NONE && field.cost_m[place as usize].is_finite()
        };
        let mut lost: Vec<u32> = (changed.iter().copied())
            .filter(|&place| blocked[place as usize] && field.next[place as usize] != NONE)
            .collect();
        for &place in &lost {
            field.take_back(place);
        }
        let mut seen = 0;
        while let Some(&place) = lost.get(seen) {
            seen += 1;
            for (beside, _) in self.steps(place) {
                if field.next[beside as usize] == place {
                    field.take_back(beside);
                    lost.push(beside);
                }
            }
        }
        let opened = (changed.iter().copied())
            .filter(|&place| !blocked[place as usize] && !is_end(field, place));
        let mut queue = BinaryHeap::new();
        for place in lost.iter().copied().chain(opened) {
            for (beside, _) in self.steps(place) {
                let cost_m = field.cost_m[beside as usize];
                if cost_m.is_finite() {
                    queue.push(Reverse((cost_m.to_bits(), beside)));
                }
            }
        }
        self.spread(queue, blocked, field);
    }
}

impl CostField {
    /// No way is known from a place any more.
    fn take_back(&mut self, place: u32) {
        self.cost_m[place as usize] = f32::INFINITY;
        self.next[place as usize] = NONE;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{KnownMapTuning, StandingRoom, Target};
    use proptest::prelude::*;
    use volume::SolidVoxels;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(30))]

        #[test]
        fn repaired_the_costs_are_to_the_bit_those_of_a_field_made_anew(
            blocks in prop::collection::vec((0.0..1.6f64, 0.0..1.6f64, 0.04..0.4f64, 0.04..0.4f64, 1..6_u32), 0..6),
            x in 0.1..1.9f64, y in 0.1..1.9f64,
            changes in prop::collection::vec(prop::collection::vec((0..10_000_u32, 1..60_u32, any::<bool>()), 1..4), 1..12),
        ) {
            let mut boxes = vec![[[0.0, 0.0, -0.04], [2.0, 2.0, 0.0]]];
            boxes.extend(blocks.iter().map(|&(x, y, dx, dy, h)| [[x, y, 0.0], [x + dx, y + dy, 0.04 * f64::from(h)]]));
            let room = StandingRoom { radius_m: 0.08, height_m: 0.55 };
            let floors = Floors::new((&SolidVoxels::of_boxes(&boxes, 0.04).unwrap(), None), room, &KnownMapTuning::default());
            let count = floors.count() as u32;
            prop_assume!(count > 0);
            let target = Target { at_m: [x, y], radius_m: 0.05, height_m: None };
            let mut blocked = vec![false; floors.count()];
            let (mut field, mut anew) = (CostField::default(), CostField::default());
            floors.aim(&target, &blocked, &mut field);
            for change in changes {
                let mut changed = vec![];
                for (first, length, blocks) in change {
                    for place in first % count..(first % count + length).min(count) {
                        if blocked[place as usize] != blocks {
                            blocked[place as usize] = blocks;
                            changed.push(place);
                        }
                    }
                }
                floors.repair(&changed, &blocked, &mut field);
                floors.aim(&target, &blocked, &mut anew);
                for place in 0..count {
                    prop_assert_eq!(field.cost_m(place).to_bits(), anew.cost_m(place).to_bits());
                    if let Some(next) = field.next(place) {
                        let step = floors.steps(place).find(|step| step.0 == next).unwrap();
                        prop_assert_eq!(field.cost_m(place), field.cost_m(next) + step.1 as f32);
                    }
                }
            }
        }
    }
}
