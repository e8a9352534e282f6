//! The way: A* over cells and over the climbs that join levels, the path that is followed, and reasons to refuse.
//!
//! A way over a floor of your own: cells in, a path out.
//!
//! ```
//! use geometry::{Cell, Goal, Grid, Lattice, Map, Pose, Robot};
//! use mapping::{FloorView, Surface};
//! use planning::{AStar, AStarConfig, Planner};
//! use stairs::{ClimbingConfig, Feet, Staircase};
//!
//! let lattice = Lattice { origin_m: [-1.0, -1.0], cell_m: 0.04 };
//! let mut view = FloorView::new(lattice, Grid::filled(75, 50, Surface::Floor(0.0)), 10);
//! for row in 0..35 {
//!     *view.cells.get_mut(Cell::new(40, row)).unwrap() = Surface::Obstacle(0.5); // a wall with a way round its end
//! }
//! let feet = Feet { length_m: 0.105, pair_width_m: 0.16, stance_m: 0.085 };
//! let mut planner = AStar::new(AStarConfig::default(), ClimbingConfig::default(), feet, 0.12)?;
//! let start = Pose::<Map, Robot>::from_yaw(0.0, -0.5, 0.0, 0.0);
//! let goal = Goal { x_m: 1.5, y_m: -0.5, radius_m: 0.15, height_m: None };
//! let plan = planner.plan(&view, &Staircase::default(), &start, &goal)?;
//! let path = plan.way.expect("a way round the wall");
//! assert!(path.cost_m > 2.0);
//! assert!(path.points_m.iter().any(|[_, y_m]| *y_m > 0.4));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod a_star;
mod built_in;
mod climb_links;
mod config;
pub mod footsteps;
mod guide;
mod outside_window;
mod part;
mod path;
mod plan;
mod refusal;
pub mod search;
mod sideways_passages;
mod steep_slopes;
mod tuning;

pub use a_star::AStar;
pub use config::{AStarConfig, Footprint};
pub use geometry::Goal;
pub use guide::{GuideConfig, GuideTuning, Guided};
pub use part::{PlannerNeeds, PlannerPart};
pub use plan::{Climb, NoWay, Path, PathEnd, Plan, PlanError, Planner, Refusal, Sidle, Step};
pub use terrain::{TerrainConfig, VoronoiConfig};
pub use tuning::PlanningTuning;

/// The planners that come with the crate: a new one is a file beside these, and its lines here.
pub const PARTS: &[PlannerPart] = &[
    built_in::A_STAR,
    built_in::VORONOI,
    built_in::D_STAR_LITE,
    built_in::FIELD_D_STAR,
    built_in::ARA_STAR,
    built_in::VORONOI_GRAPH,
    built_in::HIERARCHICAL,
];
