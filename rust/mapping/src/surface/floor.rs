//! The floor height grid: equations (2), (4), (8) and (9) of 000.

use geometry::{Cell, CellArea, Grid, Lattice};

use super::merging::{INVALID, merge_height};
use super::tilts::{LEVEL, Tilts};
use super::{FloorTuning, FogConfig, LabelledFrame};
use geometry::runs;
use volume::OccupancyGrid;
use volume::Update;

/// Whether the occupancy grid, which does not hold a height in the cell that is stored at an index, holds one within a distance of it, and the
/// floor there has a gradient.
fn holds_slope(
    occupancy: &OccupancyGrid,
    (index, height_m): (usize, f64),
    gradient: [f32; 2],
    within_m: f64,
) -> bool {
    gradient != LEVEL
        && [-within_m, within_m].iter().any(|off_m| {
            let layer = occupancy.layer_at(height_m + off_m);
            layer.is_some_and(|layer| occupancy.holds(index, layer))
        })
}

/// Heights of the highest horizontal surface of each cell.
#[derive(Debug, Clone, PartialEq)]
pub struct FloorGrid {
    lattice: Lattice,
    /// All heights; [`INVALID`] where there is none.
    pub heights: Grid<f32>,
    /// Frames that saw the surface which the cell holds from within the sure range.
    sightings: Grid<u16>,
    tilts: Tilts,
    /// From how near any frame saw it, m over the ground.
    distances_m: Grid<f32>,
    epsilon: f32,
    nu: f32,
    layer_m: f32,
    sure_range_m: f32,
    tuning: FloorTuning,
    /// What the frame shows that is being inserted, per cell: highest supported height, sum and number of those within epsilon.
    frame_top: Grid<f32>,
    frame_sum: Grid<(f64, u32)>,
    /// Cells with a supported height in this frame, and the cell, the height and the label of every point with one.
    frame_cells: Vec<usize>,
    supported: Vec<(usize, f64, u16)>,
}

impl FloorGrid {
    /// A grid without any height, equation (4).
    pub fn new(lattice: Lattice, config: &FogConfig) -> Self {
        let n = config.cells;
        Self {
            lattice,
            heights: Grid::filled(n, n, INVALID),
            sightings: Grid::filled(n, n, 0),
            tilts: Tilts::new(n, config.tuning.slopes.clone()),
            distances_m: Grid::filled(n, n, f32::INFINITY),
            epsilon: config.epsilon as f32,
            nu: config.nu as f32,
            layer_m: config.layer as f32,
            sure_range_m: config.sure_range as f32,
            tuning: config.tuning.floors.clone(),
            frame_top: Grid::filled(n, n, INVALID),
            frame_sum: Grid::filled(n, n, (0.0, 0)),
            frame_cells: Vec::with_capacity(n * n),
            supported: Vec::new(),
        }
    }

    /// Equation (2): height of the floor of a cell, m; `None` is *invalid*, also outside.
    pub fn height(&self, cell: Cell) -> Option<f32> {
        self.heights
            .get(cell)
            .copied()
            .filter(|&height| height != INVALID)
    }

    /// Height of the floor of the cell that is stored at an index, row by row, m; `None` is *invalid*.
    #[inline]
    pub(crate) fn height_at(&self, index: usize) -> Option<f32> {
        let height = self.heights.values()[index];
        (height != INVALID).then_some(height)
    }

    /// Highest floor of the cells around one, at most so many cells to each side, m.
    pub fn highest_around(&self, cell: Cell, cells: i32) -> Option<f32> {
        let around = runs(CellArea::of(cell).grown(cells), self.size());
        let heights = around.flat_map(|run| &self.heights.values()[run]);
        // Below every height there is INVALID.
        let highest = heights.copied().fold(INVALID, f32::max);
        (highest != INVALID).then_some(highest)
    }

    /// Columns and rows.
    fn size(&self) -> [usize; 2] {
        [self.heights.cols(), self.heights.rows()]
    }

    /// For each cell, row by row, what [`Self::sightings`] tells.
    pub(crate) fn all_sightings(&self) -> &[u16] {
        self.sightings.values()
    }

    /// How many frames saw the surface that a cell holds from near enough to be sure.
    pub fn sightings(&self, cell: Cell) -> u16 {
        self.sightings.get(cell).copied().unwrap_or(0)
    }

    /// How much the floor of the cell that is stored at an index rises per metre along the map's axes; nothing where it is level or not known.
    pub(crate) fn gradient_at(&self, index: usize) -> [f32; 2] {
        self.tilts.gradient_at(index)
    }

    /// Moves the window by whole cells to where `lattice` lies.
    pub fn shift(&mut self, cols: i32, rows: i32, lattice: Lattice) {
        self.heights.shift(cols, rows, &INVALID);
        self.sightings.shift(cols, rows, &0);
        self.tilts.shift(cols, rows);
        self.distances_m.shift(cols, rows, &f32::INFINITY);
        self.lattice = lattice;
    }

    /// Equation (8): forgets heights of the area that the occupancy grid, with the same cells, no longer supports, by (3) and (7).
    pub fn verify(&mut self, occupancy: &OccupancyGrid, area: CellArea) {
        let within_m = self.tuning.slope_within;
        for index in runs(area, self.size()).flatten() {
            let Some(height) = self.height_at(index) else {
                continue;
            };
            let height_m = f64::from(height);
            let layer = occupancy.layer_at(height_m);
            let held = layer.is_some_and(|layer| occupancy.holds(index, layer));
            if !held
                && !holds_slope(
                    occupancy,
                    (index, height_m),
                    self.gradient_at(index),
                    within_m,
                )
            {
                self.heights.values_mut()[index] = INVALID;
                self.sightings.values_mut()[index] = 0;
                self.distances_m.values_mut()[index] = f32::INFINITY;
            }
        }
    }

