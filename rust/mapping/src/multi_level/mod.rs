//! The multi-level surface map of Triebel, Pfaff and Burgard 2006 (004, Fig. 36.11d): the surfaces of a cell one above the other, each with its
//! height as [`crate::Elevation`] keeps it and the vertical extent of what it is on.
//!
//! A robot stands on one of them. Planners see, of each cell, the surface that is reached from there, cell by cell: the deck of a
//! bridge from its ramp, the road from the road.

mod config;
mod patches;
pub(crate) mod reached;
pub(crate) mod seen_through;

use geometry::{Cell, CellArea, Grid, Map, Pose, Robot};
use segmentation::Planes;
use settings::{ConfigError, Part, Table, TableDescription, read, require};

use crate::elevation::cells::Revision;
use crate::elevation::level::LevelCells;
use crate::elevation::sensed::SensedFrame;
use crate::elevation::slope::SlopeFinder;
use crate::elevation::{ElevationConfig, Gathered, SurfaceRule, cell_of};
use crate::part::WorldModelPart;
use crate::surface::{Underfoot, Window, check_poses};
use crate::{FloorView, Insertion, MapError, Surface, Voxel, WorldModel};
pub use config::{MultiLevelConfig, MultiLevelTuning};
pub use patches::Patch;
use patches::Patches;
use reached::Reached;
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
    window: Window,
    cells: Grid<Patches>,
    underfoot: Underfoot,
    frame: SensedFrame,
    gathered: Gathered,
    reached: Reached,
    /// Of each cell height of the surface by which the robot comes, m; NaN where none is known.
    heights_m: Vec<f32>,
    /// Frames that saw that surface, and the room above it, m.
    ways: Vec<(u16, f32)>,
    level: LevelCells,
    slopes: SlopeFinder,
    view: FloorView,
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
        let window = Window::new(elevation.cell, n, elevation.tuning.wander);
        Ok(Self {
            headroom_m: headroom.map_or(f32::INFINITY, |room_m| room_m as f32),
            cells: Grid::filled(n, n, Patches::NONE),
            underfoot: Underfoot::new(n, elevation.footprint),
            frame: SensedFrame::default(),
            gathered: Gathered::default(),
            reached: Reached::new(n),
            heights_m: vec![f32::NAN; n * n],
            ways: vec![(0, f32::INFINITY); n * n],
            level: LevelCells::default(),
            slopes: SlopeFinder::default(),
            view: FloorView {
                least_gradient: elevation.tuning.slopes.least,
                ..FloorView::unknown(window.lattice(), n)
            },
            window,
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

    /// Height from which on two surfaces are no longer one way, m.
    fn joined_m(&self) -> f32 {
        (self.config.tuning.joined * self.elevation.rise) as f32
    }

    fn follow(&mut self, robot_m: [f64; 3]) {
        let [cols, rows] = self.window.follow(robot_m);
        if [cols, rows] != [0; 2] {
            self.cells.shift(cols, rows, &Patches::NONE);
            self.underfoot.shift(cols, rows);
            self.view.shift(cols, rows, self.window.lattice());
        }
    }

    /// The shift that brings the frame onto the heights that are known.
    fn shift_m(&mut self) -> Option<f64> {
        let cells = self.cells.values();
        let known_m = |cell: usize, from_m: f32| {
            let heights_m = cells[cell].seen().iter().map(|one| one.estimate().height_m);
            heights_m.min_by(|a, b| (a - from_m).abs().total_cmp(&(b - from_m).abs()))
        };
        let gate = (self.elevation.match_gate, self.elevation.min_pairs);
        (self.frame).shift_m(known_m, gate, &self.elevation.tuning.matching)
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
        let (size, lattice) = (self.view.size(), self.window.lattice());
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

    /// The surface of a cell by which the robot comes: height and frames, and the room above it, m.
    fn way(&self, index: usize) -> Option<(f32, u16, f32)> {
        let by_m = self.reached.height_m(index);
        let patches = self.cells.values()[index].seen();
        let off = |one: &Patch| (one.estimate().height_m - by_m).abs();
        let nearest =
            (0..patches.len()).min_by(|&a, &b| off(&patches[a]).total_cmp(&off(&patches[b])))?;
        let height_m = patches[nearest].estimate().height_m;
        let above = patches.get(nearest + 1);
        let room_m = above.map_or(f32::INFINITY, |one| one.low_m - height_m);
        Some((height_m, patches[nearest].frames(), room_m))
    }

    fn surface(&self, index: usize, is_level: bool) -> (Surface, u16) {
        let (height_m, (frames, room_m)) = (self.heights_m[index], self.ways[index]);
        if height_m.is_nan() {
            let stood = self.underfoot.height_at(index);
            return (stood.map_or(Surface::Unknown, Surface::Floor), 0);
        }
        let blocked = !is_level && self.lies_above_one_beside(index);
        if blocked || room_m < self.headroom_m || frames == 0 {
            (Surface::Obstacle(height_m), 0)
        } else {
            (Surface::Floor(height_m), frames)
        }
    }

    /// Whether a cell lies higher above one beside it than can be climbed.
    fn lies_above_one_beside(&self, index: usize) -> bool {
        let size = self.view.size();
        let beside = CellArea::of(cell_of(index, size)).grown(1);
        let heights_m = geometry::runs(beside, size)
            .flatten()
            .map(|other| self.heights_m[other]);
        let height_m = self.heights_m[index];
        // What is no number is not lower.
        height_m - heights_m.fold(height_m, f32::min) > self.elevation.rise as f32
    }

    /// Makes the view of what is reached from where the robot stands.
    fn refresh(&mut self, robot_m: [f64; 3]) {
        let start = self.window.lattice().cell_at(robot_m[0], robot_m[1]);
        let cells = &self.cells;
        let nearest = |index: usize, from_m: f32| {
            let heights = cells.values()[index]
                .seen()
                .iter()
                .map(|one| one.estimate().height_m);
            heights.min_by(|a, b| (a - from_m).abs().total_cmp(&(b - from_m).abs()))
        };
        let joined_m = self.joined_m();
        self.reached
            .spread((start, robot_m[2] as f32), joined_m, nearest);
        for index in 0..self.cells.values().len() {
            let unknown = (f32::NAN, 0, f32::INFINITY);
            let (height_m, frames, room_m) = self.way(index).unwrap_or(unknown);
            (self.heights_m[index], self.ways[index]) = (height_m, (frames, room_m));
        }
        let (size, area) = (self.view.size(), self.view.cells.area());
        let mut level_cells = std::mem::take(&mut self.level);
        for run in geometry::runs(area, size) {
            let rise_m = self.elevation.rise as f32;
            let level = level_cells.of_run(&self.heights_m, size, run.clone(), (None, rise_m));
            for (index, &is_level) in run.zip(level) {
                let (surface, frames) = self.surface(index, is_level);
                self.view.cells.values_mut()[index] = surface;
                self.view.sightings.values_mut()[index] = frames;
            }
        }
        self.level = level_cells;
        let (heights_m, view) = (&self.heights_m, &mut self.view);
        let height = |index: usize| Some(heights_m[index]).filter(|height_m| !height_m.is_nan());
        let rule = (self.elevation.cell as f32, self.elevation.slope_rule());
        self.slopes
            .find((size, area), height, rule, |index, gradient| {
                view.gradients.values_mut()[index] = gradient;
            });
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
        let _stood = self.underfoot.stand(robot_m, &self.window.lattice());
        let place = (self.window.lattice(), self.view.size());
        self.frame
            .read(planes, map_from_robot, self.elevation.max_range, place);
        let shift = planes.ground.is_none().then(|| self.shift_m());
        let shift = shift.flatten();
        let used = self.frame.settle(planes, shift);
        if used {
            self.take_in(planes, map_from_robot);
        }
        self.refresh(robot_m);
        Ok(Insertion {
            changed: self.view.cells.area(),
            height_shift_m: shift.filter(|_| used),
            used,
        })
    }

    fn view(&self) -> &FloorView {
        &self.view
    }

    fn needs_surfaces(&self) -> bool {
        false
    }

    /// Cubes of a cell's side over the vertical extent of each surface.
    fn occupied(&self) -> Vec<Voxel> {
        let (lattice, side_m) = (self.window.lattice(), self.elevation.cell);
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
