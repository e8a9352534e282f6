//! Which edges are fitted in a frame, and what the fits of all frames say of the stairs.

use geometry::{Map, Point, Pose, Robot};
use segmentation::Planes;
use sensing::{Intrinsics, Scan};

use crate::edges::fusion::FusedEdge;
use crate::edges::joints::{apart_m, before, part_beside};
use crate::frame::view::View;
use crate::lines::line::Line;
use crate::{Edge, EdgeFit, EdgeModel, Stair, StairsConfig};

/// Edges fitted in a frame: those in view that the robot, going straight on, would cross first.
const FITTED: usize = 2;
/// An edge along the robot's way counts as one that it meets at this cosine: the sides of a staircase lie near all the way up,
/// and are not climbed.
const GLANCING: f64 = 0.1;
/// Edges that are kept.
const KEPT: usize = 16;
/// Levels of one edge may differ by this from those that it was fitted with, m: less than half of the lowest step. An edge
/// that was fitted from afar between levels that turn out to be others lies elsewhere, by more than that.
const SAME_LEVEL_M: f64 = 0.007;
/// Errors of the place (m) and the heading (rad) of an edge between two regions of labels.
const SURE: (f64, f64) = (0.006, 0.06);
/// An edge whose middle is out of view is fitted so far to either side of where it is crossed, m.
const AHEAD_M: f64 = 0.15;
/// Largest change of height that is fitted, m.
const LARGEST_RISE_M: f64 = 0.1;

/// Fits edges and keeps what is found.
#[derive(Debug, Clone)]
pub(crate) struct Fits {
    model: EdgeModel,
    edges: Vec<FusedEdge>,
}

/// An edge to be fitted: the guess in the robot's frame, and the levels before and behind it.
struct Wanted {
    /// How far ahead the robot's way crosses its line, m.
    ahead_m: f64,
    guess: Edge<Robot>,
    heights_m: [f64; 2],
}

impl Fits {
    pub(crate) fn new(camera: Intrinsics) -> Self {
        Self {
            model: EdgeModel::new(camera),
            edges: Vec::with_capacity(KEPT),
        }
    }

    /// Drops what was fitted.
    pub(crate) fn forget(&mut self) {
        self.edges.clear();
    }

    /// The robot stepped this often.
    pub(crate) fn step(&mut self, times: u64, config: &StairsConfig) {
        for edge in &mut self.edges {
            // One more than is remembered is forgotten.
            for _ in 0..times.min(u64::from(config.forget_steps) + 1) {
                edge.step();
            }
        }
        self.edges
            .retain(|edge| edge.steps_ago <= config.forget_steps);
    }

    /// Fits the nearest edges of the stairs that a frame shows.
    pub(crate) fn see(
        &mut self,
        (scan, planes): (&Scan, &Planes),
        view: &View<'_>,
        stairs: &[Stair<Map>],
        map_from_robot: &Pose<Map, Robot>,
        config: &StairsConfig,
    ) {
        let mut wanted = wanted(stairs, view, map_from_robot, config);
        wanted.sort_by(|a, b| a.ahead_m.total_cmp(&b.ahead_m));
        let map_from_camera = *map_from_robot * planes.robot_from_camera;
        let rise_m = map_from_robot.origin().inner.z;
        for Wanted {
            guess,
            heights_m: [near_m, far_m],
            ..
        } in wanted.into_iter().take(FITTED)
        {
            let Ok(fitted) = self.model.fit(scan, planes, &guess, near_m, far_m) else {
                continue;
            };
            let edge = fitted.edge.transformed(map_from_robot);
            let heights_m = [near_m + rise_m, far_m + rise_m];
            let same = |known: &FusedEdge| {
                let levels = known.heights_m.iter().zip(&heights_m);
                let same_levels = levels
                    .into_iter()
                    .all(|(a, b)| (a - b).abs() < SAME_LEVEL_M);
                same_levels && apart_m(known.edge(), &edge).is_some()
            };
            if let Some(known) = self.edges.iter_mut().find(|known| same(known)) {
                known.add(&fitted, &edge, &map_from_camera);
                known.heights_m = heights_m;
                continue;
            }
            if self.edges.len() == KEPT {
                let _ = self.edges.remove(0);
            }
            let new = FusedEdge::new(&fitted, &edge, heights_m, &map_from_camera);
            self.edges.push(new);
        }
    }

