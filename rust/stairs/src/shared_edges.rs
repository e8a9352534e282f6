//! The edge between two surfaces, seen from both. The labels of each run over it or stop before it, by as much: the
//! middle between the far side of the nearer and the near side of the farther surface is right within millimetres.

use geometry::Robot;
use nalgebra::{Point2, Vector2};

use crate::extract::{OPPOSITE, Sighting, level_edge};
use crate::view::View;
use crate::{Edge, StairsConfig};

/// How far the two sides may lie apart besides their fringes, m.
const GAP_M: f64 = 0.03;
/// How far beside its ends an edge is still believed to go on, m.
const BESIDE_M: f64 = 0.05;

/// Two surfaces that meet, and the edge between them.
struct Shared {
    nearer: usize,
    farther: usize,
    at: Point2<f64>,
    along: Vector2<f64>,
}

/// Gives neighbours the edge between them.
pub(crate) fn share_edges(found: &mut [Sighting], view: &View<'_>, config: &StairsConfig) {
    for farther in 0..found.len() {
        let candidates = (0..found.len()).filter(|&nearer| nearer != farther);
        let shared = candidates.filter_map(|nearer| shared(found, [nearer, farther], view, config));
        let nearest = shared.min_by(|(a_m, _), (b_m, _)| a_m.total_cmp(b_m));
        if let Some((_, shared)) = nearest {
            let nearer = &mut found[shared.nearer].stair;
            nearer.back = shared.on(&nearer.back);
            nearer.seen_ends.back = nearer.support;
            let farther = &mut found[shared.farther].stair;
            farther.front = shared.on(&farther.front);
            farther.seen_ends.front = farther.support;
        }
    }
}

impl Shared {
    /// An edge of one of the two, moved onto the shared one.
    fn on(&self, edge: &Edge<Robot>) -> Edge<Robot> {
        let ends = [&edge.right, &edge.left].map(|end| {
            let end = end.inner.xy();
            self.at + self.along * self.along.dot(&(end - self.at))
        });
        level_edge(ends, edge.left.inner.z)
    }
}

/// How far the far side of one surface and the near side of another lie apart, m, and the middle between them, if they
/// are neighbours.
fn shared(
    found: &[Sighting],
    [nearer, farther]: [usize; 2],
    view: &View<'_>,
    config: &StairsConfig,
) -> Option<(f64, Shared)> {
    let (before, behind) = (&found[nearer], &found[farther]);
    let (back, front) = (&before.stair.back, &behind.stair.front);
    let towards = behind.stair.reference.inner.xy().coords.normalize();
    let crossing_m = |edge: &Edge<Robot>| {
        let steepness = edge.across().dot(&towards);
        (steepness > 0.5).then(|| -edge.beyond_m([0.0, 0.0]) / steepness)
    };
    let (ends_m, begins_m) = (crossing_m(back)?, crossing_m(front)?);
    let drop_m = before.stair.height_m() - behind.stair.height_m();
    let below_m = view.height_m() - before.stair.height_m();
    if drop_m.abs() < config.own_height || below_m < 0.05 || ends_m < 0.0 {
        return None;
    }
    // The near side of a lower surface is hidden as far as the ray over the higher one's edge goes on.
    let hidden_m = drop_m.max(0.0) * ends_m / below_m;
    let gap_m = begins_m - hidden_m - ends_m;
    let parallel = back.across().dot(&front.across()) > OPPOSITE;
    let fringes_m = before.fringe_m + behind.fringe_m;
    let crossing = Point2::from(towards * ends_m);
    if !parallel || gap_m.abs() > GAP_M + fringes_m || beside_m(back, &crossing) > BESIDE_M {
        return None;
    }
    let [back_run, front_run] = [back, front].map(|edge| (edge.left.inner - edge.right.inner).xy());
    let along = (back_run + front_run).normalize();
    let middle_m = (ends_m + begins_m - hidden_m) / 2.0;
    let shared = Shared {
        nearer,
        farther,
        at: (towards * middle_m).into(),
        along,
    };
    Some((gap_m.abs(), shared))
}

/// How far beside an edge's ends a place lies, m.
fn beside_m(edge: &Edge<Robot>, place: &Point2<f64>) -> f64 {
    let (left, right) = (edge.left.inner.xy(), edge.right.inner.xy());
    let along = (left - right).normalize();
    let to_left_m = along.dot(&(place - left));
    to_left_m.max(along.dot(&(right - place)))
}
