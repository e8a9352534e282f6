//! Which cells and layers the maps cover: centred on the robot, moved by whole cells and layers, never turned.

use geometry::Lattice;

use super::FogConfig;

/// Where a window lies along one axis, in whole units from the map's origin.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Axis {
    unit_m: f64,
    units: usize,
    /// Border between units that is nearest to the robot.
    center: i64,
    /// Units that the robot may wander from it before the window follows.
    slack: f64,
}

impl Axis {
    const fn new(unit_m: f64, units: usize, slack: f64) -> Self {
        Self {
            unit_m,
            units,
            center: 0,
            slack,
        }
    }

    /// Follows the robot; the whole units moved.
    fn follow(&mut self, robot_m: f64) -> i32 {
        let at = robot_m / self.unit_m;
        if (at - self.center as f64).abs() <= self.slack {
            return 0;
        }
        let target = at.round() as i64;
        let moved = target.saturating_sub(self.center);
        self.center = target;
        // Beyond the window nothing is kept, however far it went.
        moved.clamp(-(self.units as i64), self.units as i64) as i32
    }
}

/// The cells of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Window {
    axes: [Axis; 2],
}

impl Window {
    /// So many cells along each side, around the map's origin. The robot may wander `slack` cells from the middle.
    pub(crate) const fn new(cell_m: f64, cells: usize, slack: f64) -> Self {
        Self {
            axes: [Axis::new(cell_m, cells, slack); 2],
        }
    }

    /// A window around a place, to the next border of cells, where it stays while the robot is no more than `slack` cells away.
    pub(crate) fn around(cell_m: f64, cells: usize, place_m: [f64; 2], slack: f64) -> Self {
        let axis = |at_m: f64| Axis {
            center: (at_m / cell_m).round() as i64,
            ..Axis::new(cell_m, cells, slack)
        };
        Self {
            axes: place_m.map(axis),
        }
    }

    /// Follows the robot; the whole columns and rows moved.
    pub(crate) fn follow(&mut self, [x_m, y_m, _]: [f64; 3]) -> [i32; 2] {
        let [cols, rows] = &mut self.axes;
        [cols.follow(x_m), rows.follow(y_m)]
    }

    pub(crate) fn lattice(&self) -> Lattice {
        let half = |axis: &Axis| (axis.units / 2) as i64;
        let border = |axis: Axis| (axis.center as f64 - half(&axis) as f64) * axis.unit_m;
        Lattice {
            origin_m: self.axes.map(border),
            cell_m: self.axes[0].unit_m,
        }
    }
}

/// The layers of an occupancy grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Layers {
    axis: Axis,
    origin_m: f64,
    /// Layers below the robot's, where they follow it.
    below: Option<usize>,
}

impl Layers {
    pub(super) fn new(config: &FogConfig) -> Self {
        Self {
            axis: Axis::new(config.layer, config.layers, config.tuning.wander),
            origin_m: config.layer_origin,
            below: config.follow_height.then_some(config.layers_below),
        }
    }

    /// Follows the robot's height; the whole layers moved.
    pub(super) fn follow(&mut self, robot_z_m: f64) -> i32 {
        self.below.map_or(0, |_| self.axis.follow(robot_z_m))
    }

    /// Lower bound of the lowest layer, m.
    pub(super) fn bottom_m(&self) -> f64 {
        let layers = self
            .below
            .map_or(0.0, |below| self.axis.center as f64 - below as f64);
        self.origin_m + layers * self.axis.unit_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_robot_stays_near_the_middle(steps in prop::collection::vec(prop::array::uniform3(-0.2..0.2f64), 1..30)) {
            let mut window = Window::new(0.04, 100, 0.75);
            let mut layers = Layers::new(&FogConfig::default());
            let mut robot = [0.0; 3];
            let mut total = [0_i32; 2];
            for step in steps {
                for a in 0..3 { robot[a] += step[a]; }
                let moved = window.follow(robot);
                let _ = layers.follow(robot[2]);
                for a in 0..2 { total[a] += moved[a]; }
                let origin = window.lattice().origin_m;
                for a in 0..2 {
                    prop_assert!((origin[a] + 2.0 - robot[a]).abs() <= 0.75 * 0.04 + 1e-9);
                    prop_assert!((origin[a] - (f64::from(total[a]) * 0.04 - 2.0)).abs() < 1e-9);
                }
                let ground_layer = layers.bottom_m() + 8.0 * 0.04 + 0.02;
                prop_assert!((ground_layer - robot[2]).abs() <= 0.75 * 0.04 + 1e-9);
            }
        }
    }

    #[test]
    fn a_window_with_slack_stays_where_it_was_put_until_the_robot_is_too_far_away() {
        let mut window = Window::around(0.04, 100, [1.01, -3.0], 25.0);
        assert_eq!(window.follow([1.9, -3.9, 0.0]), [0; 2]);
        let [x_m, y_m] = window.lattice().origin_m;
        assert!((x_m + 1.0).abs() < 1e-12 && (y_m + 5.0).abs() < 1e-12);
        assert_eq!(window.follow([2.04, -3.9, 0.0]), [26, 0]);
    }

    #[test]
    fn swaying_over_a_border_moves_nothing() {
        let mut window = Window::new(0.04, 100, 0.75);
        let mut layers = Layers::new(&FogConfig::default());
        let _ = window.follow([0.1, 0.1, 0.0]);
        for sway in [0.005, -0.005, 0.01, -0.01] {
            assert_eq!(window.follow([0.1 + sway, 0.1 - sway, sway]), [0; 2]);
            assert_eq!(layers.follow(sway), 0);
        }
    }
}
