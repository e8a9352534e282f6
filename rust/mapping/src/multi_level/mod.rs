//! The multi-level surface map of Triebel, Pfaff and Burgard 2006 (004, Fig. 36.11d): the surfaces of a cell one above the other, each with its
//! height as [`crate::Elevation`] keeps it and the vertical extent of what it is on.
//!
//! A robot stands on one of them. Planners see, of each cell, the surface that is reached from there, cell by cell: the deck of a
//! bridge from its ramp, the road from the road.

mod config;
mod patches;

pub(crate) mod seen_through;

use geometry::{Cell, Grid, Map, Pose, Robot};
use segmentation::Planes;
use settings::{ConfigError, Part, Table, TableDescription, read, require};

use crate::columns::{ReachedView, WayRule};
use crate::elevation::cells::Revision;
use crate::elevation::sensed::SensedFrame;
use crate::elevation::{ElevationConfig, Gathered, SurfaceRule, cell_of};
use crate::part::WorldModelPart;
use crate::surface::check_poses;
use crate::{FloorView, Insertion, MapError, Voxel, WorldModel};
pub use config::{MultiLevelConfig, MultiLevelTuning};
pub use patches::Patch;
use patches::Patches;
use seen_through::SeenThrough;

/// How it is listed and made.
pub(crate) const PART: WorldModelPart = Part {
    name: MultiLevel::NAME,
    about: "the surfaces of a cell one above the other: bridges and what is below them",
    source: Some("Triebel, Pfaff and Burgard 2006 (004, Fig. 36.11d)"),
    tables: &[
        TableDescription::of::<ElevationConfig>(),
        TableDescription::of::<MultiLevelConfig>(),
    ],
    make: |needs| {
        let config: MultiLevelConfig = read(needs.tables, "multi_level")?;
        let elevation = read(needs.tables, "elevation")?;
        Ok(Box::new(MultiLevel::new(
            config,
            elevation,
            needs.headroom_m,
        )?))
    },
};

/// Keeps the surfaces and the view made of them.
#[derive(Debug, Clone)]
pub struct MultiLevel {
    config: MultiLevelConfig,
    elevation: ElevationConfig,
    /// Room between two things above each other with which both are kept, m.
    headroom_m: f32,
    cells: Grid<Patches>,
    frame: SensedFrame,
    gathered: Gathered,
    reached: ReachedView,
}

impl MultiLevel {
    /// The name by which it is chosen.
    pub const NAME: &'static str = "multi_level";

    /// A map of which nothing is known, around the map's origin. `robot_height_m` is the room that counts where the configuration has none.
    pub fn new(
        config: MultiLevelConfig,
        elevation: ElevationConfig,
        robot_height_m: Option<f64>,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        elevation.check()?;
        let headroom = config.headroom.or(robot_height_m);
        let key = "navigation.multi_level.headroom";
        require(
            headroom.is_some(),
            key,
            "given where there is no robot",
            "nothing",
        )?;
        let n = elevation.window;
        let headroom_m = headroom.map_or(f32::INFINITY, |room_m| room_m as f32);
        let rule = WayRule {
            headroom_m,
            joined_m: (config.tuning.joined * elevation.rise) as f32,
            edge: None,
        };
        Ok(Self {
            headroom_m,
            cells: Grid::filled(n, n, Patches::NONE),
            frame: SensedFrame::default(),
            gathered: Gathered::default(),
            reached: ReachedView::new(&elevation, rule),
            config,
            elevation,
        })
    }

    /// The surfaces of a cell, the lowest first; none where nothing was seen, and outside.
    pub fn patches(&self, cell: Cell) -> &[Patch] {
        self.cells.get(cell).map_or(&[], Patches::seen)
    }

    const fn revision(&self) -> Revision {
        Revision {
            gate: self.elevation.gate as f32,
            patience: self.elevation.tuning.patience,
            gap_m: self.headroom_m,
        }
    }

    fn follow(&mut self, robot_m: [f64; 3]) {
        let [cols, rows] = self.reached.follow(robot_m);
        if [cols, rows] != [0; 2] {
            self.cells.shift(cols, rows, &Patches::NONE);
        }
    }

