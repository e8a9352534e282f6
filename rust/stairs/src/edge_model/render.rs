//! Draws a step's disparities and how they change with its parameters.

use super::sight::{Faces, Linear, first_met};
use super::window::{REACH, Window};

/// Columns and rows of a picture, from and up to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Area {
    pub(super) cols: (usize, usize),
    pub(super) rows: (usize, usize),
}

impl Area {
    pub(super) const fn columns(&self) -> usize {
        self.cols.1 - self.cols.0
    }

    pub(super) const fn pixels(&self) -> usize {
        self.columns() * (self.rows.1 - self.rows.0)
    }
}

/// A linear function along one row.
#[derive(Clone, Copy)]
struct Ramp {
    start: f32,
    per_col: f32,
}

impl Ramp {
    fn new(linear: &Linear, col: f64, row: f64) -> Self {
        Self {
            start: linear.at(col, row) as f32,
            per_col: linear.per_col() as f32,
        }
    }

    fn at(self, col: f32) -> f32 {
        self.start + self.per_col * col
    }
}

/// Draws what the pixels of `area` and a border around it see of a step, and matches it; jumps where `wanted`.
pub(super) fn render(faces: &Faces, area: &Area, wanted: &[u32], window: &mut Window) {
    let columns = area.columns() + 2 * REACH;
    let first = area.cols.0 as f64 - REACH as f64;
    let [value, by_place, by_heading, by_near, by_far] = &mut window.sharp;
    let lines = value
        .chunks_exact_mut(columns)
        .zip(by_place.chunks_exact_mut(columns))
        .zip(by_heading.chunks_exact_mut(columns))
        .zip(by_near.chunks_exact_mut(columns))
        .zip(by_far.chunks_exact_mut(columns));
    for (index, ((((value, by_place), by_heading), by_near), by_far)) in lines.enumerate() {
        let row = (area.rows.0 + index) as f64 - REACH as f64;
        let out = [value, by_place, by_heading, by_near, by_far];
        if faces.rising {
            rising_line(faces, first, row, out);
        } else {
            falling_line(faces, first, row, out);
        }
    }
    window.match_all();
    if may_jump(faces, area) {
        window.match_jumps(wanted);
    }
}

fn ramps(faces: &Faces, col: f64, row: f64) -> [Ramp; 7] {
    [
        &faces.near,
        &faces.far,
        &faces.riser,
        &faces.riser_by_place,
        &faces.riser_by_heading,
        &faces.near_by_height,
        &faces.far_by_height,
    ]
    .map(|linear| Ramp::new(linear, col, row))
}

fn rising_line(faces: &Faces, col: f64, row: f64, out: [&mut [f32]; 5]) {
    let [near, far, riser, riser_p, riser_h, near_z, far_z] = ramps(faces, col, row);
    let [value, by_place, by_heading, by_near, by_far] = out;
    let count = value.len();
    let (by_place, by_heading) = (&mut by_place[..count], &mut by_heading[..count]);
    let (by_near, by_far) = (&mut by_near[..count], &mut by_far[..count]);
    for i in 0..count {
        let at = i as f32;
        let (n, f, r) = (near.at(at), far.at(at), riser.at(at));
        let seen = first_met(true, n, f, r);
        value[i] = seen;
        let (on_near, on_riser) = (seen == n, seen == r);
        by_place[i] = if on_riser { riser_p.at(at) } else { 0.0 };
        by_heading[i] = if on_riser { riser_h.at(at) } else { 0.0 };
        by_near[i] = if on_near { near_z.at(at) } else { 0.0 };
        by_far[i] = if on_near || on_riser {
            0.0
        } else {
            far_z.at(at)
        };
    }
}

fn falling_line(faces: &Faces, col: f64, row: f64, out: [&mut [f32]; 5]) {
    let [near, far, riser, riser_p, riser_h, near_z, far_z] = ramps(faces, col, row);
    let [value, by_place, by_heading, by_near, by_far] = out;
    let count = value.len();
    let (by_place, by_heading) = (&mut by_place[..count], &mut by_heading[..count]);
    let (by_near, by_far) = (&mut by_near[..count], &mut by_far[..count]);
    // A pixel at the border sees both surfaces: the share of the near one runs from 0 to 1 over one pixel.
    let sharpness = 1.0 / border_steepness(faces) as f32;
    for i in 0..count {
        let at = i as f32;
        let (n, f, r) = (near.at(at), far.at(at), riser.at(at));
        let share = ((n - r) * sharpness + 0.5).clamp(0.0, 1.0);
        let jump = n - f;
        value[i] = f + share * jump;
        let turning = if share > 0.0 && share < 1.0 {
            -sharpness * jump
        } else {
            0.0
        };
        by_place[i] = turning * riser_p.at(at);
        by_heading[i] = turning * riser_h.at(at);
        by_near[i] = (share - turning) * near_z.at(at);
        by_far[i] = (1.0 - share) * far_z.at(at);
    }
}

/// Change of (near - riser) from pixel to pixel across the border of the near surface, px.
pub(super) fn border_steepness(faces: &Faces) -> f64 {
    faces
        .near
        .mix(1.0, &faces.riser, -1.0)
        .steepness()
        .max(1e-6)
}

/// Whether disparities inside a window may differ by as much as a correlation's peak is wide.
fn may_jump(faces: &Faces, area: &Area) -> bool {
    let jump = faces.near.mix(1.0, &faces.far, -1.0);
    let most = [area.cols.0, area.cols.1]
        .iter()
        .flat_map(|&col| {
            [area.rows.0, area.rows.1].map(|row| jump.at(col as f64, row as f64).abs())
        })
        .fold(0.0, f64::max);
    let slope = faces.near.steepness().max(faces.far.steepness());
    most + slope * 5.7 > 1.0
}
