//! The points of a whole recording without what moved: ghosts taken out (004, Figs 36.20 and 36.21).

use settings::{ConfigError, SHARE, Table, at_least, settings};

use crate::tracks::{ClustersConfig, PointOfView, moving_clusters};
use crate::views::{PointLooks, RangeView, ViewsConfig};

settings! {
    /// When a point is of something that is there no more at the end of a recording.
    pub struct GoneConfig("navigation.moving.gone") {
        /// The last looks at its place that say something: so many.
        recent: u32 = 6, "1", at_least(1.0);
        /// It is gone if such a share of them saw through it.
        share: f64 = 0.6, "1", SHARE;
    }
}

/// A frame of a recording.
#[derive(Debug, Clone)]
struct RecordedFrame {
    time_s: f64,
    points: Vec<([f64; 3], f64)>,
    /// Of each point whether it is of something, and no error of the sensor.
    are_sound: Vec<bool>,
    eye_m: [f64; 2],
}

/// Frames of a recording, to tell what in them is static.
#[derive(Debug, Clone)]
pub struct StaticPoints {
    views_config: ViewsConfig,
    clusters: ClustersConfig,
    gone: GoneConfig,
    frames: Vec<RecordedFrame>,
    views: Vec<RangeView>,
}

impl StaticPoints {
    /// Without a frame.
    pub fn new(
        views: ViewsConfig,
        clusters: ClustersConfig,
        gone: GoneConfig,
    ) -> Result<Self, ConfigError> {
        views.check()?;
        clusters.check()?;
        gone.check()?;
        Ok(Self {
            views_config: views,
            clusters,
            gone,
            frames: Vec::new(),
            views: Vec::new(),
        })
    }

    /// Takes in a frame, later than the last: how far it saw, and its points with their heights above the ground, m in the map frame.
    pub fn insert(&mut self, view: RangeView, points: Vec<([f64; 3], f64)>) {
        let time_s = view.time_s();
        let sound = |&(at_m, height_m): &([f64; 3], f64)| {
            height_m > self.clusters.ground
                && at_m.iter().all(|at| at.is_finite())
                && self.views_config.has_company(&view, at_m)
        };
        self.frames.push(RecordedFrame {
            time_s,
            are_sound: points.iter().map(sound).collect(),
            points,
            eye_m: view.eye_m(),
        });
        let spacing_s = self.views_config.spacing;
        let last = self.views.last().map(RangeView::time_s);
        if last.is_none_or(|last_s| time_s - last_s >= spacing_s) {
            self.views.push(view.prepared(&self.views_config));
        }
    }

    /// Of each frame which of its points are static: of what is there at the end of the recording, and was there all the time that a look is kept
    /// ([`ViewsConfig::memory`]). What stood and went is not, nor what passed; what came and stayed is once it has stood so long.
    pub fn are_static(&self) -> Vec<Vec<bool>> {
        self.frames
            .iter()
            .map(|frame| self.of_frame(frame))
            .collect()
    }

    fn of_frame(&self, frame: &RecordedFrame) -> Vec<bool> {
        let seen = |(&(at_m, height_m), &sound): (&([f64; 3], f64), &bool)| {
            let (moves, stays) = if sound {
                self.fate(frame.time_s, at_m)
            } else {
                (false, true)
            };
            PointOfView {
                at_m,
                height_m,
                moves,
                stays,
                at_side: false,
            }
        };
        let points: Vec<_> = frame
            .points
            .iter()
            .zip(&frame.are_sound)
            .map(seen)
            .collect();
        let mut are_static = vec![true; points.len()];
        for cluster in moving_clusters(&points, frame.eye_m, &self.clusters) {
            for index in cluster.points {
                are_static[index] = false;
            }
        }
        are_static
    }

    /// Whether what is at a point at a time moves, and whether it was seen there more often than not.
    fn fate(&self, time_s: f64, at_m: [f64; 3]) -> (bool, bool) {
        let config = &self.views_config;
        let now = self.views.partition_point(|view| view.time_s() < time_s);
        let kept = |view: &&RangeView| time_s - view.time_s() <= config.memory;
        let mut before = PointLooks::default();
        for view in self.views[..now].iter().rev().take_while(kept) {
            before.add(view, at_m, config);
        }
        let mut last = PointLooks::default();
        for view in self.views[now..].iter().rev() {
            last.add(view, at_m, config);
            if last.through + last.there >= self.gone.recent {
                break;
            }
        }
        let all = f64::from(last.through + last.there);
        let gone = last.through >= config.looks && f64::from(last.through) >= self.gone.share * all;
        let all = PointLooks {
            through: before.through + last.through,
            there: before.there + last.there,
        };
        (before.moves(config) || gone, all.stays())
    }
}
