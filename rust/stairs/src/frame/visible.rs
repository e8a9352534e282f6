//! What of a stair is in view, and where it ends there.

use geometry::Robot;
use nalgebra::{Point3, Vector2};

use crate::frame::view::{PlanesView, Shows};
use crate::{Edge, Sides, Stair, StairsConfig, StairsTuning};

/// Whether the surface is seen at most of the places of the stair: hulls are optimistic.
pub(crate) fn is_solid(stair: &Stair<Robot>, view: &PlanesView<'_>, tuning: &StairsTuning) -> bool {
    let (mut surface, mut other) = (0, 0);
    for place in stair.places(&tuning.places) {
        match view.shows_at(&place.inner) {
            Some(Shows::Surface) => surface += 1,
            Some(Shows::Higher | Shows::Lower) => other += 1,
            None => {}
        }
    }
    f64::from(surface) >= tuning.frame.solid * f64::from(surface + other) && surface > 0
}

/// Which sides end the surface and not only the view; of its front and its back, those that are `shared` with a neighbour
/// surely do. What ends behind something higher on the robot's side is hidden.
pub(crate) fn seen_ends(
    stair: &Stair<Robot>,
    shared: [bool; 2],
    view: &PlanesView<'_>,
    config: &StairsConfig,
) -> Sides {
    let tuning = &config.tuning.frame;
    let Stair { front, back, .. } = stair;
    let beyond = |edge: &Edge<Robot>, outward: Vector2<f64>| {
        view.beyond([&edge.left.inner, &edge.right.inner], &outward)
    };
    let support = |is_shared: bool, ends: bool| match (is_shared, ends) {
        (true, _) => stair.support,
        (false, true) => stair.support.div_ceil(tuning.one_sided),
        (false, false) => 0,
    };
    let ends_before = beyond(front, -front.across()).lower >= tuning.side_ends;
    let ends_behind = beyond(back, back.across()).any() >= tuning.side_ends;
    let mut seen = Sides {
        front: support(shared[0], ends_before),
        back: support(shared[1], ends_behind),
        ..Sides::default()
    };
    let to_left = |edge: &Edge<Robot>| (edge.left.inner - edge.right.inner).xy();
    // An edge that is only where the picture ends does not say which way is sideways.
    let left = match (seen.front > 0, seen.back > 0) {
        (true, false) => to_left(front),
        (false, true) => to_left(back),
        _ => to_left(front) + to_left(back),
    };
    let ends = |side: [&Point3<f64>; 2], outward: Vector2<f64>| {
        // Where the picture cuts a surface to a corner, that is no side.
        let deep_m = outward.normalize().perp(&(side[1] - side[0]).xy()).abs();
        deep_m > config.min_depth * tuning.side_depth
            && view.beyond(side, &outward).any() >= tuning.side_ends
    };
    let is_left = ends([&front.left.inner, &back.left.inner], left);
    let is_right = ends([&front.right.inner, &back.right.inner], -left);
    seen.left = usize::from(is_left) * stair.support;
    seen.right = usize::from(is_right) * stair.support;
    seen
}
