//! Floor plans for the tests: random ones, and houses whose rooms are known.

use geometry::{Grid, Lattice, SplitMix64};

pub(crate) const CELL_M: f64 = 0.05;

pub(crate) fn lattice() -> Lattice {
    Lattice {
        origin_m: [-1.0, 2.0],
        cell_m: CELL_M,
    }
}

/// Free but for a rim and some blocks.
pub(crate) fn random_plan(seed: u64, side: usize, blocks: usize) -> Grid<bool> {
    let mut numbers = SplitMix64::new(seed);
    let mut free = Grid::filled(side, side, true);
    let mut upto = |most: usize| (numbers.uniform() * most as f64) as usize;
    for _ in 0..blocks {
        let (col, row) = (upto(side), upto(side));
        let (wide, high) = (1 + upto(side / 4), 1 + upto(side / 4));
        for at in 0..side * side {
            if (col..col + wide).contains(&(at % side)) && (row..row + high).contains(&(at / side))
            {
                free.values_mut()[at] = false;
            }
        }
    }
    free
}

/// A house: the free cells, and the number of the room of each, 0 in walls.
pub(crate) struct House {
    pub(crate) free: Grid<bool>,
    pub(crate) room_of: Vec<u32>,
    pub(crate) rooms: u32,
    pub(crate) doors: usize,
}

/// Rooms in two rows along a corridor, each with a door to it, some with furniture along their walls.
pub(crate) fn house(seed: u64) -> House {
    let mut numbers = SplitMix64::new(seed);
    let rooms = 2 + (numbers.uniform() * 2.0) as usize;
    let metres = |length_m: f64| (length_m / CELL_M).round() as usize;
    let wide = metres(2.8 + numbers.uniform() * 1.4);
    let deep = metres(2.6 + numbers.uniform() * 1.4);
    let corridor = metres(1.4 + 0.4 * numbers.uniform());
    let (wall, door) = (2, metres(0.8 + 0.2 * numbers.uniform()));
    let cols = wall + rooms * (wide + wall);
    let rows = 4 * wall + 2 * deep + corridor;
    let mut found = House {
        free: Grid::filled(cols, rows, false),
        room_of: vec![0; cols * rows],
        rooms: 2 * rooms as u32 + 1,
        doors: 2 * rooms,
    };
    let middle = 2 * wall + deep;
    found.open([wall, middle], [cols - 2 * wall, corridor], 1);
    for number in 0..2 * rooms {
        let (col, above) = (wall + (number % rooms) * (wide + wall), number >= rooms);
        let row = if above {
            middle + corridor + wall
        } else {
            wall
        };
        found.open([col, row], [wide, deep], number as u32 + 2);
        let at = col + 6 + (numbers.uniform() * (wide - door - 12) as f64) as usize;
        let row_of_door = if above {
            middle + corridor
        } else {
            wall + deep
        };
        found.open([at, row_of_door], [door, wall], 1);
        for _ in 0..3 {
            // Along the wall that is far from the door.
            let length = metres(0.4 + 0.6 * numbers.uniform());
            let thick = metres(0.3 + 0.2 * numbers.uniform());
            let first = col + (numbers.uniform() * (wide - length) as f64) as usize;
            let row = if above { row + deep - thick } else { row };
            found.block([first, row], [length, thick]);
        }
    }
    found
}

impl House {
    fn open(&mut self, from: [usize; 2], size: [usize; 2], room: u32) {
        self.set(from, size, true, room);
    }

    fn block(&mut self, from: [usize; 2], size: [usize; 2]) {
        self.set(from, size, false, 0);
    }

    fn set(&mut self, from: [usize; 2], size: [usize; 2], free: bool, room: u32) {
        let cols = self.free.cols();
        for row in from[1]..from[1] + size[1] {
            for col in from[0]..from[0] + size[0] {
                self.free.values_mut()[row * cols + col] = free;
                self.room_of[row * cols + col] = room;
            }
        }
    }
}
