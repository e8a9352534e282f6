//! Test support: a point that walks over a plane of cells, sees what its gaze covers, and plans by Dijkstra.

mod eyes;

use std::collections::BinaryHeap;

use geometry::{Cell, Grid, Lattice, PlanarPose, Pose};
use localization::Estimate;
use mapping::{FloorView, Surface};
use planning::{AStar, Goal, NoWay, Path, Plan, Planner, Refusal};
use robot::Extent;
use stairs::{LevelsConfig, Staircase};

use crate::{
    Behaviour, Decision, Gaze, Motion, Outcome, Situation, WalkingBehaviour, WalkingConfig,
};

/// Size of the robot.
pub(crate) const EXTENT: Extent = Extent {
    radius: BODY_RADIUS_M,
    height: 0.58,
    depth: None,
    width: None,
    foot_side: 0.06,
};

/// Feet side by side.
pub(crate) const SOLES: [crate::SoleAt; 2] = [sole_at(0.0425), sole_at(-0.0425)];

const fn sole_at(y_m: f64) -> crate::SoleAt {
    crate::SoleAt {
        pose: PlanarPose {
            x_m: 0.0,
            y_m,
            yaw_rad: 0.0,
        },
        height_m: 0.0,
        slope: [0.0; 2],
    }
}

/// The behaviour on a body of this extent.
pub(crate) fn walking(config: WalkingConfig) -> WalkingBehaviour {
    WalkingBehaviour::new(config, LevelsConfig::default(), &EXTENT).unwrap()
}

pub(crate) const TICK_NS: u64 = 10_000_000;
const BODY_RADIUS_M: f64 = 0.14;
const CELL_M: f64 = 0.04;
/// A planner is asked every so many frames.
const PLANNED_FRAMES: u64 = 4;
const CELLS: usize = 120;

/// The plane with all that stands on it: discs of x, y, radius in metres.
#[expect(clippy::struct_excessive_bools, reason = "the switches of a test")]
pub(crate) struct Simulation {
    pub(crate) obstacles: Vec<[f64; 3]>,
    /// Patches that stereo never sees.
    pub(crate) holes: Vec<[f64; 3]>,
    pub(crate) blind: bool,
    /// The camera gives no picture that was taken anew.
    pub(crate) frozen: bool,
    /// Nothing is seen where the camera looks further than this, rad, from a heading, rad: a wall is too near.
    pub(crate) sees_only: Option<(f64, f64)>,
    /// Nothing is seen beyond this, m: a wall is too near.
    pub(crate) sees_before_x_m: f64,
    /// Beyond this, m, the picture is filled by what is too near.
    pub(crate) dark_beyond_x_m: f64,
    /// Where feet come upon an edge across the way that nobody sees, m.
    pub(crate) unseen_edge_m: Option<f64>,
    /// Whether the map keeps what the feet meet there.
    pub(crate) feels: bool,
    /// Whether the planner's path ends where it meets the goal's disc.
    pub(crate) ends_at_the_rim: bool,
    /// Whether the planner says that there is no way.
    pub(crate) closed: bool,
    /// Where it is closed: whether the walls stand around the goal.
    pub(crate) goal_is_shut_in: bool,
    /// Plans instead of the Dijkstra here.
    pub(crate) planner: Option<AStar>,
    /// Plans instead of both, by the robot's pose.
    pub(crate) plans: Option<fn(&PlanarPose) -> Plan>,
    /// Boxes: their lowest and highest corner, m.
    pub(crate) boxes: Vec<[[f64; 2]; 2]>,
    pub(crate) pose: PlanarPose,
    pub(crate) goal: Goal,
    pub(crate) last_goal: bool,
    pub(crate) time_ns: u64,
    pub(crate) view: FloorView,
    pub(crate) plan: Option<Plan>,
    pub(crate) behaviour: WalkingBehaviour,
    /// State, and the place where it began.
    pub(crate) states: Vec<(&'static str, PlanarPose)>,
    gaze: Gaze,
    stumbled: bool,
    frames: u64,
    last_frame_ns: Option<u64>,
    standing_ticks: u32,
    blocked_cells: usize,
    /// Until then the localizer does not know where the robot is, s.
    pub(crate) lost_until_s: f64,
}

impl Simulation {
    pub(crate) fn new(start: PlanarPose, goal: [f64; 2]) -> Self {
        let half_m = CELLS as f64 * CELL_M / 2.0;
        Self {
            obstacles: Vec::new(),
            holes: Vec::new(),
            blind: false,
            frozen: false,
            sees_only: None,
            sees_before_x_m: f64::INFINITY,
            dark_beyond_x_m: f64::INFINITY,
            unseen_edge_m: None,
            feels: false,
            ends_at_the_rim: false,
            closed: false,
            goal_is_shut_in: false,
            planner: None,
            plans: None,
            boxes: Vec::new(),
            pose: start,
            goal: Goal {
                x_m: goal[0],
                y_m: goal[1],
                radius_m: 0.15,
                height_m: None,
            },
            last_goal: true,
            time_ns: 0,
            view: FloorView::new(
                Lattice {
                    origin_m: [-half_m, -half_m],
                    cell_m: CELL_M,
                },
                Grid::filled(CELLS, CELLS, Surface::Unknown),
                0,
            ),
            plan: None,
            behaviour: walking(WalkingConfig::default()),
            states: Vec::new(),
            gaze: Gaze::default(),
            stumbled: false,
            frames: 0,
            last_frame_ns: None,
            standing_ticks: 100,
            blocked_cells: usize::MAX,
            lost_until_s: 0.0,
        }
    }