    /// Puts the stairs' edges where the fits have them.
    pub(crate) fn apply(&self, stairs: &mut [Stair<Map>]) {
        for stair in stairs {
            let height_m = stair.height_m();
            let front = self.surest(&stair.front, |[near, far]| [far, near], height_m);
            let back = self.surest(&stair.back, |levels| levels, height_m);
            if let Some((line, fit)) = front {
                stair.front = stair.front.onto(&line);
                stair.front_fit = Some(fit);
            }
            if let Some((line, fit)) = back {
                stair.back = stair.back.onto(&line);
                stair.back_fit = Some(fit);
            }
        }
    }

    /// The surest of the fitted edges that may be `edge`; one that was fitted from afar may lie beside it. Of the levels
    /// before and behind, `order` puts the stair's first.
    fn surest(
        &self,
        edge: &Edge<Map>,
        order: impl Fn([f64; 2]) -> [f64; 2],
        height_m: f64,
    ) -> Option<(Line, EdgeFit)> {
        let sure = self.edges.iter().filter(|fused| is_sure(&fused.fit()));
        let same = sure.filter_map(|fused| {
            let [one_way, other_way] = order(fused.heights_m);
            let ways = [
                (*fused.edge(), one_way),
                (fused.edge().reversed(), other_way),
            ];
            let (fitted, _) = ways.into_iter().find(|(fitted, level_m)| {
                (level_m - height_m).abs() < SAME_LEVEL_M && apart_m(edge, fitted).is_some()
            })?;
            Some((Line::along(&fitted)?, fused.fit()))
        });
        same.min_by(|(_, a), (_, b)| a.place_sigma_m.total_cmp(&b.place_sigma_m))
    }
}

/// Whether a fit is better than what the labels say.
fn is_sure(fit: &EdgeFit) -> bool {
    fit.place_sigma_m < SURE.0 && fit.heading_sigma_rad < SURE.1
}

/// The front edges ahead of the robot that are in view, with the levels on both sides.
fn wanted(
    stairs: &[Stair<Map>],
    view: &View<'_>,
    map_from_robot: &Pose<Map, Robot>,
    config: &StairsConfig,
) -> Vec<Wanted> {
    let robot_from_map = map_from_robot.inverse();
    let robot_m = map_from_robot.origin().inner.z;
    let one = |index: usize| {
        let stair = &stairs[index];
        let before = before(stairs, index, config.own_height).map(|at| &stairs[at]);
        let near_m = before.map_or(0.0, |before| before.height_m() - robot_m);
        let guess = guess(stair, before, view, &robot_from_map);
        let far_m = stair.height_m() - robot_m;
        let away_m = -guess.beyond_m([0.0, 0.0]);
        let shows = away_m > 0.0
            && (far_m - near_m).abs() < LARGEST_RISE_M
            && (stair.seen_ends.front > 0 || stair.front_fit.is_some())
            && view.contains(&guess.middle().inner);
        shows.then_some(Wanted {
            ahead_m: away_m / guess.across().x.max(GLANCING),
            guess,
            heights_m: [near_m, far_m],
        })
    };
    (0..stairs.len()).filter_map(one).collect()
}

/// Where the front edge of a stair is looked for. The middle of a wide one may be out of view: that of the floor at the foot of a
/// narrow staircase, then the part behind the stair before it counts; or one that the robot crosses off its middle, then the
/// part ahead.
fn guess(
    stair: &Stair<Map>,
    before: Option<&Stair<Map>>,
    view: &View<'_>,
    robot_from_map: &Pose<Robot, Map>,
) -> Edge<Robot> {
    let whole = stair.front.transformed(robot_from_map);
    let behind = before.and_then(|before| part_beside(&stair.front, &before.back));
    let behind = behind.map_or(whole, |part| part.transformed(robot_from_map));
    let parts = [whole, behind, part_ahead(&whole)];
    let mut seen = parts.into_iter();
    seen.find(|part| view.contains(&part.middle().inner))
        .unwrap_or(behind)
}

