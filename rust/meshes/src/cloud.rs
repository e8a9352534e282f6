//! A mesh of points in no order, where they are a field: of heights, seen from above, or of ranges, seen from where the sensor was.

use nalgebra::{Matrix3, Vector3};
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};

use crate::joining::JoiningRule;
use crate::mesh::{TriangleMesh, vector};
use crate::picture::SeenMesh;

/// From where a cloud is a field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SeenFrom {
    /// From high above: each place has one height, as in airborne clouds. The height is that of the sensor above the highest point, m, at
    /// which the noise is that of its ranges.
    Above(f64),
    /// From the place of the sensor, m: each direction has one range.
    Eye([f64; 3]),
}

/// A cloud that cannot be made a mesh of.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CloudMeshError {
    /// More corners than numbers.
    #[error("a cloud of at most {most} points can become a mesh, got {found}")]
    TooLarge {
        /// Points at most.
        most: usize,
        /// Points found.
        found: usize,
    },
}

/// Where a point lies in the plane of the triangulation.
#[derive(Debug, Clone, Copy)]
struct Flattened {
    at: Point2<f64>,
    point: u32,
}

impl HasPosition for Flattened {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

/// A mesh of points, m, by Delaunay's triangulation of how they lie as they are seen; those that are no numbers are left out, and of several
/// in one direction all but one. Between points of which one lies on another surface than the other there is no triangle, nor across gaps
/// in the cloud. From the sensor's place directions are drawn as circles stay circles (stereographically), so that this is Delaunay's
/// triangulation of the sphere, but for a hole opposite to where most points are.
pub fn mesh_of_cloud(
    points_m: &[[f32; 3]],
    from: SeenFrom,
    rule: &JoiningRule,
) -> Result<SeenMesh, CloudMeshError> {
    let most = u32::MAX as usize;
    if points_m.len() > most {
        let found = points_m.len();
        return Err(CloudMeshError::TooLarge { most, found });
    }
    let view = CloudView::of(points_m, from);
    let numbered = points_m.iter().enumerate();
    let seen = numbered.filter_map(|(number, &at_m)| {
        let at = view.flattened(vector(at_m))?;
        let point = number as u32;
        Some(Flattened { at, point })
    });
    let mut mesh = TriangleMesh {
        corners_m: points_m.to_vec(),
        triangles: Vec::new(),
    };
    // Numbers that Delaunay's triangulation refuses are no directions.
    if let Ok(flat) = DelaunayTriangulation::<Flattened>::bulk_load_stable(seen.collect()) {
        mesh.triangles = view.triangles(&flat, points_m, rule);
    }
    Ok(SeenMesh::tidied(mesh))
}

/// How a cloud is seen.
struct CloudView {
    from: SeenFrom,
    /// Turns the direction in which the points are to z.
    turned: Matrix3<f64>,
    /// Where sight lines begin, for all that is seen from above: so high, m.
    top_m: f64,
}

impl CloudView {
    fn of(points_m: &[[f32; 3]], from: SeenFrom) -> Self {
        let seen = points_m.iter().map(|&at| vector(at));
        let seen = seen.filter(|at| at.iter().all(|part| part.is_finite()));
        let (mut sum, mut top_m) = (Vector3::zeros(), f64::NEG_INFINITY);
        for at in seen {
            top_m = top_m.max(at.z);
            if let SeenFrom::Eye(eye_m) = from {
                let along = at - Vector3::from(eye_m);
                sum += along.try_normalize(0.0).unwrap_or_default();
            }
        }
        let z = sum.try_normalize(0.0).unwrap_or_else(Vector3::z);
        let aside = [Vector3::x(), Vector3::y()];
        let aside = aside[usize::from(z.x.abs() > z.y.abs())];
        let x = aside.cross(&z).normalize();
        Self {
            from,
            turned: Matrix3::from_columns(&[x, z.cross(&x), z]).transpose(),
            top_m,
        }
    }

    /// A point's sight line, m: from where the line begins to the point.
    fn sight(&self, at: Vector3<f64>) -> Vector3<f64> {
        match self.from {
            SeenFrom::Above(height_m) => Vector3::new(0.0, 0.0, at.z - self.top_m - height_m),
            SeenFrom::Eye(eye_m) => at - Vector3::from(eye_m),
        }
    }

    /// Where a point is in the plane of the triangulation; none where it is nowhere.
    fn flattened(&self, at: Vector3<f64>) -> Option<Point2<f64>> {
        let [x, y] = match self.from {
            SeenFrom::Above(_) => [at.x, at.y],
            SeenFrom::Eye(_) => {
                let along = self.turned * self.sight(at).try_normalize(0.0)?;
                [along.x, along.y].map(|part| part / (1.0 + along.z))
            }
        };
        let clean = [x, y].map(|part| spade::mitigate_underflow(Point2::new(part, 0.0)).x);
        let point = Point2::new(clean[0], clean[1]);
        (x.is_finite() && y.is_finite() && at.z.is_finite()).then_some(point)
    }

    /// The triangles of one surface each, facing the eye.
    fn triangles(
        &self,
        flat: &DelaunayTriangulation<Flattened>,
        points_m: &[[f32; 3]],
        rule: &JoiningRule,
    ) -> Vec<[u32; 3]> {
        let apart = |one: Point2<f64>, other: Point2<f64>| {
            geometry::hypot(one.x - other.x, one.y - other.y)
        };
        let lengths = flat.undirected_edges().map(|edge| {
            let [one, other] = edge.positions();
            apart(one, other)
        });
        let mut lengths: Vec<f64> = lengths.collect();
        let middle = lengths.len() / 2;
        let usual = if lengths.is_empty() {
            0.0
        } else {
            *lengths.select_nth_unstable_by(middle, f64::total_cmp).1
        };
        let joined = |one: &Flattened, other: &Flattened| {
            let [a, b] = [one, other].map(|end| vector(points_m[end.point as usize]));
            let near = apart(one.at, other.at) <= rule.gap * usual;
            near && match self.from {
                SeenFrom::Eye(_) => rule.joins(&self.sight(a), &self.sight(b)),
                SeenFrom::Above(_) => {
                    let far = self.sight(b) + Vector3::new(b.x - a.x, b.y - a.y, 0.0);
                    rule.joins(&self.sight(a), &far)
                }
            }
        };
        let mut triangles = Vec::with_capacity(flat.num_inner_faces());
        for face in flat.inner_faces() {
            let corners = face.vertices().map(|corner| *corner.data());
            if (0..3).all(|at| joined(&corners[at], &corners[(at + 1) % 3])) {
                let [a, b, c] = corners.map(|corner| corner.point);
                // The flat triangles go around as seen from above, or along the sight lines.
                triangles.push(match self.from {
                    SeenFrom::Above(_) => [a, b, c],
                    SeenFrom::Eye(_) => [a, c, b],
                });
            }
        }
        triangles
    }
}
