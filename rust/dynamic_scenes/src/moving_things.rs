//! What moves among the points of each frame, as it is seen: for maps that leave it out, and for planners that go behind it.

use settings::{ConfigError, Table};

use crate::config::MovingConfig;
use crate::tracks::{ClustersConfig, MovingTrack, MovingTracks, PointOfView, moving_clusters};
use crate::views::{PointLooks, RangeView, ViewMemory};

/// Which points move, frame by frame, and the things that they belong to.
#[derive(Debug, Clone)]
pub struct MovingThings {
    views: ViewMemory,
    clusters: ClustersConfig,
    tracks: MovingTracks,
    time_s: f64,
}

impl MovingThings {
    /// Nothing was seen yet.
    pub fn new(config: MovingConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            views: ViewMemory::new(config.views)?,
            clusters: config.clusters,
            tracks: MovingTracks::new(config.tracks)?,
            time_s: 0.0,
        })
    }

    /// Takes in a frame: how far it saw, and its points with their heights above the ground, m in the map frame. Of each point the number of the thing that
    /// moves and that it is of; none of what stays. Points that are no numbers are of nothing.
    ///
    /// A point moves that looks of the last seconds saw through. What has come and stayed for longer than they are kept is part of the world, and
    /// what stood there from the start and goes is one that moves as soon as it is where it was not.
    pub fn see(
        &mut self,
        view: RangeView,
        points: impl IntoIterator<Item = ([f64; 3], f64)>,
    ) -> Vec<Option<u32>> {
        let config = self.views.config();
        let point = |(at_m, height_m): ([f64; 3], f64)| {
            let sound = height_m > self.clusters.ground
                && at_m.iter().all(|at| at.is_finite())
                && config.has_company(&view, at_m);
            let looks = if sound {
                self.views.looks(at_m)
            } else {
                PointLooks::default()
            };
            PointOfView {
                at_m,
                height_m,
                moves: looks.moves(config),
                stays: looks.stays(),
                at_side: sound && view.is_at_side(at_m, config.beside),
            }
        };
        let points: Vec<_> = points.into_iter().map(point).collect();
        let clusters = moving_clusters(&points, view.eye_m(), &self.clusters);
        self.time_s = view.time_s();
        let ids = self.tracks.update(self.time_s, &clusters);
        let mut of = vec![None; points.len()];
        for (cluster, id) in clusters.iter().zip(ids) {
            for &index in &cluster.points {
                of[index] = Some(id);
            }
        }
        self.views.insert(view);
        of
    }

    /// What is followed.
    pub fn tracks(&self) -> &[MovingTrack] {
        self.tracks.tracks()
    }

    /// What moves for sure, by its number.
    pub fn surely_moves(&self, id: u32) -> bool {
        let mut tracks = self.tracks.tracks().iter();
        tracks.any(|track| track.id == id && track.moves)
    }

    /// Forgets all: the map lies elsewhere.
    pub fn forget(&mut self) {
        self.views.clear();
        self.tracks.clear();
    }
}
