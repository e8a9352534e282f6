//! What block matching makes of a step: every disparity is that of a whole window.
//!
//! Where the disparities inside a window differ by less than the width of the correlation's peak, the match is their
//! mean; where they differ by more, it is the mean of those around the nearest surface (mean shift with a flat kernel).

/// Pixels from a window's middle to its border.
pub(super) const REACH: usize = 2;
/// Width and height of a window, pixels.
pub(super) const WINDOW: usize = 2 * REACH + 1;
/// Surfaces closer than this in disparity blend, px: about the half width of a correlation's peak.
const BANDWIDTH_PX: f32 = 1.0;
/// Windows whose corners differ by less hold no such jump, px.
const SUSPECT_PX: f32 = 0.8;
/// Steps of the mean shift.
const SHIFTS: usize = 4;
/// Images of a rendered step: disparity and its change with each of the four parameters.
pub(super) const CHANNELS: usize = 5;

/// Images of a step, as rendered with a border of `REACH` pixels around, and as matched.
#[derive(Debug, Clone, Default)]
pub(super) struct Window {
    /// Size of the rendered images, pixels.
    size: (usize, usize),
    /// As rendered: one image after the other.
    pub(super) sharp: [Vec<f32>; CHANNELS],
    /// As matched, without the border.
    pub(super) matched: [Vec<f32>; CHANNELS],
    over_rows: Vec<f32>,
}

impl Window {
    /// Makes room for matched images of up to so many columns and rows.
    pub(super) fn with_room(columns: usize, rows: usize) -> Self {
        let pixels = (columns + 2 * REACH) * (rows + 2 * REACH);
        let image = || Vec::with_capacity(pixels);
        Self {
            size: (0, 0),
            sharp: std::array::from_fn(|_| image()),
            matched: std::array::from_fn(|_| image()),
            over_rows: image(),
        }
    }

    /// Sets the size of the matched images.
    pub(super) fn resize(&mut self, columns: usize, rows: usize) {
        self.size = (columns + 2 * REACH, rows + 2 * REACH);
        for image in &mut self.sharp {
            image.resize(self.size.0 * self.size.1, 0.0);
        }
        for image in &mut self.matched {
            image.resize(columns * rows, 0.0);
        }
        self.over_rows.resize(self.size.0 * rows, 0.0);
    }

    /// Matches what was rendered.
    pub(super) fn match_all(&mut self) {
        let width = self.size.0;
        for (sharp, matched) in self.sharp.iter().zip(&mut self.matched) {
            mean(sharp, width, &mut self.over_rows, matched);
        }
    }

    /// Puts right those of the wanted pixels whose window holds disparities farther apart than a peak's width.
    pub(super) fn match_jumps(&mut self, wanted: &[u32]) {
        let columns = self.size.0 - 2 * REACH;
        for &at in wanted {
            let at = at as usize;
            let corner = at / columns * self.size.0 + at % columns;
            if self.spread_of_corners_px(corner) < SUSPECT_PX {
                continue;
            }
            let mut inside = [0.0_f32; WINDOW * WINDOW];
            let (mut least, mut most) = (f32::INFINITY, f32::NEG_INFINITY);
            for (row, line) in inside.chunks_exact_mut(WINDOW).enumerate() {
                let from = corner + row * self.size.0;
                line.copy_from_slice(&self.sharp[0][from..from + WINDOW]);
                for &value in line.iter() {
                    least = least.min(value);
                    most = most.max(value);
                }
            }
            if most - least < BANDWIDTH_PX {
                continue;
            }
            let chosen = near_mode(&inside, most);
            let count = chosen.iter().filter(|&&near| near).count().max(1) as f32;
            for (sharp, matched) in self.sharp.iter().zip(&mut self.matched) {
                let mut sum = 0.0;
                for (row, chosen) in chosen.chunks_exact(WINDOW).enumerate() {
                    let from = corner + row * self.size.0;
                    for (value, &near) in sharp[from..from + WINDOW].iter().zip(chosen) {
                        sum += if near { *value } else { 0.0 };
                    }
                }
                matched[at] = sum / count;
            }
        }
    }

    /// Largest less smallest disparity at the corners of the window that starts at `corner`, px.
    fn spread_of_corners_px(&self, corner: usize) -> f32 {
        let (right, down) = (WINDOW - 1, (WINDOW - 1) * self.size.0);
        let corners = [corner, corner + right, corner + down, corner + down + right]
            .map(|at| self.sharp[0][at]);
        corners.iter().copied().fold(f32::NEG_INFINITY, f32::max)
            - corners.iter().copied().fold(f32::INFINITY, f32::min)
    }
}

/// Which of a window's disparities belong to the mode that mean shift finds from `start`.
fn near_mode(inside: &[f32; WINDOW * WINDOW], start: f32) -> [bool; WINDOW * WINDOW] {
    let mut mode = start;
    let mut chosen = [false; WINDOW * WINDOW];
    for _ in 0..SHIFTS {
        let (mut sum, mut count) = (0.0, 0.0);
        for (near, value) in chosen.iter_mut().zip(inside) {
            *near = (value - mode).abs() < BANDWIDTH_PX;
            sum += if *near { *value } else { 0.0 };
            count += if *near { 1.0 } else { 0.0 };
        }
        mode = sum / f32::max(count, 1.0);
    }
    chosen
}

/// Fills `out` with the means over all whole windows of an image `width` pixels wide.
fn mean(image: &[f32], width: usize, over_rows: &mut [f32], out: &mut [f32]) {
    let columns = width - 2 * REACH;
    let count = over_rows.len();
    let share = 1.0 / (WINDOW * WINDOW) as f32;
    let row = |i: usize| &image[i * width..i * width + count];
    let rows = [row(0), row(1), row(2), row(3), row(4)];
    for (i, sum) in over_rows.iter_mut().enumerate() {
        *sum = (rows[0][i] + rows[1][i] + rows[2][i] + rows[3][i] + rows[4][i]) * share;
    }
    for (line, out) in over_rows
        .chunks_exact(width)
        .zip(out.chunks_exact_mut(columns))
    {
        let shifted = |i: usize| &line[i..i + columns];
        let parts = [shifted(0), shifted(1), shifted(2), shifted(3), shifted(4)];
        for (i, value) in out.iter_mut().enumerate() {
            *value = parts[0][i] + parts[1][i] + parts[2][i] + parts[3][i] + parts[4][i];
        }
    }
}
