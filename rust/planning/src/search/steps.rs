//! Which of the eight steps out of a cell can lead on, by what is free around it and by the steps that led there.
//!
//! Left out is what another way reaches for less: where all cells cost the same, a cheapest way keeps within 45 degrees until something
//! stands in it. What is left out costs half a cell more at least, which is why a search finds the same way without it.

/// The last step, west, east, south, north, then south west, south east, north west, north east, and eight or sixteen more where the
/// steps before it rule out one that turns by 45 degrees, to the one side or the other.
pub(crate) type Trail = u8;
/// No step led here.
pub(crate) const ANYWHERE: Trail = 24;
const TRAILS: usize = 25;

/// Columns and rows that a step goes.
type CellStep = [i32; 2];
/// The first four go straight.
const STEPS: [CellStep; 8] = [
    [-1, 0],
    [1, 0],
    [0, -1],
    [0, 1],
    [-1, -1],
    [1, -1],
    [-1, 1],
    [1, 1],
];

/// One bit for each cell of a block of 3 x 3, row by row from the south west.
pub(crate) type Block = usize;
const BLOCKS: usize = 1 << 9;
pub(crate) const MIDDLE: Block = bit([0, 0]);
pub(crate) const WESTERN: Block = bit([-1, -1]) | bit([-1, 0]) | bit([-1, 1]);
pub(crate) const EASTERN: Block = bit([1, -1]) | bit([1, 0]) | bit([1, 1]);

/// One bit for each step that leads on, and eight bits higher another one where it rules out a turn after it.
type AllowedSteps = u16;

/// By trail and which cells of the block are free; the middle's bit says whether all of them cost the same.
static ONWARD: [[AllowedSteps; BLOCKS]; TRAILS] = table();
/// By trail and step, the trail of a step; eight places further of one that rules out a turn.
static NEXT: [[Trail; 16]; TRAILS] = next();

/// Steps that lead on from the middle of a block.
#[derive(Debug)]
pub(crate) struct Steps {
    left: u32,
    /// Three bits higher, which of them rule out a turn: shifted down by a step's number, bit 3 is the 8 to add to it in `next`.
    leans: u32,
    next: &'static [Trail; 16],
}

impl Steps {
    #[inline]
    pub(crate) fn from(free: Block, alike: bool, trail: Trail) -> Self {
        let block = (free & !MIDDLE) | if alike { MIDDLE } else { 0 };
        let onward = u32::from(ONWARD[usize::from(trail)][block]);
        Self {
            left: onward & 0xff,
            leans: onward >> 5,
            next: &NEXT[usize::from(trail)],
        }
    }
}

impl Iterator for Steps {
    /// The step's number, and its trail.
    type Item = (usize, Trail);

    #[inline]
    fn next(&mut self) -> Option<(usize, Trail)> {
        if self.left == 0 {
            return None;
        }
        let at = self.left.trailing_zeros() as usize % 8;
        let leans = (self.leans >> at & 0b1000) as usize;
        self.left &= self.left - 1;
        Some((at, self.next[at | leans]))
    }
}

/// The bit of the cell so many columns and rows from the middle; 0 outside of the block.
const fn bit([right, up]: CellStep) -> Block {
    if right.abs() > 1 || up.abs() > 1 {
        return 0;
    }
    1 << (3 * (up + 1) + right + 1)
}

const fn less(a: CellStep, b: CellStep) -> CellStep {
    [a[0] - b[0], a[1] - b[1]]
}

const fn dot(a: CellStep, b: CellStep) -> i32 {
    a[0] * b[0] + a[1] * b[1]
}

const fn is_straight(step: CellStep) -> bool {
    step[0] * step[1] == 0
}

/// The step that a trail rules out, if it does: half a turn to the side less than 90 degrees.
const fn ruled_out(trail: usize) -> Option<CellStep> {
    let [right, up] = STEPS[trail % 8];
    let side = match trail / 8 {
        1 => 1,
        2 => -1,
        _ => return None,
    };
    let turned = [right - side * up, up + side * right];
    Some(if is_straight([right, up]) {
        turned
    } else {
        [turned[0] / 2, turned[1] / 2]
    })
}

/// The trail of a step that rules out another one.
const fn trail_that_rules_out(at: usize, step: CellStep) -> usize {
    let left = at + 8;
    if let Some([right, up]) = ruled_out(left)
        && right == step[0]
        && up == step[1]
    {
        return left;
    }
    at + 16
}