/// The part of an edge around where the robot's way straight on crosses it, or that is nearest to there.
fn part_ahead(edge: &Edge<Robot>) -> Edge<Robot> {
    let (left, right) = (edge.left.inner, edge.right.inner);
    let ahead = (left.y / (left.y - right.y).max(1e-9)).clamp(0.0, 1.0);
    let half = AHEAD_M / edge.length_m().max(AHEAD_M);
    let at = |share: f64| Point::wrap(left + (right - left) * share.clamp(0.0, 1.0));
    Edge {
        left: at(ahead - half),
        right: at(ahead + half),
    }
}

#[cfg(test)]
mod tests {
    use geometry::{Camera, Point};
    use proptest::prelude::*;

    use super::*;
    use crate::synthetic::{CAMERA, camera_pose};
    use crate::{FittedEdge, Sides};

    /// A step of 30 mm whose front was labelled 1 cm too far, and whose edge was fitted between levels that are off.
    fn front_fit(off_m: f64) -> Option<EdgeFit> {
        let stair = stair_with(&[(0.5, off_m, 0.003)]);
        let at_m = if stair.front_fit.is_some() { 0.5 } else { 0.51 };
        assert!(stair.front.beyond_m([at_m, 0.0]).abs() < 1e-9);
        stair.front_fit
    }

    /// The same after edges were fitted at these places, with these errors of the levels and these sigmas, m.
    fn stair_with(edges: &[(f64, f64, f64)]) -> Stair<Map> {
        let edge = |x_m: f64, z_m: f64| Edge {
            left: Point::<Map>::new(x_m, 0.2, z_m),
            right: Point::<Map>::new(x_m, -0.2, z_m),
        };
        let camera = Pose::<Map, Camera>::identity();
        let mut fits = Fits::new(crate::synthetic::CAMERA);
        for &(x_m, off_m, place_sigma_m) in edges {
            let at = edge(x_m, 0.03);
            let heights_m = [off_m, 0.03 + off_m];
            let fitted = FittedEdge {
                edge: at.transformed(&Pose::<Robot, Map>::identity()),
                place_sigma_m,
                heading_sigma_rad: 0.02,
                near_height_m: heights_m[0],
                far_height_m: heights_m[1],
            };
            fits.edges
                .push(FusedEdge::new(&fitted, &at, heights_m, &camera));
        }
        let mut stairs = [Stair {
            front: edge(0.51, 0.03),
            back: edge(0.63, 0.03),
            reference: Point::new(0.57, 0.0, 0.03),
            left_margin_m: 0.0,
            right_margin_m: 0.0,
            support: 300,
            seen_ends: Sides::default(),
            front_fit: None,
            back_fit: None,
            seen_from_m: 0.5,
            steps_ago: 0,
        }];
        fits.apply(&mut stairs);
        let [stair] = stairs;
        stair
    }

    #[test]
    fn the_part_ahead_of_an_edge_lies_on_it_around_where_it_is_crossed() {
        for (aside_m, ends_m) in [
            (-0.2, [0.15, -0.15]),
            (0.0, [0.15, -0.15]),
            (0.5, [-0.1, -0.25]),
        ] {
            let at = |y_m: f64| Point::<Robot>::new(0.07, y_m, 0.05);
            let edge = Edge {
                left: at(0.4 - aside_m),
                right: at(-0.4 - aside_m),
            };
            let part = part_ahead(&edge);
            for (end, y_m) in [part.left, part.right].iter().zip(ends_m) {
                assert!((end.inner - at(y_m).inner).norm() < 1e-12, "{part:?}");
            }
        }
    }

    #[test]
    fn of_two_fits_of_one_edge_the_surer_counts_whichever_came_first() {
        let (near, far) = ((0.5, 0.0, 0.002), (0.53, 0.006, 0.0055));
        for edges in [[near, far], [far, near]] {
            let stair = stair_with(&edges);
            assert!(stair.front.beyond_m([0.5, 0.0]).abs() < 1e-9, "{stair:?}");
            assert!(
                stair
                    .front_fit
                    .is_some_and(|fit| fit.place_sigma_m < 0.0025)
            );
        }
    }

