//! Loops: a scan that fits an older local map, where it may be by what is known of the way between, and of which another scan says the same.

use std::collections::BTreeSet;

use geometry::{Cell, PlanarPose};
use settings::{ConfigError, Table};

use crate::config::LoopsConfig;
use crate::local_map::LocalMap;
use crate::matcher::{ScanMatch, ScanMatcher};
use crate::maxima::{BRANCH, FieldMaxima};
use crate::pose_graph::{PoseGraph, PoseLink};
use crate::spread::{Spread, Tie, carried, spreads_from, turned};

/// A match to an older local map, and whether it is believed.
#[derive(Debug, Clone)]
struct LoopClaim {
    link: PoseLink,
    believed: bool,
}

/// The newest scan: its number and points, m in the sensor's frame, a local map that it is tied to, and the covariance of its pose there.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Newest<'a> {
    pub(crate) scan: usize,
    pub(crate) points_m: &'a [[f64; 2]],
    pub(crate) map: usize,
    pub(crate) spread: &'a Spread,
}

/// Looks for loops.
#[derive(Debug, Clone)]
pub(crate) struct Loops {
    config: LoopsConfig,
    seen: Vec<LoopClaim>,
    last: Option<PlanarPose>,
    ties: Vec<Tie>,
    ties_of: Vec<Vec<usize>>,
    tied: BTreeSet<[usize; 2]>,
    news: bool,
}

