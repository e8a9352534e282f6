//! What block matching makes of a step: every disparity is that of a whole window.
//!
//! Where the disparities inside a window differ by less than the width of the correlation's peak, the match is their
//! mean; where they differ by more, it is the mean of those around the nearest surface (mean shift with a flat kernel).

use super::lot::{Lot, PADDED, PIXELS, REACH, SIDE, counted, most_and_spread, sum_of};
use super::sight::{PixelLinear, StepFaces, first_met};

use crate::WindowTuning;

/// What the window around a pixel gives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Match {
    /// Disparity, px.
    pub(super) value_px: f32,
    /// Change of the disparity with those of the near surface, the far one and the riser at the pixel.
    pub(super) by_face: [f32; 3],
    /// Whether surfaces are so far apart that the window may take one side.
    pub(super) jumps: bool,
}

/// A plane in the picture, and what it adds to its disparity at each pixel of a window.
#[derive(Debug, Clone, Copy)]
struct WindowPlane {
    origin: f32,
    per_col: f32,
    per_row: f32,
    offsets: Lot,
}

impl WindowPlane {
    fn new(linear: &PixelLinear) -> Self {
        let (origin, per_col, per_row) = (
            linear.at(0.0, 0.0) as f32,
            linear.per_col as f32,
            linear.per_row as f32,
        );
        let offset = |i: usize| {
            let i = i.min(PIXELS - 1);
            let (col, row) = ((i % SIDE) as f32, (i / SIDE) as f32);
            per_col * (col - REACH as f32) + per_row * (row - REACH as f32)
        };
        Self {
            origin,
            per_col,
            per_row,
            offsets: std::array::from_fn(offset),
        }
    }

    fn at(&self, col: f32, row: f32) -> f32 {
        self.origin + self.per_col * col + self.per_row * row
    }
}

/// Matches windows on a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Matcher {
    near: WindowPlane,
    far: WindowPlane,
    riser: WindowPlane,
    rising: bool,
    /// How much near less riser, and riser less far, differ at most between a window's middle and its border, px.
    near_reach_px: f32,
    far_reach_px: f32,
    /// Share of the near surface that a pixel gains per pixel of disparity at its border.
    sharpness: f32,
    /// Difference of disparities below which surfaces blend, and beyond which a window takes one side before long, px.
    bandwidth_px: f32,
    suspect_px: f32,
    /// Steps of the mean shift.
    shifts: usize,
}

impl Matcher {
    pub(super) fn new(faces: &StepFaces, tuning: &WindowTuning) -> Self {
        let before = faces.near.mix(1.0, &faces.riser, -1.0);
        let behind = faces.riser.mix(1.0, &faces.far, -1.0);
        let reach = |gap: &PixelLinear| (REACH * (gap.per_col.abs() + gap.per_row.abs())) as f32;
        let steepness = before.steepness().max(1e-6) as f32;
        Self {
            near: WindowPlane::new(&faces.near),
            far: WindowPlane::new(&faces.far),
            riser: WindowPlane::new(&faces.riser),
            rising: faces.rising,
            near_reach_px: reach(&before) + if faces.rising { 0.0 } else { 0.5 * steepness },
            far_reach_px: reach(&behind),
            sharpness: 1.0 / steepness,
            bandwidth_px: tuning.bandwidth,
            suspect_px: tuning.suspect,
            shifts: tuning.shifts,
        }
    }

    /// What the window around a pixel gives.
    #[inline]
    pub(super) fn look(&self, col: f32, row: f32) -> Match {
        let faces = self.faces(col, row);
        if let Some(face) = self.alone(faces) {
            let mut by_face = [0.0; 3];
            by_face[face] = 1.0;
            return Match {
                value_px: faces[face],
                by_face,
                jumps: false,
            };
        }
        self.look_at_all(faces)
    }

    /// The disparity that the window around a pixel gives, px.
    #[inline]
    pub(super) fn value_px(&self, col: f32, row: f32) -> f32 {
        let faces = self.faces(col, row);
        self.alone(faces)
            .map_or_else(|| self.window(faces).mean_px(), |face| faces[face])
    }

    /// Disparities of near surface, far one and riser at a pixel, px.
    fn faces(&self, col: f32, row: f32) -> [f32; 3] {
        [&self.near, &self.far, &self.riser].map(|plane| plane.at(col, row))
    }

