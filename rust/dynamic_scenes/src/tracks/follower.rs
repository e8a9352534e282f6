//! Moving things followed from frame to frame.

use std::collections::VecDeque;

use geometry::distance_m;
use pathfinding::kuhn_munkres::kuhn_munkres_min;
use pathfinding::matrix::Matrix;
use settings::{ConfigError, NOT_NEGATIVE, POSITIVE, Table, at_least, between, settings};

use super::clusters::MovingCluster;
use super::filter::{PredictedPlace, TrackFilter};

settings! {
    /// How things that move are followed.
    pub struct TracksConfig("navigation.moving.tracks") {
        /// Standard deviation of a thing's middle, as a frame sees it.
        sigma: f64 = 0.06, "m", POSITIVE;
        /// Standard deviation of the middle of a thing that the side of what the sensor sees cuts.
        cut_sigma: f64 = 0.3, "m" of world, POSITIVE;
        /// Standard deviation of the speed of a thing that was not seen before.
        speed: f64 = 0.4, "m/s" of world, POSITIVE;
        /// Standard deviation of the accelerations, over a second.
        acceleration: f64 = 0.25, "m/s^2" of world, POSITIVE;
        /// A thing is one that is followed where such a share of its places lies no further off, or nearer.
        gate: f64 = 0.997, "1", between(0.0, 1.0);
        /// Things that were not seen so long are gone.
        forget: f64 = 2.5, "s" of world, POSITIVE;
        /// What they did is remembered so long.
        history: f64 = 30.0, "s" of world, POSITIVE;
        /// A thing moves for sure that was seen in so many frames.
        looks: u32 = 4, "1", at_least(2.0);
        /// A thing moves for sure that is so far from where it was first seen.
        moved: f64 = 0.12, "m" of world, NOT_NEGATIVE;
    }
}

impl TracksConfig {
    /// Standard deviation of the middle of a thing, m.
    const fn sigma_of(&self, cluster: &MovingCluster) -> f64 {
        if cluster.is_cut {
            self.cut_sigma
        } else {
            self.sigma
        }
    }
}

/// Where a thing was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackPoint {
    /// When, s.
    pub time_s: f64,
    /// The middle of what was seen of it, m in the map frame.
    pub at_m: [f64; 2],
}

/// A thing that is followed.
#[derive(Debug, Clone)]
pub struct MovingTrack {
    /// Its number, its own for ever.
    pub id: u32,
    /// Frames that saw it.
    pub looks: u32,
    /// How far its points reach from its middle, m; the furthest of late.
    pub radius_m: f64,
    /// Where it was seen, the oldest first.
    pub history: VecDeque<TrackPoint>,
    /// Whether it moves for sure, and did not only come into view.
    pub moves: bool,
    first_m: [f64; 2],
    seen_s: f64,
    filter: TrackFilter,
}

impl MovingTrack {
    /// Where it will be, so long after the last frame.
    pub fn predicted(&self, ahead_s: f64) -> PredictedPlace {
        self.filter.predicted(ahead_s)
    }

    /// Its velocity, m/s in the map frame.
    pub fn velocity_mps(&self) -> [f64; 2] {
        self.filter.velocity_mps().0
    }

    /// When the last frame was taken, s: predictions count from then on.
    pub const fn time_s(&self) -> f64 {
        self.filter.time_s()
    }

    /// When it was seen last, s.
    pub const fn seen_s(&self) -> f64 {
        self.seen_s
    }
}

/// The things that are followed.
#[derive(Debug, Clone)]
pub struct MovingTracks {
    config: TracksConfig,
    tracks: Vec<MovingTrack>,
    next: u32,
}

