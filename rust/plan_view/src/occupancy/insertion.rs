//! How scans of lasers and sonars change the map.

use geometry::{Cell, CellArea, PlanarPose, wrap_angle};
use volume::VoxelWalk;

use super::map::{OccupancyError, OccupancyMap};
use super::said::Said;
use super::{LaserModel, SonarModel};
use crate::scan::{PlanarBeam, PlanarScan, SweptBeam};

/// What became of the beams of a scan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ScanCounts {
    /// Beams that said something.
    pub used: usize,
    /// Maximum range readings.
    pub nothing_seen: usize,
    /// Beams whose range was 0, negative or no number.
    pub unusable: usize,
}

impl OccupancyMap {
    /// Takes in a scan of a laser, as one observation: a cell in which a beam ends is occupied to it, whatever the others say; one that beams
    /// pass is free (004, equation 36.6). Beams that see further than `max_range` are free up to there.
    pub fn insert(&mut self, scan: &PlanarScan) -> Result<ScanCounts, OccupancyError> {
        let (counts, seen) = usable(scan);
        let swept = |beam: &PlanarBeam| SweptBeam {
            bearing_rad: beam.bearing_rad,
            from_m: 0.0,
            range_m: beam.range_m.unwrap_or(0.0),
            hit: true,
        };
        let swept: Vec<_> = seen.iter().map(swept).collect();
        self.insert_swept(&scan.map_from_sensor, &swept)?;
        Ok(counts)
    }

    /// Takes in beams of which a part is known alone, from one place, as one observation; they are as [`SweptBeam`] says, with finite numbers.
    pub fn insert_swept(
        &mut self,
        map_from_sensor: &PlanarPose,
        beams: &[SweptBeam],
    ) -> Result<(), OccupancyError> {
        check(map_from_sensor)?;
        let (most_m, cell_m) = (self.config.max_range, self.config.cell);
        let reaches = |beam: &SweptBeam| (beam.bearing_rad, beam.range_m.min(most_m) + cell_m);
        self.cover(map_from_sensor, beams.iter().map(reaches))?;
        let model = LaserModel::new(&self.config);
        for beam in beams {
            self.pass(map_from_sensor, beam, &model);
        }
        let says = [self.config.prior, self.config.free, self.config.occupied];
        for index in std::mem::take(&mut self.touched) {
            let said = std::mem::replace(&mut self.said[index as usize], Said::Nothing);
            self.tell(index as usize, says[said as usize]);
        }
        Ok(())
    }

    /// Takes in measurements of sonars, each by itself.
    pub fn insert_sonar(
        &mut self,
        scan: &PlanarScan,
        model: &SonarModel,
    ) -> Result<ScanCounts, OccupancyError> {
        let pose = scan.map_from_sensor;
        check(&pose)?;
        let (counts, seen) = usable(scan);
        let opening_rad = model.config().half_opening;
        let sides = |beam: &PlanarBeam| {
            let reach_m = model.reach_m(beam.range_m);
            let turns = [-opening_rad, 0.0, opening_rad];
            turns.map(|turn_rad| (beam.bearing_rad + turn_rad, reach_m.unwrap_or(0.0)))
        };
        self.cover(&pose, seen.iter().flat_map(sides))?;
        for beam in &seen {
            let Some(reach_m) = model.reach_m(beam.range_m) else {
                continue;
            };
            let axis_rad = pose.yaw_rad + beam.bearing_rad;
            for cell in self.cone(&pose, (axis_rad, opening_rad), reach_m).cells() {
                let [x_m, y_m] = self.lattice.center_of(cell);
                let (right_m, up_m) = (x_m - pose.x_m, y_m - pose.y_m);
                let distance_m = geometry::hypot(right_m, up_m);
                let off_rad = wrap_angle(libm::atan2(up_m, right_m) - axis_rad);
                let within = distance_m <= reach_m && off_rad.abs() <= opening_rad;
                if let Some(index) = self.cells.index(cell).filter(|_| within) {
                    self.tell(index, model.probability(beam.range_m, distance_m, off_rad));
                }
            }
        }
        Ok(counts)
    }