    /// Which of the three planes is all that the window shows: it gives that plane at its middle.
    fn alone(&self, [near, far, riser]: [f32; 3]) -> Option<usize> {
        if near - riser > self.near_reach_px {
            Some(0)
        } else if self.rising {
            let behind = riser - far > self.far_reach_px;
            let on_riser = riser - near > self.near_reach_px && far - riser > self.far_reach_px;
            if behind {
                Some(1)
            } else {
                on_riser.then_some(2)
            }
        } else {
            (riser - near > self.near_reach_px).then_some(1)
        }
    }

    fn look_at_all(&self, faces: [f32; 3]) -> Match {
        let window = self.window(faces);
        let [near, far, riser] = faces;
        let (mut by_near, mut by_far, mut by_riser) = ([0.0; PADDED], [0.0; PADDED], [0.0; PADDED]);
        for i in 0..PADDED {
            let n = near + self.near.offsets[i];
            let f = far + self.far.offsets[i];
            let r = riser + self.riser.offsets[i];
            if self.rising {
                let seen = first_met(true, n, f, r);
                by_near[i] = if seen == n { 1.0 } else { 0.0 };
                by_far[i] = if seen == f { 1.0 } else { 0.0 };
                by_riser[i] = 1.0 - by_near[i] - by_far[i];
            } else {
                let part = self.near_part(n, r);
                let share = part.clamp(0.0, 1.0);
                let turning = if share == part {
                    self.sharpness * (n - f)
                } else {
                    0.0
                };
                by_near[i] = share + turning;
                by_far[i] = 1.0 - share;
                by_riser[i] = -turning;
            }
        }
        Match {
            value_px: window.mean_px(),
            by_face: [&by_near, &by_far, &by_riser].map(|shares| window.mean(shares)),
            jumps: window.jumps,
        }
    }

    /// A pixel at the border sees both: the share of the near surface runs from 0 to 1 over one pixel.
    fn near_part(&self, near: f32, riser: f32) -> f32 {
        (near - riser) * self.sharpness + 0.5
    }

    /// The disparities around a pixel where more than one plane shows.
    fn window(&self, [near, far, riser]: [f32; 3]) -> MatchedWindow {
        let mut values = [0.0_f32; PADDED];
        for (i, value) in values.iter_mut().enumerate() {
            let n = near + self.near.offsets[i];
            let f = far + self.far.offsets[i];
            let r = riser + self.riser.offsets[i];
            *value = if self.rising {
                first_met(true, n, f, r)
            } else {
                f + self.near_part(n, r).clamp(0.0, 1.0) * (n - f)
            };
        }
        let (mut most, mut spread) = most_and_spread(&values);
        let jumps = spread > self.suspect_px;
        if jumps && !self.rising {
            // A mixed pixel would be a bridge between the surfaces, and matchers have none.
            for (i, value) in values.iter_mut().enumerate() {
                let n = near + self.near.offsets[i];
                let r = riser + self.riser.offsets[i];
                let f = far + self.far.offsets[i];
                *value = if n > r { n } else { f };
            }
            (most, spread) = most_and_spread(&values);
        }
        let chosen = if spread < self.bandwidth_px {
            counted(|_| true, &values)
        } else {
            self.near_mode(&values, most)
        };
        MatchedWindow {
            values,
            share: 1.0 / sum_of(&chosen, |_| 1.0).max(1.0),
            chosen,
            jumps,
        }
    }

    /// Which of a window's disparities (1, else 0) belong to the mode that mean shift finds from `start`.
    fn near_mode(&self, values: &Lot, start: f32) -> Lot {
        let bandwidth_px = self.bandwidth_px;
        let mut mode = start;
        let mut chosen = [0.0; PADDED];
        for _ in 0..self.shifts {
            chosen = counted(|value| (value - mode).abs() < bandwidth_px, values);
            let before = mode;
            mode = sum_of(&chosen, |i| values[i]) / sum_of(&chosen, |_| 1.0).max(1.0);
            if mode == before {
                break;
            }
        }
        chosen
    }
}

/// What a window sees, and which of it the match is made of.
struct MatchedWindow {
    values: Lot,
    /// 1 for those that count, else 0; and one through their number.
    chosen: Lot,
    share: f32,
    jumps: bool,
}

impl MatchedWindow {
    fn mean(&self, of: &Lot) -> f32 {
        self.share * sum_of(&self.chosen, |i| of[i])
    }

    fn mean_px(&self) -> f32 {
        self.mean(&self.values)
    }
}
