//! Stairs in one frame (003, section IV.B).

use geometry::{Cut, Outline, Point, Robot};
use nalgebra::Point2;
use segmentation::Planes;
use sensing::Intrinsics;

use crate::frame::outer_points::{OuterPoints, OuterRows};
use crate::frame::shared_edges::{SharedEdge, SharedEdges};
use crate::frame::size::{is_cut_short, is_large_enough};
use crate::frame::view::PlanesView;
use crate::frame::visible::{is_solid, seen_ends};
use crate::lines::boundary::side;
use crate::stair::level_edge;
use crate::{Edge, FrameTuning, Stair, StairsConfig, StairsTuning};

/// One stair as one frame shows it.
#[derive(Debug, Clone)]
pub(crate) struct StairSighting {
    /// The stair; its margins are zero.
    pub(crate) stair: Stair<Robot>,
    /// Its whole boundary, robot frame, m.
    pub(crate) hull: Outline,
    /// Whether it is at the robot's own height, with no other surface between.
    pub(crate) own_level: bool,
    /// Whether it is large enough to be a stair by itself, or may be beyond the picture's border.
    pub(crate) large_enough: bool,
}

/// Finds stairs in planes. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(crate) struct Extraction {
    outer_points: OuterPoints,
    shared_edges: SharedEdges,
    /// What the last frame showed: level surfaces that may be stairs, and those that the robot may stand on.
    pub(crate) found: Vec<StairSighting>,
}

impl Extraction {
    /// Finds the level surfaces of a frame.
    pub(crate) fn read(&mut self, planes: &Planes, camera: Intrinsics, config: &StairsConfig) {
        let view = PlanesView::new(planes, camera, &config.tuning.view);
        self.outer_points.read(planes, camera.width);
        self.shared_edges.read(planes, &view, camera.width, config);
        self.found.clear();
        for region in 0..planes.regions.len() {
            let sighting = self.sighting(region, &view, config);
            self.found.extend(sighting);
        }
        // Without the ground in the picture heights are no better than the camera's tilt is known.
        let tilt_rad = match planes.ground {
            Some(_) => 0.0,
            None => config.tuning.frame.tilt,
        };
        for i in 0..self.found.len() {
            self.found[i].own_level = is_own_level(&self.found, i, tilt_rad, config);
        }
        let near = |stair: &Stair<Robot>| stair.seen_from_m <= config.max_distance;
        self.found
            .retain(|sighting| sighting.own_level || near(&sighting.stair));
        for sighting in &mut self.found {
            let stair = &sighting.stair;
            sighting.large_enough =
                is_large_enough(stair, config) || is_cut_short(stair, &view, config);
        }
    }

    fn sighting(
        &mut self,
        index: usize,
        view: &PlanesView<'_>,
        config: &StairsConfig,
    ) -> Option<StairSighting> {
        let tuning = &config.tuning.frame;
        let shared_front = self.shared(view, tuning, |edge| edge.farther == index);
        let surface = LevelSurface::new(index, view, shared_front.as_ref(), tuning)?;
        let reference = surface.reference;
        let front = match &shared_front {
            Some(front) => front.at_height(surface.height_m),
            None => self.front(&surface, view, &config.tuning)?,
        };
        if front.across().dot(&reference.coords) < tuning.faces * reference.coords.norm() {
            return None;
        }
        let parallel = |back: &Edge<Robot>| front.across().dot(&back.across()) > tuning.opposite;
        let shared_back = self.shared(view, tuning, |edge| {
            edge.nearer == index && parallel(&edge.edge)
        });
        let surface = surface.before(shared_back.as_ref())?;
        let back = shared_back.map_or_else(
            || self.back(&surface, view, &config.tuning),
            |back| Some(back.at_height(surface.height_m)),
        );
        let back = match back.filter(parallel) {
            Some(back) => back,
            // A spike of the hull, or no straight side: as the front, through the middle of what is there.
            None => self.outer_points.parallel(
                view,
                (index, OuterRows::Highest),
                &front,
                &config.tuning.lines,
            )?,
        };
        let reference = surface.reference;
        let reference = Point::new(reference.x, reference.y, surface.height_m);
        let mut stair = Stair::seen(front, back, reference, view.region(index).support);
        if !is_solid(&stair, view, &config.tuning) {
            return None;
        }
        let shared = [shared_front.is_some(), shared_back.is_some()];
        stair.seen_ends = seen_ends(&stair, shared, view, config);
        Some(StairSighting {
            stair,
            hull: surface.hull,
            own_level: false,
            large_enough: false,
        })
    }

    /// The side of the hull that the line from the robot enters, without its fringes.
    fn front(
        &mut self,
        surface: &LevelSurface,
        view: &PlanesView<'_>,
        tuning: &StairsTuning,
    ) -> Option<Edge<Robot>> {
        let [enters, _] = surface.cuts()?;
        // Counter-clockwise such a side goes from left to right.
        let [left, right] = side(&surface.hull, enters.edge, surface.fringe_m, &tuning.lines);
        let rough = level_edge([right, left], surface.height_m);
        let rows = (surface.index, OuterRows::Lowest);
        let smooth = self
            .outer_points
            .through(view, rows, &rough, surface.fringe_m, tuning);
        Some(smooth.unwrap_or(rough))
    }

