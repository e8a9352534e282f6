//! What is known of the stairs around: merged while the robot stands (003, section IV.C), remembered while it steps.

use geometry::{Map, Pose, Robot};
use mapping::FloorView;
use nalgebra::Point2;

use crate::frame::extract::StairSighting;
use crate::frame::view::{PlanesView, Shows};
use crate::treads::merge::{contradict, merge_all, overlap};
use crate::treads::tread::Tread;
use crate::{Stair, StairsConfig, StairsTuning};

/// The treads around the robot, seen or remembered.
#[derive(Debug, Clone, Default)]
pub(crate) struct TreadMemory {
    treads: Vec<Tread>,
    /// Frames merged since the last step.
    pub(crate) frames: u32,
}

impl TreadMemory {
    /// The robot stepped this often: what was seen is now remembered.
    pub(crate) fn step(&mut self, times: u64, config: &StairsConfig) {
        self.frames = 0;
        self.treads
            .retain(|tread| tread.sightings >= config.min_frames);
        for tread in &mut self.treads {
            // One more than is remembered is forgotten.
            for _ in 0..times.min(u64::from(config.forget_steps) + 1) {
                tread.step(&config.tuning);
            }
        }
    }

    /// Forgets treads where the map has a slope: its level strips are no stairs, and what it leads to is walked onto.
    pub(crate) fn leave_slopes(&mut self, floor: &FloorView, tuning: &StairsTuning) {
        self.treads.retain(|tread| {
            tread
                .stair()
                .is_none_or(|stair| !is_of_slope(&stair, floor, tuning))
        });
    }

    /// Takes in what a frame showed.
    pub(crate) fn see(
        &mut self,
        sightings: &[StairSighting],
        view: &PlanesView<'_>,
        map_from_robot: &Pose<Map, Robot>,
        config: &StairsConfig,
    ) {
        let robot = map_from_robot.origin().inner.xy();
        self.look_for_gone(view, map_from_robot, &config.tuning);
        let known = self.treads.len();
        for sighting in sightings {
            let Some(tread) = Tread::new(sighting, map_from_robot, &config.tuning) else {
                continue;
            };
            let same = |old: &Tread| overlap(old, &tread, config);
            let counts = if sighting.own_level {
                self.treads[..known]
                    .iter()
                    .any(|old| same(old) && carries(old, &robot))
            } else {
                sighting.large_enough || self.treads[..known].iter().any(same)
            };
            if counts {
                self.treads.push(tread);
            }
        }
        merge_all(&mut self.treads, config);
        self.drop_contradicted(config);
        let far =
            |tread: &Tread| nalgebra::distance(&tread.middle(), &robot) > config.forget_distance;
        self.treads
            .retain(|tread| !far(tread) && tread.steps_ago <= config.forget_steps);
        for tread in &mut self.treads {
            tread.face(&robot, &config.tuning);
        }
        self.frames = self.frames.saturating_add(1);
    }

    /// Counts the frames in which something lower shows where a tread should be, or a level surface that lies over it.
    fn look_for_gone(
        &mut self,
        view: &PlanesView<'_>,
        map_from_robot: &Pose<Map, Robot>,
        tuning: &StairsTuning,
    ) {
        let memory = &tuning.treads.memory;
        let robot_from_map = map_from_robot.inverse();
        for tread in &mut self.treads {
            let Some(mut stair) = tread.stair() else {
                continue;
            };
            // Of a deep one the camera may show no more than its front, which is what is stepped on.
            if stair.depth_m() > memory.front_depth {
                stair.back = stair.front.shifted(memory.front_depth);
            }
            let (mut there, mut gone) = (0_usize, 0_usize);
            for place in stair.transformed(&robot_from_map).places(&tuning.places) {
                match view.shows_at(&place.inner) {
                    Some(Shows::Surface) => there += 1,
                    Some(Shows::Lower) => gone += 1,
                    Some(Shows::Higher) if view.is_covered(&place.inner) => gone += 1,
                    Some(Shows::Higher) | None => {}
                }
            }
            let looked_at = there + gone;
            if looked_at >= memory.looked_at {
                let through = gone as f64 >= memory.seen_through * looked_at as f64;
                tread.contradicted = if through { tread.contradicted + 1 } else { 0 };
            }
        }
    }

    /// Drops treads that were looked through for some frames, and remembered ones in whose place something of another
    /// height is seen that is known better.
    fn drop_contradicted(&mut self, config: &StairsConfig) {
        self.treads
            .retain(|tread| tread.contradicted < config.contradicted_frames);
        self.treads.sort_by(|a, b| b.worth.total_cmp(&a.worth));
        let mut index = 0;
        while index < self.treads.len() {
            let tread = &self.treads[index];
            let better = |other: &Tread| contradict(other, tread, &config.tuning.treads.merging);
            if tread.steps_ago > 0 && self.treads[..index].iter().any(better) {
                let _ = self.treads.remove(index);
            } else {
                index += 1;
            }
        }
    }

    /// The stairs that are sure enough, no two in one place.
    pub(crate) fn stairs(&self, config: &StairsConfig, stairs: &mut Vec<Stair<Map>>) {
        let merging = &config.tuning.treads.merging;
        stairs.clear();
        for (index, tread) in self.treads.iter().enumerate() {
            let known = |tread: &Tread| tread.sightings >= config.min_frames;
            let better = |other: &Tread| known(other) && contradict(other, tread, merging);
            if known(tread) && !self.treads[..index].iter().any(better) {
                stairs.extend(tread.stair());
            }
        }
    }
}

/// Whether most of a stair lies on a slope, or most of its front along one.
fn is_of_slope(stair: &Stair<Map>, floor: &FloorView, tuning: &StairsTuning) -> bool {
    let memory = &tuning.treads.memory;
    let (front_places, beside_m) = (&memory.front_places, memory.beside);
    let is_sloped = |at: [f64; 2]| floor.gradient_at(at[0], at[1]) != [0.0; 2];
    let on = stair.places(&tuning.places).map(|place| place.inner);
    let on = on.filter(|place| is_sloped([place.x, place.y])).count();
    let (front, across) = (&stair.front, stair.front.across());
    let along = front_places.iter().filter(|&&share| {
        let place = front.right.inner.lerp(&front.left.inner, share);
        [-beside_m, 0.0, beside_m].iter().any(|beside_m| {
            is_sloped([place.x + across.x * beside_m, place.y + across.y * beside_m])
        })
    });
    let (all, all_along) = (stair.places(&tuning.places).count(), front_places.len());
    on as f64 >= memory.on_slope * all as f64
        || along.count() as f64 > memory.on_slope * all_along as f64
}

/// Whether a tread lies under the robot.
fn carries(tread: &Tread, robot: &Point2<f64>) -> bool {
    tread.stair().is_some_and(|stair| {
        let at = [robot.x, robot.y];
        stair.front.beyond_m(at) > 0.0 && stair.back.beyond_m(at) < 0.0
    })
}
