//! Courses with levels: what the world model and the recognizer show of them.

use geometry::{Grid, Lattice, Map, Point, Pose};
use mapping::{FloorView, Surface};
use planning::{AStar, AStarConfig, Goal, Path, Plan, Planner, Refusal};
use stairs::{ClimbingConfig, Edge, EdgeFit, Feet, Sides, Stair, Staircase};

pub(crate) const FEET: Feet = Feet {
    length_m: 0.105,
    pair_width_m: 0.16,
    stance_m: 0.085,
};
const SURE: Option<EdgeFit> = Some(EdgeFit {
    frames: 8,
    place_sigma_m: 0.002,
    heading_sigma_rad: 0.01,
});

/// A view and the stairs in it.
pub(crate) struct Course {
    pub(crate) view: FloorView,
    pub(crate) stairs: Staircase,
}

impl Course {
    /// A window of floor, 4 m a side, around the origin.
    pub(crate) fn floor() -> Self {
        Self {
            view: FloorView::new(
                Lattice {
                    origin_m: [-2.0, -2.0],
                    cell_m: 0.04,
                },
                Grid::filled(100, 100, Surface::Floor(0.0)),
                9,
            ),
            stairs: Staircase::default(),
        }
    }

    /// Stairs between walls a metre apart.
    pub(crate) fn stage() -> Self {
        let mut course = Self::floor();
        course.wall_in(0.5);
        course
    }

    /// Steps of equal height from x = 1 on, the last one a landing 33 cm deep.
    pub(crate) fn staircase(steps: usize, rise_m: f64, width_m: f64) -> Self {
        let mut course = Self::floor();
        for i in 0..steps {
            let x = 1.0 + 0.12 * i as f64;
            let depth_m = if i + 1 == steps { 0.33 } else { 0.12 };
            course.stair(x, depth_m, rise_m * (i + 1) as f64, width_m);
        }
        course
    }

    /// Stairs without a landing, across a stage.
    pub(crate) fn in_the_air(steps: usize, rise_m: f64) -> Self {
        let mut course = Self::floor();
        for i in 0..steps {
            course.stair(1.0 + 0.12 * i as f64, 0.12, rise_m * (i + 1) as f64, 1.0);
        }
        course
    }

    /// A level block around y = 0, seen by both.
    pub(crate) fn stair(&mut self, x_m: f64, depth_m: f64, height_m: f64, width_m: f64) {
        let half_m = 0.5 * width_m;
        let surface = Surface::Floor(height_m as f32);
        self.paint([x_m, -half_m], [x_m + depth_m, half_m], surface);
        self.stairs
            .stairs
            .push(stair(x_m, depth_m, height_m, width_m));
    }

    pub(crate) fn sill(&mut self, x_m: f64, depth_m: f64, height_m: f64, width_m: f64) {
        self.stair(x_m, depth_m, height_m, width_m);
    }

    /// All floor is at this height but a gap across the stage at x.
    pub(crate) fn basin(&mut self, x_m: f64, depth_m: f64, height_m: f64) {
        let high = Surface::Floor(height_m as f32);
        self.paint([-2.0, -0.5], [2.0, 0.5], high);
        let low = Surface::Floor(0.0);
        self.paint([x_m, -0.5], [x_m + depth_m, 0.5], low);
        let bottom = stair(x_m, depth_m, 0.0, 1.0);
        self.stairs.stairs.push(bottom);
        let beyond = stair(x_m + depth_m, 0.5, height_m, 1.0);
        self.stairs.stairs.push(Stair {
            back_fit: None,
            ..beyond
        });
    }

    /// Walls along x at both sides.
    pub(crate) fn wall_in(&mut self, half_m: f64) {
        let wall = Surface::Obstacle(0.5);
        self.paint([-2.0, half_m], [2.0, half_m + 0.08], wall);
        self.paint([-2.0, -half_m - 0.08], [2.0, -half_m], wall);
    }

