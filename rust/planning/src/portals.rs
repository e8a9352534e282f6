//! Where levels join: ways over the edges of stairs, square to each, from the cell where the robot lines up to the cell
//! where it walks on. And ways through slits.

use geometry::{Map, angle_between};
use stairs::{ClimbingConfig, Feet, Stair, Staircase, Unfit};

use crate::faces::{After, Faces, GROUND_DEPTH_M, differs, level_before};
use crate::levels::Stand;
use crate::line::{Line, ground_behind};
use crate::links::Links;
use crate::room::{RUN_M, SAME_M, distance_m, lanes, range_m, run_to_cell, walkable};
use crate::terrain::Terrain;
use crate::{AStarConfig, Goal, Step};

/// From a tread the robot steps on without moving up to an edge first when it is within this, m.
const REACH_M: f64 = 0.16;
/// It turns no more than this on a tread, rad.
const TURN_RAD: f64 = 0.5;
/// The robot stands where it should by this, m.
const IN_PLACE_M: f64 = 0.015;

/// What portals are made from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scene<'a> {
    pub(crate) terrain: &'a Terrain,
    pub(crate) view: &'a mapping::FloorView,
    pub(crate) climbing: &'a ClimbingConfig,
    pub(crate) feet: &'a Feet,
    pub(crate) config: &'a AStarConfig,
    pub(crate) stand: Stand,
    pub(crate) goal: Goal,
    /// Places from which the robot has looked on purpose, m.
    pub(crate) looked_m: &'a [[f64; 2]],
}

/// One step of a way, with where the robot stands before and after it, m.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stride {
    pub(crate) step: Step,
    pub(crate) from_m: [f64; 2],
    pub(crate) to_m: [f64; 2],
    /// How far from its middle the edge may be crossed, m.
    pub(crate) range_m: f64,
    /// What a metre costs here by what stands beside it: 1 where nothing is near.
    pub(crate) beside: f64,
    /// Why it is not taken.
    pub(crate) limit: Option<Unfit>,
}

/// Whether a way can be taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Fit {
    /// Every step of it is within the limits.
    Holds,
    /// One is not, as far as can be told from afar.
    Doubtful,
    /// One is not.
    Broken,
}

/// A link over stairs, or through a slit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Way {
    pub(crate) first: usize,
    pub(crate) end: usize,
    /// Where it begins, in its first cell, m.
    pub(crate) enter_m: [f64; 2],
    /// Where it ends, in its last cell, m; `None` where it ends on the last stair.
    pub(crate) leave_m: Option<[f64; 2]>,
    pub(crate) fit: Fit,
    /// Whether it ends at the goal; otherwise what comes behind its last stair is not known.
    pub(crate) at_goal: bool,
    /// The heading with which it is walked sideways, rad: it leads through a slit, and over no stair.
    pub(crate) turned_rad: Option<f64>,
}

/// All ways over stairs and through slits. Reused.
#[derive(Debug, Clone, Default)]
pub(crate) struct Portals {
    pub(crate) links: Links,
    pub(crate) ways: Vec<Way>,
    pub(crate) strides: Vec<Stride>,
    pub(crate) faces: Faces,
}

/// A stair to step on first, and from where.
pub(crate) struct Entry {
    pub(crate) stair: Stair<Map>,
    pub(crate) face: Option<usize>,
    /// Height of the ground before it, m,
    pub(crate) level_m: f64,
    /// and whether that was seen there: else it is taken to be the robot's own.
    pub(crate) level_seen: bool,
    pub(crate) offset_m: f64,
    pub(crate) cell: usize,
    pub(crate) enter_m: [f64; 2],
    /// Where the robot stands before the step when that is given: it does not move up to the edge, m.
    pub(crate) fixed: bool,
}

/// A stair that was stepped on.
pub(crate) struct Landing {
    pub(crate) stair: Stair<Map>,
    pub(crate) face: Option<usize>,
    pub(crate) after: After,
}

impl Portals {
    /// Finds all ways over the stairs for a robot that stands as the scene says.
    pub(crate) fn read(&mut self, scene: &Scene<'_>, stairs: &Staircase) {
        self.links.clear(scene.terrain.weights.len());
        self.ways.clear();
        self.strides.clear();
        self.faces.read(stairs);
        for face in 0..self.faces.all().len() {
            self.enter_from_floor(scene, face);
            self.leave_to_floor(scene, face);
        }
        self.slip_through(scene);
    }

    /// The way of a link.
    pub(crate) fn way(&self, link: usize) -> &Way {
        &self.ways[link]
    }

    /// Whether any way fits just so.
    pub(crate) fn has(&self, fit: Fit) -> bool {
        self.ways.iter().any(|way| way.fit == fit)
    }

    /// The steps of a way.
    pub(crate) fn strides(&self, way: &Way) -> &[Stride] {
        &self.strides[way.first..way.end]
    }

    /// All steps of all ways.
    pub(crate) fn all_strides(&self) -> &[Stride] {
        &self.strides
    }

    /// Onto a stair over its front edge, from what lies before it.
    fn enter_from_floor(&mut self, scene: &Scene<'_>, index: usize) {
        let face = self.faces.all()[index];
        let range_m = range_m(scene, &face.front);
        for offset_m in lanes(range_m, scene.config.lane) {
            let before = level_before(scene.terrain, &face.front, offset_m);
            self.enter(scene, face.stair, Some(index), before, offset_m);
        }
        self.enter_from_start(scene, face.stair, Some(index));
    }

