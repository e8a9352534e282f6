//! Localization and mapping at once: each scan is matched to the local map that is being made, and loops are closed to older ones.

use geometry::{PlanarPose, hypot};
use nalgebra::Matrix3;
use plan_view::PlanarScan;
use settings::{ConfigError, Table};

use crate::config::{LocalMapsConfig, LoopsConfig, PoseGraphConfig, ScanMatchConfig};
use crate::local_map::LocalMap;
use crate::loops::{Loops, Newest};
use crate::matcher::ScanMatcher;
use crate::pose_graph::{PoseGraph, PoseLink};
use crate::spread::{carried, turned};

/// Settings of all parts.
#[derive(Debug, Clone, Default)]
pub struct ScanSlamConfig {
    /// How a scan is matched.
    pub matching: ScanMatchConfig,
    /// What a local map is, and what odometry is worth.
    pub local_maps: LocalMapsConfig,
    /// Which loops are closed.
    pub loops: LoopsConfig,
    /// How the graph is solved.
    pub graph: PoseGraphConfig,
}

/// Why a scan could not be taken in. Nothing is changed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ScanSlamError {
    /// A pose by odometry with a component that is no number.
    #[error("the pose by odometry must be finite")]
    PoseNotFinite,
    /// There would be too many local maps.
    #[error("there would be more than {0} local maps, plan_view.local_maps.most")]
    TooMany(usize),
}

/// A local map that is being made.
#[derive(Debug, Clone, Copy)]
struct Active {
    map: usize,
    /// How the first of those that are being made lies in this one.
    from_first: PlanarPose,
}

/// Finds where scans were taken.
#[derive(Debug, Clone)]
pub struct ScanSlam {
    matcher: ScanMatcher,
    config: LocalMapsConfig,
    solving: PoseGraphConfig,
    loops: Loops,
    graph: PoseGraph,
    maps: Vec<LocalMap>,
    points_m: Vec<Vec<[f64; 2]>>,
    active: Vec<Active>,
    /// The last scan in the first of those, and the covariance of that in its axes.
    here: PlanarPose,
    spread: Matrix3<f64>,
    odometry: PlanarPose,
    /// What ties the scan that comes to local maps that it is no part of.
    departed: Vec<PoseLink>,
    unmatched: usize,
}

/// Standard deviations, m and rad, of the very first scan in its own local map.
const FIRST: [f64; 2] = [1e-3, 1e-4];

impl ScanSlam {
    /// With settings, without a scan.
    pub fn new(config: ScanSlamConfig) -> Result<Self, ConfigError> {
        config.local_maps.check()?;
        config.graph.check()?;
        Ok(Self {
            matcher: ScanMatcher::new(config.matching)?,
            loops: Loops::new(config.loops)?,
            config: config.local_maps,
            solving: config.graph,
            graph: PoseGraph::default(),
            maps: Vec::new(),
            points_m: Vec::new(),
            active: Vec::new(),
            here: PlanarPose::default(),
            spread: diagonal(FIRST),
            odometry: PlanarPose::default(),
            departed: Vec::new(),
            unmatched: 0,
        })
    }

    /// Takes in a scan, placed where odometry says: of those places only the steps from one to the next count.
    pub fn insert(&mut self, scan: &PlanarScan) -> Result<(), ScanSlamError> {
        let odometry = scan.map_from_sensor;
        if ![odometry.x_m, odometry.y_m, odometry.yaw_rad]
            .iter()
            .all(|part| part.is_finite())
        {
            return Err(ScanSlamError::PoseNotFinite);
        }
        if self.maps.len() >= self.config.most && self.is_next_due() {
            return Err(ScanSlamError::TooMany(self.config.most));
        }
        let points_m = self.matcher.points_m(&scan.beams);
        if self.active.is_empty() {
            self.begin_map(odometry);
        } else {
            let fits = self.advance(&self.odometry.relative(&odometry), &points_m);
            let first = self.graph.maps[self.active[0].map];
            let place = first.compose(&self.here);
            if !fits {
                self.leave();
                self.begin_map(place);
            } else if self.is_next_due() {
                self.begin_map(place);
            }
        }
        self.odometry = odometry;
        self.take(points_m);
        let node = self.graph.scans.len() - 1;
        let newest = Newest {
            scan: node,
            points_m: &self.points_m[node],
            map: self.active[0].map,
            spread: &self.spread,
        };
        self.loops
            .look(&self.matcher, &mut self.graph, &self.maps, newest);
        if self.maps[self.active[0].map].scans.len() >= self.config.scans {
            self.close_first();
        }
        Ok(())
    }

    /// Solves the graph a last time.
    pub fn finish(&mut self) {
        if !self.graph.maps.is_empty() {
            let _costs = self.graph.solve(&self.solving);
        }
    }

    /// Where the scan of this number was taken, in the frame in which odometry placed the first one.
    pub fn pose(&self, scan: usize) -> Option<PlanarPose> {
        self.graph.scans.get(scan).copied()
    }

    /// Where all scans were taken.
    pub fn poses(&self) -> &[PlanarPose] {
        &self.graph.scans
    }

    /// Covariance of the last scan's pose in the local map that is being made, in that one's axes: m², m rad, rad².
    pub const fn covariance(&self) -> &Matrix3<f64> {
        &self.spread
    }

