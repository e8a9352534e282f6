//! Draws a scene: the box around each body is projected, and every pixel in it gets a real ray.

use settings::{POSITIVE, settings};

use crate::error::SceneError;
use crate::eye::{CameraPose, LocalEye, dot, minus};
use crate::picture::TruePicture;
use crate::pinhole::Pinhole;
use crate::scene::{Form, GeomPoses, TrueScene};
use crate::shapes::{CapsuleAhead, CuboidAhead, CylinderAhead, EllipsoidAhead, PlaneAhead};
use crate::view::{Around, PixelArea, ViewBorders};

settings! {
    /// How far the simulated camera's rays go.
    pub struct RasterConfig("camera.rays") {
        /// What is nearer is taken to be here.
        nearest: f64 = 1e-6, "m", POSITIVE;
        /// A body all of which is farther is not seen, unless it has no end.
        farthest: f64 = 20.0, "m", POSITIVE;
    }
}

/// A camera's picture, drawn again in each frame.
#[derive(Debug, Clone)]
pub struct DepthRaster {
    config: RasterConfig,
    frustum: ViewBorders,
    picture: TruePicture,
}

impl DepthRaster {
    /// For a camera of this size.
    pub fn new(config: RasterConfig, pinhole: &Pinhole) -> Self {
        Self {
            config,
            frustum: ViewBorders::new(*pinhole),
            picture: TruePicture::new(pinhole),
        }
    }

    /// What was drawn last.
    pub const fn picture(&self) -> &TruePicture {
        &self.picture
    }

    /// What was drawn last, for what was cast elsewhere to be put into it.
    pub const fn picture_mut(&mut self) -> &mut TruePicture {
        &mut self.picture
    }

    /// Writes the depth, m, NaN where nothing was met.
    pub fn write_depth(&self, depth_m: &mut [f64]) {
        self.picture.write_depth(self.config.nearest, depth_m);
    }

    /// Draws the scene as it is seen from here. Of bodies equally near the first one is seen.
    pub fn draw(
        &mut self,
        scene: &TrueScene,
        poses: &GeomPoses<'_>,
        view: &CameraPose,
    ) -> Result<(), SceneError> {
        poses.check(scene.len())?;
        self.picture.clear();
        for (index, form, around) in scene.drawn() {
            let (position, rotation) = poses.of(index);
            if around.is_some_and(|around| self.is_beside(around, position, rotation, view)) {
                continue;
            }
            let eye = LocalEye::new(view, position, rotation);
            let area = match around {
                Some(around) => self.frustum.project(around, &eye),
                None => Some(self.frustum.everything()),
            };
            if let Some(area) = area {
                self.paint(scene, index, form, &eye, &area);
            }
        }
        Ok(())
    }

    /// Whether a body is too far or beside the picture, by the sphere around it.
    fn is_beside(
        &self,
        around: &Around,
        position: [f64; 3],
        rotation: &[f64; 9],
        view: &CameraPose,
    ) -> bool {
        let radius = around.radius_m();
        let away = minus(position, view.position_m);
        let reach = self.config.farthest + radius + dot(around.centre, around.centre).sqrt();
        if dot(away, away) > reach * reach {
            return true;
        }
        let rows = rotation.as_chunks::<3>().0;
        let centre = [0, 1, 2].map(|i| position[i] + dot(rows[i], around.centre));
        !self.frustum.reaches(view.look(centre), radius)
    }

    fn paint(
        &mut self,
        scene: &TrueScene,
        index: usize,
        form: Form,
        eye: &LocalEye,
        area: &PixelArea,
    ) {
        let picture = &mut self.picture;
        let id = index as i32;
        match form {
            Form::Plane(half) => {
                if let Some(plane) = PlaneAhead::new(eye, half) {
                    picture.paint(area, eye, id, |ray, _| plane.met(ray));
                }
            }
            Form::Sphere(radius) => Self::paint_ellipsoid(picture, id, [radius; 3], eye, area),
            Form::Ellipsoid(radii) => Self::paint_ellipsoid(picture, id, radii, eye, area),
            Form::Capsule(radius, half) => {
                let capsule = CapsuleAhead::new(eye, radius, half);
                if capsule.is_before() {
                    picture.paint(area, eye, id, |ray, _| capsule.met(ray));
                } else {
                    picture.paint(area, eye, id, |ray, _| capsule.met_within(ray));
                }
            }
            Form::Cylinder(radius, half) => {
                let cylinder = CylinderAhead::new(eye, radius, half);
                if cylinder.is_beside() {
                    picture.paint(area, eye, id, |ray, _| cylinder.met(ray));
                } else {
                    picture.paint(area, eye, id, |ray, _| cylinder.met_within(ray));
                }
            }
            Form::Cuboid(half) => {
                let cuboid = CuboidAhead::new(eye, half);
                picture.paint(area, eye, id, |ray, _| cuboid.met(ray));
            }
            Form::HeightField(field) => {
                let field = scene.field(field);
                picture.paint(area, eye, id, |ray, known| field.met(eye.place, ray, known));
            }
            Form::Mesh(mesh) => {
                let mesh = scene.mesh(mesh);
                picture.paint(area, eye, id, |ray, known| mesh.met(eye.place, ray, known));
            }
            Form::Unknown => {}
        }
    }

