//! Which changes of height are short slopes: what the frames say of each, together.

use geometry::{Map, Point, Pose, Robot};
use mapping::Bevel;
use nalgebra::{Point2, Vector2};

use crate::edges::edge_model::bevel::FittedBevel;
use crate::{BevelMemoryTuning, Edge};

/// A change of height, and what the frames said of it.
#[derive(Debug, Clone)]
pub(super) struct ChangeOfHeight {
    /// Heights before and behind it, map frame, m.
    pub(super) heights_m: [f64; 2],
    /// The middle of the slope that it may be, its ends those of the widest sight of it.
    pub(super) middle: Edge<Map>,
    pub(super) run_m: f64,
    /// What its place and length weigh.
    weight: f64,
    /// By how much it is better explained by a slope, in squared noise.
    pub(super) better: f64,
    /// Whether a sole stood on it that was not tilted so: it is none.
    pub(super) refuted: bool,
    /// Steps since it was last seen.
    steps_ago: u32,
}

impl ChangeOfHeight {
    /// Whether it is at the place of another one, whichever of them is which way up.
    fn is_at(&self, other: &Self, apart_m: f64) -> bool {
        self.middle.beyond_m(other.middle.middle_m()).abs() < apart_m
            && other.middle.beyond_m(self.middle.middle_m()).abs() < apart_m
    }

    /// Whether it is between the same levels as another one, seen from either side.
    fn has_levels(&self, other: &Self, same_m: f64) -> bool {
        let [a, b] = self.heights_m;
        let same = |[c, d]: [f64; 2]| (a - c).abs() < same_m && (b - d).abs() < same_m;
        let [near_m, far_m] = other.heights_m;
        let ahead = self.middle.across().dot(&other.middle.across()) > 0.0;
        same(if ahead {
            [near_m, far_m]
        } else {
            [far_m, near_m]
        })
    }

    /// This one with what another frame says of it.
    fn with(mut self, new: &Self, tuning: &BevelMemoryTuning) -> Self {
        let (most, settled) = (tuning.most, tuning.settled);
        self.better = (self.better + new.better).clamp(-most, most);
        self.steps_ago = 0;
        if new.weight > 0.0 {
            let ahead = self.middle.across().dot(&new.middle.across()) > 0.0;
            let [near_m, far_m] = new.heights_m;
            let (middle, heights_m) = if ahead {
                (new.middle, [near_m, far_m])
            } else {
                (new.middle.reversed(), [far_m, near_m])
            };
            let share = new.weight / (self.weight + new.weight);
            self.run_m += share * (new.run_m - self.run_m);
            self.middle = between(&self.middle, &middle, share);
            for (known, new) in self.heights_m.iter_mut().zip(heights_m) {
                *known += share * (new - *known);
            }
            self.weight = (self.weight + new.weight).min(settled);
        }
        self
    }
}

/// The changes of height that were looked at.
#[derive(Debug, Clone, Default)]
pub(crate) struct Bevels {
    pub(super) known: Vec<ChangeOfHeight>,
}

impl Bevels {
    /// Drops all.
    pub(crate) fn forget(&mut self) {
        self.known.clear();
    }

    /// The robot stepped this often; what was not seen for longer is forgotten.
    pub(crate) fn step(&mut self, times: u64, forget_steps: u32) {
        let times = u32::try_from(times).unwrap_or(u32::MAX);
        self.known.retain_mut(|known| {
            known.steps_ago = known.steps_ago.saturating_add(times);
            known.steps_ago <= forget_steps
        });
    }

