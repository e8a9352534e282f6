//! The slice of a frame between floor and head, as a laser would see it.

use std::f64::consts::PI;

use geometry::{Cell, Grid, Lattice, Map, Pose, Robot};
use plan_view::SweptBeam;
use segmentation::Planes;

use super::DepthSliceConfig;

/// What a point says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Slice {
    Floor,
    InTheWay,
}

/// A point of the slice: direction and distance from the sensor over the ground, and its cell.
#[derive(Debug, Clone, Copy)]
struct SlicePoint {
    beam: u32,
    range_m: f32,
    what: Slice,
    cell: Option<u32>,
}

/// What one direction saw.
#[derive(Debug, Clone, Default)]
struct SeenAlong {
    nearest_hit_m: Option<f64>,
    floor_m: Vec<f32>,
}

/// Makes scans; reused from frame to frame.
#[derive(Debug, Clone)]
pub(super) struct Slicer {
    points: Vec<SlicePoint>,
    counts: Grid<u16>,
    seen: Vec<SeenAlong>,
}

impl Slicer {
    pub(super) fn new(config: &DepthSliceConfig) -> Self {
        let beams = (2.0 * PI / config.beam).ceil() as usize;
        Self {
            points: Vec::new(),
            counts: Grid::filled(config.window, config.window, 0),
            seen: vec![SeenAlong::default(); beams],
        }
    }

    /// The frame as beams from above the sensor, their bearings along the axes of the map. `high_m`: what is higher than this above the robot's
    /// ground is passed below.
    pub(super) fn scan(
        &mut self,
        (planes, map_from_robot): (&Planes, &Pose<Map, Robot>),
        config: &DepthSliceConfig,
        (high_m, lattice): (f64, Lattice),
    ) -> Vec<SweptBeam> {
        self.read((planes, map_from_robot), config, (high_m, lattice));
        for seen in &mut self.seen {
            seen.nearest_hit_m = None;
            seen.floor_m.clear();
        }
        for point in &self.points {
            let seen = &mut self.seen[point.beam as usize];
            let range_m = f64::from(point.range_m);
            let count = point
                .cell
                .map_or(0, |cell| self.counts.values()[cell as usize]);
            match point.what {
                Slice::Floor => seen.floor_m.push(point.range_m),
                Slice::InTheWay if usize::from(count) >= config.least_points => {
                    seen.nearest_hit_m = Some(
                        seen.nearest_hit_m
                            .map_or(range_m, |hit_m| hit_m.min(range_m)),
                    );
                }
                Slice::InTheWay => {}
            }
        }
        let mut beams = self.seen_over_others((planes, map_from_robot), config, lattice);
        for (index, seen) in self.seen.iter_mut().enumerate() {
            let bearing_rad = (index as f64 + 0.5) * config.beam - PI;
            seen.beams(bearing_rad, config.gap, &mut beams);
        }
        beams
    }

    /// A beam to each cell in which enough is in the way, though something lower stands before it: cameras see over that, lasers do not.
    fn seen_over_others(
        &self,
        (planes, map_from_robot): (&Planes, &Pose<Map, Robot>),
        config: &DepthSliceConfig,
        lattice: Lattice,
    ) -> Vec<SweptBeam> {
        let eye = (*map_from_robot * planes.robot_from_camera.origin()).inner;
        let cells = self.counts.area().cells().zip(self.counts.values());
        let hit = |(cell, &count): (Cell, &u16)| {
            let [x_m, y_m] = lattice.center_of(cell);
            let (right_m, up_m) = (x_m - eye.x, y_m - eye.y);
            let range_m = geometry::hypot(right_m, up_m);
            (usize::from(count) >= config.least_points).then(|| SweptBeam {
                bearing_rad: libm::atan2(up_m, right_m),
                from_m: range_m,
                range_m,
                hit: true,
            })
        };
        cells.filter_map(hit).collect()
    }

    /// The points of the slice, and how many are in the way in each cell.
    fn read(
        &mut self,
        (planes, map_from_robot): (&Planes, &Pose<Map, Robot>),
        config: &DepthSliceConfig,
        (high_m, lattice): (f64, Lattice),
    ) {
        self.points.clear();
        self.counts.fill(&0);
        let rotation = *map_from_robot.inner.rotation.to_rotation_matrix().matrix();
        let eye = rotation * planes.robot_from_camera.origin().inner.coords;
        let robot = map_from_robot.inner.translation.vector;
        let each = planes
            .points_in_robot_m
            .iter()
            .zip(&planes.floor_height_m)
            .zip(&planes.at_step);
        for ((&at_m, &surface_m), &at_step) in each {
            if at_step || at_m.iter().any(|part| !part.is_finite()) {
                continue;
            }
            let from_robot = rotation * nalgebra::Vector3::from(at_m.map(f64::from));
            let (right_m, up_m) = (from_robot.x - eye.x, from_robot.y - eye.y);
            let range_m = geometry::hypot(right_m, up_m);
            // Heights are those above the robot's own ground, which is level.
            let (height_m, limit_m) = if surface_m.is_nan() {
                (from_robot.z, config.stray)
            } else {
                (f64::from(surface_m), config.low)
            };
            if range_m > config.max_range || height_m > high_m {
                continue;
            }
            let what = if height_m.abs() < limit_m {
                Slice::Floor
            } else {
                Slice::InTheWay
            };
            let cell = lattice.cell_at(robot.x + from_robot.x, robot.y + from_robot.y);
            let index = self.counts.index(cell);
            if what == Slice::InTheWay
                && let Some(index) = index
            {
                let count = &mut self.counts.values_mut()[index];
                *count = count.saturating_add(1);
            }
            let bearing_rad = libm::atan2(up_m, right_m) + PI;
            let beam = ((bearing_rad / config.beam) as usize).min(self.seen.len() - 1);
            self.points.push(SlicePoint {
                beam: beam as u32,
                range_m: range_m as f32,
                what,
                cell: index.map(|index| index as u32),
            });
        }
    }
}

impl SeenAlong {
    /// Floor from the nearest point on, in parts where a gap is larger than `gap_m`, and what stands behind it.
    fn beams(&mut self, bearing_rad: f64, gap_m: f64, beams: &mut Vec<SweptBeam>) {
        let hit_m = self.nearest_hit_m;
        let end_m = hit_m.unwrap_or(f64::INFINITY);
        self.floor_m.retain(|at_m| f64::from(*at_m) < end_m);
        self.floor_m.sort_unstable_by(f32::total_cmp);
        let parts = self
            .floor_m
            .chunk_by(|one_m, next_m| f64::from(next_m - one_m) <= gap_m);
        let mut reached_m = None;
        for part in parts {
            if let (Some(&from_m), Some(&to_m)) = (part.first(), part.last()) {
                let (from_m, range_m) = (f64::from(from_m), f64::from(to_m));
                reached_m = Some((from_m, range_m));
                beams.push(SweptBeam {
                    bearing_rad,
                    from_m,
                    range_m,
                    hit: false,
                });
            }
        }
        if let Some(range_m) = hit_m {
            // Up to what stands there the floor is seen as far as it goes.
            let joined = reached_m.filter(|(_, to_m)| range_m - to_m <= gap_m);
            let from_m = joined.map_or(range_m, |(from_m, _)| from_m);
            beams.push(SweptBeam {
                bearing_rad,
                from_m,
                range_m,
                hit: true,
            });
        }
    }
}
