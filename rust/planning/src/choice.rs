//! The path before, or a new one.

use geometry::{PlanarPose, angle_between};

use crate::keep::{End, Kept};
use crate::legs::Draft;
use crate::levels::Stand;
use crate::{AStar, Goal, NoWay, Path, Plan};

/// Where a path leads at first is seen this far from the robot, m.
const SETTING_OFF_M: f64 = 0.25;

/// What is left of the path before.
pub(crate) struct Rest {
    pub(crate) draft: Draft,
    pub(crate) path: Path,
    pub(crate) end: End,
    pub(crate) certain: bool,
    /// Whether part of it became known.
    pub(crate) revealed: bool,
}

impl Rest {
    /// Whether the robot is on a leg sideways: until its end no other way is better.
    pub(crate) fn in_slit(&self) -> bool {
        let first = self.draft.sidles.first();
        self.certain && first.is_some_and(|sidle| sidle.from_point == 0)
    }
}

impl AStar {
    /// What is left of the path before where it holds.
    pub(crate) fn rest(&mut self, stand: &Stand, goal: &Goal) -> Option<Rest> {
        let kept = self.kept.as_ref().filter(|kept| kept.goal == *goal)?;
        if kept.end == End::Look
            && let Some(&end_m) = kept.draft.points_m.last()
            && self.seek.arrive(stand.at_m, end_m)
        {
            return None;
        }
        let draft = kept.rest(&self.terrain, &self.portals, stand, &self.config)?;
        let path = draft.annotate(&self.terrain, &self.config);
        Some(Rest {
            revealed: unknown_in(&path) < kept.unknown,
            certain: kept.end.is_certain(),
            end: kept.end,
            draft,
            path,
        })
    }

    /// The path before, or the new one if it is much better or leads further.
    pub(crate) fn choose(
        &mut self,
        kept: Option<Rest>,
        found: Result<Kept, NoWay>,
        start: &PlanarPose,
    ) -> Plan {
        let (new, kept) = match (found, kept) {
            (Ok(new), kept) => (new, kept),
            (Err(_), Some(rest)) if rest.certain => return self.hold(rest),
            (Err(no_way), _) => {
                self.kept = None;
                return Plan {
                    way: Err(no_way),
                    replanned: true,
                };
            }
        };
        let path = new.draft.annotate(&self.terrain, &self.config);
        let Some(rest) = kept else {
            return self.follow(new, path);
        };
        let cost_m = |path: &Path| path.cost_m + self.config.turn_cost * turn_rad(path, start);
        let (new_m, rest_m) = (cost_m(&path), cost_m(&rest.path));
        let further_m = self.beyond_m(&path, new.end, &new.goal)
            - self.beyond_m(&rest.path, rest.end, &new.goal);
        let worse = new_m + further_m >= self.config.better * rest_m;
        let stays = match (rest.certain, new.end.is_certain()) {
            (true, true) => worse,
            (true, false) => true,
            (false, true) => false,
            (false, false) => {
                worse && rest.end == new.end && rest.draft.steps() == new.draft.steps()
            }
        };
        if stays {
            self.hold(rest)
        } else {
            self.follow(new, path)
        }
    }

    /// Goes on with the path before.
    pub(crate) fn hold(&mut self, rest: Rest) -> Plan {
        if let Some(kept) = &mut self.kept {
            kept.draft = rest.draft;
            kept.unknown = unknown_in(&rest.path);
        }
        Plan {
            way: Ok(rest.path),
            replanned: false,
        }
    }

    /// What is left behind the end of a path, m. Paths end where the window did when they were found, one further on than the
    /// other.
    fn beyond_m(&self, path: &Path, end: End, goal: &Goal) -> f64 {
        match (end, path.points_m.last()) {
            (End::Border, Some(&end_m)) => self.beyond.left_m(end_m, goal),
            _ => 0.0,
        }
    }

    /// Takes a new path.
    fn follow(&mut self, new: Kept, path: Path) -> Plan {
        self.kept = Some(Kept {
            unknown: unknown_in(&path),
            ..new
        });
        Plan {
            way: Ok(path),
            replanned: true,
        }
    }
}

/// How many of a path's points were not seen.
fn unknown_in(path: &Path) -> usize {
    path.unknown.iter().filter(|&&unknown| unknown).count()
}

/// How far the robot has to turn to set off on a path, rad.
fn turn_rad(path: &Path, start: &PlanarPose) -> f64 {
    let away_m = |point: &&[f64; 2]| (point[0] - start.x_m).hypot(point[1] - start.y_m);
    let ahead = path
        .points_m
        .iter()
        .find(|point| away_m(point) > SETTING_OFF_M);
    ahead.map_or(0.0, |[x, y]| {
        let bearing_rad = (y - start.y_m).atan2(x - start.x_m);
        angle_between(start.yaw_rad, bearing_rad).abs()
    })
}
