//! How a climb begins: where the robot lines up before the edge of a stair, or stands before it already.

use geometry::{Map, angle_between, same_level, two_levels};
use stairs::{Stair, Staircase};
use terrain::StairOutline;

use super::climbs::Entry;
use super::directed_stairs::{After, DirectedStairs, differs, ground_behind, level_before};
use super::room_at_edges::{distance_m, lanes, range_m, run_to_cell, walkable};
use super::{ClimbLinks, Scene};

impl ClimbLinks {
    /// Finds all ways over the stairs for a robot that stands as the scene says.
    pub(crate) fn read(&mut self, scene: &Scene<'_>, stairs: &Staircase) {
        self.clear(scene.terrain.weights.len());
        self.stairs.read(stairs);
        for index in 0..self.stairs.all.len() {
            self.enter_from_floor(scene, index);
            self.leave_to_floor(scene, index);
        }
    }

    /// Onto a stair over its front edge, from what lies before it.
    fn enter_from_floor(&mut self, scene: &Scene<'_>, index: usize) {
        let face = self.stairs.all[index];
        let (range_m, tuning) = (range_m(scene, &face.front), &scene.config.tuning);
        for offset_m in lanes(range_m, scene.config.lane, tuning.room_at_edges.narrow) {
            let before = level_before(
                scene.terrain,
                &tuning.directed_stairs,
                &face.front,
                offset_m,
            );
            self.enter(scene, face.stair, Some(index), before, offset_m);
        }
        self.enter_from_start(scene, face.stair, Some(index));
    }

    /// Off a stair over its back edge, where the floor behind it has another height.
    fn leave_to_floor(&mut self, scene: &Scene<'_>, index: usize) {
        let face = self.stairs.all[index];
        let (range_m, tuning) = (range_m(scene, &face.back), &scene.config.tuning);
        let ground_at = |stairs: &DirectedStairs, offset_m: f64| {
            let crossing_m = face
                .front
                .at(face.front.offset_m(face.back.at(offset_m, 0.0)), 0.0);
            let after = stairs.after(
                scene.terrain,
                (scene.climbing, &tuning.directed_stairs),
                &face.stair,
                Some(index),
                crossing_m,
            );
            match after {
                After::Ground(height_m, _) => {
                    let depth_m = tuning.directed_stairs.ground_depth;
                    Some(ground_behind(&face.stair, height_m, depth_m))
                }
                _ => None,
            }
        };
        for offset_m in lanes(range_m, scene.config.lane, tuning.room_at_edges.narrow) {
            if let Some(ground) = ground_at(&self.stairs, offset_m) {
                let level_m = Some(face.stair.height_m());
                self.enter(scene, ground, None, level_m, offset_m);
            }
        }
        let offset_m = face.back.offset_m(scene.stand.at_m);
        if let Some(ground) = ground_at(&self.stairs, offset_m.clamp(-range_m, range_m)) {
            self.enter_from_start(scene, ground, None);
        }
    }

    /// The ways that begin with a stair, crossed at an offset.
    fn enter(
        &mut self,
        scene: &Scene<'_>,
        stair: Stair<Map>,
        index: Option<usize>,
        before: Option<f64>,
        offset_m: f64,
    ) {
        let level_m = before.unwrap_or(scene.stand.height_m);
        let rise_m = stair.height_m() - level_m;
        if !differs(scene.climbing, rise_m) {
            return;
        }
        let line = stair.front.as_line();
        let toes_m = scene.climbing.set_for(rise_m).approach_x;
        let before_m = toes_m - 0.5 * scene.feet.length_m;
        let tolerance_m = scene.climbing.levels.same;
        // Unseen ground may be of the robot's own level: it is no way up to another one.
        let own = same_level(level_m, scene.stand.height_m, tolerance_m);
        let run = run_to_cell(scene, &line, offset_m, before_m, -1.0, |height| {
            height.map_or(own, |height_m| same_level(height_m, level_m, tolerance_m))
        });
        if let Some((cell, enter_m)) = run {
            let entry = Entry {
                stair,
                index,
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
    fn enter_from_start(&mut self, scene: &Scene<'_>, stair: Stair<Map>, index: Option<usize>) {
        let (terrain, stand, tuning) = (scene.terrain, &scene.stand, &scene.config.tuning);
        let entering = &tuning.entries;
        let line = stair.front.as_line();
        let rise_m = stair.height_m() - stand.height_m;
        let (before_m, offset_m) = (-line.beyond_m(stand.at_m), line.offset_m(stand.at_m));
        let range_m = range_m(scene, &line);
        let reached =
            (0.0..=tuning.room_at_edges.run).contains(&before_m) && offset_m.abs() <= line.half_m();
        let Some(cell) = terrain.index_at(stand.at_m).filter(|_| reached) else {
            return;
        };
        let here = (stand.at_m, stand.height_m);
        let follows_another =
            self.stairs
                .begins_between((scene.climbing, &tuning.directed_stairs), here, &line);
        if !differs(scene.climbing, rise_m) || follows_another {
            return;
        }
        let clamped_m = offset_m.clamp(-range_m, range_m);
        if let Some(level_m) = level_before(terrain, &tuning.directed_stairs, &line, clamped_m)
            && two_levels(level_m, stand.height_m, scene.climbing.levels.same)
            && before_m > entering.reach
        {
            return;
        }
        let toes_m = scene.climbing.set_for(rise_m).approach_x;
        let place_m = line.at(clamped_m, toes_m - 0.5 * scene.feet.length_m);
        let away_m = distance_m(place_m, stand.at_m);
        let aligned = angle_between(line.heading_rad, stand.heading_rad).abs() <= entering.turn;
        let on_tread = terrain.edge_clearance_m(cell) < terrain.needs.feet_m
            && before_m <= entering.reach
            && self.on_short_tread(scene);
        let fixed = (on_tread || away_m <= entering.in_place) && aligned;
        if !fixed && (on_tread || !walkable(scene, stand.at_m, place_m, stand.height_m)) {
            return;
        }
        let entry = Entry {
            stair,
            index,
            level_m: stand.height_m,
            level_seen: true,
            offset_m: clamped_m,
            cell,
            enter_m: stand.at_m,
            fixed,
        };
        self.follow(scene, &entry);
    }

    /// Whether the robot stands on something too short to walk on: a stair that is known, or nothing that is known.
    fn on_short_tread(&self, scene: &Scene<'_>) -> bool {
        let (stand, stride_m) = (&scene.stand, scene.config.stride);
        let tolerance_m = scene.climbing.levels.same;
        let outside_m = scene.config.tuning.entries.outside;
        let under = self.stairs.all.iter().step_by(2).find(|face| {
            let outline = StairOutline::of(&face.stair);
            outline.outside_m(stand.at_m) <= outside_m
                && same_level(face.stair.height_m(), stand.height_m, tolerance_m)
        });
        if let Some(face) = under {
            return -face.back.beyond_m(face.front.at(0.0, 0.0)) <= stride_m;
        }
        let level = scene.terrain.index_at(stand.at_m);
        let level = level.and_then(|cell| scene.terrain.level_m(cell));
        level.is_none_or(|level_m| two_levels(level_m, stand.height_m, tolerance_m))
    }
}