    /// Equation (9) for the frame's points whose height the occupancy grid supports.
    ///
    /// Per frame, a cell is updated once, with the mean of the heights within epsilon of the highest one that was seen.
    pub fn update(&mut self, frame: &LabelledFrame, occupancy: &OccupancyGrid, update: Update) {
        self.gather(frame, occupancy);
        let tops = self.frame_top.values();
        let sums = self.frame_sum.values_mut();
        let heights = self.heights.values_mut();
        for &(index, floor_height_m, label) in &self.supported {
            let height = floor_height_m as f32;
            if update == Update::PerPoint {
                let stored = &mut heights[index];
                if height > *stored + self.epsilon {
                    // Another surface: nobody has seen it before.
                    self.sightings.values_mut()[index] = 0;
                    self.distances_m.values_mut()[index] = f32::INFINITY;
                }
                *stored = merge_height(*stored, height, self.epsilon, self.nu);
            } else if height >= tops[index] - self.epsilon {
                let sum = &mut sums[index];
                *sum = (sum.0 + floor_height_m, sum.1 + 1);
                self.tilts.see(index, frame.gradient(label));
            }
        }
        self.finish(frame.eye_m, update);
    }

    /// Finds the points whose height the occupancy grid, with the same cells, supports, and the highest of each cell.
    fn gather(&mut self, frame: &LabelledFrame, occupancy: &OccupancyGrid) {
        self.supported.clear();
        let within_m = self.tuning.slope_within;
        let tops = self.frame_top.values_mut();
        // Points of one surface come one after the other and have one height.
        let mut last = (f64::NAN, None);
        for (point, index) in frame.located() {
            let height_m = point.floor_height_m;
            if height_m.is_nan() {
                continue;
            }
            if height_m != last.0 {
                last = (height_m, occupancy.layer_at(height_m));
            }
            let Some(index) = index else {
                continue;
            };
            let held = last.1.is_some_and(|layer| occupancy.holds(index, layer));
            let at = (index, height_m);
            if !held && !holds_slope(occupancy, at, frame.gradient(point.label), within_m) {
                continue;
            }
            self.supported.push((index, height_m, point.label));
            let top = &mut tops[index];
            if *top == INVALID {
                self.frame_cells.push(index);
            }
            *top = top.max(height_m as f32);
        }
    }

    /// Forgets the heights of an area's cells for which `is_no_floor` holds, whatever the occupancy grid says.
    pub(crate) fn forget(&mut self, area: CellArea, is_no_floor: impl Fn(Cell) -> bool) {
        for cell in area.cells().filter(|&cell| is_no_floor(cell)) {
            self.set(cell, INVALID, 0, f32::INFINITY);
        }
    }

    /// Applies what was gathered of the frame and clears it.
    fn finish(&mut self, [eye_x_m, eye_y_m, _]: [f64; 3], update: Update) {
        let cols = self.heights.cols();
        while let Some(index) = self.frame_cells.pop() {
            let cell = Cell::new((index % cols) as i32, (index / cols) as i32);
            let top = &mut self.frame_top.values_mut()[index];
            let sum = &mut self.frame_sum.values_mut()[index];
            let measured = match update {
                Update::PerFrame => (sum.0 / f64::from(sum.1)) as f32,
                Update::PerPoint => *top,
            };
            *top = INVALID;
            *sum = (0.0, 0);
            let [x, y] = self.lattice.center_of(cell);
            let distance_m = (x - eye_x_m).hypot(y - eye_y_m) as f32;
            self.merge((cell, index), measured, distance_m, update);
        }
    }

    /// Equation (9) for one cell, where points did not apply it themselves, and what comes of it for who saw the surface.
    fn merge(
        &mut self,
        (cell, index): (Cell, usize),
        measured: f32,
        distance_m: f32,
        update: Update,
    ) {
        let (Some(&stored), Some(&stored_from_m)) =
            (self.heights.get(cell), self.distances_m.get(cell))
        else {
            return;
        };
        let seen = self.sightings(cell);
        let below = measured < stored - self.epsilon;
        let better = update == Update::PerFrame
            && self.sees_better(stored - measured, distance_m, stored_from_m);
        if below && !better {
            return;
        }
        let height = match update {
            Update::PerPoint => stored,
            Update::PerFrame if below => measured,
            Update::PerFrame => {
                let nu = self.tilts.share_kept(index, self.nu);
                merge_height(stored, measured, self.epsilon, nu)
            }
        };
        let count = u16::from(distance_m <= self.sure_range_m);
        let same = !below && measured <= stored + self.epsilon;
        self.tilts.merge(index, same, self.nu);
        if same {
            let nearest_m = distance_m.min(stored_from_m);
            self.set(cell, height, seen.saturating_add(count), nearest_m);
        } else {
            self.set(cell, height, count, distance_m);
        }
    }

    /// Whether a height so far below the stored one is that of the same surface, seen better, and not of one below it: from
    /// afar treads run into each other, and the occupancy grid, which puts other wrong heights right, tells no heights apart
    /// that are less than a layer from each other.
    fn sees_better(&self, below_m: f32, distance_m: f32, stored_from_m: f32) -> bool {
        below_m <= self.layer_m && distance_m < self.tuning.nearer * stored_from_m
    }

    fn set(&mut self, cell: Cell, height: f32, seen: u16, distance_m: f32) {
        if let (Some(slot), Some(count), Some(from_m)) = (
            self.heights.get_mut(cell),
            self.sightings.get_mut(cell),
            self.distances_m.get_mut(cell),
        ) {
            (*slot, *count, *from_m) = (height, seen, distance_m);
        }
    }
}