    proptest! {
        #[test]
        fn an_edge_that_was_fitted_between_other_levels_is_none_of_a_stairs(
            off_m in 0.0075..0.03f64, low in any::<bool>(),
        ) {
            prop_assert_eq!(front_fit(if low { -off_m } else { off_m }), None);
        }

        #[test]
        fn an_edge_that_was_fitted_between_the_same_levels_is(off_m in -0.0065..0.0065f64) {
            prop_assert!(front_fit(off_m).is_some());
        }
    }

    #[test]
    fn an_edge_whose_middle_is_out_of_view_is_looked_for_behind_the_stair_before_it_or_ahead() {
        let mut planes = Planes::new(CAMERA.width * CAMERA.height);
        planes.robot_from_camera = camera_pose(0.0, 1.0);
        let view = View::new(&planes, CAMERA);
        let stair = |[front_m, back_m]: [f64; 2], ends_m: [f64; 2], z_m| {
            let edge = |x_m: f64| {
                let [right, left] = ends_m.map(|y_m| Point::<Robot>::new(x_m, y_m, z_m));
                Edge { left, right }
            };
            let (front, back) = (edge(front_m), edge(back_m));
            Stair::seen(front, back, front.middle(), 100).transformed(&Pose::identity())
        };
        let tread = stair([0.05, 0.2], [-0.16, 0.16], 0.0);
        let floor = |ends_m| stair([0.2, 2.0], ends_m, -0.03);
        let ends_m = |floor: &Stair<Map>, before| {
            let guess = guess(floor, before, &view, &Pose::identity());
            assert!(guess.beyond_m([0.2, 0.0]).abs() < 1e-9);
            [guess.right, guess.left].map(|end| end.inner.y)
        };
        let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) < 1e-9;
        assert!(near(
            ends_m(&floor([-1.4, 0.2]), Some(&tread)),
            [-0.16, 0.16]
        ));
        assert!(near(ends_m(&floor([-1.4, 0.2]), None), [-0.15, 0.15]));
        assert!(near(ends_m(&floor([-0.3, 0.3]), Some(&tread)), [-0.3, 0.3]));
    }

    /// Floor on both sides of a staircase whose sides the robot sees nearer than the steps.
    #[test]
    fn of_steps_ahead_and_the_sides_of_the_stairs_the_steps_are_fitted() {
        let mut planes = Planes::new(CAMERA.width * CAMERA.height);
        planes.robot_from_camera = camera_pose(0.0, 0.8);
        let view = View::new(&planes, CAMERA);
        let stair = |right: [f64; 2], left: [f64; 2], deep: [f64; 2], z_m: f64| {
            let edge = |by: f64| Edge {
                left: Point::<Robot>::new(left[0] + by * deep[0], left[1] + by * deep[1], z_m),
                right: Point::<Robot>::new(right[0] + by * deep[0], right[1] + by * deep[1], z_m),
            };
            let mut seen = Stair::seen(edge(0.0), edge(1.0), edge(0.5).middle(), 100);
            seen.seen_ends.front = 100;
            seen.transformed(&Pose::identity())
        };
        let step = |x_m: f64, z_m| stair([x_m, -0.15], [x_m, 0.15], [0.11, 0.0], z_m);
        let stairs = [
            stair([0.3, -0.15], [0.9, -0.15], [0.0, -0.5], -0.03),
            step(0.5, 0.03),
            stair([0.9, 0.15], [0.3, 0.15], [0.0, 0.5], -0.03),
            step(0.61, 0.06),
        ];
        let here = Pose::identity();
        let mut wanted = wanted(&stairs, &view, &here, &StairsConfig::default());
        assert_eq!(wanted.len(), stairs.len());
        wanted.sort_by(|a, b| a.ahead_m.total_cmp(&b.ahead_m));
        let heights_m = wanted.iter().take(FITTED).map(|edge| edge.heights_m[1]);
        assert_eq!(heights_m.collect::<Vec<_>>(), [0.03, 0.06]);
    }
}
