//! Test support: two soles in a world of stairs, eyes that see edges in view, and a planner that leads straight over them.

mod course;
mod eyes;
mod soles;

use geometry::{Grid, Lattice, PlanarPose, Pose};
use localization::Estimate;
use mapping::{FloorView, Surface};
use planning::{Goal, Plan};
use robot::Side;
use stairs::{ClimbingConfig, Feet, Stair, Staircase};

use crate::{
    Behaviour, Decision, Footstep, Gaze, Motion, Outcome, Pace, Situation, StairClimbing,
    StairClimbingConfig, Stepping, WalkingConfig,
};

use crate::walking::simulation::walking;
pub(crate) use course::{stair, straight};

pub(crate) const TICK_NS: u64 = 10_000_000;
pub(crate) const FEET: Feet = Feet {
    length_m: 0.105,
    pair_width_m: 0.16,
    stance_m: 0.085,
};

/// Where the robot's eyes are.
fn eyes() -> robot::Head {
    robot::Head {
        pan: Some("pan".to_owned()),
        tilt: Some("tilt".to_owned()),
        eye_height: 0.45,
        eye_ahead: 0.04,
    }
}

/// One foot in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Foot {
    pub(crate) pose: PlanarPose,
    pub(crate) height_m: f64,
}

/// Steps one behind the other, each up to the front edge of the next.
#[expect(clippy::struct_excessive_bools, reason = "the switches of a test")]
pub(crate) struct Simulation {
    pub(crate) steps: Vec<Stair<geometry::Map>>,
    /// Steps that are not where they look to be: that much lower, m.
    pub(crate) sunk_m: Vec<f64>,
    pub(crate) blind: bool,
    /// Whether the localizer does not know where the robot is.
    pub(crate) lost: bool,
    /// Whether the planner refuses what the feet do not fit on; else only the behaviour can.
    pub(crate) planner_checks: bool,
    /// Whether the planner answers at all.
    pub(crate) planning: bool,
    /// Steps whose edge is further away than this are not planned over, m.
    pub(crate) planned_within_m: f64,
    /// Each landing is this far off, m and rad.
    pub(crate) landing_error: PlanarPose,
    /// A leg buckles when it is to carry the robot on a step.
    pub(crate) weak: bool,
    pub(crate) obstacle: Option<[f64; 3]>,
    /// The plan leads over the edges this far to the left of their middle, m.
    pub(crate) way_aside_m: f64,
    /// Where feet come upon an edge across the way that nobody sees, m.
    pub(crate) unseen_edge_m: Option<f64>,
    pub(crate) feet: [Foot; 2],
    pub(crate) goal: Goal,
    pub(crate) time_ns: u64,
    pub(crate) behaviour: StairClimbing,
    /// State, and when it began, s.
    pub(crate) states: Vec<(&'static str, f64)>,
    pub(crate) arms_raised: bool,
    pub(crate) landings: Vec<(Footstep, Foot)>,
    pub(crate) seen: Vec<u32>,
    stepping: Stepping,
    list_from: PlanarPose,
    list_ground_m: f64,
    ticks_left: u32,
    standing_ticks: u32,
    gaze: Gaze,
    frames: u64,
    last_frame_ns: Option<u64>,
    staircase: Staircase,
    plan: Option<Plan>,
    view: FloorView,
}

impl Simulation {
    pub(crate) fn new(
        start: PlanarPose,
        steps: Vec<Stair<geometry::Map>>,
        goal: [f64; 2],
        pace: Pace,
    ) -> Self {
        let foot = |side: Side| Foot {
            pose: start.compose(&PlanarPose::new(
                0.0,
                0.5 * side.sign() * FEET.stance_m,
                0.0,
            )),
            height_m: 0.0,
        };
        let walking = walking(WalkingConfig::default());
        let count = steps.len();
        let mut simulation = Self {
            sunk_m: vec![0.0; count],
            steps,
            blind: false,
            lost: false,
            planner_checks: true,
            planning: true,
            planned_within_m: f64::INFINITY,
            landing_error: PlanarPose::default(),
            weak: false,
            obstacle: None,
            way_aside_m: 0.0,
            unseen_edge_m: None,
            feet: Side::BOTH.map(foot),
            goal: disc(goal),
            time_ns: 0,
            behaviour: StairClimbing::new(
                StairClimbingConfig::default(),
                walking,
                ClimbingConfig::default(),
                FEET,
                &eyes(),
                pace,
            )
            .unwrap(),
            states: Vec::new(),
            arms_raised: false,
            landings: Vec::new(),
            seen: vec![0; count],
            stepping: Stepping::default(),
            list_from: PlanarPose::default(),
            list_ground_m: 0.0,
            ticks_left: 0,
            standing_ticks: 100,
            gaze: Gaze::default(),
            frames: 0,
            last_frame_ns: None,
            staircase: Staircase::default(),
            plan: None,
            view: FloorView::new(
                Lattice {
                    origin_m: [-2.0, -2.0],
                    cell_m: 0.04,
                },
                Grid::filled(150, 100, Surface::Unknown),
                3,
            ),
        };
        simulation.paint();
        simulation
    }

    /// All floor is known; what is tested is the climb.
    pub(crate) fn paint(&mut self) {
        for cell in self.view.cells.area().cells() {
            let [x_m, y_m] = self.view.lattice.center_of(cell);
            let hit = self
                .obstacle
                .is_some_and(|[ox, oy, r]| geometry::hypot(ox - x_m, oy - y_m) < r);
            let surface = if hit {
                Surface::Obstacle(0.4)
            } else {
                Surface::Floor(self.looks_like_m([x_m, y_m]) as f32)
            };
            if let Some(slot) = self.view.cells.get_mut(cell) {
                *slot = surface;
            }
        }
    }

