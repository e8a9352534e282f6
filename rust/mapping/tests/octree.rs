//! The octree says what an exact grid says that stores every voxel.

mod beams;

use std::collections::BTreeMap;

use beams::{SPAN, frames, in_voxels, point, tree};
use mapping::Update;
use proptest::prelude::*;
use volume::octree::{Format, Key, Leaf, Octree, OctreeConfig, probability};
use volume::{Ray, VoxelWalk, bayes};

/// Log-odds in the tree's steps.
fn steps(p: f64) -> f32 {
    ((libm::log(p / (1.0 - p)) * 1_048_576.0).round() / 1_048_576.0) as f32
}

/// Probabilities by voxel, each as equation (1) of 002 says: nothing is merged, left out or bounded by a brick.
#[derive(Default)]
struct Exact(BTreeMap<Key, f64>);

impl Exact {
    fn update(&mut self, key: Key, hit: bool) {
        let rounded = |p: f64| probability(steps(p));
        let measured = rounded(if hit { 0.7 } else { 0.4 });
        let known = self.0.entry(key).or_insert(0.5);
        *known = bayes(*known, measured, 1.0 - measured).clamp(rounded(0.1192), rounded(0.971));
    }

    fn insert(&mut self, eye: [f64; 3], rays: &[Ray], update: Update) {
        let mut seen = BTreeMap::new();
        for ray in rays {
            let Some(walk) = VoxelWalk::new(in_voxels(eye), in_voxels(ray.end_m), [SPAN; 3]) else {
                continue;
            };
            let (last, hit) = (walk.last, ray.hit && walk.ends_inside);
            for voxel in walk {
                let (key, hit) = (voxel.map(|at| at as u16), hit && voxel == last);
                match update {
                    Update::PerPoint => self.update(key, hit),
                    Update::PerFrame => *seen.entry(key).or_insert(false) |= hit,
                }
            }
        }
        for (key, hit) in seen {
            self.update(key, hit);
        }
    }

    /// Whether the tree says the same of every voxel, to 1e-9. A voxel whose edge a ray touches may have been passed or not.
    fn agrees(&self, tree: &Octree, touched: impl Fn(Key) -> bool) -> Result<(), String> {
        let mut left = self.0.clone();
        for leaf in tree.leaves() {
            let edge = leaf.edge() as u16;
            for voxel in 0..u64::from(edge).pow(3) {
                let along = |n: u32| (voxel / u64::from(edge).pow(n)) as u16 % edge;
                let key: Key = std::array::from_fn(|axis| leaf.corner[axis] + along(axis as u32));
                let expected = left.remove(&key).unwrap_or(-1.0);
                let found = probability(leaf.log_odds);
                if (found - expected).abs() > 1e-9 && !touched(key) {
                    return Err(format!("{key:?}: {found}, expected {expected}"));
                }
            }
        }
        left.keys()
            .find(|&&key| !touched(key))
            .map_or(Ok(()), |key| Err(format!("{key:?} is missing")))
    }
}

/// Whether a ray goes by an edge of a voxel so near that rounding decides.
fn grazes(eye: [f64; 3], end: [f64; 3], key: Key) -> bool {
    let (from, to) = (in_voxels(eye), in_voxels(end));
    let overlap = |margin: f64| {
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for a in 0..3 {
            let bound = |border: f64| (border - from[a]) / (to[a] - from[a]);
            let low = bound(f64::from(key[a]) - margin);
            let high = bound(f64::from(key[a]) + 1.0 + margin);
            enter = enter.max(low.min(high));
            leave = leave.min(low.max(high));
        }
        leave - enter
    };
    overlap(1e-6) >= 0.0 && overlap(-1e-6) < 0.0
}

