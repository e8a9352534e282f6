//! What is seen of the stairs, and the plan that follows from it.

use geometry::PlanarPose;
use planning::{AStarConfig, Climb, NoWay, Path, Plan, Refusal, Step};
use stairs::{ClimbingConfig, EdgeFit, Footing, Onward, Stair};

use crate::climbing::simulation::{FEET, Simulation};

const EYE_HEIGHT_M: f64 = 0.45;

impl Simulation {
    pub(super) fn see(&mut self) {
        let pose = self.pose();
        let moving = !self.stands();
        for (at, stair) in self.steps.iter().enumerate() {
            let middle = stair.front.middle().inner;
            let (x_m, y_m) = pose.inverse().apply(middle.x, middle.y);
            let away_m = geometry::hypot(x_m - 0.04, y_m);
            let down_rad = libm::atan2(EYE_HEIGHT_M - (stair.height_m() - self.ground_m()), away_m);
            let in_view = geometry::angle_between(self.gaze.pan_rad, libm::atan2(y_m, x_m)).abs()
                < 0.41
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

    pub(super) fn make_plan(&self) -> Plan {
        Plan {
            way: self.way(),
            replanned: false,
        }
    }

    fn way(&self) -> Result<Path, NoWay> {
        let pose = self.pose();
        let from = self.index_at([pose.x_m, pose.y_m]).map_or(0, |at| at + 1);
        let goal = self.index_at([self.goal.x_m, self.goal.y_m]);
        if goal.map_or(0, |at| at + 1) < from {
            // This planner knows no way back.
            return Err(NoWay::new(Refusal::Drop, "the goal lies behind".to_owned()));
        }
        let mut ground_m = self.ground_m();
        let mut steps = Vec::new();
        for stair in &self.staircase.stairs {
            let middle = stair.front.middle().inner;
            let goal_m = [self.goal.x_m, self.goal.y_m];
            let away_m = -stair.front.beyond_m([pose.x_m, pose.y_m]);
            if away_m <= 0.0
                || steps.is_empty() && away_m > self.planned_within_m
                || stair.front.beyond_m(goal_m) < 0.0
                || steps.len() + from >= self.steps.len()
            {
                continue;
            }
            steps.push(Step {
                stair: *stair,
                rise_m: stair.height_m() - ground_m,
                crossing_m: [middle.x, middle.y + self.way_aside_m],
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
    let count = (geometry::hypot(to[0] - from[0], to[1] - from[1]) / 0.04)
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
            return Err(NoWay::unfit(&config, &AStarConfig::default(), unfit));
        }
    }
    Ok(())
}
