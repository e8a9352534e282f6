//! Things one above the other in the columns of the window, and the view of those by which the robot comes.
//!
//! Models that have no direction that is up bring what they know into columns; planners see, of each column, the surface that is reached from
//! where the robot stands.

mod reached;
mod reached_view;
mod things;

use geometry::{Cell, Map, Pose, Robot};
use segmentation::Planes;

use crate::elevation::ElevationConfig;
use crate::elevation::sensed::SensedFrame;
use crate::{FloorView, Insertion, Voxel};
pub(crate) use reached_view::{ReachedView, WayRule};
use things::Columns;
pub use things::Span;

/// What became of a frame before it is taken in.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Settled {
    /// The shift in height that brought it onto what is known, m.
    pub shift_m: Option<f64>,
    /// Whether it is of use.
    pub used: bool,
    /// Whether the window moved: then the columns must be filled anew.
    pub moved: bool,
}

/// Columns and the view made of them.
#[derive(Debug, Clone)]
pub(crate) struct ColumnView {
    headroom_m: f32,
    columns: Columns,
    reached: ReachedView,
}

impl ColumnView {
    /// Of which nothing is known, around the map's origin. Levels that lie within so many rises of each other are one way; things with less than
    /// `headroom_m` between them are one.
    pub(crate) fn new(elevation: &ElevationConfig, headroom_m: f32, joined: f64) -> Self {
        let rule = WayRule {
            headroom_m,
            joined_m: (joined * elevation.rise) as f32,
            edge: Some(elevation.edge_rule()),
        };
        Self {
            headroom_m,
            columns: Columns::default(),
            reached: ReachedView::new(elevation, rule),
        }
    }

    /// What planners see.
    pub(crate) const fn view(&self) -> &FloorView {
        &self.reached.view
    }

    /// The things in a cell of the view, the lowest first; none where nothing was seen, and outside.
    pub(crate) fn things(&self, cell: Cell) -> &[Span] {
        let index = self.reached.view.cells.index(cell);
        index.map_or(&[], |at| self.columns.things(at))
    }

    /// Moves the window to the robot, reads a frame up to `most_m` away, and brings it onto the heights that are known.
    pub(crate) fn settle(
        &mut self,
        frame: &mut SensedFrame,
        (planes, map_from_robot): (&Planes, &Pose<Map, Robot>),
        most_m: f64,
    ) -> Settled {
        let robot_m = map_from_robot.inner.translation.vector.into();
        let moved = self.reached.follow(robot_m) != [0; 2];
        frame.read(planes, map_from_robot, most_m, self.reached.place());
        let things = |cell: usize| self.columns.things(cell);
        let shift_m = planes.ground.is_none();
        let shift_m = shift_m.then(|| self.reached.shift_m(frame, things));
        let shift_m = shift_m.flatten();
        Settled {
            shift_m,
            used: frame.settle(planes, shift_m),
            moved,
        }
    }

    /// Fills the columns anew: `spans` tells what is in them, by whole cells from the map's origin.
    pub(crate) fn fill(&mut self, spans: impl FnOnce(&mut dyn FnMut([i32; 2], Span))) {
        let (lattice, _) = self.reached.place();
        let corner = lattice
            .origin_m
            .map(|at_m| (at_m / lattice.cell_m).round() as i32);
        let (columns, cells) = (&mut self.columns, &self.reached.view.cells);
        columns.begin();
        spans(&mut |column, span| {
            let cell = Cell::new(column[0] - corner[0], column[1] - corner[1]);
            if let Some(index) = cells.index(cell) {
                columns.add(index, span);
            }
        });
        columns.finish(cells.values().len(), self.headroom_m);
    }

    /// Makes the view of what is reached from where the robot stands, after a frame was taken in.
    pub(crate) fn refresh(
        &mut self,
        map_from_robot: &Pose<Map, Robot>,
        settled: Settled,
    ) -> Insertion {
        let columns = &self.columns;
        let robot_m = map_from_robot.inner.translation.vector.into();
        self.reached.refresh(robot_m, |cell| columns.things(cell));
        Insertion {
            changed: self.view().cells.area(),
            height_shift_m: settled.shift_m.filter(|_| settled.used),
            used: settled.used,
        }
    }

    /// Cubes of a cell's side over the vertical extent of each thing in the window.
    pub(crate) fn occupied(&self) -> Vec<Voxel> {
        let (lattice, _) = self.reached.place();
        let side_m = lattice.cell_m;
        let mut voxels = Vec::new();
        for cell in self.reached.view.cells.area().cells() {
            let [x_m, y_m] = lattice.center_of(cell);
            for thing in self.things(cell) {
                let count = (f64::from(thing.high_m - thing.low_m) / side_m) as usize + 1;
                let top_m = f64::from(thing.high_m);
                voxels.extend((0..count).map(|down| Voxel {
                    centre_m: [x_m, y_m, top_m - (down as f64 + 0.5) * side_m],
                    side_m,
                }));
            }
        }
        voxels
    }
}
