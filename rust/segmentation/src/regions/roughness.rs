//! How rough level surfaces and slopes are, in the roughness of the ground.
//!
//! Stones as small as the matching window are smoothed by it until they pass for a level surface in some more noise than others.
//! The noise of the sensor is not known that well, and differs from block to block of the picture, but the ground that the robot
//! stands on has it, too.

use settings::{POSITIVE, SHARE, settings};

use crate::picture::{MAX_REGIONS, Picture, label_runs};
use crate::regions::region::Region;

settings! {
    /// How the roughness of level surfaces is measured, in the roughness of the ground.
    pub struct RoughnessTuning("navigation.ground.tuning.roughness") {
        /// Fewest pixels away from a region's border that tell how rough it is.
        fewest: usize = 80, "1", POSITIVE;
        /// Deviations from a surface count up to this, in disparity: what is further off was mismatched.
        largest: f32 = 0.6, "px", POSITIVE;
        /// Least roughness of the ground, as a share of `noise_floor`: beside the ground of a perfect sensor everything would be rough.
        least: f32 = 0.6, "1", POSITIVE;
        /// Share that one frame has in what is believed of the ground's roughness.
        gain: f32 = 0.1, "1", SHARE;
    }
}

/// Pixels of a region, and the sum of their squared deviations from it, px.
#[derive(Debug, Clone, Copy, Default)]
struct Deviation {
    pixels: usize,
    squares: f32,
}

/// Measures how far regions deviate from level surfaces, and slopes from their planes. Keeps what it learned of the ground.
#[derive(Debug, Clone)]
pub(crate) struct Roughness {
    tuning: RoughnessTuning,
    regions: [Deviation; MAX_REGIONS + 1],
    /// Roughness of the ground, root mean square, px; none before any was seen.
    ground_px: Option<f32>,
    least_px: f32,
}

impl Roughness {
    /// Nothing is known of the ground, nor of the sensor but the noise that it has at least, px.
    pub(crate) fn new(noise_floor_px: f32, tuning: RoughnessTuning) -> Self {
        Self {
            regions: [Deviation::default(); MAX_REGIONS + 1],
            ground_px: None,
            least_px: tuning.least * noise_floor_px,
            tuning,
        }
    }

    /// Takes in the pixels of a frame's regions that lie away from borders, by the labels that are left there.
    pub(crate) fn measure(&mut self, picture: Picture<'_>, regions: &[Region], inner: &[u16]) {
        let (fewest, largest_px) = (self.tuning.fewest, self.tuning.largest);
        self.regions = [Deviation::default(); MAX_REGIONS + 1];
        // Of finer images some rows tell it.
        let lines = inner.chunks_exact(picture.width).enumerate();
        let runs = lines.step_by(picture.finer).flat_map(|(row, line)| {
            let first = row * picture.width;
            label_runs(line).map(move |(label, cols)| (label, first + cols.start..first + cols.end))
        });
        for (label, pixels) in runs {
            // Of thin regions all pixels are left, which the window blends with what borders on them.
            let region = usize::from(label).checked_sub(1);
            let region = region.and_then(|index| regions.get(index));
            let Some(region) = region.filter(|region| region.core >= fewest) else {
                continue;
            };
            let row = pixels.start / picture.width;
            let plane = region.plane.filter(|_| region.is_slope);
            let surface_px = |at: usize| match plane {
                Some(plane) => plane.at(at - row * picture.width, row),
                None => region.q * picture.g[at],
            };
            let sums = &mut self.regions[usize::from(label)];
            let mut sum = *sums;
            for at in pixels {
                let d = picture.disparity_px[at];
                if !d.is_nan() {
                    let deviation = (d - surface_px(at)).clamp(-largest_px, largest_px);
                    sum.pixels += 1;
                    sum.squares += deviation * deviation;
                }
            }
            *sums = sum;
        }
    }

    /// Says nothing of a region of the last frame, which is no one surface.
    pub(crate) fn forget(&mut self, region: usize) {
        self.regions[region + 1] = Deviation::default();
    }

    /// Learns from the region that is the ground.
    pub(crate) fn learn(&mut self, ground: usize) {
        if let Some(px) = self.region_px(ground) {
            let known = self.ground_px.unwrap_or(px);
            self.ground_px = Some(known + self.tuning.gain * (px - known));
        }
    }

    /// How many times as rough as the ground a region of the last frame is; none where too little is seen of either.
    pub(crate) fn of(&self, region: usize) -> Option<f32> {
        Some(self.region_px(region)? / self.ground_px?.max(self.least_px))
    }

    fn region_px(&self, region: usize) -> Option<f32> {
        let Deviation { pixels, squares } = self.regions[region + 1];
        (pixels >= self.tuning.fewest).then(|| (squares / pixels as f32).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: usize = 20;

    /// Two surfaces of ten rows each: deviations of `ground_px` from the first, of `other_px` from the second.
    fn measured(ground_px: f32, other_px: f32) -> Roughness {
        let inner: Vec<u16> = (0..20 * WIDTH)
            .map(|i| if i < 10 * WIDTH { 1 } else { 2 })
            .collect();
        let g = vec![0.1; inner.len()];
        let disparity_px: Vec<f32> = inner
            .iter()
            .enumerate()
            .map(|(i, &label)| {
                let off = if label == 1 { ground_px } else { other_px };
                let exact = if label == 1 { 6.0 } else { 7.0 };
                exact + if i % 2 == 0 { off } else { -off }
            })
            .collect();
        let picture = Picture {
            width: WIDTH,
            disparity_px: &disparity_px,
            g: &g,
            sigma_px: &g,
            finer: 1,
        };
        let region = |q| Region {
            q,
            core: 10 * WIDTH,
            ..Region::default()
        };
        let mut roughness = Roughness::new(0.1, RoughnessTuning::default());
        roughness.measure(picture, &[region(60.0), region(70.0)], &inner);
        roughness
    }

    #[test]
    fn a_surface_is_as_many_times_as_rough_as_its_deviations_are_larger() {
        let mut roughness = measured(0.1, 0.22);
        assert_eq!(roughness.of(1), None, "nothing is known of the ground");
        roughness.learn(0);
        let times = roughness.of(1).unwrap();
        assert!((times - 2.2).abs() < 1e-3, "{times}");
        assert!((roughness.of(0).unwrap() - 1.0).abs() < 1e-6);
    }

    #[test]
    fn one_frame_changes_what_is_believed_of_the_ground_by_a_tenth() {
        let mut roughness = measured(0.1, 0.2);
        roughness.learn(0);
        roughness.learn(1);
        assert!((roughness.ground_px.unwrap() - 0.11).abs() < 1e-4);
    }

    #[test]
    fn of_a_perfect_sensor_no_surface_is_rough() {
        let mut roughness = measured(1e-6, 1e-4);
        roughness.learn(0);
        assert!(roughness.of(1).unwrap() < 0.01);
    }

    #[test]
    fn of_what_is_hardly_seen_nothing_is_said() {
        let mut roughness = measured(0.1, 0.2);
        roughness.learn(0);
        roughness.regions[2].pixels = RoughnessTuning::default().fewest - 1;
        assert_eq!(roughness.of(1), None);
    }
}