    /// One tick of 10 ms.
    pub(crate) fn tick(&mut self) -> Decision {
        if self.time_ns.is_multiple_of(8 * TICK_NS) && !self.sees_nothing() {
            self.see();
            self.make_plan();
        }
        let map_from_robot = Pose::from_yaw(self.pose.x_m, self.pose.y_m, 0.0, self.pose.yaw_rad);
        let estimate = Estimate {
            time_ns: self.time_ns,
            map_from_robot,
            map_from_odometry: Pose::identity(),
            lost: (self.time_ns as f64) < 1e9 * self.lost_until_s,
        };
        let decision = self
            .behaviour
            .next(&Situation {
                time_ns: self.time_ns,
                estimate: &estimate,
                view: &self.view,
                stairs: &Staircase::default(),
                takes_footsteps: true,
                stepping: crate::Stepping {
                    stumbled: self.stumbled,
                    ..crate::Stepping::default()
                },
                plan: self.plan.as_ref(),
                goal: &self.goal,
                last_goal: self.last_goal,
                soles: SOLES,
                standing: self.standing_ticks > 60,
                gaze: self.gaze,
                frames_used: self.frames,
                last_frame_ns: self.last_frame_ns,
                measured_share: (!self.frozen)
                    .then(|| f64::from(u8::from(self.pose.x_m < self.dark_beyond_x_m))),
            })
            .unwrap();
        self.obey(&decision);
        self.time_ns += TICK_NS;
        decision
    }

    /// Runs until something is declared; the time in seconds with it.
    pub(crate) fn run(&mut self, limit_s: f64) -> (Option<Outcome>, f64) {
        while (self.time_ns as f64) * 1e-9 < limit_s {
            let decision = self.tick();
            if decision.outcome.is_some() {
                return (decision.outcome, self.time_ns as f64 * 1e-9);
            }
        }
        (None, limit_s)
    }

    pub(crate) fn was_in(&self, state: &str) -> bool {
        self.states.iter().any(|(name, _)| *name == state)
    }

    fn obey(&mut self, decision: &Decision) {
        if self
            .states
            .last()
            .is_none_or(|(name, _)| *name != decision.state)
        {
            self.states.push((decision.state, self.pose));
        }
        self.gaze = decision.command.gaze;
        assert!(self.gaze.pan_rad.is_finite() && self.gaze.down_rad.is_finite());
        match decision.command.motion {
            Motion::Walk(_) if self.stumbled => self.standing_ticks += 1,
            Motion::Walk(velocity) => {
                let step =
                    [velocity.x_mps, velocity.y_mps, velocity.yaw_radps].map(|speed| speed * 0.01);
                assert!(step.iter().all(|value| value.is_finite()), "{velocity:?}");
                let pose = self
                    .pose
                    .compose(&PlanarPose::new(step[0], step[1], step[2]));
                self.standing_ticks = 0;
                self.stumbled = self.unseen_edge_m.is_some_and(|edge_m| pose.x_m > edge_m);
                if !self.stumbled {
                    self.pose = pose;
                } else if self.feels && self.view.felt.is_empty() {
                    self.view.felt.push(mapping::FeltPlace {
                        at_m: [pose.x_m + 0.06, pose.y_m],
                        heading_rad: pose.yaw_rad,
                        top_m: 0.015,
                        ground_m: 0.0,
                        half_width_m: 0.04,
                        thing: 0,
                    });
                }
            }
            _ => {
                self.standing_ticks += 1;
                self.stumbled &= self.standing_ticks <= 60;
            }
        }
    }

