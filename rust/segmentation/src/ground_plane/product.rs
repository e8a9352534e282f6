//! From regions in disparity to planes, points and floor heights in the robot's frame.

use geometry::{Outline, Plane, Point, Pose, Robot};
use nalgebra::{Isometry3, Point2, Point3, Translation3, Unit, UnitQuaternion, Vector3};

use super::buffers::{LabelRun, ProductBuffers};
use crate::camera_pose::Levelled;
use crate::ground_plane::grounded::Grounded;
use crate::picture::{View, label_runs, to_f32};
use crate::planes::{PlaneRegion, Planes};
use crate::regions::{Finder, TiltedRecord, over_rays};

/// What a pixel without a region has.
const NO_REGION: (u16, f32) = (0, f32::NAN);

impl<F: Finder> Grounded<F> {
    /// Fills regions, labels, points and floor heights. `rise_m` is what the ground adds to the camera's height; a ground that was
    /// `searched` has all its pieces.
    pub(super) fn fill_product(
        &mut self,
        levelled: &Levelled,
        rise_m: f64,
        searched: bool,
        planes: &mut Planes,
    ) {
        let predicted = levelled.predicted.inner;
        let mut position = predicted.translation.vector;
        position.z += rise_m;
        let rotation = UnitQuaternion::from_rotation_matrix(&levelled.turn()) * predicted.rotation;
        planes.robot_from_camera = Pose::wrap(Isometry3::from_parts(
            Translation3::from(position),
            rotation,
        ));
        planes.camera = Some(self.camera);
        self.place_points(levelled, &position, planes);
        if let Some(ground) = planes.ground.filter(|_| searched) {
            self.join_pieces(ground);
        }
        self.describe_regions(levelled, &position, planes);
        planes.floor_height_m.fill(f32::NAN);
        for run in &self.product.runs {
            let first = run.row * self.camera.width;
            let pixels = first + run.cols.start..first + run.cols.end;
            let (label, height_m) = self.product.floors[usize::from(run.label)];
            self.surfaces.labels[pixels.clone()].fill(label);
            planes.floor_height_m[pixels].fill(height_m);
        }
        self.fill_slopes(&levelled.view, position.z, planes);
        if !F::ANY_DIRECTION {
            self.walls.find(
                &self.surfaces.images.disparity_px,
                &self.camera,
                &self.surfaces.images.sigma_px,
                &mut self.surfaces.labels,
                planes,
            );
        }
        planes.labels.copy_from_slice(&self.surfaces.labels);
        self.product.step_marks.mark(self.camera.width, planes);
        for (at_step, doubtful) in planes
            .at_step
            .iter_mut()
            .zip(&self.surfaces.parts.slopes.doubtful)
        {
            *at_step |= doubtful;
        }
    }

    /// Every pixel's point: `position + f B / d * ray`.
    fn place_points(&self, levelled: &Levelled, position: &Vector3<f64>, planes: &mut Planes) {
        let width = self.camera.width;
        let view = &levelled.view;
        let (px, py, pz) = (position.x as f32, position.y as f32, position.z as f32);
        for (row, (points, disparities)) in planes
            .points_in_robot_m
            .chunks_exact_mut(width)
            .zip(self.surfaces.images.disparity_px.chunks_exact(width))
            .enumerate()
        {
            let starts = [view.x.at(0, row), view.y.at(0, row), view.g.at(0, row)];
            for (col, (point, &d)) in points.iter_mut().zip(disparities).enumerate() {
                // NaN where nothing was seen stays NaN.
                let (col, nearness) = (to_f32(col), 1.0 / d);
                *point = [
                    px + (starts[0] + view.x.per_col * col) * nearness,
                    py + (starts[1] + view.y.per_col * col) * nearness,
                    pz - (starts[2] + view.g.per_col * col) * nearness,
                ];
            }
        }
    }

