//! Which edges are fitted in a frame, and what the fits of all frames say of the stairs.

use geometry::{Map, Point, Pose, Robot};
use mapping::Bevel;
use segmentation::Planes;
use sensing::{Intrinsics, Scan};

use crate::edges::bevels::Bevels;
use crate::edges::edge_model::bevel::BevelModel;
use crate::edges::felt::CarryingSole;
use crate::edges::fusion::FusedEdge;
use crate::edges::joints::{apart_m, before, part_beside};
use crate::frame::view::PlanesView;
use crate::lines::line::StraightLine;
use crate::{
    Edge, EdgeFit, EdgeModel, EdgesTuning, FitsTuning, Stair, StairsConfig, StairsTuning, SureEdge,
};

/// Fits edges and keeps what is found.
#[derive(Debug, Clone)]
pub(crate) struct Fits {
    model: EdgeModel,
    edges: Vec<FusedEdge>,
    bevel_model: BevelModel,
    bevels: Bevels,
}

/// An edge to be fitted: the guess in the robot's frame, and the levels before and behind it.
struct Wanted {
    /// How far ahead the robot's way crosses its line, m.
    ahead_m: f64,
    guess: Edge<Robot>,
    heights_m: [f64; 2],
    /// How far before and behind it nothing else changes, m.
    room_m: [f64; 2],
}

impl Fits {
    pub(crate) fn new(camera: Intrinsics, tuning: &StairsTuning) -> Self {
        Self {
            model: EdgeModel::new(camera, tuning.edge_model.clone()),
            edges: Vec::with_capacity(tuning.edges.fits.kept),
            bevel_model: BevelModel::default(),
            bevels: Bevels::default(),
        }
    }

    /// Drops what was fitted.
    pub(crate) fn forget(&mut self) {
        self.edges.clear();
        self.bevels.forget();
    }

    /// The robot stepped this often.
    pub(crate) fn step(&mut self, times: u64, config: &StairsConfig) {
        for edge in &mut self.edges {
            // One more than is remembered is forgotten.
            for _ in 0..times.min(u64::from(config.forget_steps) + 1) {
                edge.step(&config.tuning.edges.fusion);
            }
        }
        self.edges
            .retain(|edge| edge.steps_ago <= config.forget_steps);
        self.bevels.step(times, config.forget_steps);
    }

    /// Fits the nearest edges of the stairs that a frame shows.
    pub(crate) fn see(
        &mut self,
        (scan, planes): (&Scan, &Planes),
        view: &PlanesView<'_>,
        stairs: &[Stair<Map>],
        map_from_robot: &Pose<Map, Robot>,
        config: &StairsConfig,
    ) {
        let EdgesTuning {
            joints,
            fits,
            fusion,
            bevels,
        } = &config.tuning.edges;
        let robot_m = map_from_robot.origin().inner.xy().into();
        let slopes = |stair: &Stair<Map>| self.bevels.level_before(&stair.front, robot_m, bevels);
        let mut wanted = wanted(stairs, view, map_from_robot, slopes, config);
        let robot_from_map = map_from_robot.inverse();
        let rise_m = map_from_robot.origin().inner.z;
        for (middle, heights_m) in self.bevels.middles(bevels) {
            let guess = middle.transformed(&robot_from_map);
            wanted.extend(facing(guess, heights_m.map(|m| m - rise_m), fits));
        }
        wanted.sort_by(|a, b| a.ahead_m.total_cmp(&b.ahead_m));
        let map_from_camera = *map_from_robot * planes.robot_from_camera;
        for Wanted {
            guess,
            heights_m: [near_m, far_m],
            room_m,
            ..
        } in wanted.into_iter().take(fits.fitted)
        {
            let edge_model = &config.tuning.edge_model;
            let heights_m = [near_m, far_m];
            let seen = (scan, planes);
            let model = &mut self.bevel_model;
            if let Some(bevel) = model.fit(seen, &guess, heights_m, room_m, edge_model) {
                let heights_m = heights_m.map(|m| m + rise_m);
                let place = (map_from_robot, fits.same_level);
                self.bevels.see(&bevel, heights_m, place, bevels);
            }
            let Ok(fitted) = self.model.fit(scan, planes, &guess, near_m, far_m) else {
                continue;
            };
            let edge = fitted.edge.transformed(map_from_robot);
            let heights_m = [near_m + rise_m, far_m + rise_m];
            let same = |known: &FusedEdge| {
                let levels = known.heights_m.iter().zip(&heights_m);
                let same_levels = levels
                    .into_iter()
                    .all(|(a, b)| (a - b).abs() < fits.same_level);
                same_levels && apart_m(&known.edge, &edge, joints).is_some()
            };
            if let Some(known) = self.edges.iter_mut().find(|known| same(known)) {
                known.add(&fitted, &edge, &map_from_camera, fusion);
                known.heights_m = heights_m;
                known.was_sure |= is_sure(&known.fit, fits);
                continue;
            }
            if self.edges.len() == fits.kept {
                let _ = self.edges.remove(0);
            }
            let mut new = FusedEdge::new(&fitted, &edge, heights_m, &map_from_camera, fusion);
            new.was_sure = is_sure(&new.fit, fits);
            self.edges.push(new);
        }
    }

