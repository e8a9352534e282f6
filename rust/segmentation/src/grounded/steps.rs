//! Pixels beside the edges of steps: they belong to neither of the two surfaces.

use crate::Planes;

/// Columns and rows to each side of an edge that a matching window of 5 spoils.
const SPOILED: (usize, usize) = (2, 3);
/// Most pixels of a riser, which has no label, between two treads.
const RISER: usize = 6;
/// Surfaces nearer than this to each other are one, and further apart they are no step, m.
const STEP_M: (f32, f32) = (0.008, 0.07);

/// Marks in `planes.at_step` the pixels beside edges, going down the columns and along the rows.
pub(super) fn mark_steps(width: usize, planes: &mut Planes) {
    planes.at_step.fill(false);
    let height = planes.labels.len() / width.max(1);
    for col in 0..width {
        mark_line(planes, col, width, height, SPOILED.1);
    }
    for row in 0..height {
        mark_line(planes, row * width, 1, width, SPOILED.0);
    }
}

/// Marks along one line of pixels: `count` of them, `stride` apart.
fn mark_line(planes: &mut Planes, first: usize, stride: usize, count: usize, spoiled: usize) {
    let mut before: Option<(usize, f32)> = None;
    for i in 0..count {
        let height_m = planes.floor_height_m[first + i * stride];
        if height_m.is_nan() {
            continue;
        }
        if let Some((last, other_m)) = before {
            let apart_m = (height_m - other_m).abs();
            if apart_m > STEP_M.0 && apart_m < STEP_M.1 && i - last <= RISER + 1 {
                let begin = (last + 1).saturating_sub(spoiled);
                for j in begin..(i + spoiled).min(count) {
                    planes.at_step[first + j * stride] = true;
                }
            }
        }
        before = Some((i, height_m));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One column of pixels with these heights, m.
    fn marked(heights_m: &[f32]) -> Vec<bool> {
        let mut planes = Planes::new(heights_m.len());
        planes.floor_height_m = heights_m.to_vec();
        planes.labels = vec![1; heights_m.len()];
        mark_steps(1, &mut planes);
        planes.at_step
    }

    #[test]
    fn three_pixels_on_both_sides_of_an_edge_and_the_riser_between_are_left_out() {
        let nan = f32::NAN;
        let mut heights = vec![0.06; 8];
        heights.extend([nan, nan]);
        heights.extend([0.03; 8]);
        let marked = marked(&heights);
        let expected: Vec<_> = (0..18).map(|i| (5..13).contains(&i)).collect();
        assert_eq!(marked, expected);
    }

    #[test]
    fn pieces_of_one_surface_and_tall_boxes_have_no_steps() {
        for other_m in [0.004, 0.2, f32::NAN] {
            let mut heights = vec![0.0; 8];
            heights.extend([other_m; 8]);
            assert!(marked(&heights).iter().all(|&at| !at));
        }
    }
}
