//! Whether enough of both surfaces is in view to trust an edge.

use super::excerpt::{Area, Excerpt};
use super::product::Untrusted;
use super::sight::{CameraSight, StepModel};

use crate::EdgeModelTuning;

/// Room for slices of the edge, of which there is one a pixel: more than any edge in a picture of the robots' width has. Of a wider
/// picture a slice holds more than one pixel a row.
const SLICES: usize = 96;

/// Checks that both surfaces are seen along most of the edge, which is `half_m` long to each side and where a pixel is
/// `pixel_m` wide.
pub(super) fn check(
    excerpt: &Excerpt,
    area: &Area,
    sight: &CameraSight,
    step: &StepModel,
    (half_m, pixel_m): (f64, f64),
    tuning: &EdgeModelTuning,
) -> Result<(), Untrusted> {
    let counts = Counts::of(excerpt, area, sight, step, (half_m, pixel_m), tuning)
        .ok_or(Untrusted::WrongSide)?;
    let tuning = &tuning.visibility;
    let seen = counts.any.iter().filter(|&&any| any).count();
    if seen < tuning.fewest {
        return Err(Untrusted::OutOfView);
    }
    let share = |counts: &[u16; SLICES]| {
        counts
            .iter()
            .filter(|&&count| count >= tuning.pixels)
            .count() as f64
            / seen as f64
    };
    if share(&counts.near) < tuning.most {
        return Err(Untrusted::NearHidden(share(&counts.near)));
    }
    if share(&counts.far) < tuning.most {
        return Err(Untrusted::FarHidden(share(&counts.far)));
    }
    Ok(())
}

/// Pixels that show a surface well away from the edge, slice by slice of the edge, and whether a slice shows anything.
struct Counts {
    near: [u16; SLICES],
    far: [u16; SLICES],
    any: [bool; SLICES],
}

impl Counts {
    fn of(
        excerpt: &Excerpt,
        area: &Area,
        sight: &CameraSight,
        step: &StepModel,
        (half_m, pixel_m): (f64, f64),
        tuning: &EdgeModelTuning,
    ) -> Option<Self> {
        let (visibility, least_px) = (&tuning.visibility, tuning.excerpt.least_disparity);
        let close_px = visibility.close * tuning.refine.noise;
        let faces = step.faces(sight)?;
        let along = sight.along(&step.along());
        let aside_m = step.along().dot(&(sight.position_m.xy() - step.anchor_m));
        let before = faces.near.mix(1.0, &faces.riser, -1.0);
        let behind = if faces.rising {
            faces.riser.mix(1.0, &faces.far, -1.0)
        } else {
            before.times(-1.0)
        };
        let away_px = [&before, &behind].map(|gap| visibility.away * gap.steepness());
        // A slice is as wide as a pixel at the edge, so that it holds about one pixel a row.
        let slices = ((2.0 * half_m / pixel_m) as usize).clamp(1, SLICES);
        let mut counts = Self {
            near: [0; SLICES],
            far: [0; SLICES],
            any: [false; SLICES],
        };
        for (row, line) in excerpt.lines(area) {
            for (col, &observed) in line.iter().enumerate() {
                let col = (area.cols.0 + col) as f64;
                let (near, far) = (
                    faces.near.at(col, row) as f32,
                    faces.far.at(col, row) as f32,
                );
                if observed.is_nan() || near.min(far) < least_px {
                    continue;
                }
                let place_m = aside_m + along.at(col, row) / f64::from(faces.seen(col, row));
                let slice = (place_m + half_m) / (2.0 * half_m) * slices as f64;
                if !(0.0..slices as f64).contains(&slice) {
                    continue;
                }
                let slice = slice as usize;
                counts.any[slice] = true;
                if before.at(col, row) > away_px[0] {
                    counts.near[slice] += u16::from((observed - near).abs() < close_px);
                } else if behind.at(col, row) > away_px[1] {
                    counts.far[slice] += u16::from((observed - far).abs() < close_px);
                }
            }
        }
        Some(counts)
    }
}
