//! Which edges are fitted in a frame, and what the fits of all frames say of the stairs.

use geometry::{Map, Pose, Robot};
use segmentation::Planes;
use sensing::{Intrinsics, Scan};

use crate::fusion::FusedEdge;
use crate::joints::{apart_m, before};
use crate::line::Line;
use crate::view::View;
use crate::{Edge, EdgeFit, EdgeModel, Stair, StairsConfig};

/// Edges fitted in a frame: the nearest in view.
const FITTED: usize = 2;
/// Edges that are kept.
const KEPT: usize = 16;
/// Levels of one edge may differ by this from what was fitted before, m.
const SAME_LEVEL_M: f64 = 0.012;
/// Errors of the place (m) and the heading (rad) of an edge between two regions of labels.
const SURE: (f64, f64) = (0.006, 0.06);
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
    away_m: f64,
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

    /// The robot stepped this often.
    pub(crate) fn step(&mut self, times: u64, config: &StairsConfig) {
        for edge in &mut self.edges {
            for _ in 0..times.min(u64::from(config.forget_steps)) {
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
        wanted.sort_by(|a, b| a.away_m.total_cmp(&b.away_m));
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
            for fused in self.edges.iter().filter(|fused| is_sure(&fused.fit())) {
                let levels = fused
                    .heights_m
                    .map(|level_m| (level_m - height_m).abs() < SAME_LEVEL_M);
                for (edge, [near, far]) in [
                    (*fused.edge(), levels),
                    (fused.edge().reversed(), [levels[1], levels[0]]),
                ] {
                    let Some(line) = Line::along(&edge) else {
                        continue;
                    };
                    if far && apart_m(&stair.front, &edge).is_some() {
                        stair.front = stair.front.onto(&line);
                        stair.front_fit = Some(fused.fit());
                    }
                    if near && apart_m(&stair.back, &edge).is_some() {
                        stair.back = stair.back.onto(&line);
                        stair.back_fit = Some(fused.fit());
                    }
                }
            }
        }
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
        let guess = stair.front.transformed(&robot_from_map);
        let near_m = before(stairs, index, config.own_height)
            .map_or(0.0, |at| stairs[at].height_m() - robot_m);
        let far_m = stair.height_m() - robot_m;
        let away_m = -guess.beyond_m([0.0, 0.0]);
        let shows = away_m > 0.0
            && (far_m - near_m).abs() < LARGEST_RISE_M
            && (stair.seen_ends.front > 0 || stair.front_fit.is_some())
            && view.contains(&guess.middle().inner);
        shows.then_some(Wanted {
            away_m,
            guess,
            heights_m: [near_m, far_m],
        })
    };
    (0..stairs.len()).filter_map(one).collect()
}
