//! Which cells and layers the maps cover: centred on the robot, moved by whole cells and layers, never turned.

use geometry::Lattice;

use super::FogConfig;

/// The robot may wander this far from the middle, in cells or layers, before the window follows: a robot that sways over
/// a border would move it to and fro.
const SLACK: f64 = 0.75;

/// The window's place in whole cells and layers from the map's origin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Window {
    /// Cell borders nearest to the robot, along x and y, and layer border nearest to its ground.
    center: [i64; 3],
}

impl Window {
    pub(super) const fn new() -> Self {
        Self { center: [0; 3] }
    }

    /// Follows the robot; the whole cells and layers moved.
    pub(super) fn follow(&mut self, robot_m: [f64; 3], config: &FogConfig) -> [i32; 3] {
        let unit = [config.cell, config.cell, config.layer];
        let most = [config.cells, config.cells, config.layers];
        std::array::from_fn(|a| {
            let at = robot_m[a] / unit[a];
            let stays = (at - self.center[a] as f64).abs() <= SLACK;
            if stays || (a == 2 && !config.follow_height) {
                return 0;
            }
            let target = at.round() as i64;
            let moved = target.saturating_sub(self.center[a]);
            self.center[a] = target;
            // Beyond the window nothing is kept, however far it went.
            moved.clamp(-(most[a] as i64), most[a] as i64) as i32
        })
    }

    pub(super) fn lattice(&self, config: &FogConfig) -> Lattice {
        let half = (config.cells / 2) as i64;
        let border = |center: i64| (center as f64 - half as f64) * config.cell;
        Lattice {
            origin_m: [border(self.center[0]), border(self.center[1])],
            cell_m: config.cell,
        }
    }

    /// Lower bound of the lowest layer, m.
    pub(super) fn bottom_m(&self, config: &FogConfig) -> f64 {
        if config.follow_height {
            let layers = self.center[2] as f64 - config.layers_below as f64;
            config.layer_origin + layers * config.layer
        } else {
            config.layer_origin
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_robot_stays_near_the_middle(steps in prop::collection::vec(prop::array::uniform3(-0.2..0.2f64), 1..30)) {
            let config = FogConfig::default();
            let mut window = Window::new();
            let mut robot = [0.0; 3];
            let mut total = [0_i32; 3];
            for step in steps {
                for a in 0..3 { robot[a] += step[a]; }
                let moved = window.follow(robot, &config);
                for a in 0..3 { total[a] += moved[a]; }
                let origin = window.lattice(&config).origin_m;
                for a in 0..2 {
                    prop_assert!((origin[a] + 2.0 - robot[a]).abs() <= 0.75 * 0.04 + 1e-9);
                    prop_assert!((origin[a] - (f64::from(total[a]) * 0.04 - 2.0)).abs() < 1e-9);
                }
                let ground_layer = window.bottom_m(&config) + 8.0 * 0.04 + 0.02;
                prop_assert!((ground_layer - robot[2]).abs() <= 0.75 * 0.04 + 1e-9);
            }
        }
    }

    #[test]
    fn swaying_over_a_border_moves_nothing() {
        let config = FogConfig::default();
        let mut window = Window::new();
        let _ = window.follow([0.1, 0.1, 0.0], &config);
        for sway in [0.005, -0.005, 0.01, -0.01] {
            assert_eq!(
                window.follow([0.1 + sway, 0.1 - sway, sway], &config),
                [0; 3]
            );
        }
    }
}
