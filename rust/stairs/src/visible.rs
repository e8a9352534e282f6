//! What of a stair is in view, and where it ends there.

use geometry::Robot;
use nalgebra::Vector2;

use crate::view::{Shows, View};
use crate::{Edge, Sides, Stair};

/// Share of a side's places that must show that the surface ends there.
const ENDS: f64 = 0.5;
/// Share of a stair's places that must show the surface, of those that show anything.
const SOLID: f64 = 0.6;
/// What an edge counts that was seen from one of its sides only: fringes move it by centimetres.
const ONE_SIDED: usize = 8;

/// Whether the surface is seen at most of the places of the stair: hulls are optimistic.
pub(crate) fn is_solid(stair: &Stair<Robot>, view: &View<'_>) -> bool {
    let (mut surface, mut other) = (0, 0);
    for place in stair.places() {
        match view.shows_at(&place.inner) {
            Some(Shows::Surface) => surface += 1,
            Some(Shows::Higher | Shows::Lower) => other += 1,
            None => {}
        }
    }
    f64::from(surface) >= SOLID * f64::from(surface + other) && surface > 0
}

/// Which sides end the surface and not only the view. What ends behind something higher on the robot's side is hidden.
pub(crate) fn seen_ends(stair: &Stair<Robot>, view: &View<'_>) -> Sides {
    let [front_left, front_right] = [&stair.front.left.inner, &stair.front.right.inner];
    let [back_left, back_right] = [&stair.back.left.inner, &stair.back.right.inner];
    let to_left = |edge: &Edge<Robot>| (edge.left.inner - edge.right.inner).xy();
    let left = to_left(&stair.front) + to_left(&stair.back);
    let ends = |side: [&_; 2], outward: Vector2<f64>| {
        let beyond = view.beyond(side, &outward);
        beyond.lower + beyond.higher >= ENDS
    };
    let front = view.beyond([front_left, front_right], &-stair.front.across());
    let back = ends([back_left, back_right], stair.back.across());
    Sides {
        front: usize::from(front.lower >= ENDS) * stair.support.div_ceil(ONE_SIDED),
        back: usize::from(back) * stair.support.div_ceil(ONE_SIDED),
        left: usize::from(ends([front_left, back_left], left)) * stair.support,
        right: usize::from(ends([front_right, back_right], -left)) * stair.support,
    }
}
