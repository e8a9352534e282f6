//! Test support: two soles in a world of stairs, eyes that see edges in view, and a planner that leads straight over them.

use geometry::{Grid, Lattice, PlanarPose, Point, Pose};
use localization::Estimate;
use mapping::{FloorView, Surface};
use planning::{Climb, Goal, NoWay, Path, Plan, Refusal, Step};
use robot::Side;
use stairs::{
    ClimbingConfig, Edge, EdgeFit, Feet, Footing, Onward, Sides, Stair, Staircase, Unfit,
};

use crate::{
    Behaviour, Decision, Footstep, Gaze, Misstep, Motion, Outcome, Pace, Situation, StairClimbing,
    StairClimbingConfig, Stepping, WalkingBehaviour, WalkingConfig,
};

pub(crate) const TICK_NS: u64 = 10_000_000;
const EYE_HEIGHT_M: f64 = 0.45;
const STEP_TICKS: u32 = 100;
const SHIFT_TICKS: u32 = 50;
pub(crate) const FEET: Feet = Feet {
    length_m: 0.105,
    pair_width_m: 0.16,
    stance_m: 0.085,
};

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
    /// Whether the planner refuses what the feet do not fit on; else only the behaviour can.
    pub(crate) planner_checks: bool,
    /// Whether the planner answers at all.
    pub(crate) planning: bool,
    /// Each landing is this far off, m and rad.
    pub(crate) landing_error: PlanarPose,
    pub(crate) obstacle: Option<[f64; 3]>,
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

/// Stairs along x from `first_m` on: rise and tread of each; all of this width.
pub(crate) fn straight(
    first_m: f64,
    steps: &[(f64, f64)],
    width_m: f64,
) -> Vec<Stair<geometry::Map>> {
    let (mut x_m, mut z_m) = (first_m, 0.0);
    steps
        .iter()
        .map(|&(rise_m, tread_m)| {
            z_m += rise_m;
            let stair = stair([x_m, 0.0, 0.0], [x_m + tread_m, 0.0, 0.0], z_m, width_m);
            x_m += tread_m;
            stair
        })
        .collect()
}

