//! Claims: a robot whose joints and feet rest does not turn; and it turns as the leg that carries it says.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use robot::{Body, Side};
use sensing::SenseFault;

use super::config::SenseWatchConfig;
use super::repair::Repair;
use super::turn::turn_rad;
use super::{Check, Finding, Moment};

/// The mean reading of the gyroscope since the joints began to rest.
#[derive(Debug, Clone)]
pub(super) struct Resting {
    /// Where the joints were when they began to rest.
    began_rad: Vec<f64>,
    sum_radps: Vector3<f64>,
    lasted_s: f64,
    ticks: f64,
}

impl Resting {
    pub(super) fn new(body: &Body) -> Self {
        Self {
            began_rad: vec![f64::NAN; body.joint_count()],
            sum_radps: Vector3::zeros(),
            lasted_s: 0.0,
            ticks: 0.0,
        }
    }

    fn begin(&mut self, read_rad: &[f64]) {
        self.began_rad.copy_from_slice(read_rad);
        (self.sum_radps, self.lasted_s, self.ticks) = (Vector3::zeros(), 0.0, 0.0);
    }
}

impl Check for Resting {
    fn look(&mut self, moment: &Moment<'_>) -> Option<Finding> {
        let (read_rad, config) = (&moment.observation.joint_positions_rad, moment.config);
        let rests = moment.state.stands_level
            && Side::BOTH.iter().all(|&side| {
                (moment.body.leg_joints(side).iter()).all(|&joint| {
                    (read_rad[joint] - self.began_rad[joint]).abs() <= config.joint_rest
                })
            });
        if !rests {
            self.begin(read_rad);
            return None;
        }
        self.sum_radps += Vector3::from(moment.observation.angular_velocity_radps);
        self.lasted_s += moment.passed_s;
        self.ticks += 1.0;
        if self.lasted_s < config.resting_time {
            return None;
        }
        let mean_radps = self.sum_radps / self.ticks;
        self.begin(read_rad);
        if mean_radps.amax() <= config.resting {
            return None;
        }
        let turn = mean_radps.amax();
        Some(Finding {
            fault: SenseFault::new(
                "the gyroscope",
                format!("tells a turn of {turn:.3} rad/s while the robot stands still"),
            ),
            repair: Repair::Inertial,
        })
    }
}

/// By how much gyroscope and legs differ in the last moments.
#[derive(Debug, Clone, Default)]
pub(super) struct Turning {
    before: Option<(Side, UnitQuaternion<f64>)>,
    tilt_rad: Vector3<f64>,
    /// By how much the tilt differed at most over each foot, less what has faded since, rad.
    most_rad: [f64; 2],
    axes: AxisOrder,
    heading_rad: f64,
}

impl Check for Turning {
    fn look(&mut self, moment: &Moment<'_>) -> Option<Finding> {
        let (state, config, passed_s) = (moment.state, moment.config, moment.passed_s);
        let side = state.support;
        let torso_from_sole = moment.body.torso_from_sole(&state.links, side).rotation;
        let before = self.before.replace((side, torso_from_sole));
        let fade = |time_s: f64| time_s / (time_s + passed_s);
        self.tilt_rad *= fade(config.tilt_time);
        self.most_rad = self
            .most_rad
            .map(|most_rad| most_rad * fade(config.both_time));
        self.heading_rad *= fade(config.heading_time);
        if let Some((_, before)) = before.filter(|&(before, _)| before == side) {
            let by_legs_rad = turn_rad(&before, &torso_from_sole);
            let by_gyro_rad = state.angular_velocity_radps * passed_s;
            let off_rad = by_gyro_rad - by_legs_rad;
            let up = torso_from_sole * Vector3::z();
            let turned_rad = off_rad.dot(&up);
            // A sole slips for a moment and fast; a gyroscope errs slowly and for long.
            let fastest_rad = config.slip * passed_s;
            self.heading_rad += turned_rad.clamp(-fastest_rad, fastest_rad);
            // A sole that rests on some of its cells alone rocks, and one that is set onto a slope or a thing turns until it lies on it.
            let cells_n = &moment.observation.foot_forces_n[side.index()];
            let least_n = config.firm * moment.weight_n;
            let is_firm = cells_n.iter().all(|&force_n| force_n > least_n);
            if is_firm && !moment.on_uneven[side.index()] {
                self.tilt_rad += off_rad - up * turned_rad;
                let most_rad = &mut self.most_rad[side.index()];
                *most_rad = most_rad.max(self.tilt_rad.norm());
            }
            self.axes
                .take_in(by_gyro_rad, by_legs_rad, passed_s, config);
        }
        // A sole that lies aslant slips: its leg does not tell the heading.
        let sole_up = state.odometry_from_torso_rotation * torso_from_sole * Vector3::z();
        if sole_up.angle(&Vector3::z()) > config.slope {
            self.heading_rad = 0.0;
        }
        // A sole that rocks on something turns as no other axes of the legs do, and over one foot.
        let over_both = self.most_rad.iter().all(|&rad| rad > config.tilt_of_both);
        let believed = over_both || self.axes.is_wrong(config);
        let (tilt_rad, heading_rad) = (self.tilt_rad.norm(), self.heading_rad.abs());
        let what = if tilt_rad > config.tilt && believed {
            format!("tells another tilt than the legs, by {tilt_rad:.2} rad")
        } else if heading_rad > config.heading {
            format!("tells another turn than the legs, by {heading_rad:.2} rad")
        } else {
            return None;
        };
        Some(Finding {
            fault: SenseFault::new("the gyroscope", what),
            repair: Repair::Inertial,
        })
    }
}

/// How turns by the gyroscope and by the legs go together, axis by axis, in the last moments: whether some of its axes are swapped.
#[derive(Debug, Clone, Default)]
struct AxisOrder {
    by_gyro_rad: Vector3<f64>,
    by_legs_rad: Vector3<f64>,
    products: Matrix3<f64>,
    squares: f64,
}

impl AxisOrder {
    /// Takes in how far both turned in a tick, in the torso's frame.
    fn take_in(
        &mut self,
        by_gyro_rad: Vector3<f64>,
        by_legs_rad: Vector3<f64>,
        passed_s: f64,
        config: &SenseWatchConfig,
    ) {
        let share = passed_s / (passed_s + config.turn_smooth);
        self.by_gyro_rad += (by_gyro_rad - self.by_gyro_rad) * share;
        self.by_legs_rad += (by_legs_rad - self.by_legs_rad) * share;
        let fade = config.tilt_time / (config.tilt_time + passed_s);
        self.products *= fade;
        self.products += self.by_gyro_rad * self.by_legs_rad.transpose();
        self.squares *= fade;
        self.squares += self.by_gyro_rad.norm_squared() + self.by_legs_rad.norm_squared();
    }

    /// Whether the gyroscope's readings are much more like the legs' turn about other axes, or the other way about.
    fn is_wrong(&self, config: &SenseWatchConfig) -> bool {
        let products = &self.products;
        let left = |same: f64| self.squares - 2.0 * same;
        let other = ORDERS.iter().map(|order| {
            let axes = order.iter().enumerate();
            axes.map(|(axis, &other)| products[(axis, other)].abs())
                .sum()
        });
        let best = other.fold(f64::NEG_INFINITY, f64::max);
        left(best) < config.rewired * left(products.trace())
    }
}

/// The orders in which three axes may be wired.
const ORDERS: [[usize; 3]; 6] = [
    [0, 1, 2],
    [0, 2, 1],
    [1, 0, 2],
    [1, 2, 0],
    [2, 0, 1],
    [2, 1, 0],
];