/// A picture's rays from the eye onto a wall 2 m away, row by row.
fn picture(eye: [f64; 3], width: usize) -> Vec<Ray> {
    let ray = |index: usize| {
        let across = (index % width) as f64 / width as f64 - 0.5;
        let down = (index / width) as f64 / width as f64 - 0.4;
        Ray {
            end_m: [
                eye[0] + 2.0 + 0.3 * across,
                eye[1] + 2.0 * across,
                eye[2] - 2.0 * down,
            ],
            hit: true,
        }
    };
    (0..width * width).map(ray).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]
    #[test]
    fn the_tree_is_the_exact_grid_per_frame(frames in frames(6.0)) {
        let (mut tree, mut exact) = (tree(), Exact::default());
        for (eye, rays) in &frames {
            let _beyond = tree.insert(*eye, rays, Update::PerFrame).unwrap();
            exact.insert(*eye, rays, Update::PerFrame);
        }
        let touched = |key: Key| frames.iter().any(|(eye, rays)| rays.iter().any(|ray| grazes(*eye, ray.end_m, key)));
        prop_assert_eq!(exact.agrees(&tree, touched), Ok(()));
    }

    #[test]
    fn the_tree_is_the_exact_grid_per_point(frames in frames(3.0)) {
        let (mut tree, mut exact) = (tree(), Exact::default());
        for (eye, rays) in &frames {
            let _beyond = tree.insert(*eye, rays, Update::PerPoint).unwrap();
            exact.insert(*eye, rays, Update::PerPoint);
        }
        prop_assert_eq!(exact.agrees(&tree, |_| false), Ok(()));
    }

    #[test]
    fn a_picture_of_many_frames_is_the_exact_grid(eyes in proptest::collection::vec(point(0.3), 1..4), width in 20..60_usize) {
        let (mut tree, mut exact) = (tree(), Exact::default());
        // Often enough that free voxels become as free as can be, and are then skipped.
        for eye in eyes.iter().chain(&eyes).chain(&eyes).chain(&eyes) {
            let _beyond = tree.insert(*eye, &picture(*eye, width), Update::PerFrame).unwrap();
            exact.insert(*eye, &picture(*eye, width), Update::PerFrame);
        }
        let touched = |key: Key| eyes.iter().any(|eye| picture(*eye, width).iter().any(|ray| grazes(*eye, ray.end_m, key)));
        prop_assert_eq!(exact.agrees(&tree, touched), Ok(()));
    }

    #[test]
    fn the_order_of_a_frame_does_not_matter(frames in frames(6.0), turn in 0..40_usize) {
        let (mut one, mut other) = (tree(), tree());
        for (eye, rays) in &frames {
            let mut turned = rays.clone();
            turned.rotate_left(turn % rays.len().max(1));
            turned.reverse();
            let _beyond = one.insert(*eye, rays, Update::PerFrame).unwrap();
            let _beyond = other.insert(*eye, &turned, Update::PerFrame).unwrap();
        }
        prop_assert!(one.to_bytes(Format::Full) == other.to_bytes(Format::Full));
    }

    #[test]
    fn what_expands_prunes_to_the_same_tree(keys in proptest::collection::vec(proptest::array::uniform3(32_760..32_776_u16), 0..60)) {
        let mut tree = tree();
        // A block of 16 x 16 x 16 voxels that were all seen free once is one leaf of depth 12.
        let block = || (0..4096_u16).map(|n| [32_768 + n % 16, 32_768 + n / 16 % 16, 32_768 + n / 256]);
        block().for_each(|key| tree.update_voxel(key, false));
        prop_assert_eq!((tree.leaves().count(), tree.node_count()), (1, 13));
        let mut changed = tree.clone();
        let mut plain: BTreeMap<Key, f32> = block().map(|key| (key, tree.log_odds(key).unwrap())).collect();
        for &key in &keys {
            changed.update_voxel(key, true);
            let known = plain.entry(key).or_insert(0.0);
            *known = (*known + steps(0.7)).min(steps(0.971));
        }
        prop_assert_eq!(changed.leaves().map(|leaf| u64::from(leaf.edge()).pow(3)).sum::<u64>(), plain.len() as u64);
        for (key, value) in plain {
            prop_assert_eq!(changed.log_odds(key), Some(value));
        }
        let again = Octree::from_bytes("copy", &changed.to_bytes(Format::Full)).unwrap();
        prop_assert!(again == changed && again.node_count() == changed.node_count());
    }
}

#[test]
fn far_beams_take_no_more_room_than_they_pass() {
    let mut tree = tree();
    let rays = [
        Ray {
            end_m: [3000.0, 2500.0, -2000.0],
            hit: true,
        },
        Ray {
            end_m: [1e9, 0.0, 0.0],
            hit: true,
        },
    ];
    let _beyond = tree
        .insert([0.01, 0.02, 0.03], &rays, Update::PerFrame)
        .unwrap();
    assert_eq!(tree.is_occupied_at([3000.0, 2500.0, -2000.0]), Some(true));
    assert_eq!(
        tree.is_occupied_at([1500.005, 1250.01, -999.985]),
        Some(false)
    );
    assert_eq!(
        tree.is_occupied_at([3276.0, 0.02, 0.03]),
        Some(false),
        "free up to where the tree ends"
    );
    assert!(tree.leaves().filter(Leaf::is_occupied).count() == 1);
}

#[test]
fn a_beam_that_is_no_number_changes_nothing() {
    let mut tree = tree();
    let good = Ray {
        end_m: [1.0, 1.0, 1.0],
        hit: true,
    };
    let bad = Ray {
        end_m: [f64::NAN, 1.0, 1.0],
        hit: true,
    };
    let said = tree
        .insert([0.0; 3], &[good, bad], Update::PerFrame)
        .unwrap_err()
        .to_string();
    assert_eq!(
        said,
        "point 1 must be finite, and no further away than a map can reach"
    );
    assert!(
        tree.insert([f64::INFINITY, 0.0, 0.0], &[good], Update::PerPoint)
            .is_err()
    );
    assert_eq!(tree.leaves().count(), 0);
}

#[test]
fn what_lies_beyond_the_voxels_is_counted_and_refused_where_all_does() {
    let mut tree = Octree::new(OctreeConfig::default()).unwrap();
    let hit = |end_m| Ray { end_m, hit: true };
    let (far, eye) = (
        [500_000.5, 5_000_000.0, 100.0],
        [500_000.0, 5_000_000.0, 100.0],
    );
    for update in [Update::PerFrame, Update::PerPoint] {
        let said = tree
            .insert(eye, &[hit(far)], update)
            .unwrap_err()
            .to_string();
        assert!(said.starts_with("point 0 at (500000.5, 5000000, 100) m lies beyond the tree: with voxels of 0.04 m it reaches from -1310.72 to 1310.72 m along each axis"), "{said}");
    }
    assert_eq!(
        tree.occupy(&[far]).unwrap_err().to_string(),
        tree.insert(eye, &[hit(far)], Update::PerFrame)
            .unwrap_err()
            .to_string()
    );
    assert_eq!(tree.leaves().count(), 0);
    let near = [1.0, 0.0, 0.0];
    assert_eq!(
        tree.insert([0.0; 3], &[hit(near), hit(far)], Update::PerFrame),
        Ok(1)
    );
    assert_eq!(tree.occupy(&[near, far, far, [f64::NAN; 3]]), Ok(2));
    assert_eq!(tree.is_occupied_at(near), Some(true));
    assert_eq!(tree.insert(eye, &[], Update::PerFrame), Ok(0));
}