#[expect(clippy::large_stack_arrays, reason = "it is made by the compiler")]
const fn table() -> [[AllowedSteps; BLOCKS]; TRAILS] {
    let mut table = [[0; BLOCKS]; TRAILS];
    let mut free = 0;
    while free < BLOCKS {
        let open = open(free);
        let mut trail = 0;
        while trail < TRAILS {
            let ahead = open & !behind(trail);
            table[trail][free] = if free & MIDDLE == 0 {
                ahead
            } else {
                alike(ahead, trail, free)
            };
            trail += 1;
        }
        free += 1;
    }
    table
}

const fn next() -> [[Trail; 16]; TRAILS] {
    let mut table = [[0; 16]; TRAILS];
    let mut trail = 0;
    while trail < TRAILS {
        let mut at = 0;
        while at < STEPS.len() {
            table[trail][at] = at as Trail;
            table[trail][at + 8] = match turn_after(trail, STEPS[at]) {
                Some((ruled_out, _)) => trail_that_rules_out(at, ruled_out) as Trail,
                None => at as Trail,
            };
            at += 1;
        }
        trail += 1;
    }
    table
}

/// The steps to free cells; a diagonal one needs both of its corners.
const fn open(free: Block) -> AllowedSteps {
    let (mut steps, mut at) = (0, 0);
    while at < STEPS.len() {
        let [right, up] = STEPS[at];
        let needed = (bit([right, up]) | bit([right, 0]) | bit([0, up])) & !MIDDLE;
        if free & needed == needed {
            steps |= 1 << at;
        }
        at += 1;
    }
    steps
}

/// The steps to the cell that was left and to those of its neighbours that are neighbours here, too, and that it comes upon by a
/// straight step: that costs less than to go by the middle, whatever the weights.
const fn behind(trail: usize) -> AllowedSteps {
    if trail == ANYWHERE as usize {
        return 0;
    }
    let [right, up] = STEPS[trail % 8];
    let (mut steps, mut at) = (0, 0);
    while at < STEPS.len() {
        // From the cell that was left to where this step ends.
        let [col, row] = [STEPS[at][0] + right, STEPS[at][1] + up];
        if col.abs() + row.abs() <= 1 {
            steps |= 1 << at;
        }
        at += 1;
    }
    steps
}

/// Of some steps those that lead on where all cells cost the same, with what they rule out.
const fn alike(steps: AllowedSteps, trail: usize, free: Block) -> AllowedSteps {
    if trail == ANYWHERE as usize {
        return steps;
    }
    let came = STEPS[trail % 8];
    if free & bit(less([0, 0], came)) == 0 {
        return steps; // from a start that costs nothing that is known
    }
    let (mut left, mut at) = (steps, 0);
    while at < STEPS.len() {
        let step = STEPS[at];
        if steps >> at & 1 == 1 {
            if leads_aside(came, step, free) || is_ruled_out(trail, step, free) {
                left &= !(1 << at);
            } else if let Some((_, needed)) = turn_after(trail, step)
                && free & needed == needed
            {
                left |= 0x100 << at;
            }
        }
        at += 1;
    }
    left
}

/// Whether a step at right angles to the one that led here ends where the cell that was left leads without the middle: at once, with
/// the diagonal step's corner free, or by two straight steps around the corner, which is free.
const fn leads_aside(came: CellStep, step: CellStep, free: Block) -> bool {
    let turns = dot(came, step) == 0;
    turns && (!is_straight(came) || free & bit(less(step, came)) != 0)
}

/// Whether a trail rules out a step: straight and diagonal steps on both sides of it come to two that go between them.
const fn is_ruled_out(trail: usize, step: CellStep, free: Block) -> bool {
    let came = STEPS[trail % 8];
    let Some([right, up]) = ruled_out(trail) else {
        return false;
    };
    let same = right == step[0] && up == step[1];
    same && (is_straight(came) || free & bit(less(less(step, came), less([0, 0], step))) != 0)
}

/// The turn that a step rules out after a trail, given that some cells are free.
const fn turn_after(trail: usize, step: CellStep) -> Option<(CellStep, Block)> {
    let came = STEPS[trail % 8];
    let straight = is_straight(came);
    if dot(came, step) == 2 || straight && is_straight(step) && dot(came, step) == 1 {
        // Straight on: what was ruled out still is.
        let Some(turn) = ruled_out(trail) else {
            return None;
        };
        let beside = if straight {
            bit(less(turn, came))
        } else {
            bit(less(turn, less(came, turn)))
        };
        return Some((turn, beside));
    }
    if dot(came, step) != 1 {
        return None;
    }
    if straight {
        let turn = less(step, came);
        Some((turn, bit(less(turn, came))))
    } else {
        Some((less(step, less(came, step)), 0))
    }
}
