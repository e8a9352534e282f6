//! Octrees that share what they have in common, as the maps of particles do (004, ref. 36.19).

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

use proptest::prelude::*;
use volume::octree::{Octree, OctreeConfig};
use volume::{Ray, Update};

type Frame = ([f64; 3], Vec<[f64; 3]>);

fn tree() -> Octree {
    let resolution = 0.1;
    Octree::new(OctreeConfig {
        resolution,
        ..OctreeConfig::default()
    })
    .unwrap()
}

fn insert(tree: &mut Octree, (eye_m, ends): &Frame) {
    let rays: Vec<_> = ends.iter().map(|&end_m| Ray { end_m, hit: true }).collect();
    let _ = tree.insert(*eye_m, &rays, Update::PerFrame).unwrap();
}

fn of(frames: &[&Frame]) -> Octree {
    let mut made = tree();
    for frame in frames {
        insert(&mut made, frame);
    }
    made
}

fn leaves(tree: &Octree) -> Vec<(volume::octree::Key, u32, u32)> {
    let each = tree.leaves();
    each.map(|leaf| (leaf.corner, leaf.depth, leaf.log_odds.to_bits()))
        .collect()
}

fn frames() -> impl Strategy<Value = Vec<Frame>> {
    let point = || prop::array::uniform3(-2.0..2.0f64);
    prop::collection::vec((point(), prop::collection::vec(point(), 1..20)), 0..5)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn a_clone_and_its_original_never_see_each_others_insertions_and_equal_unshared_trees_bit_by_bit(
        before in frames(), ours in frames(), theirs in frames(),
    ) {
        let mut original = of(&before.iter().collect::<Vec<_>>());
        let mut clone = original.clone();
        // In turn, so that each writes where the other has not yet.
        for at in 0..ours.len().max(theirs.len()) {
            ours.get(at).into_iter().for_each(|frame| insert(&mut original, frame));
            theirs.get(at).into_iter().for_each(|frame| insert(&mut clone, frame));
        }
        let alone = |after: &[Frame]| of(&before.iter().chain(after).collect::<Vec<_>>());
        prop_assert_eq!(leaves(&original), leaves(&alone(&ours)));
        prop_assert_eq!(leaves(&clone), leaves(&alone(&theirs)));
    }
}