    /// Marks what a beam says of the cells on its way.
    fn pass(&mut self, pose: &PlanarPose, beam: &SweptBeam, model: &LaserModel) {
        let (range_m, most_m) = (beam.range_m, self.config.max_range);
        let (sin, cos) = libm::sincos(pose.yaw_rad + beam.bearing_rad);
        let eye_m = [pose.x_m, pose.y_m];
        let far_m = range_m.min(most_m) + self.config.cell;
        let end_m = [eye_m[0] + far_m * cos, eye_m[1] + far_m * sin];
        let [from, to] = [eye_m, end_m].map(|at_m| self.in_cells(at_m));
        let size = [self.cells.cols() as i32, self.cells.rows() as i32, 1];
        let hit = beam.hit && range_m <= most_m;
        // The middle of a cell that the beam crosses by its diagonal may be further off than half a side.
        let end = self
            .lattice
            .cell_at(eye_m[0] + range_m * cos, eye_m[1] + range_m * sin);
        for [col, row, _] in VoxelWalk::new(from, to, size).into_iter().flatten() {
            let cell = Cell::new(col, row);
            let distance_m = geometry::distance_m(self.lattice.center_of(cell), eye_m);
            let probability = model.probability(Some(range_m), true, distance_m);
            let said = if hit && (cell == end || probability > self.config.prior) {
                Said::Occupied
            } else if probability < self.config.prior
                && (beam.from_m..=most_m).contains(&distance_m)
            {
                Said::Free
            } else {
                continue;
            };
            let index = row as usize * self.cells.cols() + col as usize;
            if self.said[index] == Said::Nothing {
                self.touched.push(index as u32);
            }
            self.said[index] = self.said[index].max(said);
        }
    }

    /// The cells of the box around a cone: its axis and half of its opening, rad, and how far it reaches, m.
    fn cone(
        &self,
        pose: &PlanarPose,
        (axis_rad, opening_rad): (f64, f64),
        reach_m: f64,
    ) -> CellArea {
        let mut area = CellArea::of(self.lattice.cell_at(pose.x_m, pose.y_m));
        // Its corners, and where the arc is further out than they are: no further than along its tangents in the corners.
        let out_m = reach_m / libm::cos(opening_rad / 2.0);
        for turn_rad in [
            -opening_rad,
            -opening_rad / 2.0,
            0.0,
            opening_rad / 2.0,
            opening_rad,
        ] {
            let (sin, cos) = libm::sincos(axis_rad + turn_rad);
            let (x_m, y_m) = (pose.x_m + out_m * cos, pose.y_m + out_m * sin);
            area.include(self.lattice.cell_at(x_m, y_m));
        }
        area.within(self.cells.area())
    }

    /// Grows the map to hold beams from a place: bearings, rad, and how far they reach, m.
    fn cover(
        &mut self,
        pose: &PlanarPose,
        reaches: impl Iterator<Item = (f64, f64)>,
    ) -> Result<(), OccupancyError> {
        let (mut low, mut high) = ([pose.x_m, pose.y_m], [pose.x_m, pose.y_m]);
        for (bearing_rad, reach_m) in reaches {
            let (sin, cos) = libm::sincos(pose.yaw_rad + bearing_rad);
            let end_m = [pose.x_m + reach_m * cos, pose.y_m + reach_m * sin];
            for axis in 0..2 {
                low[axis] = low[axis].min(end_m[axis]);
                high[axis] = high[axis].max(end_m[axis]);
            }
        }
        self.cover_box(low, high)
    }
}

fn check(pose: &PlanarPose) -> Result<(), OccupancyError> {
    if [pose.x_m, pose.y_m, pose.yaw_rad]
        .iter()
        .all(|part| part.is_finite())
    {
        Ok(())
    } else {
        Err(OccupancyError::PoseNotFinite)
    }
}

/// The beams that say something, and what became of all.
fn usable(scan: &PlanarScan) -> (ScanCounts, Vec<PlanarBeam>) {
    let mut counts = ScanCounts::default();
    let mut seen = Vec::with_capacity(scan.beams.len());
    for beam in &scan.beams {
        if !beam.is_usable() {
            counts.unusable += 1;
        } else if beam.range_m.is_none() {
            counts.nothing_seen += 1;
        } else {
            counts.used += 1;
            seen.push(*beam);
        }
    }
    (counts, seen)
}
