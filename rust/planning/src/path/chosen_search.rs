//! How the way to the goal is looked for: by the search that was chosen, over the same cells, links and ends as any other.
//!
//! All other questions of the planner, where nothing leads to the goal, are A*'s. So is this one where a search cannot answer it: D* Lite
//! and Field D* have no links between cells (stairs, passages), and no ways out of the window and back.

use geometry::Lattice;
use terrain::Terrain;

use super::ends::{PathEnds, run};
use crate::climb_links::{ClimbLinks, Fit};
use crate::search::ara_star::{AraStar, AraStarConfig};
use crate::search::d_star_lite::{Asked, DStarLite, DStarLiteConfig};
use crate::search::field_d_star::{FieldDStar, FieldDStarConfig};
use crate::search::hierarchical::{HierarchicalConfig, HierarchicalSearch};
use crate::search::kept::{KeptRoute, WeightChange};
use crate::search::voronoi_graph::{VoronoiGraphPlannerConfig, VoronoiGraphSearch};
use crate::search::{Graph, Route, Search};

/// The search that was chosen, with what it keeps from one plan to the next.
#[derive(Debug, Clone)]
pub(crate) enum ChosenSearch {
    /// A*, unless the way before is provably still a cheapest one.
    AStar(Kept),
    /// D* Lite or Delayed D*; where its cells lie, and the share of changed cells from which it begins anew.
    DStarLite(Box<DStarLite>, SearchedCells, f64),
    /// Field D*, likewise.
    FieldDStar(Box<FieldDStar>, SearchedCells, f64),
    /// ARA*.
    AraStar(Box<AraStar>, AraStarConfig),
    /// A* over the generalized Voronoi diagram and the ways to it and from it.
    VoronoiGraph(VoronoiGraphSearch),
    /// A graph of places over local maps, then A* over those on its way.
    Hierarchical(Box<HierarchicalSearch>),
}

impl Default for ChosenSearch {
    fn default() -> Self {
        Self::AStar(Kept::default())
    }
}

impl ChosenSearch {
    pub(crate) fn d_star_lite(config: &DStarLiteConfig) -> Self {
        let search = Box::new(DStarLite::new(config.delayed));
        Self::DStarLite(search, SearchedCells::default(), config.anew)
    }

    pub(crate) fn field_d_star(config: &FieldDStarConfig) -> Self {
        let search = Box::new(FieldDStar::new(config.pieces));
        Self::FieldDStar(search, SearchedCells::default(), config.anew)
    }

    pub(crate) fn ara_star(config: AraStarConfig) -> Self {
        Self::AraStar(Box::default(), config)
    }

    pub(crate) const fn voronoi_graph(config: VoronoiGraphPlannerConfig) -> Self {
        Self::VoronoiGraph(VoronoiGraphSearch::new(config))
    }

    pub(crate) fn hierarchical(config: HierarchicalConfig) -> Self {
        Self::Hierarchical(Box::new(HierarchicalSearch::new(config)))
    }

    /// The weights of the ground over which a route that was found may be straightened.
    pub(crate) fn ground<'a>(&'a self, terrain: &'a Terrain, route: &Route) -> &'a [f32] {
        match self {
            Self::VoronoiGraph(search) if search.holds(route) => search.weights(),
            _ => &terrain.weights,
        }
    }

    /// Forgets what is kept from plan to plan.
    pub(crate) fn forget(&mut self) {
        match self {
            Self::AStar(kept) => kept.forget(),
            Self::DStarLite(search, ..) => search.forget(),
            Self::FieldDStar(search, ..) => search.forget(),
            Self::AraStar(..) | Self::VoronoiGraph(..) | Self::Hierarchical(..) => {}
        }
    }