    /// Takes in what a frame says of a change of height.
    pub(crate) fn see(
        &mut self,
        fitted: &FittedBevel,
        heights_m: [f64; 2],
        (map_from_robot, same_level_m): (&Pose<Map, Robot>, f64),
        tuning: &BevelMemoryTuning,
    ) {
        let middle = fitted.middle.transformed(map_from_robot);
        let better = fitted.better - tuning.price;
        let said = better.clamp(-tuning.most_once, tuning.most_once);
        let new = ChangeOfHeight {
            heights_m,
            middle,
            run_m: fitted.run_m,
            weight: better.clamp(0.0, tuning.most),
            better: said,
            refuted: false,
            steps_ago: 0,
        };
        let is_here = |known: &ChangeOfHeight| known.is_at(&new, tuning.apart);
        let is_same =
            |known: &ChangeOfHeight| is_here(known) && known.has_levels(&new, same_level_m);
        let mut same = None;
        self.known.retain_mut(|known| {
            if is_same(known) && same.is_none() {
                same = Some(known.clone());
            } else if is_here(known) {
                // There is one of them.
                known.better -= said.max(0.0);
                return !is_same(known) && known.better > 0.0;
            } else {
                return true;
            }
            false
        });
        if self.known.len() == tuning.kept {
            let _ = self.known.remove(0);
        }
        self.known.push(match same {
            Some(known) => known.with(&new, tuning),
            None => new,
        });
    }

    /// Those that are sure, their edges with the heights before and behind.
    fn sure(&self, tuning: &BevelMemoryTuning) -> impl Iterator<Item = &ChangeOfHeight> {
        let least = tuning.sure;
        (self.known.iter()).filter(move |known| known.better > least && !known.refuted)
    }

    /// The level before an edge to which the last slope leads that the robot crosses on its way there.
    pub(crate) fn level_before(
        &self,
        edge: &Edge<Map>,
        robot_m: [f64; 2],
        tuning: &BevelMemoryTuning,
    ) -> Option<f64> {
        let between = self.sure(tuning).filter_map(|known| {
            let at_m = edge.beyond_m(known.middle.middle_m());
            let crossed = known.middle.beyond_m(edge.middle_m());
            let here = known.middle.beyond_m(robot_m);
            let is_between = at_m < -tuning.apart && crossed * here < 0.0;
            let [near_m, far_m] = known.heights_m;
            is_between.then_some((at_m, if crossed > 0.0 { far_m } else { near_m }))
        });
        let last = between.max_by(|a, b| a.0.total_cmp(&b.0));
        last.map(|(_, level_m)| level_m)
    }

    /// The middles of those that are sure, with the heights before and behind.
    pub(crate) fn middles(
        &self,
        tuning: &BevelMemoryTuning,
    ) -> impl Iterator<Item = (Edge<Map>, [f64; 2])> {
        self.sure(tuning)
            .map(|known| (known.middle, known.heights_m))
    }

    /// The short slopes.
    pub(crate) fn list(&self, bevels: &mut Vec<Bevel>, tuning: &BevelMemoryTuning) {
        bevels.clear();
        bevels.extend(self.sure(tuning).map(|known| {
            let [near_m, far_m] = known.heights_m;
            let uphill = if far_m > near_m {
                known.middle
            } else {
                known.middle.reversed()
            };
            Bevel {
                middle_m: uphill.middle_m(),
                heading_rad: uphill.heading_rad(),
                half_width_m: 0.5 * uphill.length_m(),
                run_m: known.run_m,
                heights_m: [near_m.min(far_m), near_m.max(far_m)],
            }
        }));
    }
}