    fn take_in(&mut self, planes: &Planes, map_from_robot: &Pose<Map, Robot>) {
        let (revision, noise) = (self.revision(), self.elevation.noise());
        let rule = SurfaceRule {
            gate: revision.gate,
            share: self.elevation.tuning.surface_share as f32,
            gap_m: revision.gap_m,
        };
        self.gathered.begin(self.cells.values().len());
        for point in &self.frame.points {
            if let Some(cell) = point.cell() {
                let variance_m2 = noise.variance_m2(point.range_m);
                (self.gathered).add(cell, self.frame.height_m(point), variance_m2);
            }
        }
        let cells = self.cells.values_mut();
        let eye_m = self.frame.eye_m[2] as f32;
        self.gathered.measure(rule, |measured| {
            cells[measured.cell].measure(&measured, eye_m, revision);
        });
        if self.elevation.clearing
            && let Some(seen) = SeenThrough::new(planes, map_from_robot)
        {
            self.look_through(&seen, revision);
        }
    }

    /// Takes back surfaces behind which the frame saw something. Those of cells that it measured something in are left to that.
    fn look_through(&mut self, seen: &SeenThrough<'_>, revision: Revision) {
        let (lattice, size) = self.reached.place();
        let (noise, behind) = (self.elevation.noise(), self.config.tuning.behind as f32);
        for (index, patches) in self.cells.values_mut().iter_mut().enumerate() {
            if patches.seen().is_empty() || self.gathered.holds(index) {
                continue;
            }
            let [x_m, y_m] = lattice.center_of(cell_of(index, size));
            let _dropped = patches.drop_where(|patch| {
                let top_m = patch.estimate().height_m;
                let Some((range_m, beyond_m)) = seen.beyond_m([x_m, y_m, f64::from(top_m)]) else {
                    return false;
                };
                let sigma_m = (noise.variance_m2(range_m) + patch.estimate().variance_m2).sqrt();
                let gone = beyond_m > behind * sigma_m + lattice.cell_m as f32;
                gone && patch.top.contradict(revision)
            });
        }
    }
}

impl WorldModel for MultiLevel {
    fn forget(&mut self) {
        let height_m = Some(f64::from(self.headroom_m));
        if let Ok(fresh) = Self::new(self.config.clone(), self.elevation.clone(), height_m) {
            *self = fresh;
        }
    }

    fn insert(
        &mut self,
        planes: &Planes,
        map_from_robot: &Pose<Map, Robot>,
    ) -> Result<Insertion, MapError> {
        check_poses(planes, map_from_robot)?;
        let robot_m: [f64; 3] = map_from_robot.inner.translation.vector.into();
        self.follow(robot_m);
        let (place, most_m) = (self.reached.place(), self.elevation.max_range);
        self.frame.read(planes, map_from_robot, most_m, place);
        let cells = self.cells.values();
        let shift = planes.ground.is_none().then(|| {
            let patches = |cell: usize| cells[cell].seen();
            self.reached.shift_m(&mut self.frame, patches)
        });
        let shift = shift.flatten();
        let used = self.frame.settle(planes, shift);
        if used {
            self.take_in(planes, map_from_robot);
        }
        let cells = self.cells.values();
        self.reached.refresh(robot_m, |cell| cells[cell].seen());
        Ok(Insertion {
            changed: self.view().cells.area(),
            height_shift_m: shift.filter(|_| used),
            used,
        })
    }

    fn view(&self) -> &FloorView {
        &self.reached.view
    }

    fn needs_surfaces(&self) -> bool {
        false
    }

    /// Cubes of a cell's side over the vertical extent of each surface.
    fn occupied(&self) -> Vec<Voxel> {
        let ((lattice, _), side_m) = (self.reached.place(), self.elevation.cell);
        let mut voxels = Vec::new();
        for cell in self.cells.area().cells() {
            let [x_m, y_m] = lattice.center_of(cell);
            for patch in self.patches(cell) {
                let count = (f64::from(patch.depth_m()) / side_m) as usize + 1;
                let top_m = f64::from(patch.estimate().height_m);
                voxels.extend((0..count).map(|down| Voxel {
                    centre_m: [x_m, y_m, top_m - (down as f64 + 0.5) * side_m],
                    side_m,
                }));
            }
        }
        voxels
    }
}
