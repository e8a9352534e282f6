//! The surfaces of a cell, one above the other: what a multi-level surface map keeps (004, Fig. 36.11d).

use crate::columns::Span;
use crate::elevation::cells::{HeightCell, Revision};
use crate::elevation::{CellMeasurement, HeightEstimate};

/// A surface and the vertical extent of what it is on. What was only seen from below its height has no surface that is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patch {
    pub(super) top: HeightCell,
    /// Lowest height at which the thing was seen, m.
    pub low_m: f32,
}

impl Patch {
    const NONE: Self = Self {
        top: HeightCell::UNKNOWN,
        low_m: f32::NAN,
    };

    /// Height of the surface in the map frame and how sure it is.
    pub const fn estimate(&self) -> HeightEstimate {
        self.top.estimate
    }

    /// Frames that saw the surface from above, saturating.
    pub const fn frames(&self) -> u16 {
        self.top.frames
    }

    /// Vertical depth: from the lowest height at which the thing was seen to its surface, m.
    pub const fn depth_m(&self) -> f32 {
        self.top.estimate.height_m - self.low_m
    }
}

impl From<Patch> for Span {
    fn from(patch: Patch) -> Self {
        Self {
            low_m: patch.low_m,
            high_m: patch.estimate().height_m,
            frames: patch.frames(),
            sigma_m: patch.estimate().variance_m2.sqrt(),
        }
    }
}

/// The surfaces of a cell, the lowest first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Patches {
    patches: [Patch; Self::MOST],
    count: u8,
}

impl Patches {
    /// Things one above the other in a cell at most: more storeys than a robot's window is high.
    const MOST: usize = 4;
    /// Nothing was seen.
    pub(super) const NONE: Self = Self {
        patches: [Patch::NONE; Self::MOST],
        count: 0,
    };

    /// Those that were seen, the lowest first.
    #[inline]
    pub(super) fn seen(&self) -> &[Patch] {
        &self.patches[..usize::from(self.count)]
    }

    /// Takes in what a frame measured of a thing from an eye at this height, m: it is the one that is known where there is no room for the
    /// robot between both, else another one. From below its underside or its side is seen, not its surface.
    pub(super) fn measure(&mut self, measured: &CellMeasurement, eye_m: f32, revision: Revision) {
        let count = usize::from(self.count);
        let known = &mut self.patches[..count];
        let (low_m, high_m) = (measured.low_m, measured.surface.height_m);
        let apart_m = |patch: &Patch| {
            let above = low_m - patch.top.estimate.height_m;
            let below = patch.low_m - high_m;
            above.max(below)
        };
        let nearest = known
            .iter_mut()
            .min_by(|a, b| apart_m(a).total_cmp(&apart_m(b)));
        let joined = nearest.filter(|patch| apart_m(patch) <= revision.gap_m);
        let from_below = high_m > eye_m;
        let Some(patch) = joined else {
            let mut top = HeightCell::UNKNOWN;
            if from_below {
                top.estimate = measured.surface;
            } else {
                top.measure(measured, revision);
            }
            self.add(Patch { top, low_m });
            return;
        };
        let before_m = patch.top.estimate.height_m;
        if from_below {
            patch.low_m = patch.low_m.min(low_m);
            if high_m > before_m {
                patch.top.raise(measured.surface);
            }
        } else {
            // Within the thing nothing is another thing.
            let revision = Revision {
                gap_m: f32::INFINITY,
                ..revision
            };
            patch.top.measure(measured, revision);
            let lowered = patch.top.frames == 1 && patch.top.estimate.height_m < before_m;
            patch.low_m = if lowered {
                low_m
            } else {
                patch.low_m.min(low_m)
            };
        }
        self.sort();
    }

    /// Takes back what `gone` says of.
    pub(super) fn drop_where(&mut self, mut gone: impl FnMut(&mut Patch) -> bool) -> bool {
        let count = usize::from(self.count);
        let mut kept = 0;
        for index in 0..count {
            let mut patch = self.patches[index];
            if !gone(&mut patch) {
                self.patches[kept] = patch;
                kept += 1;
            }
        }
        self.count = kept as u8;
        kept < count
    }

    /// Adds a thing in its place; where there are too many, in that of the one that was seen least.
    fn add(&mut self, patch: Patch) {
        let count = usize::from(self.count);
        if count == Self::MOST {
            let seen = self.patches.iter().enumerate();
            if let Some((least, _)) = seen.min_by_key(|(_, one)| one.top.frames) {
                self.patches[least] = patch;
            }
        } else {
            self.patches[count] = patch;
            self.count += 1;
        }
        self.sort();
    }

    fn sort(&mut self) {
        let count = usize::from(self.count);
        let height = |patch: &Patch| patch.top.estimate.height_m;
        self.patches[..count].sort_by(|a, b| height(a).total_cmp(&height(b)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REVISION: Revision = Revision {
        gate: 3.0,
        patience: 3,
        gap_m: 0.5,
    };

    fn after(things: &[[f32; 2]]) -> Vec<[f32; 2]> {
        let from_above: Vec<_> = things.iter().map(|&thing| (thing, 9.0)).collect();
        seen_from(&from_above)
    }

    /// The things as they are known after they were seen, each from an eye of this height.
    fn seen_from(things: &[([f32; 2], f32)]) -> Vec<[f32; 2]> {
        let mut patches = Patches::NONE;
        for &([low_m, high_m], eye_m) in things {
            let measured = CellMeasurement {
                cell: 0,
                surface: HeightEstimate {
                    height_m: high_m,
                    variance_m2: 1e-4,
                },
                low_m,
                points: 3,
            };
            patches.measure(&measured, eye_m, REVISION);
        }
        let seen = patches.seen().iter();
        seen.map(|one| [one.low_m, one.estimate().height_m])
            .collect()
    }

    #[test]
    fn a_bridge_and_the_road_below_it_are_two_surfaces_in_either_order() {
        let both = vec![[0.0, 0.0], [0.7, 0.75]];
        assert_eq!(after(&[[0.0, 0.0], [0.7, 0.75]]), both);
        assert_eq!(after(&[[0.7, 0.75], [0.0, 0.0]]), both);
    }

    #[test]
    fn the_underside_of_a_deck_is_not_its_surface() {
        let (under, top) = ([0.65, 0.66], [0.7, 0.71]);
        let below = [(under, 0.4), (under, 0.4), (under, 0.4), (top, 1.2)];
        assert_eq!(seen_from(&below), [[0.65, 0.71]]);
    }

    #[test]
    fn a_wall_seen_bit_by_bit_is_one_thing_with_its_whole_depth() {
        assert_eq!(after(&[[0.3, 0.4], [0.0, 0.1], [0.5, 0.9]]), [[0.0, 0.9]]);
    }

    #[test]
    fn a_thing_that_is_gone_leaves_the_floor_after_some_frames() {
        let floor = [0.0, 0.0];
        assert_eq!(after(&[[0.1, 0.2], floor, floor]), [[0.0, 0.2]]);
        assert_eq!(after(&[[0.1, 0.2], floor, floor, floor]), [floor]);
    }

    #[test]
    fn of_too_many_things_those_seen_least_go() {
        let things: Vec<_> = (0..9).map(|i| [i as f32, i as f32]).collect();
        assert_eq!(after(&things).len(), Patches::MOST);
        assert_eq!(
            after(&[
                things[0], things[0], things[1], things[2], things[3], things[4]
            ])[0],
            things[0]
        );
    }
}
