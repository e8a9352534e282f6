//! Rule: which cells belong to recognised stairs or lie beside them, how high those are, and which of them nothing leads up to.

use geometry::Map;
use settings::{settings, within};
use stairs::Stair;

use crate::{Sight, StairOutline, Terrain};

settings! {
    /// Which cells belong to stairs.
    pub struct StairCellsConfig("navigation.terrain.stair_cells") {
        /// Stairs this near to each other may be steps of one staircase.
        joint: f64 = 0.15, "m", within(0.0, 1.0);
    }
}

pub(super) fn apply(terrain: &mut Terrain, sight: &Sight<'_>, config: &StairCellsConfig) {
    let stairs = &sight.stairs.stairs;
    let (size, step_m) = ([terrain.cols, terrain.rows], terrain.needs.limits.step_m);
    let joint_m = config.joint;
    terrain.stairs.clear(size[0] * size[1], !stairs.is_empty());
    for stair in stairs {
        let apart = !stairs
            .iter()
            .any(|other| leads_to(other, stair, step_m, joint_m));
        (terrain.stairs).add((stair, apart), &sight.view.lattice, size);
    }
}

/// Whether a stair is a step up to another one: near to it, and lower by no more than can be climbed.
fn leads_to(from: &Stair<Map>, to: &Stair<Map>, step_m: f64, joint_m: f64) -> bool {
    let rise_m = to.height_m() - from.height_m();
    let [a, b] = [from, to].map(StairOutline::of);
    let meet = || a.has_corner_near(&b, joint_m) || b.has_corner_near(&a, joint_m);
    rise_m > 0.0 && rise_m <= step_m && meet()
}

#[cfg(test)]
mod tests {
    use crate::testing::{Floor, cell, stair};

    #[test]
    fn cells_belong_to_a_stair_or_lie_beside_it_and_a_single_one_stands_apart() {
        let mut floor = Floor::new();
        floor.stairs.stairs = vec![
            stair(0.5, 0.2, 0.04, 0.6),
            stair(0.7, 0.2, 0.08, 0.6),
            stair(-1.0, 0.2, 0.04, 0.6),
        ];
        let terrain = floor.after("stair_cells");
        let at = |x_m: f64| cell(&terrain, x_m, 0.025);
        let stairs = &terrain.stairs;
        assert!(stairs.covers(at(0.625)) && stairs.covers(at(0.825)));
        assert!(!stairs.covers(at(0.475)) && stairs.is_near(at(0.475)));
        assert!(!stairs.is_near(at(0.375)));
        assert!(stairs.is_near_climbable(at(0.825)), "a step leads to it");
        assert!(!stairs.is_near_climbable(at(-0.875)), "nothing does");
    }
}