/// An edge between two, as long as both together reach.
fn between(a: &Edge<Map>, b: &Edge<Map>, share: f64) -> Edge<Map> {
    let (at, other) = (Point2::from(a.middle_m()), Point2::from(b.middle_m()));
    let [from, to] = [a, b].map(|edge| edge.left.inner.xy() - edge.right.inner.xy());
    let along: Vector2<f64> = from.normalize().lerp(&to.normalize(), share).normalize();
    let across = Vector2::new(along.y, -along.x);
    let at = at + across * (share * across.dot(&(other - at)));
    let ends = [a.left, a.right, b.left, b.right].map(|end| along.dot(&(end.inner.xy() - at)));
    let (right, left) = ends
        .iter()
        .fold((f64::MAX, f64::MIN), |(least, most), end| {
            (least.min(*end), most.max(*end))
        });
    let z_m = a.left.inner.z;
    let end = |along_m: f64| Point::new(at.x + along.x * along_m, at.y + along.y * along_m, z_m);
    Edge {
        left: end(left),
        right: end(right),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A frame from the origin that sees a slope, or a step, at a place between 0 and this height.
    fn frame(at_m: f64, run_m: f64, height_m: f64, better: f64) -> (FittedBevel, [f64; 2]) {
        let end = |left_m: f64| Point::new(at_m, left_m, height_m);
        let middle = Edge {
            left: end(0.4),
            right: end(-0.4),
        };
        let fitted = FittedBevel {
            middle,
            run_m,
            better,
        };
        (fitted, [0.0, height_m])
    }

    fn after(frames: &[(FittedBevel, [f64; 2])]) -> Vec<Bevel> {
        let (mut bevels, tuning) = (Bevels::default(), BevelMemoryTuning::default());
        for (fitted, heights_m) in frames {
            bevels.see(fitted, *heights_m, (&Pose::identity(), 0.007), &tuning);
        }
        let mut list = Vec::new();
        bevels.list(&mut list, &tuning);
        list
    }

    #[test]
    fn frames_together_tell_a_slope_and_near_ones_say_where_it_is() {
        let far = vec![frame(0.5, 0.2, 0.02, 3.0); 8];
        let near = vec![frame(0.44, 0.1, 0.018, 40.0); 8];
        assert!(after(&far[..3]).is_empty());
        let found = after(&[far, near].concat());
        assert_eq!(found.len(), 1);
        let [x_m, y_m] = found[0].middle_m;
        assert!((x_m - 0.44).abs() < 0.005 && y_m.abs() < 1e-9, "{found:?}");
        assert!((found[0].run_m - 0.1).abs() < 0.01 && found[0].heading_rad.abs() < 1e-9);
    }

    #[test]
    fn a_step_is_none_whatever_one_frame_says() {
        let mut frames = vec![frame(0.5, 0.08, 0.02, -5.0); 4];
        frames.push(frame(0.5, 0.08, 0.02, 500.0));
        assert!(after(&frames).is_empty());
    }

    #[test]
    fn where_a_change_turns_out_to_be_another_the_first_is_gone() {
        let wrong = vec![frame(0.5, 0.2, -0.024, 9.0); 8];
        let right = vec![frame(0.48, 0.1, 0.012, 9.0); 14];
        let found = after(&[wrong, right].concat());
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].heights_m[1] > 0.0);
    }

    #[test]
    fn the_level_before_an_edge_is_that_of_the_slope_before_it() {
        let (mut bevels, tuning) = (Bevels::default(), BevelMemoryTuning::default());
        for _ in 0..8 {
            let (fitted, heights_m) = frame(0.5, 0.1, 0.02, 20.0);
            bevels.see(&fitted, heights_m, (&Pose::identity(), 0.007), &tuning);
        }
        let edge = |at_m: f64| Edge {
            left: Point::new(at_m, 0.4, 0.0),
            right: Point::new(at_m, -0.4, 0.0),
        };
        let level_m =
            |at_m: f64, robot_m: f64| bevels.level_before(&edge(at_m), [robot_m, 0.0], &tuning);
        assert!((level_m(0.7, 0.0).unwrap() - 0.02).abs() < 1e-9);
        assert_eq!((level_m(0.7, 0.6), level_m(0.4, 0.0)), (None, None));
    }

    #[test]
    fn a_way_down_rises_the_other_way() {
        let found = after(&vec![frame(0.5, 0.1, -0.02, 20.0); 8]);
        assert!(found[0].heading_rad.abs() > 3.1, "{found:?}");
        assert!((found[0].heights_m[0] + 0.02).abs() < 1e-9);
    }
}