    /// Describes each region that was found; those that are tilted get no floor height.
    fn describe_regions(
        &mut self,
        levelled: &Levelled,
        position: &Vector3<f64>,
        planes: &mut Planes,
    ) {
        planes.regions.clear();
        self.product.floors.clear();
        self.product.floors.push(NO_REGION);
        self.find_runs();
        let ground = planes.ground;
        for index in 0..self.surfaces.regions.len() {
            if self.surfaces.regions[index].support == 0 {
                // It is a part of another one.
                self.product.floors.push(NO_REGION);
                continue;
            }
            if !self.surfaces.is_level(index) {
                let mut record = self.describe_tilted_region(index, planes);
                if let Some(slope) = &mut record
                    && self.surfaces.regions[index].is_slope
                {
                    slope.roughness = self.surfaces.parts.roughness.of(index);
                }
                // Slices of walls and of slopes have none: they are left for generic planes.
                let number = record.as_ref().map_or(0, |_| planes.regions.len() + 1);
                self.product.floors.push((number as u16, f32::NAN));
                planes.regions.extend(record);
                continue;
            }
            let height_m = if ground == Some(index) {
                0.0
            } else {
                position.z - 1.0 / f64::from(self.surfaces.regions[index].q)
            };
            if ground == Some(index) {
                planes.ground = Some(planes.regions.len());
            }
            let (support, mean) = self.outline_corners(index, levelled, position, height_m);
            let number = planes.regions.len() as u16 + 1;
            self.product.floors.push((number, height_m as f32));
            planes.regions.push(PlaneRegion {
                support,
                mean: Point::<Robot>::wrap(mean),
                plane: Plane {
                    normal: Unit::new_unchecked(Vector3::z()),
                    distance_m: height_m,
                },
                boundary: Outline::hull(&self.product.corners).ok(),
                floor_height_m: Some(height_m),
                roughness: self.surfaces.parts.roughness.of(index),
            });
        }
    }

    /// Gives the pixels of slopes the height of their plane there.
    fn fill_slopes(&self, view: &View, camera_m: f64, planes: &mut Planes) {
        let width = self.camera.width;
        for run in &self.product.runs {
            let region = &self.surfaces.regions[usize::from(run.label) - 1];
            let Some(plane) = region.plane.filter(|_| region.is_slope) else {
                continue;
            };
            for col in run.cols.clone() {
                let below_m = view.g.at(col, run.row) / plane.at(col, run.row);
                planes.floor_height_m[run.row * width + col] = camera_m as f32 - below_m;
            }
        }
    }

    /// Lists the runs of all labels, row by row.
    fn find_runs(&mut self) {
        let runs = &mut self.product.runs;
        runs.clear();
        let lines = self.surfaces.labels.chunks_exact(self.camera.width);
        for (row, line) in lines.enumerate() {
            runs.extend(label_runs(line).map(|(label, cols)| LabelRun { label, row, cols }));
        }
    }

    /// Describes a region whose plane the finder gave.
    fn describe_tilted_region(&mut self, index: usize, planes: &Planes) -> Option<PlaneRegion> {
        let in_camera = over_rays(&self.surfaces.regions[index].plane?, &self.camera);
        let pose = planes.robot_from_camera.inner;
        let corners = &mut self.product.corners;
        let mut record = TiltedRecord::new(&self.camera, pose, in_camera, corners);
        for (at, &label) in self.surfaces.labels.iter().enumerate() {
            if usize::from(label) == index + 1 {
                let (col, row) = (at % self.camera.width, at / self.camera.width);
                let ray = Vector3::from(self.camera.ray(col, row));
                record.add(&ray, in_camera.dot(&ray));
            }
        }
        record.finish(self.config.tuning.tilted.least_rise)
    }

    /// Collects where the outermost pixels of each row meet the region's plane; returns the number of pixels and the mean
    /// of where they all do.
    fn outline_corners(
        &mut self,
        index: usize,
        levelled: &Levelled,
        position: &Vector3<f64>,
        height_m: f64,
    ) -> (usize, Point3<f64>) {
        let view = &levelled.view;
        let label = index as u16 + 1;
        let below_m = position.z - height_m;
        let place = |col: usize, row: usize| {
            let nearness = below_m / f64::from(view.g.at(col, row));
            Point2::new(
                position.x + f64::from(view.x.at(col, row)) * nearness,
                position.y + f64::from(view.y.at(col, row)) * nearness,
            )
        };
        let ProductBuffers { runs, corners, .. } = &mut self.product;
        let mut row_before = None;
        corners.clear();
        let (mut support, mut sum) = (0, [0.0, 0.0]);
        for run in runs.iter().filter(|run| run.label == label) {
            support += run.cols.len();
            for col in run.cols.clone() {
                let point = place(col, run.row);
                sum[0] += point.x;
                sum[1] += point.y;
            }
            let last = place(run.cols.end - 1, run.row);
            match corners.last_mut() {
                Some(end) if row_before == Some(run.row) => *end = last,
                _ => corners.extend([place(run.cols.start, run.row), last]),
            }
            row_before = Some(run.row);
        }
        let count = support.max(1) as f64;
        (
            support,
            Point3::new(sum[0] / count, sum[1] / count, height_m),
        )
    }
}