    /// The step that a place lies on, counted from 0; `None` before the first.
    fn index_at(&self, place_m: [f64; 2]) -> Option<usize> {
        self.steps
            .iter()
            .rposition(|step| step.front.beyond_m(place_m) >= 0.0)
    }

    fn looks_like_m(&self, place_m: [f64; 2]) -> f64 {
        self.index_at(place_m)
            .map_or(0.0, |at| self.steps[at].height_m())
    }

    pub(crate) fn truth_m(&self, place_m: [f64; 2]) -> f64 {
        self.index_at(place_m)
            .map_or(0.0, |at| self.steps[at].height_m() - self.sunk_m[at])
    }

    pub(crate) fn pose(&self) -> PlanarPose {
        let [left, right] = self.feet.map(|foot| foot.pose);
        let turn = geometry::angle_between(right.yaw_rad, left.yaw_rad);
        PlanarPose::new(
            0.5 * (left.x_m + right.x_m),
            0.5 * (left.y_m + right.y_m),
            right.yaw_rad + 0.5 * turn,
        )
    }

    fn soles(&self) -> [crate::SoleAt; 2] {
        let (here, ground_m) = (self.pose(), self.ground_m());
        self.feet.map(|foot| crate::SoleAt {
            pose: here.relative(&foot.pose),
            height_m: foot.height_m - ground_m,
            slope: [0.0; 2],
        })
    }

    pub(crate) fn ground_m(&self) -> f64 {
        self.feet[0].height_m.min(self.feet[1].height_m)
    }

    /// One tick of 10 ms.
    pub(crate) fn tick(&mut self) -> Decision {
        if self.time_ns.is_multiple_of(8 * TICK_NS) && !self.blind {
            self.see();
            self.plan = self.planning.then(|| self.make_plan());
        }
        let pose = self.pose();
        let estimate = Estimate {
            time_ns: self.time_ns,
            map_from_robot: Pose::from_yaw(pose.x_m, pose.y_m, self.ground_m(), pose.yaw_rad),
            map_from_odometry: Pose::identity(),
            lost: self.lost,
        };
        let decision = self
            .behaviour
            .next(&Situation {
                time_ns: self.time_ns,
                estimate: &estimate,
                view: &self.view,
                stairs: &self.staircase,
                takes_footsteps: true,
                stepping: self.stepping,
                plan: self.plan.as_ref(),
                goal: &self.goal,
                last_goal: true,
                soles: self.soles(),
                standing: self.stands(),
                gaze: self.gaze,
                frames_used: self.frames,
                last_frame_ns: self.last_frame_ns,
                measured_share: Some(1.0),
            })
            .unwrap();
        self.obey(&decision);
        self.time_ns += TICK_NS;
        decision
    }

    /// Runs until something is declared; the time in seconds with it.
    pub(crate) fn run(&mut self, limit_s: f64) -> (Option<Outcome>, f64) {
        while self.now_s() < limit_s {
            let decision = self.tick();
            if decision.outcome.is_some() {
                return (decision.outcome, self.now_s());
            }
        }
        (None, limit_s)
    }

    pub(crate) fn run_until(&mut self, limit_s: f64, met: impl Fn(&Self) -> bool) {
        while self.now_s() < limit_s && !met(self) {
            let _ = self.tick();
        }
        assert!(met(self), "{:?}", self.states);
    }

    /// Whether a walk has come upon an unseen edge.
    pub(crate) const fn has_stumbled(&self) -> bool {
        self.stepping.stumbled
    }

    /// Where the head looks.
    pub(crate) const fn gaze(&self) -> Gaze {
        self.gaze
    }

    pub(crate) fn now_s(&self) -> f64 {
        self.time_ns as f64 * 1e-9
    }

    pub(crate) fn was_in(&self, state: &str) -> bool {
        self.states.iter().any(|(name, _)| *name == state)
    }

    pub(crate) fn stands(&self) -> bool {
        self.ticks_left == 0 && self.standing_ticks > 40
    }

    fn obey(&mut self, decision: &Decision) {
        if self
            .states
            .last()
            .is_none_or(|(name, _)| *name != decision.state)
        {
            self.states.push((decision.state, self.now_s()));
        }
        self.gaze = decision.command.gaze;
        self.arms_raised |= decision.command.arms == crate::Arms::Raised;
        match &decision.command.motion {
            Motion::Walk(_) if self.stepping.stumbled => self.standing_ticks += 1,
            Motion::Walk(velocity) => {
                let way = PlanarPose::new(
                    velocity.x_mps * 0.01,
                    velocity.y_mps * 0.01,
                    velocity.yaw_radps * 0.01,
                );
                let pose = self.pose().compose(&way);
                self.standing_ticks = 0;
                self.stepping.landed = 0;
                if self.unseen_edge_m.is_some_and(|edge_m| pose.x_m > edge_m) {
                    self.stepping.stumbled = true;
                    return;
                }
                let ground_m = self.ground_m();
                assert_eq!(
                    self.truth_m([pose.x_m, pose.y_m]),
                    ground_m,
                    "walks off a level at {pose:?}"
                );
                for side in Side::BOTH {
                    let place = PlanarPose::new(0.0, 0.5 * side.sign() * FEET.stance_m, 0.0);
                    self.feet[side.index()].pose = pose.compose(&place);
                }
            }
            Motion::Stand => {
                self.standing_ticks += 1;
                if self.stands() {
                    self.stepping.stumbled = false;
                    self.stepping.landed = 0;
                }
            }
            Motion::Footsteps(list) => self.take(list),
        }
    }
}

/// A goal at any height.
const fn disc([x_m, y_m]: [f64; 2]) -> Goal {
    Goal {
        x_m,
        y_m,
        radius_m: 0.12,
        height_m: None,
    }
}