    /// The side of the hull that the line leaves, without its fringes; `None` where it is not straight.
    fn back(
        &mut self,
        surface: &LevelSurface,
        view: &PlanesView<'_>,
        tuning: &StairsTuning,
    ) -> Option<Edge<Robot>> {
        let [_, leaves] = surface.cuts()?;
        let [right, left] = side(&surface.hull, leaves.edge, surface.fringe_m, &tuning.lines);
        let rough = level_edge([right, left], surface.height_m);
        let rows = (surface.index, OuterRows::Highest);
        self.outer_points
            .through(view, rows, &rough, surface.fringe_m, tuning)
    }

    /// The edge to the neighbour with the smallest difference in height, of those edges that are long enough.
    fn shared(
        &self,
        view: &PlanesView<'_>,
        tuning: &FrameTuning,
        wanted: impl Fn(&SharedEdge) -> bool,
    ) -> Option<Edge<Robot>> {
        let of_region = || self.shared_edges.edges.iter().filter(|edge| wanted(edge));
        let longest_m = of_region()
            .map(|edge| edge.edge.length_m())
            .fold(0.0, f64::max);
        let rise_m = |edge: &SharedEdge| {
            let [near, far] = [edge.nearer, edge.farther].map(|at| view.region(at).floor_height_m);
            near.zip(far)
                .map_or(f64::INFINITY, |(near_m, far_m)| (far_m - near_m).abs())
        };
        let long = of_region().filter(|edge| edge.edge.length_m() > tuning.long_enough * longest_m);
        long.min_by(|a, b| rise_m(a).total_cmp(&rise_m(b)))
            .map(|edge| edge.edge)
    }
}

/// A level region without what its hull has in front of its front and behind its back.
struct LevelSurface {
    index: usize,
    height_m: f64,
    hull: Outline,
    reference: Point2<f64>,
    fringe_m: f64,
}

impl LevelSurface {
    fn new(
        index: usize,
        view: &PlanesView<'_>,
        front: Option<&Edge<Robot>>,
        tuning: &FrameTuning,
    ) -> Option<Self> {
        let region = view.region(index);
        let (height_m, hull) = (region.floor_height_m?, region.boundary.clone()?);
        let reference = region.mean.inner.xy();
        let away_m = reference.coords.norm();
        let whole = Self {
            index,
            height_m,
            hull,
            reference,
            fringe_m: view.fringe_m(height_m, away_m),
        };
        let usable = away_m > tuning.nearest && view.looks_down_on(height_m);
        whole
            .cut_off(front.filter(|_| usable), 1.0)
            .filter(|_| usable)
    }

    /// The part before its back.
    fn before(self, back: Option<&Edge<Robot>>) -> Option<Self> {
        self.cut_off(back, -1.0)
    }

    /// The part behind (1) or before (-1) an edge, if there is one.
    fn cut_off(mut self, edge: Option<&Edge<Robot>>, side: f64) -> Option<Self> {
        let Some(edge) = edge else {
            return Some(self);
        };
        let at = edge.middle().inner.xy();
        self.hull = self.hull.cut_off(&at, &(edge.across() * side)).ok()?;
        if !self.hull.contains(&self.reference) {
            // It lies around what stands before it.
            let corners = self.hull.corners();
            self.reference = nalgebra::center(&corners[0], &corners[corners.len() / 2]);
        }
        Some(self)
    }

    /// Where the line from the robot through the reference point enters and leaves it.
    fn cuts(&self) -> Option<[Cut; 2]> {
        self.hull.cuts(&self.reference, &self.reference.coords)
    }
}

/// Whether the surface is at the robot's own height, as far as can be told by a camera that may be tilted by `tilt_rad`, with nothing
/// of another height on the way to it.
fn is_own_level(
    found: &[StairSighting],
    index: usize,
    tilt_rad: f64,
    config: &StairsConfig,
) -> bool {
    let tuning = &config.tuning.frame;
    let stair = &found[index].stair;
    let own = |stair: &Stair<Robot>| {
        stair.height_m().abs() < config.own_height + tilt_rad * stair.seen_from_m
    };
    let to = stair.reference.inner.xy();
    let from_robot_m = |place: &Point2<f64>| place.coords.dot(&to.coords.normalize());
    let cuts_m = |hull: &Outline| {
        let cuts = hull.cuts(&to, &to.coords)?;
        Some(cuts.map(|cut| from_robot_m(&cut.at)))
    };
    let reach_m = cuts_m(&found[index].hull).map_or(0.0, |[enters_m, _]| enters_m);
    let between = |other: &StairSighting| {
        cuts_m(&other.hull).is_some_and(|[enters_m, leaves_m]| {
            let deep = leaves_m - enters_m > config.min_depth * tuning.side_depth;
            let before = enters_m > 0.0 && leaves_m < reach_m + tuning.overlap;
            deep && before && !own(&other.stair)
        })
    };
    own(stair) && !found.iter().any(between)
}
