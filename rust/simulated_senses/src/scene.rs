//! The bodies that rays can meet: their forms, made once, and their poses, new in each frame.

use crate::error::{SceneError, of_length};
use crate::eye::Triple;
use crate::shapes::{HeightField, Mesh};
use crate::view::Around;

/// The form of a body in its own frame, around its origin. Lengths are m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Form {
    /// The plane z = 0, seen from above; half sizes along x and y, without end where not above 0.
    Plane([f64; 2]),
    /// Radius.
    Sphere(f64),
    /// About z: radius, and half of the length between the middles of its ends.
    Capsule(f64, f64),
    /// Half axes.
    Ellipsoid([f64; 3]),
    /// About z: radius and half length.
    Cylinder(f64, f64),
    /// Half sizes.
    Cuboid([f64; 3]),
    /// Index among the scene's height fields.
    HeightField(usize),
    /// Index among the scene's meshes.
    Mesh(usize),
    /// A form that is not drawn here.
    Unknown,
}

/// A body of the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geom {
    /// What it looks like.
    pub form: Form,
    /// Whether rays meet it at all.
    pub seen: bool,
}

/// Where all bodies are, in the scene's order.
#[derive(Debug, Clone, Copy)]
pub struct GeomPoses<'a> {
    /// Three numbers a body, m.
    pub positions_m: &'a [f64],
    /// Nine numbers a body: world from body, row by row.
    pub rotations: &'a [f64],
}

impl GeomPoses<'_> {
    /// Refuses poses that are not one a body.
    pub(crate) fn check(&self, bodies: usize) -> Result<(), SceneError> {
        of_length("geom_xpos", self.positions_m.len(), 3 * bodies)?;
        of_length("geom_xmat", self.rotations.len(), 9 * bodies)
    }

    /// Position and rotation of a body.
    pub(crate) fn of(&self, body: usize) -> (Triple, &[f64; 9]) {
        let positions = self.positions_m.as_chunks::<3>().0;
        (positions[body], &self.rotations.as_chunks::<9>().0[body])
    }
}

/// The bodies, with the meshes and height fields that they share.
#[derive(Debug, Clone)]
pub struct TrueScene {
    bodies: Vec<Geom>,
    /// The box around each body; `None` for what has no end.
    around: Vec<Option<Around>>,
    /// Those whose rays cost little, and those that are looked through last, behind what is known by then.
    quick: Vec<usize>,
    slow: Vec<usize>,
    meshes: Vec<Mesh>,
    fields: Vec<HeightField>,
}

impl TrueScene {
    /// Refuses bodies that cannot be drawn; those of unknown form are left out.
    pub fn new(
        bodies: Vec<Geom>,
        meshes: Vec<Mesh>,
        fields: Vec<HeightField>,
    ) -> Result<Self, SceneError> {
        let mut around = Vec::with_capacity(bodies.len());
        let (mut quick, mut slow) = (Vec::new(), Vec::new());
        for (index, body) in bodies.iter().enumerate() {
            let (lengths, box_around) = match body.form {
                Form::Plane([x, y]) => {
                    let ends = (x > 0.0 && y > 0.0).then_some([x, y, 0.0]);
                    ([x.abs(), y.abs(), 0.0], ends.map(centred))
                }
                Form::Sphere(radius) => ([radius; 3], Some(centred([radius; 3]))),
                Form::Capsule(radius, half) => {
                    let sides = [radius, radius, radius + half];
                    ([radius, half, 0.0], Some(centred(sides)))
                }
                Form::Cylinder(radius, half) => {
                    ([radius, half, 0.0], Some(centred([radius, radius, half])))
                }
                Form::Ellipsoid(half) | Form::Cuboid(half) => (half, Some(centred(half))),
                Form::HeightField(field) => {
                    let field = fields.get(field).ok_or(SceneError::Form { body: index })?;
                    ([0.0; 3], Some(field.around()))
                }
                Form::Mesh(mesh) => {
                    let mesh = meshes.get(mesh).ok_or(SceneError::Form { body: index })?;
                    ([0.0; 3], Some(*mesh.around()))
                }
                Form::Unknown => ([0.0; 3], None),
            };
            if !lengths
                .iter()
                .all(|length| length.is_finite() && *length >= 0.0)
            {
                let what = format!("a size of body {index}");
                return Err(SceneError::NotFinite { what });
            }
            around.push(box_around);
            match body.form {
                _ if !body.seen => {}
                Form::Unknown => {}
                Form::HeightField(_) | Form::Mesh(_) => slow.push(index),
                _ => quick.push(index),
            }
        }
        Ok(Self {
            bodies,
            around,
            quick,
            slow,
            meshes,
            fields,
        })
    }

    /// Number of bodies.
    pub const fn len(&self) -> usize {
        self.bodies.len()
    }

    /// Whether there are none.
    pub const fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// The bodies that would be seen, but whose form is not drawn here.
    pub fn unknown(&self) -> Vec<usize> {
        let all = 0..self.bodies.len();
        all.filter(|index| self.bodies[*index].seen && self.bodies[*index].form == Form::Unknown)
            .collect()
    }

    /// Those that are drawn, in the order in which they are.
    pub(crate) fn drawn(&self) -> impl Iterator<Item = (usize, Form, Option<&Around>)> {
        let drawn = self.quick.iter().chain(&self.slow);
        drawn.map(|&index| (index, self.bodies[index].form, self.around[index].as_ref()))
    }

    /// A mesh, by an index that was checked.
    pub(crate) fn mesh(&self, index: usize) -> &Mesh {
        &self.meshes[index]
    }

    /// A height field, by an index that was checked.
    pub(crate) fn field(&self, index: usize) -> &HeightField {
        &self.fields[index]
    }
}

/// A box around the origin.
const fn centred(half: Triple) -> Around {
    Around {
        centre: [0.0; 3],
        half,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(form: Form) -> Result<TrueScene, SceneError> {
        TrueScene::new(vec![Geom { form, seen: true }], vec![], vec![])
    }

    #[test]
    fn what_is_not_drawn_here_is_said() {
        assert_eq!(scene(Form::Unknown).unwrap().unknown(), [0]);
        assert!(scene(Form::Sphere(1.0)).unwrap().unknown().is_empty());
        let unseen = Geom {
            form: Form::Unknown,
            seen: false,
        };
        let scene = TrueScene::new(vec![unseen], vec![], vec![]).unwrap();
        assert!(scene.unknown().is_empty());
        assert_eq!(scene.drawn().count(), 0);
    }

    #[test]
    fn sizes_that_are_no_numbers_and_meshes_that_are_not_there_are_refused() {
        let refused = scene(Form::Sphere(f64::NAN)).unwrap_err();
        assert_eq!(refused.to_string(), "a size of body 0 is no finite number");
        assert!(scene(Form::Cuboid([1.0, -1.0, 1.0])).is_err());
        assert_eq!(
            scene(Form::Mesh(0)).unwrap_err(),
            SceneError::Form { body: 0 }
        );
        assert!(scene(Form::HeightField(0)).is_err());
    }
}
