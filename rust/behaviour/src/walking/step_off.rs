//! The state `step_back`: off what a foot has met, back to where the robot can turn without touching it again.

use geometry::PlanarPose;
use mapping::FeltPlace;
use terrain::support::{is_level_floor, is_roomy};

use super::WalkingBehaviour;
use crate::things_met::given_up;
use crate::walking::state::State;
use crate::walking::tick::WayTick;
use crate::{Motion, Velocity};

impl WalkingBehaviour {
    /// Stops, looks and then steps back, or gives up: a foot came upon something that nobody saw.
    pub(super) fn stumble(&mut self, tick: &WayTick<'_>) {
        let felt = &tick.situation.view.felt;
        if self.counts_touch(felt) {
            self.watched_m = felt.last().map(|felt| felt.at_m);
            self.met = felt.last().copied();
            self.enter(State::Stop);
        } else {
            self.refuse(given_up(felt));
        }
    }

    /// Counts a thing that a foot met. Whether to go on.
    pub(crate) fn counts_touch(&mut self, felt: &[FeltPlace]) -> bool {
        self.touches
            .count(felt, [self.config.tries, self.config.touches])
    }

    /// Whether it goes on: it neither stands for something, nor steps back from what a foot has met, nor has given up.
    pub(crate) fn goes_on(&self) -> bool {
        let state = self.machine.state();
        !matches!(
            state,
            State::Stop | State::StepOff { .. } | State::Refuse { .. }
        )
    }

    /// Where to step back to from what a foot has met: straight away from it, as far as there is known floor.
    pub(super) fn off_m(&self, tick: &WayTick<'_>, felt: &FeltPlace) -> Option<[f64; 2]> {
        let here = &tick.pose;
        let (dx_m, dy_m) = (here.x_m - felt.at_m[0], here.y_m - felt.at_m[1]);
        let cell_m = tick.situation.view.lattice.cell_m;
        let away_m = geometry::hypot(dx_m, dy_m);
        let off = if away_m > cell_m {
            [dx_m / away_m, dy_m / away_m]
        } else {
            // Above the thing itself: the way that the robot faces leads over it.
            let (sin, cos) = libm::sincos(here.yaw_rad);
            [-cos, -sin]
        };
        let missing_m = self.config.tuning.touch.away - away_m;
        let at = |back_m: f64| [here.x_m + off[0] * back_m, here.y_m + off[1] * back_m];
        let pieces = (missing_m / cell_m).ceil().max(0.0) as usize;
        let places = (1..=pieces).map(|piece| at(missing_m * piece as f64 / pieces as f64));
        places
            .take_while(|&place_m| self.may_stand(tick, place_m, here.yaw_rad))
            .last()
    }

    /// Whether both feet have known floor of the robot's level at a place, m, and nothing stands there.
    fn may_stand(&self, tick: &WayTick<'_>, [x_m, y_m]: [f64; 2], heading_rad: f64) -> bool {
        let view = tick.situation.view;
        let middle = PlanarPose::new(x_m, y_m, heading_rad);
        let side_m = self.foot_side_m;
        is_roomy(view, [x_m, y_m], self.radius_m)
            && [-side_m, 0.0, side_m].iter().all(|&aside_m| {
                let (x_m, y_m) = middle.apply(0.0, aside_m);
                is_level_floor(view, [x_m, y_m], tick.ground_m, self.levels.same)
            })
    }

    /// One tick of the steps back off it.
    pub(super) fn step_off(&mut self, tick: &WayTick<'_>, to_m: [f64; 2]) -> Motion {
        if let Some(motion) = self.step_towards(tick, to_m) {
            return motion;
        }
        if let Some((_, track)) = &tick.track {
            self.set_off(track);
        } else {
            self.looks = 0;
            self.look(self.around());
        }
        Motion::Stand
    }

    /// One tick of slow steps to a place near by without a turn; `None` once it is reached, or cannot be.
    pub(super) fn step_towards(&mut self, tick: &WayTick<'_>, to_m: [f64; 2]) -> Option<Motion> {
        let [x_m, y_m] = tick.in_robot(to_m);
        let away_m = geometry::hypot(x_m, y_m);
        let tuning = &self.config.tuning.blind;
        let longest_s = 2.0 * tuning.back / self.config.creep_speed;
        if away_m < tuning.reached || self.machine.lasted_s() > longest_s {
            return None;
        }
        self.gaze_at(tick, 0.0, self.config.gaze_near);
        let share = self.config.creep_speed / away_m;
        Some(Motion::Walk(Velocity {
            x_mps: share * x_m,
            y_mps: share * y_m,
            ..Velocity::default()
        }))
    }
}