impl MovingTracks {
    /// Nothing is followed.
    pub fn new(config: TracksConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            config,
            tracks: Vec::new(),
            next: 0,
        })
    }

    /// What is followed, the oldest first.
    pub fn tracks(&self) -> &[MovingTrack] {
        &self.tracks
    }

    /// Forgets what is followed.
    pub fn clear(&mut self) {
        self.tracks.clear();
    }

    /// Takes in what a frame saw move: the track of each, which may be a new one. Together the pairs are the nearest that there are (global nearest
    /// neighbour), and none is outside the gate.
    pub fn update(&mut self, time_s: f64, seen: &[MovingCluster]) -> Vec<u32> {
        for track in &mut self.tracks {
            track.filter.predict(time_s);
        }
        let paired = self.paired(seen);
        let known = self.tracks.len();
        let ids = seen
            .iter()
            .zip(paired)
            .map(
                |(cluster, track)| match track.filter(|&track| track < known) {
                    Some(track) => self.see(track, time_s, cluster),
                    None => self.begin(time_s, cluster),
                },
            )
            .collect();
        let config = &self.config;
        self.tracks
            .retain(|track| time_s - track.seen_s <= config.forget);
        for track in &mut self.tracks {
            let old = |point: &TrackPoint| time_s - point.time_s > config.history;
            while track.history.front().is_some_and(old) {
                let _ = track.history.pop_front();
            }
        }
        ids
    }

    fn see(&mut self, track: usize, time_s: f64, cluster: &MovingCluster) -> u32 {
        let (config, track) = (&self.config, &mut self.tracks[track]);
        track.filter.update(cluster.at_m, config.sigma_of(cluster));
        track.looks += 1;
        track.seen_s = time_s;
        track.radius_m = cluster
            .radius_m
            .max(f64::midpoint(track.radius_m, cluster.radius_m));
        let at_m = track.filter.predicted(0.0).at_m;
        track.history.push_back(TrackPoint { time_s, at_m });
        let went_m = distance_m(at_m, track.first_m);
        track.moves |= track.looks >= config.looks && went_m >= config.moved;
        track.id
    }

    fn begin(&mut self, time_s: f64, cluster: &MovingCluster) -> u32 {
        let (config, id, at_m) = (&self.config, self.next, cluster.at_m);
        self.next += 1;
        self.tracks.push(MovingTrack {
            id,
            looks: 1,
            radius_m: cluster.radius_m,
            history: VecDeque::from([TrackPoint { time_s, at_m }]),
            moves: false,
            first_m: at_m,
            seen_s: time_s,
            filter: TrackFilter::new(
                time_s,
                at_m,
                config.sigma_of(cluster),
                config.speed,
                config.acceleration,
            ),
        });
        id
    }

    /// The track of each thing seen, by the least sum of distances; none where it is a new one.
    fn paired(&self, seen: &[MovingCluster]) -> Vec<Option<usize>> {
        if seen.is_empty() {
            return Vec::new();
        }
        // Chi-squared with two degrees of freedom; a new thing costs as much as one at the gate.
        let gate = -2.0 * libm::log(1.0 - self.config.gate);
        let columns = self.tracks.len() + seen.len();
        let costs = seen.iter().flat_map(|cluster| {
            let known = self.tracks.iter().map(|track| {
                let distance2 = track
                    .filter
                    .distance2(cluster.at_m, self.config.sigma_of(cluster));
                match distance2.filter(|(distance2, _)| *distance2 <= gate) {
                    Some((distance2, _)) => whole(distance2),
                    None => whole(gate) * FAR,
                }
            });
            known.chain(seen.iter().map(|_| whole(gate) + 1))
        });
        let Ok(costs) = Matrix::from_vec(seen.len(), columns, costs.collect()) else {
            return vec![None; seen.len()];
        };
        let (_, chosen) = kuhn_munkres_min(&costs);
        let known = |track: usize| (track < self.tracks.len()).then_some(track);
        chosen.into_iter().map(known).collect()
    }
}

/// Costs are whole numbers to the assignment, in millionths.
fn whole(cost: f64) -> i64 {
    (cost * 1e6) as i64
}

/// A pair outside the gate costs so many times as much as one at the gate: more than any that is chosen.
const FAR: i64 = 1000;
