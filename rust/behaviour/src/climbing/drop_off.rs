//! Where the map has the floor under the robot end: an edge that was not measured yet may be thought to lie elsewhere, and beside
//! one a platform ends, too.

use geometry::PlanarPose;
use mapping::FloorView;
use stairs::Feet;
use terrain::support::{SolesOnGround, lower_places};

use super::tuning::DropOffTuning;
use crate::Velocity;

/// The floor around a robot that stands at this height.
#[derive(Debug, Clone, Copy)]
pub(super) struct DropOff<'a> {
    pub(super) view: &'a FloorView,
    pub(super) feet: &'a Feet,
    /// Height of the floor that the robot stands on, m.
    pub(super) level_m: f64,
    /// Floor that is lower by more than this is another level, m.
    pub(super) same_level_m: f64,
    /// The map is asked at so many places under the soles to each side of their middle.
    pub(super) raster: i32,
    pub(super) tuning: &'a DropOffTuning,
}

impl DropOff<'_> {
    /// Whether a walk brings the feet nearer to lower floor than they are, within their next step.
    pub(super) fn is_neared(&self, pose: &PlanarPose, velocity: &Velocity) -> bool {
        let (ahead_s, few) = (self.tuning.ahead, self.tuning.few);
        let way = [velocity.x_mps, velocity.y_mps, velocity.yaw_radps].map(|rate| rate * ahead_s);
        let next = pose.compose(&PlanarPose::new(way[0], way[1], way[2]));
        let [now, then] =
            [pose, &next].map(|pose| self.lower_places(pose, 1.0, self.tuning.margin));
        then >= few && then > now
    }

    /// Whether the rear half of a sole has lower floor under it at a place before an edge: toes may reach over that.
    pub(super) fn is_under(&self, pose: &PlanarPose) -> bool {
        self.lower_places(pose, 0.0, 0.0) >= self.tuning.few
    }

    /// At how many places under both soles there is lower floor: from the heels to this share of half their length, and so far
    /// around them, m.
    fn lower_places(&self, pose: &PlanarPose, front: f64, margin_m: f64) -> usize {
        let half_m = [self.feet.length_m, self.feet.pair_width_m].map(|size| 0.5 * size + margin_m);
        let raster = self.raster;
        let soles = SolesOnGround { half_m, raster };
        let levels_m = (self.level_m, self.same_level_m);
        lower_places(self.view, soles, (pose, front), levels_m)
    }
}

#[cfg(test)]
mod tests {
    use geometry::{Grid, Lattice};
    use mapping::Surface;
    use proptest::prelude::*;

    use super::*;
    use crate::climbing::simulation::FEET;

    /// A platform, 5 cm high, that ends at y = 0.28 m, with a shadow a cell wide below its edge.
    fn platform() -> FloorView {
        let lattice = Lattice {
            origin_m: [-1.0, -1.0],
            cell_m: 0.04,
        };
        let mut cells = Grid::filled(50, 50, Surface::Floor(0.05));
        for cell in cells.area().cells() {
            let [_, y_m] = lattice.center_of(cell);
            if let Some(surface) = cells.get_mut(cell).filter(|_| y_m > 0.28) {
                *surface = if y_m < 0.32 {
                    Surface::Unknown
                } else {
                    Surface::Floor(0.0)
                };
            }
        }
        FloorView::new(lattice, cells, 9)
    }

    fn drop_off<'a>(view: &'a FloorView, tuning: &'a DropOffTuning) -> DropOff<'a> {
        DropOff {
            view,
            feet: &FEET,
            level_m: 0.05,
            same_level_m: 0.012,
            raster: 5,
            tuning,
        }
    }

    fn sideways(y_mps: f64) -> Velocity {
        Velocity {
            y_mps,
            ..Velocity::default()
        }
    }

    #[test]
    fn a_walk_towards_the_side_of_a_platform_is_noticed_before_a_sole_is_beyond_it() {
        let view = platform();
        let tuning = DropOffTuning::default();
        let drop_off = drop_off(&view, &tuning);
        // The outer side of the left sole is 8 cm from the middle.
        assert!(!drop_off.is_neared(&PlanarPose::new(0.0, 0.1, 0.0), &sideways(0.04)));
        assert!(drop_off.is_neared(&PlanarPose::new(0.0, 0.17, 0.0), &sideways(0.04)));
        assert!(!drop_off.is_neared(&PlanarPose::new(0.0, 0.17, 0.0), &sideways(-0.04)));
    }

    #[test]
    fn toes_may_reach_over_an_edge_and_heels_may_not() {
        let view = platform();
        let tuning = DropOffTuning::default();
        let drop_off = drop_off(&view, &tuning);
        let ahead_rad = std::f64::consts::FRAC_PI_2;
        assert!(!drop_off.is_under(&PlanarPose::new(0.0, 0.26, ahead_rad)));
        assert!(drop_off.is_under(&PlanarPose::new(0.0, 0.26, -ahead_rad)));
    }

    proptest! {
        #[test]
        fn on_floor_without_any_edge_no_walk_nears_one(
            x_m in -0.5..0.5f64, y_m in -0.5..0.5f64, yaw_rad in -3.0..3.0f64, y_mps in -0.1..0.1f64,
        ) {
            let mut view = platform();
            view.cells = Grid::filled(50, 50, Surface::Floor(0.045));
            let tuning = DropOffTuning::default();
            prop_assert!(!drop_off(&view, &tuning).is_neared(&PlanarPose::new(x_m, y_m, yaw_rad), &sideways(y_mps)));
        }
    }
}