    fn paint_ellipsoid(
        picture: &mut TruePicture,
        id: i32,
        radii_m: [f64; 3],
        eye: &LocalEye,
        area: &PixelArea,
    ) {
        let ellipsoid = EllipsoidAhead::new(eye, radii_m);
        if ellipsoid.is_before() {
            picture.paint(area, eye, id, |ray, _| ellipsoid.met(ray));
        } else {
            picture.paint(area, eye, id, |ray, _| ellipsoid.met_within(ray));
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::scene::Geom;

    const UPRIGHT: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    /// Looks along +x, the picture's right being -y.
    const FORWARD: [f64; 9] = [0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0];

    fn drawn(forms: &[(Form, [f64; 3])], at: [f64; 3]) -> DepthRaster {
        let bodies = forms.iter().map(|(form, _)| Geom {
            form: *form,
            seen: true,
        });
        let scene = TrueScene::new(bodies.collect(), vec![], vec![]).unwrap();
        let positions: Vec<f64> = forms.iter().flat_map(|(_, place)| *place).collect();
        let rotations = UPRIGHT.repeat(forms.len());
        let poses = GeomPoses {
            positions_m: &positions,
            rotations: &rotations,
        };
        let pinhole = Pinhole::new(41, 31, 40.0).unwrap();
        let mut raster = DepthRaster::new(RasterConfig::default(), &pinhole);
        let view = CameraPose {
            position_m: at,
            rotation: FORWARD,
        };
        raster.draw(&scene, &poses, &view).unwrap();
        raster
    }

    fn middle(raster: &DepthRaster) -> (f64, i32) {
        let mut depth = vec![0.0; 41 * 31];
        raster.write_depth(&mut depth);
        (depth[15 * 41 + 20], raster.picture().body()[15 * 41 + 20])
    }

    #[test]
    fn the_nearest_body_is_seen_and_the_first_one_where_two_are_equally_near() {
        let cube = Form::Cuboid([0.5; 3]);
        let far = (cube, [3.0, 0.0, 0.0]);
        let ball = (Form::Sphere(0.5), [2.0, 0.0, 0.0]);
        assert_eq!(middle(&drawn(&[far, ball], [0.0; 3])), (1.5, 1));
        assert_eq!(middle(&drawn(&[ball, far], [0.0; 3])), (1.5, 0));
        assert_eq!(middle(&drawn(&[far, far], [0.0; 3])), (2.5, 0));
    }

    #[test]
    fn what_is_wholly_farther_than_the_rays_go_is_not_seen_but_for_a_plane() {
        let cube = Form::Cuboid([0.5; 3]);
        assert_eq!(middle(&drawn(&[(cube, [20.6, 0.0, 0.0])], [0.0; 3])).1, 0);
        assert_eq!(middle(&drawn(&[(cube, [21.0, 0.0, 0.0])], [0.0; 3])).1, -1);
        let floor = (Form::Plane([0.0; 2]), [-30.0, 0.0, 0.0]);
        assert_eq!(
            drawn(&[floor], [0.0, 0.0, 0.5]).picture().body()[30 * 41],
            0
        );
    }

    #[test]
    fn a_camera_in_a_body_sees_it_from_within() {
        for form in [
            Form::Sphere(1.0),
            Form::Ellipsoid([1.0, 2.0, 2.0]),
            Form::Cuboid([1.0, 3.0, 3.0]),
            Form::Cylinder(1.0, 5.0),
            Form::Capsule(1.0, 5.0),
        ] {
            let (depth, body) = middle(&drawn(&[(form, [0.0; 3])], [0.25, 0.0, 0.0]));
            assert!((depth - 0.75).abs() < 1e-12, "{form:?}: {depth}");
            assert_eq!(body, 0);
        }
    }

    #[test]
    fn poses_that_are_not_one_a_body_are_refused() {
        let body = Geom {
            form: Form::Sphere(1.0),
            seen: true,
        };
        let scene = TrueScene::new(vec![body], vec![], vec![]).unwrap();
        let poses = GeomPoses {
            positions_m: &[0.0; 3],
            rotations: &UPRIGHT[..8],
        };
        let view = CameraPose {
            position_m: [0.0; 3],
            rotation: FORWARD,
        };
        let mut raster =
            DepthRaster::new(RasterConfig::default(), &Pinhole::new(4, 3, 4.0).unwrap());
        let refused = raster.draw(&scene, &poses, &view).unwrap_err();
        assert_eq!(refused.to_string(), "geom_xmat must have 9 values, got 8");
    }

    proptest! {
        /// A pixel beside a body's box is not looked at: none of its rays may have met the body.
        #[test]
        fn no_pixel_is_lost_between_a_body_and_the_box_around_it(
            place in prop::array::uniform3(-2.0..2.0_f64),
            sizes in prop::array::uniform3(0.05..1.5_f64),
            kind in 0..5_usize,
        ) {
            let form = [
                Form::Sphere(sizes[0]),
                Form::Ellipsoid(sizes),
                Form::Cuboid(sizes),
                Form::Cylinder(sizes[0], sizes[1]),
                Form::Capsule(sizes[0], sizes[1]),
            ][kind];
            let raster = drawn(&[(form, place)], [0.0; 3]);
            let view = CameraPose { position_m: [0.0; 3], rotation: FORWARD };
            let eye = LocalEye::new(&view, place, &UPRIGHT);
            let mut whole = raster.clone();
            whole.picture.clear();
            let area = whole.frustum.everything();
            let scene = TrueScene::new(vec![], vec![], vec![]).unwrap();
            whole.paint(&scene, 0, form, &eye, &area);
            prop_assert_eq!(whole.picture.body(), raster.picture.body());
            prop_assert_eq!(whole.picture.nearness(), raster.picture.nearness());
        }
    }
}
