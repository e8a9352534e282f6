//! Topological maps (004, section 36.2.3): the generalized Voronoi diagram of the free cells as a graph of places and of ways between
//! them, planning on it, and rooms with the doorways between them.

mod cells;
mod graph;
mod nearest;
mod plan;
mod ring;
mod rooms;
mod skeleton;

use geometry::{Cell, Grid, Lattice};
use petgraph::algo::is_isomorphic;
use petgraph::graph::UnGraph;
use settings::{ConfigError, POSITIVE, Table as _, at_least, between, settings};

use graph::graph_of;
use skeleton::Skeleton;

pub use cells::VoronoiCells;
pub use plan::GraphPlan;
pub use rooms::{Doorway, Rooms};

settings! {
    /// The generalized Voronoi diagram as a graph (004, section 36.2.3).
    pub struct VoronoiGraphConfig("plan_view.topology") {
        /// A branch ends where the two nearest obstacles lie less than this apart, seen from it: in corners none begins.
        angle: f64 = 2.4, "rad", between(0.0, std::f64::consts::PI);
        /// Nearer to anything than this, centre to centre, nobody goes, and the graph has no ways.
        clearance: f64 = 0.2, "m", at_least(0.0);
        /// A branch that ends within so many times the clearance of the place that it hangs on is none: to a corner it is the root of two.
        branch: f64 = 2.0, "1", at_least(0.0);
        /// A doorway is no wider than this.
        doorway: f64 = 1.3, "m", POSITIVE;
        /// On both sides of a doorway there is so many times its width somewhere.
        widens: f64 = 1.4, "1", at_least(1.0);
        /// What is smaller is no room of its own.
        room: f64 = 1.0, "m²", POSITIVE;
    }
}

/// A place where ways meet or end.
#[derive(Debug, Clone, PartialEq)]
pub struct GraphPlace {
    /// Where it is farthest from everything, in the frame of the map, metres.
    pub position_m: [f64; 2],
    /// From there to the nearest cell that is not free, centre to centre, metres.
    pub clearance_m: f64,
    /// Ways that begin there: three or more at a meet point, one at an end; two only where a ring has no other place.
    pub degree: usize,
}

/// A way between two places, along which the two nearest obstacles are equally far.
#[derive(Debug, Clone, PartialEq)]
pub struct GraphWay {
    /// Indices of the places that it joins, equal for a ring.
    pub places: [usize; 2],
    /// Its cells' centres from the first place to the second, those included, metres.
    pub path_m: Vec<[f64; 2]>,
    /// Length, metres.
    pub length_m: f64,
    /// Where it is narrowest: distance to the nearest cell that is not free, centre to centre, metres.
    pub clearance_m: f64,
}

/// The generalized Voronoi diagram of the free cells of a map, and the graph that it is.
///
/// It says of any two places and any clearance what the cells say: whether a way between them keeps it.
#[derive(Debug, Clone)]
pub struct VoronoiGraph {
    config: VoronoiGraphConfig,
    lattice: Lattice,
    size: [usize; 2],
    skeleton: Skeleton,
    graph: UnGraph<(), ()>,
    places: Vec<GraphPlace>,
    ways: Vec<GraphWay>,
}

impl VoronoiGraph {
    /// Of the cells that are free. What is outside of the grid is not.
    pub fn new(
        config: VoronoiGraphConfig,
        lattice: Lattice,
        free: &Grid<bool>,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        let size = [free.cols(), free.rows()];
        let cols = size[0] + 2;
        let mut padded = vec![false; cols * (size[1] + 2)];
        for (row, values) in free.values().chunks_exact(size[0].max(1)).enumerate() {
            padded[(row + 1) * cols + 1..][..size[0]].copy_from_slice(values);
        }
        let least_cells = config.clearance / lattice.cell_m;
        let skeleton = Skeleton::of(&padded, cols, config.angle, least_cells);
        let passable = skeleton.at_least(least_cells);
        let mut found = Self {
            config,
            lattice,
            size,
            skeleton,
            graph: UnGraph::default(),
            places: Vec::new(),
            ways: Vec::new(),
        };
        let graph = graph_of(&passable, found.config.branch);
        found.places = graph
            .node_indices()
            .map(|node| GraphPlace {
                position_m: found.center_of(graph[node].cells[0]),
                clearance_m: found.clearance_of(graph[node].cells[0]),
                degree: graph.neighbors(node).count() + graph.edges_connecting(node, node).count(),
            })
            .collect();
        found.ways = graph
            .edge_indices()
            .filter_map(|edge| {
                let (one, other) = graph.edge_endpoints(edge)?;
                let ends = [graph[one].cells[0], graph[other].cells[0]];
                Some(found.way([one.index(), other.index()], ends, &graph[edge].cells))
            })
            .collect();
        found.graph = graph.map(|_, _| (), |_, _| ());
        Ok(found)
    }

    /// Places, in the order of their cells.
    pub fn places(&self) -> &[GraphPlace] {
        &self.places
    }

    /// Ways between them.
    pub fn ways(&self) -> &[GraphWay] {
        &self.ways
    }

    /// Cells of the diagram, row by row, those that are too narrow for the graph among them, and branches that are too short.
    pub fn cells(&self) -> impl Iterator<Item = Cell> {
        let kept = self.skeleton.kept.iter().enumerate();
        kept.filter(|(_, kept)| **kept)
            .map(|(at, _)| self.cell_of(at))
    }

    /// From a point's cell to the nearest one that is not free, centre to centre, metres; 0 where the point's is not.
    pub fn clearance_m(&self, point_m: [f64; 2]) -> f64 {
        self.index_at(point_m)
            .map_or(0.0, |at| self.clearance_of(at))
    }

    /// Whether another graph has the same places and ways, wherever they are: as many, joined alike.
    pub fn is_like(&self, other: &Self) -> bool {
        is_isomorphic(&self.graph, &other.graph)
    }

    fn way(&self, places: [usize; 2], ends: [usize; 2], cells: &[usize]) -> GraphWay {
        let all = || {
            [ends[0]]
                .into_iter()
                .chain(cells.iter().copied())
                .chain([ends[1]])
        };
        let path_m: Vec<[f64; 2]> = all().map(|at| self.center_of(at)).collect();
        GraphWay {
            places,
            length_m: length_m(&path_m),
            path_m,
            clearance_m: all()
                .map(|at| self.clearance_of(at))
                .fold(f64::INFINITY, f64::min),
        }
    }

    /// Index in the padded grid of the cell that holds a point.
    fn index_at(&self, point_m: [f64; 2]) -> Option<usize> {
        let cell = self.lattice.cell_at(point_m[0], point_m[1]);
        let within = |at: i32, size: usize| usize::try_from(at).ok().filter(|&at| at < size);
        let (col, row) = (
            within(cell.col, self.size[0])?,
            within(cell.row, self.size[1])?,
        );
        Some((row + 1) * self.skeleton.cols + col + 1)
    }

    fn cell_of(&self, at: usize) -> Cell {
        let cols = self.skeleton.cols;
        Cell::new((at % cols) as i32 - 1, (at / cols) as i32 - 1)
    }

    fn center_of(&self, at: usize) -> [f64; 2] {
        self.lattice.center_of(self.cell_of(at))
    }

    fn clearance_of(&self, at: usize) -> f64 {
        f64::from(self.skeleton.nearest.squared[at]).sqrt() * self.lattice.cell_m
    }
}

/// Length of a line through points, metres.
fn length_m(path_m: &[[f64; 2]]) -> f64 {
    let steps = path_m.windows(2);
    steps
        .map(|pair| libm::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]))
        .sum()
}