/// A stair between two edges, each by middle and heading.
pub(crate) fn stair(
    front: [f64; 3],
    back: [f64; 3],
    z_m: f64,
    width_m: f64,
) -> Stair<geometry::Map> {
    let edge = |[x_m, y_m, heading_rad]: [f64; 3]| {
        let (sin, cos) = heading_rad.sin_cos();
        let half_m = 0.5 * width_m;
        Edge {
            left: Point::new(x_m - sin * half_m, y_m + cos * half_m, z_m),
            right: Point::new(x_m + sin * half_m, y_m - cos * half_m, z_m),
        }
    };
    Stair {
        front: edge(front),
        back: edge(back),
        reference: Point::new(0.5 * (front[0] + back[0]), 0.5 * (front[1] + back[1]), z_m),
        left_margin_m: 0.0,
        right_margin_m: 0.0,
        support: 500,
        seen_ends: Sides::default(),
        front_fit: None,
        back_fit: None,
        steps_ago: 0,
    }
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
        let walking = WalkingBehaviour::new(WalkingConfig::default()).unwrap();
        let count = steps.len();
        let mut simulation = Self {
            sunk_m: vec![0.0; count],
            steps,
            blind: false,
            planner_checks: true,
            planning: true,
            landing_error: PlanarPose::default(),
            obstacle: None,
            feet: Side::BOTH.map(foot),
            goal: Goal {
                x_m: goal[0],
                y_m: goal[1],
                radius_m: 0.12,
                height_m: None,
            },
            time_ns: 0,
            behaviour: StairClimbing::new(
                StairClimbingConfig::default(),
                walking,
                ClimbingConfig::default(),
                FEET,
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
            view: FloorView {
                lattice: Lattice {
                    origin_m: [-2.0, -2.0],
                    cell_m: 0.04,
                },
                cells: Grid::filled(150, 100, Surface::Unknown),
                sightings: Grid::filled(150, 100, 3),
            },
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
                .is_some_and(|[ox, oy, r]| (ox - x_m).hypot(oy - y_m) < r);
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
            lost: false,
        };
        let decision = self
            .behaviour
            .next(&Situation {
                time_ns: self.time_ns,
                estimate: &estimate,
                view: &self.view,
                stairs: &self.staircase,
                stepping: self.stepping,
                plan: self.plan.as_ref(),
                goal: &self.goal,
                last_goal: true,
                standing: self.stands(),
                gaze: self.gaze,
                frames_used: self.frames,
                last_frame_ns: self.last_frame_ns,
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
            Motion::Walk(velocity) => {
                let way = PlanarPose::new(
                    velocity.x_mps * 0.01,
                    velocity.y_mps * 0.01,
                    velocity.yaw_radps * 0.01,
                );
                let pose = self.pose().compose(&way);
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
                self.standing_ticks = 0;
                self.stepping.landed = 0;
            }
            Motion::Stand => {
                self.standing_ticks += 1;
                if self.stands() {
                    self.stepping.landed = 0;
                }
            }
            Motion::Footsteps(list) => self.take(list),
        }
    }

    fn take(&mut self, list: &[Footstep]) {
        if self.stands() && self.stepping.landed == 0 && !list.is_empty() {
            self.list_from = self.pose();
            self.list_ground_m = self.ground_m();
            self.stepping.misstep = None;
            self.ticks_left = SHIFT_TICKS + STEP_TICKS;
            self.standing_ticks = 0;
            return;
        }
        if self.ticks_left == 0 {
            self.standing_ticks += 1;
            return;
        }
        self.ticks_left -= 1;
        if self.ticks_left == 0
            && let Some(step) = list.get(self.stepping.landed)
        {
            self.land(step);
            let more = self.stepping.misstep.is_none() && self.stepping.landed < list.len();
            self.ticks_left = if more { STEP_TICKS } else { 0 };
        }
    }

    /// A foot comes down: on what is there, or it is taken back.
    fn land(&mut self, step: &Footstep) {
        let pose = self
            .list_from
            .compose(&step.pose)
            .compose(&self.landing_error);
        let told_m = self.list_ground_m + step.height_m;
        // The part that bears load must lie on one surface.
        let [from_m, to_m] = step.bearing_m;
        let heights = [0.8 * from_m, 0.0, 0.8 * to_m].map(|along_m| {
            let (x_m, y_m) = pose.apply(along_m, 0.0);
            self.truth_m([x_m, y_m])
        });
        let highest_m = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
        if highest_m < told_m - 0.012 {
            self.stepping.misstep = Some(Misstep::NoGround);
        } else if highest_m > told_m + 0.012 {
            self.stepping.misstep = Some(Misstep::Obstructed);
        } else {
            let lowest_m = heights.into_iter().fold(f64::INFINITY, f64::min);
            assert!(
                highest_m - lowest_m < 1e-9,
                "a foot tips at {pose:?}: {heights:?}"
            );
            let foot = Foot {
                pose,
                height_m: highest_m,
            };
            self.feet[step.side.index()] = foot;
            self.landings.push((*step, foot));
            self.stepping.landed += 1;
        }
    }

    fn see(&mut self) {
        let pose = self.pose();
        let moving = !self.stands();
        for (at, stair) in self.steps.iter().enumerate() {
            let middle = stair.front.middle().inner;
            let (x_m, y_m) = pose.inverse().apply(middle.x, middle.y);
            let away_m = (x_m - 0.04).hypot(y_m);
            let down_rad = (EYE_HEIGHT_M - (stair.height_m() - self.ground_m())).atan2(away_m);
            let in_view = geometry::angle_between(self.gaze.pan_rad, y_m.atan2(x_m)).abs() < 0.41
                && (down_rad - self.gaze.down_rad).abs() < 0.30
                && x_m > 0.14
                && away_m < 1.2;
            if in_view {
                self.seen[at] += 1;
            }
        }
        self.staircase.stairs.clear();
        for (at, stair) in self.steps.iter().enumerate() {
            if self.seen[at] == 0 {
                continue;
            }
            let fit = |frames: u32| {
                (frames > 1).then_some(EdgeFit {
                    frames,
                    place_sigma_m: 0.003,
                    heading_sigma_rad: 0.02,
                })
            };
            let behind = self.seen.get(at + 1).copied().unwrap_or(0);
            self.staircase.stairs.push(Stair {
                front_fit: fit(self.seen[at]),
                back_fit: fit(behind),
                steps_ago: u32::from(self.sunk_m[at] > 0.0),
                ..*stair
            });
        }
        self.staircase.frames = if moving { 0 } else { self.staircase.frames + 1 };
        self.frames += 1;
        self.last_frame_ns = Some(self.time_ns);
    }

    fn make_plan(&self) -> Plan {
        Plan {
            way: self.way(),
            replanned: false,
        }
    }

    fn way(&self) -> Result<Path, NoWay> {
        let pose = self.pose();
        let from = self.index_at([pose.x_m, pose.y_m]).map_or(0, |at| at + 1);
        let mut ground_m = self.ground_m();
        let mut steps = Vec::new();
        for stair in &self.staircase.stairs {
            let middle = stair.front.middle().inner;
            if stair.front.beyond_m([pose.x_m, pose.y_m]) >= 0.0
                || steps.len() + from >= self.steps.len()
            {
                continue;
            }
            steps.push(Step {
                stair: *stair,
                rise_m: stair.height_m() - ground_m,
                crossing_m: [middle.x, middle.y],
            });
            ground_m = stair.height_m();
        }
        if self.planner_checks {
            check(&steps)?;
        }
        let mut path = Path {
            points_m: vec![[pose.x_m, pose.y_m]],
            ..Path::default()
        };
        if let Some(first) = steps.first() {
            let heading = first.stair.front.heading_rad();
            let before = PlanarPose::new(first.crossing_m[0], first.crossing_m[1], heading);
            let (x_m, y_m) = before.apply(-0.07, 0.0);
            dense(&mut path.points_m, [x_m, y_m]);
            let from_point = path.points_m.len() - 1;
            path.points_m
                .extend(steps.iter().map(|step| step.crossing_m));
            path.climbs.push(Climb {
                from_point,
                to_point: path.points_m.len() - 1,
                steps,
            });
        }
        dense(&mut path.points_m, [self.goal.x_m, self.goal.y_m]);
        path.unknown = vec![false; path.points_m.len()];
        path.clearance_m = vec![0.5; path.points_m.len()];
        Ok(path)
    }
}

fn dense(points_m: &mut Vec<[f64; 2]>, to: [f64; 2]) {
    let Some(&from) = points_m.last() else { return };
    let count = ((to[0] - from[0]).hypot(to[1] - from[1]) / 0.04)
        .ceil()
        .max(1.0) as usize;
    points_m.extend((1..=count).map(|i| {
        let share = i as f64 / count as f64;
        [
            from[0] + (to[0] - from[0]) * share,
            from[1] + (to[1] - from[1]) * share,
        ]
    }));
}

fn check(steps: &[Step]) -> Result<(), NoWay> {
    let config = ClimbingConfig::default();
    for (at, step) in steps.iter().enumerate() {
        let onward = steps
            .get(at + 1)
            .map_or(Onward::Level, |after| Onward::Edge {
                depth_m: step.stair.front.beyond_m(after.crossing_m),
                rise_m: after.rise_m,
            });
        let width_m = step.stair.front.length_m();
        if let Err(unfit) = Footing::on_stair(&config, &FEET, step.rise_m, width_m, onward) {
            let refusal = match unfit {
                Unfit::TooLow(_) => Refusal::StepTooLow,
                Unfit::TooHigh(_) => Refusal::StepTooHigh,
                Unfit::TreadTooShort(..) => Refusal::TreadTooShort,
                Unfit::GapTooShort(..) => Refusal::GapTooShort,
                Unfit::TooNarrow(..) => Refusal::TooNarrow,
            };
            return Err(NoWay {
                refusal,
                sentence: "as measured".to_owned(),
            });
        }
    }
    Ok(())
}
