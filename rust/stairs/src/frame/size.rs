//! Whether what one frame shows is large enough for a stair (003, section IV.B).

use geometry::Robot;

use crate::{Edge, Stair, StairsConfig, frame::view::PlanesView};

/// Whether both edges and the depth between them are long enough for a stair (003, section IV.B).
pub(crate) fn is_large_enough(stair: &Stair<Robot>, config: &StairsConfig) -> bool {
    let shortest_m = stair.front.length_m().min(stair.back.length_m());
    shortest_m >= config.min_edge && stair.depth_m() >= config.min_depth
}

/// Whether a stair is deep enough and its edges are, or where they are too short may go on outside the picture.
pub(crate) fn is_cut_short(
    stair: &Stair<Robot>,
    view: &PlanesView<'_>,
    config: &StairsConfig,
) -> bool {
    let may_be_long = |edge: &Edge<Robot>| {
        let missing_m = config.min_edge - edge.length_m();
        let Some(left) = (edge.left.inner - edge.right.inner).try_normalize(1e-6) else {
            return false;
        };
        let further = [
            edge.left.inner + left * missing_m,
            edge.right.inner - left * missing_m,
        ];
        missing_m <= 0.0 || further.iter().any(|place| !view.contains(place))
    };
    let edges = [&stair.front, &stair.back];
    let longest_m = edges.map(Edge::length_m).into_iter().fold(0.0, f64::max);
    stair.depth_m() >= config.min_depth
        && longest_m >= config.min_edge
        && edges.into_iter().all(may_be_long)
}

#[cfg(test)]
mod tests {
    use geometry::Point;
    use nalgebra::Point2;
    use segmentation::Planes;

    use super::*;
    use crate::ViewTuning;
    use crate::stair::level_edge;
    use testkit::synthetic::{CAMERA, camera_pose};

    /// A level quadrangle between two edges square to the way, each around y = 0.
    fn stair(front_m: f64, back_m: f64, depth_m: f64) -> Stair<Robot> {
        let edge = |x_m: f64, length_m: f64| {
            let half_m = 0.5 * length_m;
            level_edge([Point2::new(x_m, -half_m), Point2::new(x_m, half_m)], 0.03)
        };
        let reference = Point::new(0.5 + 0.5 * depth_m, 0.0, 0.03);
        Stair::seen(
            edge(0.5, front_m),
            edge(0.5 + depth_m, back_m),
            reference,
            100,
        )
    }

    /// S-M6.
    #[test]
    fn edges_of_15_cm_and_a_depth_of_7_cm_make_a_stair_and_a_tenth_of_a_millimetre_less_does_not() {
        let config = StairsConfig::default();
        let decide =
            |front_m, back_m, depth_m| is_large_enough(&stair(front_m, back_m, depth_m), &config);
        let (more, less) = (1e-9, -1e-4);
        assert!(decide(0.15 + more, 0.15 + more, 0.07 + more));
        assert!(!decide(0.15 + less, 0.3, 0.2));
        assert!(!decide(0.3, 0.15 + less, 0.2));
        assert!(!decide(0.3, 0.3, 0.07 + less));
    }

    #[test]
    fn an_edge_that_leaves_the_picture_may_be_long_enough_and_one_that_ends_in_it_is_not() {
        let mut planes = Planes::new(CAMERA.width * CAMERA.height);
        planes.robot_from_camera = camera_pose(0.0, 0.75);
        let tuning = ViewTuning::default();
        let view = PlanesView::new(&planes, CAMERA, &tuning);
        let row = 0.5 * CAMERA.height as f64;
        let at = |col: f64| view.on_level([col, row], 0.03).unwrap();
        let (middle, border) = (at(0.5 * CAMERA.width as f64), at(0.0));
        let cut_short = |left_m: f64, back_m: f64, depth_m: f64| {
            let edge = |x_m: f64, [right_m, left_m]: [f64; 2]| {
                level_edge([Point2::new(x_m, right_m), Point2::new(x_m, left_m)], 0.03)
            };
            let front = edge(middle.x, [left_m - 0.1, left_m]);
            let back = edge(middle.x + depth_m, [-0.5 * back_m, 0.5 * back_m]);
            let stair = Stair::seen(front, back, front.middle(), 100);
            is_cut_short(&stair, &view, &StairsConfig::default())
        };
        let leaving_m = border.y - 0.01;
        assert!(leaving_m > 0.15);
        assert!(cut_short(leaving_m, 0.2, 0.1));
        assert!(!cut_short(0.05, 0.2, 0.1));
        assert!(!cut_short(leaving_m, 0.1, 0.1));
        assert!(!cut_short(leaving_m, 0.2, 0.06));
    }
}
