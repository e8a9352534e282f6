//! Where the camera is, in the world and in a body's own frame.

/// Three numbers: a place, a direction or half sizes.
pub(crate) type Triple = [f64; 3];

/// The scalar product.
#[inline]
pub(crate) fn dot(a: Triple, b: Triple) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The difference.
#[inline]
pub(crate) fn minus(a: Triple, b: Triple) -> Triple {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// A camera's place and attitude in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraPose {
    /// Where it is, m.
    pub position_m: [f64; 3],
    /// World from the optical frame (z ahead, y down), row by row.
    pub rotation: [f64; 9],
}

impl CameraPose {
    /// A column of the rotation: an axis of the optical frame in the world.
    fn axis(&self, column: usize) -> Triple {
        [0, 3, 6].map(|row| self.rotation[row + column])
    }

    /// A point of the world in the optical frame.
    pub(crate) fn look(&self, point: Triple) -> Triple {
        let away = minus(point, self.position_m);
        [0, 1, 2].map(|column| dot(self.axis(column), away))
    }
}

/// A viewpoint in a body's own frame. The ray of a pixel is `ahead + x across + y down`, x and y being its place on the picture at
/// one metre: a ray's parameter is therefore the depth along the axis.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LocalEye {
    pub(crate) place: Triple,
    pub(crate) across: Triple,
    pub(crate) down: Triple,
    pub(crate) ahead: Triple,
}

impl LocalEye {
    /// A viewpoint seen from a body at `position`, whose rotation, world from body, is given row by row.
    pub(crate) fn new(view: &CameraPose, position: Triple, rotation: &[f64; 9]) -> Self {
        let into = |v: Triple| {
            [0, 1, 2].map(|column| {
                rotation[column] * v[0] + rotation[column + 3] * v[1] + rotation[column + 6] * v[2]
            })
        };
        Self {
            place: into(minus(view.position_m, position)),
            across: into(view.axis(0)),
            down: into(view.axis(1)),
            ahead: into(view.axis(2)),
        }
    }

    /// A point of the body's frame in the optical frame.
    pub(crate) fn look(&self, point: Triple) -> Triple {
        let away = minus(point, self.place);
        [
            dot(self.across, away),
            dot(self.down, away),
            dot(self.ahead, away),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_at_the_same_place_of_the_picture_by_the_world_and_by_a_body() {
        let view = CameraPose {
            position_m: [0.3, -0.2, 0.5],
            rotation: [0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0],
        };
        // A quarter turn about z.
        let turned = [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        let eye = LocalEye::new(&view, [1.0, 2.0, 0.0], &turned);
        // (0.1, 0.2, 0.3) of the body stands at (0.8, 2.1, 0.3).
        let (by_body, by_world) = (eye.look([0.1, 0.2, 0.3]), view.look([0.8, 2.1, 0.3]));
        for (a, b) in by_body.into_iter().zip(by_world) {
            assert!((a - b).abs() < 1e-12, "{by_body:?} {by_world:?}");
        }
        assert!((by_body[2] - 0.5).abs() < 1e-12);
    }
}
