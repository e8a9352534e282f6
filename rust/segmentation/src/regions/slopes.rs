//! Slopes: surfaces that are tilted, walkable or too steep to be walked on, each kept as one region with its own plane.
//!
//! A segmenter of level surfaces cuts a slope into level strips, which is what stairs look like, too. So a plane is grown through
//! them, `d = a X + b Y + q g`, over what it fits better than the level surfaces do. It is a slope if it explains all of that
//! better than the best flight of treads does that rises as much.

mod doubts;
mod growth;
mod memory;
mod seeds;
mod treads;
pub(crate) mod tuning;

use nalgebra::{Matrix3, Vector3};

use crate::picture::{Linear, MAX_REGIONS, Picture, SeenPicture, View};
use crate::regions::finder::Look;
use crate::regions::region::Region;
use doubts::Doubts;
use growth::{SlopeGrowth, StripReach};
use memory::SlopeMemory;
use seeds::seeds;
use treads::TreadFit;
use tuning::SlopeTuning;

/// Finds slopes. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(crate) struct SlopeSearch {
    tuning: SlopeTuning,
    growth: SlopeGrowth,
    treads: TreadFit,
    doubts: Doubts,
    // Where the slopes of this frame were grown from, and their planes.
    found: Vec<(usize, Linear)>,
    /// Pixels of what may be a slope or stairs.
    pub(crate) doubtful: Vec<bool>,
    memory: SlopeMemory,
}

impl SlopeSearch {
    /// No slope seen yet.
    pub(crate) fn new(tuning: SlopeTuning) -> Self {
        Self {
            growth: SlopeGrowth::new(tuning.growth.clone(), tuning.gradients.clone()),
            doubts: Doubts::new(tuning.doubts.clone(), tuning.alike),
            tuning,
            ..Self::default()
        }
    }

    /// Takes the pixels of slopes from the level regions and appends a region for each; says whether there were any. `look`: what a
    /// frame shows is learned once.
    pub(crate) fn find(
        &mut self,
        picture: Picture<'_>,
        view: &View,
        look: Look,
        regions: &mut Vec<Region>,
        labels: &mut [u16],
    ) -> bool {
        let seen = SeenPicture { picture, view };
        let before = regions.len();
        let faded = self.memory.faded(&self.tuning.memory);
        let (mut again, mut other) = (None, SlopeMemory::default());
        self.doubtful.clear();
        self.doubtful.resize(labels.len(), false);
        let starts = match look {
            Look::First => seeds(seen, &self.memory, &self.tuning),
            Look::Again => self.found_again(view),
        };
        self.found.clear();
        for (start, plane) in starts {
            if regions.len() == MAX_REGIONS {
                break;
            }
            if usize::from(labels[start]) > before {
                continue;
            }
            let Some((plane, better)) = self.grow(seen, (start, plane), look, regions, labels)
            else {
                continue;
            };
            let told = self.memory.told(&plane, better, &self.tuning.memory);
            if better.is_some() {
                let same = self.memory.is_of(&plane, &self.tuning.memory);
                let surer = |than: &SlopeMemory| told.sure > than.sure;
                if same && again.as_ref().is_none_or(surer) {
                    again = Some(told);
                } else if !same && surer(&other) {
                    other = told;
                }
            }
            if told.is_sure(&self.tuning.memory) {
                self.take(seen, &plane, regions, labels);
                self.found.push((start, view.plane(&plane)));
            } else if better.is_some_and(|better| better > 0.0) {
                for &at in &self.growth.pixels {
                    self.doubtful[at] = true;
                }
            }
        }
        let learned = again.unwrap_or(faded);
        if learned.is_sure(&self.tuning.memory) && regions.len() == before {
            self.doubt_all_but_largest(regions, labels);
        }
        if look == Look::First {
            self.memory = if other.sure > learned.sure {
                other
            } else {
                learned
            };
        }
        regions.len() > before
    }