    /// Off a stair over its back edge, where the floor behind it has another height.
    fn leave_to_floor(&mut self, scene: &Scene<'_>, index: usize) {
        let face = self.faces.all()[index];
        let range_m = range_m(scene, &face.back);
        let ground_at = |faces: &Faces, offset_m: f64| {
            let crossing_m = face
                .front
                .at(face.front.offset_m(face.back.at(offset_m, 0.0)), 0.0);
            let after = faces.after(
                scene.terrain,
                scene.climbing,
                &face.stair,
                Some(index),
                crossing_m,
            );
            match after {
                After::Ground(height_m, _) => {
                    Some(ground_behind(&face.stair, height_m, GROUND_DEPTH_M))
                }
                _ => None,
            }
        };
        for offset_m in lanes(range_m, scene.config.lane) {
            if let Some(ground) = ground_at(&self.faces, offset_m) {
                let level_m = Some(face.stair.height_m());
                self.enter(scene, ground, None, level_m, offset_m);
            }
        }
        let offset_m = face.back.offset_m(scene.stand.at_m);
        if let Some(ground) = ground_at(&self.faces, offset_m.clamp(-range_m, range_m)) {
            self.enter_from_start(scene, ground, None);
        }
    }

    /// The ways that begin with a stair, crossed at an offset.
    fn enter(
        &mut self,
        scene: &Scene<'_>,
        stair: Stair<Map>,
        face: Option<usize>,
        before: Option<f64>,
        offset_m: f64,
    ) {
        let level_m = before.unwrap_or(scene.stand.height_m);
        let rise_m = stair.height_m() - level_m;
        if !differs(scene.climbing, rise_m) {
            return;
        }
        let line = Line::of(&stair.front);
        let toes_m = scene.climbing.set_for(rise_m).approach_x;
        let before_m = toes_m - 0.5 * scene.feet.length_m;
        // Unseen ground may be of the robot's own level: it is no way up to another one.
        let own = (level_m - scene.stand.height_m).abs() <= SAME_M;
        let run = run_to_cell(scene, &line, offset_m, before_m, -1.0, |height| {
            height.map_or(own, |height_m| (height_m - level_m).abs() <= SAME_M)
        });
        if let Some((cell, enter_m)) = run {
            let entry = Entry {
                stair,
                face,
                level_m,
                level_seen: before.is_some(),
                offset_m,
                cell,
                enter_m,
                fixed: false,
            };
            self.follow(scene, &entry);
        }
    }

    /// The ways that begin where the robot stands: on a tread, or close before an edge.
    fn enter_from_start(&mut self, scene: &Scene<'_>, stair: Stair<Map>, face: Option<usize>) {
        let (terrain, stand) = (scene.terrain, &scene.stand);
        let line = Line::of(&stair.front);
        let rise_m = stair.height_m() - stand.height_m;
        let (before_m, offset_m) = (-line.beyond_m(stand.at_m), line.offset_m(stand.at_m));
        let range_m = range_m(scene, &line);
        let reached = (0.0..=RUN_M).contains(&before_m) && offset_m.abs() <= line.half_m();
        let Some(cell) = terrain.index_at(stand.at_m).filter(|_| reached) else {
            return;
        };
        let here = (stand.at_m, stand.height_m);
        let follows_another = self.faces.begins_between(scene.climbing, here, &line);
        if !differs(scene.climbing, rise_m) || follows_another {
            return;
        }
        if let Some(level_m) = level_before(terrain, &line, offset_m.clamp(-range_m, range_m))
            && (level_m - stand.height_m).abs() > SAME_M
            && before_m > REACH_M
        {
            return;
        }
        let toes_m = scene.climbing.set_for(rise_m).approach_x;
        let place_m = line.at(
            offset_m.clamp(-range_m, range_m),
            toes_m - 0.5 * scene.feet.length_m,
        );
        let away_m = distance_m(place_m, stand.at_m);
        let aligned = angle_between(line.heading_rad(), stand.heading_rad).abs() <= TURN_RAD;
        let on_tread = terrain.edge_clearance_m(cell) < terrain.needs.feet_m
            && before_m <= REACH_M
            && self.on_short_tread(scene);
        let fixed = (on_tread || away_m <= IN_PLACE_M) && aligned;
        if !fixed && (on_tread || !walkable(scene, stand.at_m, place_m, stand.height_m)) {
            return;
        }
        let entry = Entry {
            stair,
            face,
            level_m: stand.height_m,
            level_seen: true,
            offset_m: offset_m.clamp(-range_m, range_m),
            cell,
            enter_m: stand.at_m,
            fixed,
        };
        self.follow(scene, &entry);
    }

    /// Whether the robot stands on something too short to walk on: a stair that is known, or nothing that is known.
    fn on_short_tread(&self, scene: &Scene<'_>) -> bool {
        let (stand, stride_m) = (&scene.stand, scene.config.stride);
        let under = self.faces.all().iter().step_by(2).find(|face| {
            let outline = crate::treads::Outline::of(&face.stair);
            outline.outside_m(stand.at_m) <= 0.02
                && (face.stair.height_m() - stand.height_m).abs() <= SAME_M
        });
        if let Some(face) = under {
            return -face.back.beyond_m(face.front.at(0.0, 0.0)) <= stride_m;
        }
        let level = scene.terrain.index_at(stand.at_m);
        let level = level.and_then(|cell| scene.terrain.level_m(cell));
        level.is_none_or(|level_m| (level_m - stand.height_m).abs() > SAME_M)
    }
}