    /// The local maps, and where each lies.
    pub fn local_maps(&self) -> impl Iterator<Item = (&LocalMap, &PlanarPose)> {
        self.maps.iter().zip(&self.graph.maps)
    }

    /// What is dense in a local map, m in the map of all: the points of its scans, which keep their places in it wherever it moves.
    pub fn dense_m(&self, map: usize) -> Vec<[f64; 2]> {
        let own = self.graph.links.iter();
        let own = own.filter(|link| link.map == map && !link.is_loop);
        own.flat_map(|link| {
            let pose = self.graph.maps[map].compose(&link.local_from_sensor);
            let points = self.points_m[link.scan].iter();
            points.map(move |point| pose.apply(point[0], point[1]).into())
        })
        .collect()
    }

    /// The graph: what ties scans to local maps, loops among it.
    pub const fn graph(&self) -> &PoseGraph {
        &self.graph
    }

    /// Loops that are closed: matches of a scan to an older local map that the graph believes.
    pub fn closed_loops(&self) -> usize {
        let far2 = self.solving.far * self.solving.far;
        let closed = |link: &&PoseLink| link.is_loop && self.graph.squared_distance(link) <= far2;
        self.graph.links.iter().filter(closed).count()
    }

    /// Scans for which odometry was believed, for they fit nowhere near.
    pub const fn unmatched(&self) -> usize {
        self.unmatched
    }

    fn is_next_due(&self) -> bool {
        let Some(last) = self.active.last() else {
            return true;
        };
        self.maps[last.map].scans.len() >= self.config.scans.div_ceil(2)
    }

    /// Moves by a step of odometry, and to where the scan fits; whether it may be taken into the local map, which one that fits nowhere may not.
    fn advance(&mut self, step: &PlanarPose, points_m: &[[f64; 2]]) -> bool {
        let before = self.here.compose(step);
        let [place, heading] = [
            (self.config.place_noise, hypot(step.x_m, step.y_m)),
            (self.config.heading_noise, step.yaw_rad.abs()),
        ]
        .map(|(noise, by)| noise[0] + noise[1] * by);
        self.spread = carried(&self.spread, &self.here, &before) + diagonal([place, heading]);
        let field = &self.maps[self.active[0].map].field;
        if let Some(found) = self.matcher.follow(field, points_m, &before, &self.spread) {
            (self.here, self.spread) = (found.pose, found.covariance);
            return true;
        }
        self.here = before;
        self.unmatched += 1;
        points_m.is_empty()
    }

    /// Closes the local maps that are being made: the scan that comes is tied to them, and no part of them.
    fn leave(&mut self) {
        let scan = self.graph.scans.len();
        for active in core::mem::take(&mut self.active) {
            self.maps[active.map].close();
            self.departed.push(self.link(&active, scan));
        }
        self.spread = diagonal(FIRST);
    }

    /// How the scan lies in a local map.
    fn link(&self, active: &Active, scan: usize) -> PoseLink {
        let spread = turned(&self.spread, active.from_first.yaw_rad);
        PoseLink {
            map: active.map,
            scan,
            local_from_sensor: active.from_first.compose(&self.here),
            information: spread.try_inverse().unwrap_or_else(Matrix3::zeros),
            is_loop: false,
        }
    }

    fn begin_map(&mut self, map_from_local: PlanarPose) {
        let from_first = if self.active.is_empty() {
            self.here = PlanarPose::default();
            PlanarPose::default()
        } else {
            self.here.inverse()
        };
        self.active.push(Active {
            map: self.maps.len(),
            from_first,
        });
        self.maps.push(LocalMap::new(self.matcher.config()));
        self.graph.maps.push(map_from_local);
    }

    /// Ties the scan to the local maps that are being made, and takes it into them.
    fn take(&mut self, points_m: Vec<[f64; 2]>) {
        let scan = self.graph.scans.len();
        let first = self.graph.maps[self.active[0].map];
        self.graph.scans.push(first.compose(&self.here));
        for link in core::mem::take(&mut self.departed) {
            self.loops.tie(&self.graph, &link);
            self.graph.links.push(link);
        }
        for active in self.active.clone() {
            let link = self.link(&active, scan);
            let map = &mut self.maps[active.map];
            map.scans.push(scan);
            self.matcher
                .insert(&mut map.field, &points_m, &link.local_from_sensor);
            self.loops.tie(&self.graph, &link);
            self.graph.links.push(link);
        }
        self.points_m.push(points_m);
    }

    fn close_first(&mut self) {
        let closed = self.active.remove(0);
        self.maps[closed.map].close();
        // There is a next one: it began at half of this one.
        let from_first = self.active[0].from_first;
        self.here = from_first.compose(&self.here);
        self.spread = turned(&self.spread, from_first.yaw_rad);
        for active in &mut self.active {
            active.from_first = active.from_first.compose(&from_first.inverse());
        }
        if self.loops.take_news() {
            let _costs = self.graph.solve(&self.solving);
        }
    }
}

/// A covariance of standard deviations of a place, m, and a heading, rad.
fn diagonal([place, heading]: [f64; 2]) -> Matrix3<f64> {
    let [place, heading] = [place * place, heading * heading];
    Matrix3::from_diagonal(&nalgebra::Vector3::new(place, place, heading))
}