    /// Where there are slopes, doubts what is off its surface once all surfaces were fitted; the regions that hold several surfaces.
    pub(crate) fn doubt(
        &mut self,
        picture: Picture<'_>,
        view: &View,
        regions: &[Region],
        labels: &[u16],
    ) -> impl Iterator<Item = usize> {
        let is_any = regions.iter().any(|region| region.is_slope);
        let parts = view.parts_of_planes();
        let parts = parts.filter(|_| is_any || self.memory.sure > 0.0);
        if let Some(parts) = parts {
            self.look_for_doubts(SeenPicture { picture, view }, &parts, regions, labels);
        }
        let mixed = parts.map(|_| self.doubts.mixed());
        mixed.into_iter().flatten()
    }

    fn look_for_doubts(
        &mut self,
        seen: SeenPicture<'_>,
        parts: &Matrix3<f64>,
        regions: &[Region],
        labels: &[u16],
    ) {
        self.doubts.planes.clear();
        self.doubts.planes.extend(regions.iter().map(|region| {
            let plane = region.plane.filter(|_| region.is_slope);
            let level = (region.q > 0.0).then_some([0.0, 0.0, region.q]);
            let slope = plane.map(|plane| parts * plane.coefficients());
            slope.map_or(level, |plane| Some(plane.map(|value| value as f32).into()))
        }));
        self.doubtful.resize(labels.len(), false);
        self.doubts.find(seen, labels, &mut self.doubtful);
    }

    /// Where a slope was seen just now and is not told from level strips, nothing but the largest level surface, the ground, is sure.
    fn doubt_all_but_largest(&mut self, regions: &[Region], labels: &[u16]) {
        let largest = (0..regions.len()).max_by_key(|&index| regions[index].support);
        let ground = largest.map_or(0, |index| index as u16 + 1);
        for (doubtful, &label) in self.doubtful.iter_mut().zip(labels) {
            *doubtful |= label != ground;
        }
    }

    /// What the last look found, in another view.
    fn found_again(&self, view: &View) -> Vec<(usize, Vector3<f64>)> {
        let Some(parts) = view.parts_of_planes() else {
            return Vec::new();
        };
        let found = self.found.iter();
        found
            .map(|(start, plane)| (*start, parts * plane.coefficients()))
            .collect()
    }

    /// Grows a plane from a pixel on, and by how much it is better than treads, where that can be told; none where it is no slope.
    fn grow(
        &mut self,
        seen: SeenPicture<'_>,
        start: (usize, Vector3<f64>),
        look: Look,
        regions: &[Region],
        labels: &[u16],
    ) -> Option<(Vector3<f64>, Option<f64>)> {
        let is_found = look == Look::Again;
        let plane = self.growth.grow(seen, start, is_found, regions, labels)?;
        let pixels = &self.growth.pixels;
        let least = (self.tuning.least_share * labels.len() as f64) as usize;
        if pixels.len() < least {
            return None;
        }
        let verdict = self.treads.compare(seen, &plane, pixels, &self.tuning);
        let better = verdict.better_than_treads;
        let told = (2 * verdict.told >= least).then_some(better);
        (verdict.length_m > self.tuning.least_length).then_some((plane, told))
    }

    /// Makes a region of the pixels that were grown, and of the rest of the strips that they were taken from.
    fn take(
        &self,
        seen: SeenPicture<'_>,
        plane: &Vector3<f64>,
        regions: &mut Vec<Region>,
        labels: &mut [u16],
    ) {
        let accept = self.tuning.growth.accept;
        let abq = [plane.x, plane.y, plane.z].map(|value| value as f32);
        let own = regions.len() as u16 + 1;
        for (at, label) in labels.iter_mut().enumerate() {
            if self.growth.members[at] {
                *label = own;
            } else if *label > 0 && self.growth.reaches[usize::from(*label)] == StripReach::Strip {
                let fits = seen.miss(at, abq).abs() < accept;
                *label = if fits { own } else { 0 };
            }
        }
        regions.push(Region {
            plane: Some(seen.view.plane(plane)),
            is_slope: true,
            ..Region::default()
        });
        for region in regions.iter_mut() {
            region.support = 0;
        }
        for &label in labels.iter().filter(|label| **label > 0) {
            regions[usize::from(label) - 1].support += 1;
        }
        // A number without pixels is no surface.
        for region in regions.iter_mut().filter(|region| region.support == 0) {
            region.q = 0.0;
        }
    }
}