    fn make_plan(&mut self) {
        if let Some(plans) = self.plans {
            self.plan = Some(plans(&self.pose));
            return;
        }
        if let Some(planner) = &mut self.planner {
            if !self.frames.is_multiple_of(PLANNED_FRAMES) && self.plan.is_some() {
                return;
            }
            let start = Pose::from_yaw(self.pose.x_m, self.pose.y_m, 0.0, self.pose.yaw_rad);
            let plan = planner.plan(&self.view, &Staircase::default(), &start, &self.goal);
            self.plan = Some(plan.unwrap());
            return;
        }
        let cells = self.view.cells.values().iter();
        let blocked_cells = cells.filter(|s| matches!(s, Surface::Obstacle(_))).count();
        if self.closed {
            let no_way = NoWay {
                shuts_goal_in: self.goal_is_shut_in,
                ..NoWay::new(Refusal::Blocked, "walls all around".to_owned())
            };
            self.plan = Some(Plan {
                way: Err(no_way),
                replanned: true,
            });
            self.blocked_cells = usize::MAX;
            return;
        }
        let kept = self
            .plan
            .as_ref()
            .and_then(|plan| plan.way.as_ref().ok())
            .cloned();
        let way = match kept {
            Some(mut path) if blocked_cells == self.blocked_cells => {
                let from =
                    |p: &[f64; 2]| geometry::hypot(p[0] - self.pose.x_m, p[1] - self.pose.y_m);
                let nearest = (0..path.points_m.len())
                    .min_by(|&a, &b| from(&path.points_m[a]).total_cmp(&from(&path.points_m[b])));
                let passed = nearest.unwrap_or(0);
                let _ = path.points_m.drain(..passed);
                let _ = path.unknown.drain(..passed);
                let _ = path.clearance_m.drain(..passed);
                Plan {
                    way: Ok(path),
                    replanned: false,
                }
            }
            _ => Plan {
                way: self.shortest_path(),
                replanned: true,
            },
        };
        self.blocked_cells = blocked_cells;
        self.plan = Some(way);
    }

    /// Dijkstra from the goal over all cells that are far enough from what is known to stand there.
    fn shortest_path(&self) -> Result<Path, NoWay> {
        let lattice = self.view.lattice;
        let mut cost = Grid::filled(CELLS, CELLS, f64::INFINITY);
        let goal = lattice.cell_at(self.goal.x_m, self.goal.y_m);
        let mut open = BinaryHeap::new();
        open.push((std::cmp::Reverse(0_u64), goal));
        if let Some(slot) = cost.get_mut(goal) {
            *slot = 0.0;
        }
        while let Some((std::cmp::Reverse(key), cell)) = open.pop() {
            let here = cost.get(cell).copied().unwrap_or(f64::INFINITY);
            if key as f64 > here * 1e6 + 1.0 {
                continue;
            }
            for (dc, dr) in NEIGHBOURS {
                let next = Cell::new(cell.col + dc, cell.row + dr);
                let there = here + CELL_M * f64::from(dc * dc + dr * dr).sqrt();
                let known = cost.get(next).copied().unwrap_or(f64::NEG_INFINITY);
                if there < known - 1e-9 && self.is_free(lattice.center_of(next)) {
                    if let Some(slot) = cost.get_mut(next) {
                        *slot = there;
                    }
                    open.push((std::cmp::Reverse((there * 1e6) as u64), next));
                }
            }
        }
        self.descend(&cost, goal)
    }

    fn descend(&self, cost: &Grid<f64>, goal: Cell) -> Result<Path, NoWay> {
        let lattice = self.view.lattice;
        let mut path = Path::default();
        let mut cell = lattice.cell_at(self.pose.x_m, self.pose.y_m);
        while cell != goal {
            path.points_m.push(lattice.center_of(cell));
            let cost_of = |cell: &Cell| cost.get(*cell).copied().unwrap_or(f64::INFINITY);
            let best = NEIGHBOURS
                .map(|(dc, dr)| Cell::new(cell.col + dc, cell.row + dr))
                .into_iter()
                .min_by(|a, b| cost_of(a).total_cmp(&cost_of(b)));
            match best {
                Some(next) if cost_of(&next).is_finite() && path.points_m.len() < CELLS * CELLS => {
                    cell = next;
                }
                _ => {
                    return Err(NoWay::new(
                        Refusal::Blocked,
                        "all cells around are blocked".to_owned(),
                    ));
                }
            }
        }
        path.points_m.push([self.goal.x_m, self.goal.y_m]);
        if self.ends_at_the_rim {
            let away_m = |p: &[f64; 2]| geometry::hypot(p[0] - self.goal.x_m, p[1] - self.goal.y_m);
            let rim = path
                .points_m
                .iter()
                .position(|p| away_m(p) <= self.goal.radius_m);
            path.points_m
                .truncate(rim.map_or(usize::MAX, |rim| rim + 1));
        }
        path.unknown = path
            .points_m
            .iter()
            .map(|p| self.view.at(p[0], p[1]) == Surface::Unknown)
            .collect();
        path.clearance_m = vec![0.5; path.points_m.len()];
        Ok(path)
    }

    fn is_free(&self, [x, y]: [f64; 2]) -> bool {
        let known =
            |disc: &&[f64; 3]| matches!(self.view.at(disc[0], disc[1]), Surface::Obstacle(_));
        self.obstacles
            .iter()
            .filter(known)
            .all(|d| geometry::hypot(d[0] - x, d[1] - y) > d[2] + BODY_RADIUS_M)
    }
}

const NEIGHBOURS: [(i32, i32); 8] = [
    (1, 0),
    (-1, 0),
    (0, 1),
    (0, -1),
    (1, 1),
    (1, -1),
    (-1, 1),
    (-1, -1),
];
