//! The path before, or a new one.

use geometry::{PlanarPose, angle_between};
use terrain::StandingAt;

use crate::{AStar, Goal, NoWay, Path, PathEnd, Plan};

impl AStar {
    /// What is left of the path before where it holds.
    pub(crate) fn rest(&mut self, stand: &StandingAt, goal: &Goal) -> Option<Path> {
        let followed = (self.followed.as_ref()).filter(|_| self.goal == Some(*goal))?;
        if followed.end == PathEnd::Look
            && let Some(&end_m) = followed.points_m.last()
            && self.viewpoints.arrive(stand.at_m, end_m)
        {
            return None;
        }
        if followed.end == PathEnd::Border && !self.goal_inside && self.is_inside(goal) {
            return None;
        }
        let by = (&self.config, &self.climbing.levels);
        let mut rest = followed.rest(&self.terrain, &self.links, stand, by)?;
        rest.annotate(&self.terrain, &self.config);
        Some(rest)
    }

    fn is_inside(&self, goal: &Goal) -> bool {
        self.terrain.index_at([goal.x_m, goal.y_m]).is_some()
    }

    /// Whether part of what is left of the path became known since it was planned or held last.
    pub(crate) fn is_revealed(&self, rest: &Path) -> bool {
        let followed = self.followed.as_ref();
        followed.is_some_and(|followed| rest.unknown_points() < followed.unknown_points())
    }

    /// The path before, or the new one, to `goal`, if it is much better or leads further.
    pub(crate) fn choose(
        &mut self,
        rest: Option<Path>,
        found: Result<Path, NoWay>,
        goal: &Goal,
        start: &PlanarPose,
    ) -> Plan {
        let (mut new, rest) = match (found, rest) {
            (Ok(new), rest) => (new, rest),
            (Err(_), Some(rest)) if rest.end.is_certain() => return self.hold(rest),
            (Err(no_way), _) => {
                self.followed = None;
                return Plan {
                    way: Err(no_way),
                    replanned: true,
                };
            }
        };
        new.annotate(&self.terrain, &self.config);
        let Some(rest) = rest else {
            return self.set_out(new, goal);
        };
        let setting_off_m = self.config.tuning.choice.setting_off;
        let cost_m = |path: &Path| {
            path.cost_m + self.config.turn_cost * turn_rad(path, start, setting_off_m)
        };
        let (new_m, rest_m) = (cost_m(&new), cost_m(&rest));
        let further_m = self.left_m(&new, goal) - self.left_m(&rest, goal);
        let worse = new_m + further_m >= self.config.better * rest_m;
        let stays = match (rest.end.is_certain(), new.end.is_certain()) {
            (true, true) => worse,
            (true, false) => true,
            (false, true) => false,
            (false, false) => worse && rest.end == new.end && rest.steps() == new.steps(),
        };
        if stays {
            self.hold(rest)
        } else {
            self.set_out(new, goal)
        }
    }

    /// Goes on with the path before.
    pub(crate) fn hold(&mut self, rest: Path) -> Plan {
        self.followed = Some(rest.clone());
        Plan {
            way: Ok(rest),
            replanned: false,
        }
    }

    /// Sets out on a new path.
    fn set_out(&mut self, new: Path, goal: &Goal) -> Plan {
        self.goal = Some(*goal);
        self.goal_inside = self.is_inside(goal);
        Plan {
            replanned: true,
            ..self.hold(new)
        }
    }

    /// What is left behind the end of a path, m. Paths end where the window did when they were found, one further on than the
    /// other.
    fn left_m(&self, path: &Path, goal: &Goal) -> f64 {
        match (path.end, path.points_m.last()) {
            (PathEnd::Border, Some(&end_m)) => self.outside.left_m(end_m, goal),
            _ => 0.0,
        }
    }
}

/// How far the robot has to turn to set off on a path, rad.
fn turn_rad(path: &Path, start: &PlanarPose, setting_off_m: f64) -> f64 {
    let away_m = |point: &&[f64; 2]| geometry::hypot(point[0] - start.x_m, point[1] - start.y_m);
    let ahead = path
        .points_m
        .iter()
        .find(|point| away_m(point) > setting_off_m);
    ahead.map_or(0.0, |[x, y]| {
        let bearing_rad = libm::atan2(y - start.y_m, x - start.x_m);
        angle_between(start.yaw_rad, bearing_rad).abs()
    })
}