    pub(crate) fn forget(&mut self, min: [f64; 2], max: [f64; 2]) {
        self.paint(min, max, Surface::Unknown);
    }

    /// Sets all cells whose centre lies in the rectangle.
    pub(crate) fn paint(&mut self, min: [f64; 2], max: [f64; 2], surface: Surface) {
        for cell in self.view.cells.area().cells() {
            let [x, y] = self.view.lattice.center_of(cell);
            let inside = x > min[0] && x < max[0] && y > min[1] && y < max[1];
            if let Some(slot) = self.view.cells.get_mut(cell).filter(|_| inside) {
                *slot = surface;
            }
        }
    }
}

/// A stair that is crossed along x, its middle at y = 0.
pub(crate) fn stair(x_m: f64, depth_m: f64, height_m: f64, width_m: f64) -> Stair<Map> {
    let edge = |x_m: f64| Edge {
        left: Point::new(x_m, 0.5 * width_m, height_m),
        right: Point::new(x_m, -0.5 * width_m, height_m),
    };
    Stair {
        front: edge(x_m),
        back: edge(x_m + depth_m),
        reference: Point::new(x_m + 0.5 * depth_m, 0.0, height_m),
        left_margin_m: 0.0,
        right_margin_m: 0.0,
        support: 500,
        seen_ends: Sides {
            front: 500,
            back: 500,
            left: 500,
            right: 500,
        },
        front_fit: SURE,
        back_fit: SURE,
        seen_from_m: 0.3,
        steps_ago: 0,
    }
}

/// Moves a stair along x and up.
pub(crate) fn shift(stair: &mut Stair<Map>, by_m: f64, up_m: f64) {
    *stair = stair.transformed(&Pose::from_yaw(by_m, 0.0, up_m, 0.0));
}

pub(crate) fn goal(x_m: f64, y_m: f64) -> Goal {
    Goal {
        x_m,
        y_m,
        radius_m: 0.15,
        height_m: None,
    }
}

pub(crate) fn goal_at(x_m: f64, y_m: f64, height_m: f64) -> Goal {
    Goal {
        height_m: Some(height_m),
        ..goal(x_m, y_m)
    }
}

pub(crate) fn planner() -> AStar {
    AStar::new(
        // Every level counts as seen from near by.
        AStarConfig {
            judge_range: 10.0,
            ..AStarConfig::default()
        },
        ClimbingConfig::default(),
        FEET,
        0.14,
    )
    .unwrap()
}

pub(crate) fn plan(
    planner: &mut AStar,
    course: &Course,
    [x_m, y_m, z_m]: [f64; 3],
    yaw_rad: f64,
    goal: &Goal,
) -> Plan {
    let start = Pose::from_yaw(x_m, y_m, z_m, yaw_rad);
    planner
        .plan(&course.view, &course.stairs, &start, goal)
        .unwrap()
}

pub(crate) fn way_from(course: &Course, at: [f64; 3], yaw_rad: f64, goal: &Goal) -> Path {
    plan(&mut planner(), course, at, yaw_rad, goal).way.unwrap()
}

pub(crate) fn way(course: &Course, yaw_rad: f64, goal: &Goal) -> Path {
    way_from(course, [0.0; 3], yaw_rad, goal)
}

pub(crate) fn refused_from(course: &Course, at: [f64; 3], goal: &Goal) -> (Refusal, String) {
    let no_way = plan(&mut planner(), course, at, 0.0, goal).way.unwrap_err();
    (no_way.refusal, no_way.sentence)
}

pub(crate) fn refused(course: &Course, yaw_rad: f64, goal: &Goal) -> (Refusal, String) {
    let plan = plan(&mut planner(), course, [0.0; 3], yaw_rad, goal);
    let no_way = plan.way.unwrap_err();
    (no_way.refusal, no_way.sentence)
}