    /// The edges that were fitted well, while their places are known.
    pub(crate) fn sure(&self, list: &mut Vec<SureEdge>, tuning: &FitsTuning) {
        list.clear();
        let sure = self
            .edges
            .iter()
            .filter(|fused| fused.was_sure && lasts(&fused.fit, tuning));
        list.extend(sure.map(|fused| SureEdge {
            edge: fused.whole(),
            heights_m: fused.heights_m,
        }));
    }

    /// The robot is carried by this sole.
    pub(crate) fn stand_on(&mut self, sole: &CarryingSole, tuning: &EdgesTuning) {
        self.bevels.stand_on(sole, &tuning.bevels);
    }

    /// The changes of height that are short slopes.
    pub(crate) fn bevels(&self, list: &mut Vec<Bevel>, tuning: &EdgesTuning) {
        self.bevels.list(list, &tuning.bevels);
    }

    /// Puts the stairs' edges where the fits have them.
    pub(crate) fn apply(&self, stairs: &mut [Stair<Map>], tuning: &EdgesTuning) {
        for stair in stairs {
            let height_m = stair.height_m();
            let front = self.surest(&stair.front, |[near, far]| [far, near], height_m, tuning);
            let back = self.surest(&stair.back, |levels| levels, height_m, tuning);
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
        tuning: &EdgesTuning,
    ) -> Option<(StraightLine, EdgeFit)> {
        let sure = self
            .edges
            .iter()
            .filter(|fused| is_sure(&fused.fit, &tuning.fits));
        let same = sure.filter_map(|fused| {
            let [one_way, other_way] = order(fused.heights_m);
            let ways = [(fused.edge, one_way), (fused.edge.reversed(), other_way)];
            let (fitted, _) = ways.into_iter().find(|(fitted, level_m)| {
                (level_m - height_m).abs() < tuning.fits.same_level
                    && apart_m(edge, fitted, &tuning.joints).is_some()
            })?;
            Some((fitted.line()?, fused.fit))
        });
        same.min_by(|(_, a), (_, b)| a.place_sigma_m.total_cmp(&b.place_sigma_m))
    }
}

/// Whether a fit is better than what the labels say.
fn is_sure(fit: &EdgeFit, tuning: &FitsTuning) -> bool {
    fit.place_sigma_m < tuning.sure_place && fit.heading_sigma_rad < tuning.sure_heading
}

/// Whether an edge that was sure is known still.
fn lasts(fit: &EdgeFit, tuning: &FitsTuning) -> bool {
    fit.place_sigma_m < tuning.lasting_place && fit.heading_sigma_rad < tuning.sure_heading
}

/// The front edges ahead of the robot that are in view, with the levels on both sides. What lies before an edge is the stair that ends
/// there, else the level that a slope leads to, else the robot's own.
fn wanted(
    stairs: &[Stair<Map>],
    view: &PlanesView<'_>,
    map_from_robot: &Pose<Map, Robot>,
    slopes: impl Fn(&Stair<Map>) -> Option<f64>,
    config: &StairsConfig,
) -> Vec<Wanted> {
    let robot_from_map = map_from_robot.inverse();
    let robot_m = map_from_robot.origin().inner.z;
    let tuning = &config.tuning.edges.fits;
    let one = |index: usize| {
        let stair = &stairs[index];
        let before = before(stairs, index, config).map(|at| &stairs[at]);
        let level_m = before.map(Stair::height_m).or_else(|| slopes(stair));
        let near_m = level_m.map_or(0.0, |level_m| level_m - robot_m);
        let guess = guess(stair, before, view, &robot_from_map, tuning);
        let far_m = stair.height_m() - robot_m;
        let away_m = -guess.beyond_m([0.0, 0.0]);
        let shows = away_m > 0.0
            && (far_m - near_m).abs() < tuning.largest_rise
            && (stair.seen_ends.front > 0 || stair.front_fit.is_some())
            && view.contains(&guess.middle().inner);
        let depth_m = |stair: &Stair<Map>| 0.5 * stair.depth_m();
        shows.then_some(Wanted {
            ahead_m: away_m / guess.across().x.max(tuning.glancing),
            guess,
            heights_m: [near_m, far_m],
            room_m: [before.map_or(f64::INFINITY, depth_m), depth_m(stair)],
        })
    };
    (0..stairs.len()).filter_map(one).collect()
}

/// A known slope, looked for again from the side on which the robot is; nothing where that is behind the robot.
fn facing(guess: Edge<Robot>, heights_m: [f64; 2], tuning: &FitsTuning) -> Option<Wanted> {
    let away_m = -guess.beyond_m([0.0, 0.0]);
    let (guess, heights_m) = if away_m > 0.0 {
        (guess, heights_m)
    } else {
        (guess.reversed(), [heights_m[1], heights_m[0]])
    };
    let ahead = guess.across().x;
    (ahead > 0.0).then_some(Wanted {
        ahead_m: away_m.abs() / ahead.max(tuning.glancing),
        guess,
        heights_m,
        room_m: [f64::INFINITY; 2],
    })
}

/// Where the front edge of a stair is looked for. The middle of a wide one may be out of view: that of the floor at the foot of a
/// narrow staircase, then the part behind the stair before it counts; or one that the robot crosses off its middle, then the
/// part ahead.
fn guess(
    stair: &Stair<Map>,
    before: Option<&Stair<Map>>,
    view: &PlanesView<'_>,
    robot_from_map: &Pose<Robot, Map>,
    tuning: &FitsTuning,
) -> Edge<Robot> {
    let whole = stair.front.transformed(robot_from_map);
    let behind = before.and_then(|before| part_beside(&stair.front, &before.back));
    let behind = behind.map_or(whole, |part| part.transformed(robot_from_map));
    let parts = [whole, behind, part_ahead(&whole, tuning.ahead)];
    let mut seen = parts.into_iter();
    seen.find(|part| view.contains(&part.middle().inner))
        .unwrap_or(behind)
}

/// The part of an edge around where the robot's way straight on crosses it, or that is nearest to there: `beside_m` to either side.
fn part_ahead(edge: &Edge<Robot>, beside_m: f64) -> Edge<Robot> {
    let (left, right) = (edge.left.inner, edge.right.inner);
    let ahead = (left.y / (left.y - right.y).max(1e-9)).clamp(0.0, 1.0);
    let half = beside_m / edge.length_m().max(beside_m);
    let at = |share: f64| Point::wrap(left + (right - left) * share.clamp(0.0, 1.0));
    Edge {
        left: at(ahead - half),
        right: at(ahead + half),
    }
}

#[cfg(test)]
mod tests;
