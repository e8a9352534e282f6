//! Rule: which cells are tilted, and which lie so near to a slope that the camera may have made level strips of it there.

use settings::{settings, within};

use crate::{Sight, Terrain, cells::around};

settings! {
    /// Which cells are tilted.
    pub struct SlopesConfig("navigation.terrain.slopes") {
        /// So many cells to each side of a slope the camera may have made level strips before it told them from the slope.
        strip: usize = 3, "1", within(0.0, 20.0);
    }
}

pub(super) fn apply(terrain: &mut Terrain, sight: &Sight<'_>, config: &SlopesConfig) {
    let slopes = &mut terrain.slopes;
    slopes.cols = sight.view.cells.cols();
    slopes.cell_m = sight.view.lattice.cell_m as f32;
    slopes.strip_m = terrain.settings.slope_step as f32;
    slopes.most = terrain.settings.max_slope as f32;
    slopes.gradients.clear();
    slopes.near.clear();
    let gradients = sight.view.gradients.values();
    // Counted, not looked for: several cells at a time.
    let is_level = |gradients: &[[f32; 2]]| {
        let tilted = gradients.as_flattened().iter().filter(|rise| **rise != 0.0);
        tilted.count() == 0
    };
    if gradients.chunks(terrain.cols.max(1)).all(is_level) {
        return;
    }
    slopes.gradients.extend_from_slice(gradients);
    slopes.near.resize(gradients.len(), false);
    let size = [slopes.cols, gradients.len() / slopes.cols];
    for (index, gradient) in gradients.iter().enumerate() {
        if *gradient != [0.0; 2] && slopes.too_steep_at(index).is_none() {
            for cell in around(index, config.strip, size) {
                slopes.near[cell] = true;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::{Floor, cell};

    #[test]
    fn what_rises_with_the_slope_is_no_step_and_a_level_strip_beside_it_is_none_either() {
        let mut floor = Floor::new();
        let level = floor.after("slopes");
        assert!((level.slopes.step_m(0, 1, 0.03) - 0.03).abs() < 1e-6);
        floor.tilt([0.5, -0.5], [1.0, 0.5], 0.1);
        let terrain = floor.after("slopes");
        let [a, b] = [0.725, 0.775].map(|x_m| cell(&terrain, x_m, 0.025));
        assert_eq!(terrain.slopes.step_m(a, b, 0.005), 0.0);
        assert_eq!(terrain.slopes.step_m(a, b, 0.02), 0.0);
        assert!((terrain.slopes.step_m(a, b, 0.035) - 0.03).abs() < 1e-6);
        let [c, d] = [-0.525, -0.475].map(|x_m| cell(&terrain, x_m, 0.025));
        assert!((terrain.slopes.step_m(c, d, 0.015) - 0.015).abs() < 1e-6);
    }
}
