//! Room for the head that was not seen yet: the gaze rises before the robot walks into what it has only seen the floor of.

use geometry::PlanarPose;
use mapping::{FloorView, HeadRoom, Surface};
use planning::Path;
use robot::Description;

use super::WalkingBehaviour;
use super::gaze::Sweep;
use super::state::State;
use super::track::{Track, length};
use crate::machine::Tick;
use crate::walking::WalkingConfig;

/// Where the eyes are, how much they see, and how high the robot is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Eyes {
    /// Above the ground, m.
    height_m: f64,
    /// Ahead of the robot's middle, m.
    ahead_m: f64,
    /// From the middle of the picture to its upper edge, rad.
    half_view_rad: f64,
    /// Room that the robot needs above its floor, m.
    headroom_m: f64,
}

impl Eyes {
    /// The eyes of a robot.
    pub(crate) fn of(robot: &Description) -> Self {
        let camera = &robot.camera;
        Self {
            height_m: robot.head.eye_height,
            ahead_m: robot.head.eye_ahead,
            half_view_rad: libm::atan2(0.5 * camera.height as f64, camera.focal),
            headroom_m: robot.body.height,
        }
    }

    /// How far below the horizon to look so that all that the robot's head would meet so far away, over a floor that is higher by
    /// `rise_m`, is in the picture, rad.
    fn down_rad(&self, away_m: f64, rise_m: f64, above_head_rad: f64) -> f64 {
        let above_m = self.headroom_m + rise_m - self.height_m;
        let up_rad = libm::atan2(above_m, (away_m - self.ahead_m).max(0.0));
        self.half_view_rad - above_head_rad - up_rad
    }

    /// The look for that, neither higher than the highest nor lower than the far one; `None` where the highest does not do.
    fn look_rad(&self, away_m: f64, rise_m: f64, config: &WalkingConfig) -> Option<f64> {
        let down_rad = self.down_rad(away_m, rise_m, config.tuning.gaze.above_head);
        (down_rad >= config.gaze_high).then(|| down_rad.min(config.gaze_far))
    }
}

/// A place on the path above which not all was seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct UnseenPlace {
    pub(super) at_m: [f64; 2],
    /// Along the path from the robot, m.
    pub(super) along_m: f64,
    /// How far below the horizon to look to see all, rad.
    pub(super) down_rad: f64,
}

/// What is not seen of the room for the head ahead.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct OverheadAhead {
    /// The first place that was not looked at.
    pub(super) unlooked: Option<UnseenPlace>,
    /// Whether there is one that was looked at and stays unseen, before which the robot looks.
    pub(super) stays_unseen: bool,
}

impl WalkingBehaviour {
    /// The behaviour of a robot that looks up.
    #[must_use]
    pub(crate) fn with_eyes(mut self, eyes: Eyes) -> Self {
        self.eyes = Some(eyes);
        *self.machine.state_mut() = State::LookAround(self.around());
        self
    }

    /// The look up of a look around: as near as it is to see, or as the gaze rises.
    fn up_rad(&self) -> Option<f64> {
        let eyes = self.eyes?;
        let gaze = &self.config.tuning.gaze;
        let down_rad = eyes.down_rad(gaze.up_from, 0.0, gaze.above_head);
        Some(down_rad.clamp(self.config.gaze_high, self.config.gaze_far))
    }

    /// A look all around.
    pub(super) fn around(&self) -> Sweep {
        Sweep::around(&self.config, self.up_rad())
    }

    /// Stands and looks up, where the room for the head ahead on the path was not seen, and was not looked at, up to a distance along
    /// it, m. Whether it does.
    pub(crate) fn looks_up(&mut self, tick: &Tick<'_>, path: &Path, within_m: f64) -> bool {
        let Some(track) = Track::new(path, &tick.pose, &self.config) else {
            return false;
        };
        let (view, ground_m) = (tick.situation.view, tick.ground_m);
        let ahead = self.overhead_ahead(path, &track, view, ground_m);
        let Some(place) = ahead.unlooked.filter(|place| place.along_m <= within_m) else {
            return false;
        };
        let mut looked = std::mem::take(&mut self.looked_up);
        for place in self.unseen_places(path, &track, view, ground_m) {
            if place.along_m <= within_m {
                looked.add(place.at_m, &self.config.tuning.unknown);
            }
        }
        self.looked_up = looked;
        let bearing_rad = tick.bearing_rad(place.at_m);
        self.look(Sweep::up(bearing_rad, place.down_rad, &self.config));
        true
    }

