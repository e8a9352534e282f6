//! Grids of coarser and coarser cells for what is far away, where a sensor's points lie too far apart for fine ones: 004, section
//! 36.3.1, after Montemerlo and Thrun 2004.

use geometry::Grid;
use volume::Locator;

use super::cells::{HeightCell, Revision};
use super::sensed::SensedFrame;
use super::{Gathered, RangeNoise, SurfaceRule};
use crate::surface::Window;

/// Cells of the finer grid in a cell.
const FINER: u32 = 4;

/// One grid of the pyramid.
#[derive(Debug, Clone)]
struct CoarseGrid {
    window: Window,
    cells: Grid<HeightCell>,
    /// Most points of a frame in each cell.
    points: Grid<u32>,
    /// Points in a cell from which on the finer grid is dense enough.
    dense: u32,
}

/// The coarser grids, the finest of them first.
#[derive(Debug, Clone)]
pub(super) struct Pyramid {
    levels: Vec<CoarseGrid>,
    gathered: Gathered,
}

impl Pyramid {
    /// So many grids above the one of `cells` cells of `cell_m` a side. `dense`: points a cell with which a grid is dense enough.
    pub(super) fn new(
        coarser: usize,
        (cell_m, cells): (f64, usize),
        wander: f64,
        dense: f64,
    ) -> Self {
        let level = |level: usize| {
            let times = 1_usize << level;
            let cells = cells.div_ceil(times) + 1;
            CoarseGrid {
                window: Window::new(cell_m * times as f64, cells, wander),
                cells: Grid::filled(cells, cells, HeightCell::UNKNOWN),
                points: Grid::filled(cells, cells, 0),
                dense: (f64::from(FINER) * dense).ceil() as u32,
            }
        };
        Self {
            levels: (1..=coarser).map(level).collect(),
            gathered: Gathered::default(),
        }
    }

    /// Follows the robot.
    pub(super) fn follow(&mut self, robot_m: [f64; 3]) {
        for level in &mut self.levels {
            let [cols, rows] = level.window.follow(robot_m);
            if [cols, rows] != [0; 2] {
                level.cells.shift(cols, rows, &HeightCell::UNKNOWN);
                level.points.shift(cols, rows, &0);
            }
        }
    }

    /// Takes in a frame.
    pub(super) fn insert(
        &mut self,
        frame: &SensedFrame,
        noise: RangeNoise,
        rule: SurfaceRule,
        revision: Revision,
    ) {
        let Self { levels, gathered } = self;
        for level in levels {
            let size = [level.cells.cols(), level.cells.rows()];
            let locator = Locator::of_cells(&level.window.lattice(), size);
            gathered.begin(size[0] * size[1]);
            for point in &frame.points {
                let [x_m, y_m, z_m] = frame.at_m(point);
                if let Some(cell) = locator.index_at([x_m, y_m]) {
                    gathered.add(cell, z_m as f32, noise.variance_m2(point.range_m));
                }
            }
            gathered.measure(rule, |measured| {
                level.cells.values_mut()[measured.cell].measure(&measured, revision);
                let most = &mut level.points.values_mut()[measured.cell];
                *most = measured.points.max(*most);
            });
        }
    }

    /// Whether there is no grid in it.
    pub(super) const fn is_empty(&self) -> bool {
        self.levels.is_empty()
    }

    /// What the finest grid says of a place in which the finer grids have gaps since the sensor's points lie too far apart there.
    pub(super) fn at(&self, [x_m, y_m]: [f64; 2]) -> Option<HeightCell> {
        self.levels.iter().find_map(|level| {
            let cell = level.window.lattice().cell_at(x_m, y_m);
            let known = level.cells.get(cell)?.known()?;
            (*level.points.get(cell)? < level.dense).then_some(*known)
        })
    }
}
