//! Where plans end that lead over what was not seen.

use geometry::{Cell, CellArea};
use mapping::HeightMap;

use super::goal_field::GoalField;
use super::space::FootstepSpace;
use super::spots::StandingFoot;
use super::unseen::Unseen;

impl FootstepSpace<'_> {
    /// Where a plan that ends at this node leaves what is known, m; `None` where it ends at the goal.
    pub(super) fn exit(&self, node: u32) -> Option<[f64; 2]> {
        self.exit_of(&self.foot_at(node).unwrap_or(self.start[0]))
    }

    /// [`Self::exit`] of a plan that ends with this foot.
    pub(super) fn exit_of(&self, foot: &StandingFoot) -> Option<[f64; 2]> {
        (!self.is_at_goal(foot)).then(|| self.exit_from(foot))?
    }

    fn exit_from(&self, foot: &StandingFoot) -> Option<[f64; 2]> {
        let Unseen::Priced {
            stop_before_m,
            faces_rad,
        } = self.unseen
        else {
            return None;
        };
        let [x_m, y_m] = self.table.middle_m(&foot.pose, foot.heading, foot.side);
        let exit_m = self.field.exit_within(x_m, y_m, stop_before_m)?;
        let bearing_rad = libm::atan2(exit_m[1] - y_m, exit_m[0] - x_m);
        let turn_rad = geometry::wrap_angle(bearing_rad - foot.pose.yaw_rad);
        let near = geometry::distance_m(exit_m, [x_m, y_m]) < self.limits.sole.length_m;
        (near || turn_rad.abs() <= faces_rad).then_some(exit_m)
    }

    /// What the way costs on from a foot before ground that was not seen, s: there is no more room beside the feet there than here.
    pub(super) fn on_from_s(&self, foot: &StandingFoot) -> Option<f64> {
        let [x_m, y_m] = self.table.middle_m(&foot.pose, foot.heading, foot.side);
        let on_s = || self.field.remaining_s(x_m, y_m);
        self.exit_from(foot).map(|_| {
            let dear_s = self.config.look_cost + self.config.margin_cost;
            dear_s + self.config.field_short * on_s()
        })
    }
}

impl GoalField {
    /// Finds where what is known ends. Where it was looked in vain just where levels meet, no way leads.
    pub(super) fn read_exits(&mut self, map: &HeightMap, walk_m: f32, vain_m: &[[f64; 2]]) {
        self.exits.clear();
        for (node, &unseen) in self.unseen.iter().enumerate() {
            let cell = Cell::new(node as i32 % self.cols, node as i32 / self.cols);
            let [x_m, y_m] = self.lattice.center_of(cell);
            let blurred = || map.blurred_m(map.lattice.cell_at(x_m, y_m)).is_some();
            let vain = || {
                let near = |at_m: &[f64; 2]| {
                    geometry::distance_m(*at_m, [x_m, y_m]) < 2.0 * self.lattice.cell_m
                };
                vain_m.iter().any(near)
            };
            let meets = || {
                CellArea::of(cell).grown(1).cells().any(|beside| {
                    let inside = (0..self.cols).contains(&beside.col)
                        && (0..self.rows).contains(&beside.row);
                    let index = (beside.row * self.cols + beside.col) as usize;
                    inside && (self.levels_m[index] - self.levels_m[node]).abs() > walk_m
                })
            };
            let unsure = !unseen && blurred() && meets();
            let closed = unsure && vain();
            self.exits.push(unseen || unsure && !closed);
            if closed {
                self.levels_m[node] = f32::INFINITY;
            }
        }
    }

    /// Where the cheapest way from a place comes, within a distance, m, to what was not seen.
    pub(super) fn exit_within(&self, x_m: f64, y_m: f64, within_m: f64) -> Option<[f64; 2]> {
        let mut at = self.lattice.cell_at(x_m, y_m);
        let index = |cell: Cell| {
            let inside = (0..self.cols).contains(&cell.col) && (0..self.rows).contains(&cell.row);
            inside.then(|| (cell.row * self.cols + cell.col) as usize)
        };
        for _ in 0..=(within_m / self.lattice.cell_m) as usize {
            let here = index(at)?;
            if self.exits[here] {
                return Some(self.lattice.center_of(at));
            }
            let around = CellArea::of(at).grown(1);
            let next = around
                .cells()
                .filter_map(|cell| Some((self.costs_s[index(cell)?], cell)))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            match next {
                Some((cost_s, cell)) if cost_s < self.costs_s[here] => at = cell,
                _ => return None,
            }
        }
        None
    }
}