    /// What is not seen of the room for the head along the path.
    pub(super) fn overhead_ahead(
        &self,
        path: &Path,
        track: &Track,
        view: &FloorView,
        ground_m: f64,
    ) -> OverheadAhead {
        let mut ahead = OverheadAhead::default();
        let radius_m = self.config.tuning.unknown.looked_radius;
        for place in self.unseen_places(path, track, view, ground_m) {
            if !self.looked_up.holds(place.at_m, radius_m) {
                ahead.unlooked = Some(place);
                break;
            }
            ahead.stays_unseen |= place.along_m <= self.config.look_up_distance;
        }
        ahead
    }

    /// Places of the path above which not all was seen, as far as the gaze can be raised to them.
    fn unseen_places<'a>(
        &'a self,
        path: &'a Path,
        track: &Track,
        view: &'a FloorView,
        ground_m: f64,
    ) -> impl Iterator<Item = UnseenPlace> + 'a {
        let [x, y] = track.offset_m;
        let mut along_m = geometry::hypot(x, y);
        let points = track.nearest + 1..path.points_m.len();
        let near = points
            .map(move |index| {
                along_m += length(path, index);
                (index, along_m)
            })
            .take_while(|&(_, along_m)| along_m <= self.config.look_up);
        near.filter(|&(index, _)| self.is_unseen(path, index, view))
            .filter_map(move |(index, along_m)| {
                let at_m = path.points_m[index];
                let rise_m = match view.at(at_m[0], at_m[1]) {
                    Surface::Floor(height_m) => f64::from(height_m) - ground_m,
                    Surface::Obstacle(_) | Surface::Unknown => 0.0,
                };
                let down_rad = self.eyes?.look_rad(along_m, rise_m, &self.config)?;
                Some(UnseenPlace {
                    at_m,
                    along_m,
                    down_rad,
                })
            })
    }

    /// Whether not all was seen above the floor that the robot takes up at a place of the path.
    fn is_unseen(&self, path: &Path, index: usize, view: &FloorView) -> bool {
        let ([x0, y0], [x, y]) = (path.points_m[index - 1], path.points_m[index]);
        let heading = PlanarPose::new(x, y, libm::atan2(y - y0, x - x0));
        [-self.radius_m, 0.0, self.radius_m].iter().any(|&aside_m| {
            let (x_m, y_m) = heading.apply(0.0, aside_m);
            view.head_at(x_m, y_m) == HeadRoom::Unseen
        })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::walking::simulation::{Simulation, walking};

    const EYES: Eyes = Eyes {
        height_m: 0.46,
        ahead_m: 0.04,
        half_view_rad: 0.34,
        headroom_m: 0.58,
    };

    proptest! {
        #[test]
        fn the_look_shows_all_that_the_head_would_meet_and_rises_as_the_robot_comes_near(
            away_m in 0.1..3.0_f64,
            rise_m in -0.2..0.2_f64,
        ) {
            let config = WalkingConfig::default();
            if let Some(down_rad) = EYES.look_rad(away_m, rise_m, &config) {
                let upper_rad = EYES.half_view_rad - down_rad;
                let seen_m = EYES.height_m + (away_m - EYES.ahead_m) * libm::tan(upper_rad);
                prop_assert!(seen_m >= EYES.headroom_m + rise_m, "{}", seen_m);
                let nearer = EYES.look_rad(0.9 * away_m, rise_m, &config);
                let above = EYES.headroom_m + rise_m > EYES.height_m;
                prop_assert!(!above || nearer.is_none_or(|nearer| nearer <= down_rad));
            }
        }
    }

    /// Floor whose room for the head from 0.8 m on is seen once the robot looks up.
    fn unseen(simulation: &mut Simulation) {
        for cell in simulation.view.cells.area().cells() {
            let [x_m, _] = simulation.view.lattice.center_of(cell);
            if let Some(head) = simulation.view.head.get_mut(cell).filter(|_| x_m > 0.8) {
                *head = HeadRoom::Unseen;
            }
        }
    }

    #[test]
    fn the_gaze_rises_before_the_robot_walks_where_it_has_only_seen_the_floor() {
        let mut simulation = Simulation::new(PlanarPose::default(), [1.6, 0.0]);
        simulation.behaviour = walking(WalkingConfig::default()).with_eyes(EYES);
        unseen(&mut simulation);
        let mut looked_at_m = None;
        for _ in 0..6000 {
            let decision = simulation.tick();
            if decision.state == "walk" && decision.command.gaze.down_rad < 0.25 {
                let _ = looked_at_m.get_or_insert(simulation.pose.x_m);
            }
            if decision.outcome.is_some() {
                break;
            }
        }
        assert!(looked_at_m.is_some_and(|x_m| x_m < 0.5), "{looked_at_m:?}");
        assert!(
            simulation.pose.x_m > 1.4,
            "what stays unseen is crept through"
        );
        let looks = simulation
            .states
            .iter()
            .filter(|(name, pose)| *name == "look_around" && pose.x_m > 0.2 && pose.x_m < 0.5);
        assert!(looks.count() >= 1, "{:?}", simulation.states);
    }
}