impl Loops {
    pub(crate) fn new(config: LoopsConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            config,
            seen: Vec::new(),
            last: None,
            ties: Vec::new(),
            ties_of: Vec::new(),
            tied: BTreeSet::new(),
            news: false,
        })
    }

    /// Whether loops were closed since it was last asked.
    pub(crate) const fn take_news(&mut self) -> bool {
        core::mem::replace(&mut self.news, false)
    }

    /// Remembers that a link, which the graph does not have yet, ties its local map to those that its scan is tied to already.
    pub(crate) fn tie(&mut self, graph: &PoseGraph, link: &PoseLink) {
        self.ties_of.resize(graph.maps.len(), Vec::new());
        let spread = |link: &PoseLink| {
            let local = link.information.try_inverse()?;
            Some(turned(&local, graph.maps[link.map].yaw_rad))
        };
        // Links of one scan lie together but for its loops, which are few: the last ones are enough.
        let others = graph.links.iter().rev();
        let others = others.take_while(|other| other.scan == link.scan);
        for other in others {
            let maps = [other.map.min(link.map), other.map.max(link.map)];
            let (Some(one), Some(another)) = (spread(link), spread(other)) else {
                continue;
            };
            if maps[0] == maps[1] || !self.tied.insert(maps) {
                continue;
            }
            let tie = Tie {
                maps,
                node: link.scan,
                spread: one + another,
            };
            for map in maps {
                self.ties_of[map].push(self.ties.len());
            }
            self.ties.push(tie);
        }
    }

    /// Looks for older local maps that the newest scan fits, and ties it to those that another scan fits alike.
    pub(crate) fn look(
        &mut self,
        matcher: &ScanMatcher,
        graph: &mut PoseGraph,
        maps: &[LocalMap],
        newest: Newest<'_>,
    ) {
        let pose = graph.scans[newest.scan];
        if !self.config.close || newest.points_m.is_empty() || !self.is_due(&pose) {
            return;
        }
        for (map, spread) in self.candidates(graph, maps, newest) {
            let before = graph.maps[map].relative(&pose);
            let known = (&before, &spread);
            let Some(found) = self.find(matcher, &maps[map], newest.points_m, known) else {
                continue;
            };
            let link = PoseLink {
                map,
                scan: newest.scan,
                local_from_sensor: found.pose,
                information: found.information,
                is_loop: true,
            };
            self.judge(graph, link);
        }
    }

    fn is_due(&mut self, pose: &PlanarPose) -> bool {
        let [far_m, far_rad] = self.config.apart;
        let due = self.last.is_none_or(|last| {
            let moved = last.relative(pose);
            geometry::hypot(moved.x_m, moved.y_m) >= far_m || moved.yaw_rad.abs() >= far_rad
        });
        if due {
            self.last = Some(*pose);
        }
        due
    }

    /// The older local maps that a scan may fit best, as far as large blocks of cells tell, each with the covariance of the scan in it.
    fn candidates(
        &self,
        graph: &PoseGraph,
        maps: &[LocalMap],
        newest: Newest<'_>,
    ) -> Vec<(usize, Spread)> {
        let pose = graph.scans[newest.scan];
        let spread = turned(newest.spread, graph.maps[newest.map].yaw_rad);
        let start = (newest.map, &pose, &spread);
        let (ties, ties_of) = (&self.ties, &self.ties_of);
        let spreads = spreads_from(start, &graph.maps, &graph.scans, ties, ties_of);
        let mut found = Vec::new();
        for (map, local) in maps.iter().enumerate() {
            let (Some(maxima), Some(spread)) = (&local.maxima, spreads[map]) else {
                continue;
            };
            let last = local.scans.last();
            if last.is_none_or(|last| last + local.scans.len() > newest.scan) {
                continue;
            }
            let local_from_sensor = graph.maps[map].relative(&pose);
            let fits = fits_at_most(local, maxima, &local_from_sensor, newest.points_m);
            let spread = carried(&spread, &graph.maps[map], &pose);
            found.push((fits, map, turned(&spread, -graph.maps[map].yaw_rad)));
        }
        // Of equals the older one.
        found.sort_by_key(|&(fits, map, _)| (core::cmp::Reverse(fits), map));
        let best = found.into_iter().take(self.config.candidates);
        best.map(|(_, map, spread)| (map, spread)).collect()
    }

    fn find(
        &self,
        matcher: &ScanMatcher,
        local: &LocalMap,
        points_m: &[[f64; 2]],
        known: (&PlanarPose, &Spread),
    ) -> Option<ScanMatch> {
        let config = &self.config;
        let half = [0, 1, 2].map(|axis| {
            let [least, most] = if axis < 2 { config.reach } else { config.turn };
            (config.within * known.1[(axis, axis)].max(0.0).sqrt()).clamp(least, most)
        });
        let field = (&local.field, local.maxima.as_ref());
        let found = matcher.find(field, points_m, known, half, config.least_score)?;
        (found.score >= config.least_score).then_some(found)
    }

    /// Closes a loop of which another scan that was taken not long before says the same, and that one with it.
    fn judge(&mut self, graph: &mut PoseGraph, link: PoseLink) {
        let [near_m, near_rad] = self.config.agree;
        let since = link.scan.saturating_sub(self.config.agree_within);
        let here = graph.scans[link.scan];
        let recent = self.seen.iter_mut().rev();
        let recent = recent.take_while(|one| one.link.scan >= since);
        let mut believed = Vec::new();
        for one in recent.filter(|one| one.link.map == link.map && one.link.scan < link.scan) {
            let step = graph.scans[one.link.scan].relative(&here);
            let said = one.link.local_from_sensor.compose(&step);
            let off = said.relative(&link.local_from_sensor);
            if geometry::hypot(off.x_m, off.y_m) > near_m || off.yaw_rad.abs() > near_rad {
                continue;
            }
            if !one.believed {
                one.believed = true;
                believed.push(one.link.clone());
            }
            believed.push(link.clone());
            break;
        }
        self.news |= !believed.is_empty();
        self.seen.push(LoopClaim {
            believed: !believed.is_empty(),
            link,
        });
        for link in believed {
            self.tie_loop(graph, &link);
            graph.links.push(link);
        }
    }

    /// Remembers that a loop ties its local map to one that the scan was taken into.
    fn tie_loop(&mut self, graph: &PoseGraph, link: &PoseLink) {
        let own = graph.links.iter();
        let Some(own) = own.rev().find(|own| own.scan == link.scan && !own.is_loop) else {
            return;
        };
        let maps = [own.map.min(link.map), own.map.max(link.map)];
        let spreads = [own, link].map(|link| {
            let local = link.information.try_inverse()?;
            Some(turned(&local, graph.maps[link.map].yaw_rad))
        });
        let [Some(one), Some(other)] = spreads else {
            return;
        };
        if maps[0] == maps[1] || !self.tied.insert(maps) {
            return;
        }
        for map in maps {
            self.ties_of[map].push(self.ties.len());
        }
        self.ties.push(Tie {
            maps,
            node: link.scan,
            spread: one + other,
        });
    }
}

/// What the likelihoods of points are at most together, wherever in a block of cells around its pose a scan was taken.
fn fits_at_most(
    local: &LocalMap,
    maxima: &FieldMaxima,
    pose: &PlanarPose,
    points_m: &[[f64; 2]],
) -> u32 {
    let top = maxima.height();
    let half = BRANCH.pow(top as u32) / 2;
    let bounds = points_m.iter().map(|point| {
        let (x_m, y_m) = pose.apply(point[0], point[1]);
        let cell = local.field.lattice().cell_at(x_m, y_m);
        u32::from(maxima.bound(top, Cell::new(cell.col - half, cell.row - half)))
    });
    bounds.sum()
}