    /// The way to the goal over what is known to fit; `plain` is A*.
    pub(crate) fn run(
        &mut self,
        plain: &mut Search,
        (terrain, links): (&Terrain, &ClimbLinks),
        ends: &PathEnds<'_>,
        start: usize,
    ) -> Option<Route> {
        let alone = links.links.is_empty() && !ends.around;
        let by_a_star = |plain: &mut Search| run(plain, terrain, links, ends, start, Fit::Holds);
        let question = |ends| Asked {
            weights: &terrain.weights,
            cols: terrain.cols,
            start,
            ends,
        };
        let graph = Graph {
            weights: &terrain.weights,
            cols: terrain.cols,
            links: Some(&links.links),
        };
        let fits = |link: usize| links.way(link).fit <= Fit::Holds;
        let (cost, remaining) = (|cell| ends.cost(cell), |cell| ends.remaining(cell));
        match self {
            Self::AStar(kept) if alone && ends.inside => {
                let all = ends.all();
                let now = question(&all);
                kept.run(&terrain.lattice, now, remaining, || by_a_star(plain))
            }
            Self::AStar(kept) => {
                kept.forget();
                by_a_star(plain)
            }
            Self::DStarLite(search, window, anew) if alone => {
                if let Some((cols, rows)) = window.move_to(terrain) {
                    search.shift(cols, rows);
                }
                search.run(question(&ends.all()), *anew)
            }
            Self::FieldDStar(search, window, anew) if alone => {
                if let Some((cols, rows)) = window.move_to(terrain) {
                    search.shift(cols, rows);
                }
                search.run(question(&ends.all()), *anew)
            }
            Self::DStarLite(..) | Self::FieldDStar(..) => by_a_star(plain),
            Self::AraStar(search, config) => {
                let costs = (cost, remaining);
                let found = search.run(graph, fits, start, costs, config)?;
                Some(found.route)
            }
            Self::VoronoiGraph(search) => {
                let all = ends.all();
                let begin_and_end = all.iter().map(|&(cell, _)| cell as usize).chain([start]);
                let laid = Graph {
                    weights: search.lay(graph, begin_and_end),
                    ..graph
                };
                plain.run_linked(laid, fits, start, cost, remaining)
            }
            Self::Hierarchical(search) => {
                let (with, question) = ((plain, graph.links), (cost, remaining));
                search.read(graph.weights, graph.cols);
                search.run(with, fits, start, &ends.all(), question)
            }
        }
    }
}

/// Where the cells of a search lie.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SearchedCells {
    lattice: Lattice,
    size: [usize; 2],
}

impl SearchedCells {
    /// Lies where the terrain does; says by how many columns and rows it has moved, where it has and nothing else has changed.
    fn move_to(&mut self, terrain: &Terrain) -> Option<(isize, isize)> {
        let now = Self {
            lattice: terrain.lattice,
            size: [terrain.cols, terrain.rows],
        };
        let before = std::mem::replace(self, now);
        let cell_m = now.lattice.cell_m;
        let [cols, rows] = [0, 1].map(|axis| {
            let moved_m = now.lattice.origin_m[axis] - before.lattice.origin_m[axis];
            (moved_m / cell_m).round() as isize
        });
        let moved = (cols, rows) != (0, 0);
        (moved && before.size == now.size && before.lattice.cell_m == cell_m)
            .then_some((cols, rows))
    }
}

/// The way before, and the ground on which it was a cheapest one.
#[derive(Debug, Clone, Default)]
pub(crate) struct Kept {
    way: KeptRoute,
    lattice: Lattice,
    weights: Vec<f32>,
    cols: usize,
    ends: Vec<(u32, f64)>,
}

impl Kept {
    fn forget(&mut self) {
        self.way.forget();
        self.weights.clear();
    }

    /// What is left of the way before where the ground lies as it did, ends where it did, and changed in no way that matters.
    fn stands(
        &mut self,
        lattice: &Lattice,
        now: Asked<'_>,
        remaining: impl Fn(usize) -> f64,
    ) -> Option<Route> {
        let same = self.lattice == *lattice
            && (self.cols, self.weights.len()) == (now.cols, now.weights.len())
            && self.ends == now.ends;
        if !same {
            return None;
        }
        let pairs = self.weights.iter().zip(now.weights).enumerate();
        let changes = pairs.filter(|(_, (before, after))| before != after);
        let changes = changes.map(|(cell, (&before, &after))| WeightChange {
            cell,
            before,
            after,
        });
        let route = self.way.stands(now.start, changes, remaining)?;
        self.weights.copy_from_slice(now.weights);
        Some(route)
    }

    /// The way before where it stands, else a new one, which is kept.
    fn run(
        &mut self,
        lattice: &Lattice,
        now: Asked<'_>,
        remaining: impl Fn(usize) -> f64,
        anew: impl FnOnce() -> Option<Route>,
    ) -> Option<Route> {
        let stands = self.stands(lattice, now, remaining);
        stands.or_else(|| {
            let route = anew();
            self.keep(route.as_ref(), lattice, now);
            route
        })
    }

    fn keep(&mut self, route: Option<&Route>, lattice: &Lattice, now: Asked<'_>) {
        self.forget();
        let Some(route) = route else {
            return;
        };
        self.way.keep(route, now.weights, now.cols);
        (self.lattice, self.cols) = (*lattice, now.cols);
        self.weights.extend_from_slice(now.weights);
        self.ends.clear();
        self.ends.extend_from_slice(now.ends);
    }
}
