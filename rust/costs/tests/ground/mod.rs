//! A family of random grounds, their true dangers, and a robot that crosses them. Frozen before anything learned them: what it is may not
//! follow from how well a learner does.
//!
//! Patches of four kinds lie on gentle hills among boxes. What a robot sees of each is not what it stands on: grass looks rough and gives
//! way, gravel looks as rough and does not, and wet plates look as smooth as the floor does, and are darker. Colours from above tell the
//! kinds apart, but are other ones on each ground.

use costs::{
    CheapestPaths, GroundShape, LimitsConfig, MotionConfig, MotionCost, RobotLimits, SpeedOnCurve,
    Traversability, TraversabilityConfig,
};
use geometry::{Cell, Grid, SplitMix64, hypot};

pub(crate) const CELL_M: f64 = 0.08;
pub(crate) const CELLS: usize = 44;
pub(crate) const START: Cell = Cell::new(4, 22);
pub(crate) const GOAL: Cell = Cell::new(39, 22);
/// How far the robot sees heights and shades, m.
const SIGHT_M: f64 = 0.8;
/// Cells that it walks before it looks for a way anew.
const STRETCH: usize = 5;
const MOST_STRETCHES: usize = 60;
/// Grounds that learners may train on, and those they are tried on.
pub(crate) const TRAINING: std::ops::Range<u64> = 0..60;
pub(crate) const HELD_OUT: std::ops::Range<u64> = 1000..1200;

/// Share of patches, standard deviation that is seen and that is stood on (m), friction, shade, cover: each from one to another.
struct Kind {
    share: f64,
    seen_m: [f64; 2],
    firm_m: [f64; 2],
    friction: [f64; 2],
    shade: [f64; 2],
    cover: [f64; 2],
    /// It is stood on just as it is seen.
    as_seen: bool,
}

const KINDS: [Kind; 4] = [
    // Floor.
    Kind {
        share: 0.545,
        seen_m: [0.0, 0.001],
        firm_m: [0.0, 0.001],
        friction: [0.6, 0.9],
        shade: [0.45, 0.85],
        cover: [0.0, 0.05],
        as_seen: true,
    },
    // Grass.
    Kind {
        share: 0.22,
        seen_m: [0.002, 0.006],
        firm_m: [0.0005, 0.0015],
        friction: [0.5, 0.7],
        shade: [0.3, 0.6],
        cover: [0.4, 0.9],
        as_seen: false,
    },
    // Gravel.
    Kind {
        share: 0.2,
        seen_m: [0.002, 0.006],
        firm_m: [0.002, 0.006],
        friction: [0.4, 0.6],
        shade: [0.3, 0.7],
        cover: [0.0, 0.15],
        as_seen: true,
    },
    // Wet plates.
    Kind {
        share: 0.035,
        seen_m: [0.0, 0.001],
        firm_m: [0.0, 0.001],
        friction: [0.05, 0.15],
        shade: [0.1, 0.35],
        cover: [0.0, 0.05],
        as_seen: true,
    },
];

/// Limits of qrio, as its folder says them.
pub(crate) fn limits() -> RobotLimits {
    RobotLimits {
        slope: LimitsConfig::default().slope,
        roughness_m: 0.01,
        step_m: 0.055,
        radius_m: 0.14,
        height_m: 0.58,
        speed_mps: 0.14,
        com_height_m: 0.273,
        half_support_m: 0.0462,
        half_stance_m: 0.0425,
        step_time_s: 0.5,
        sole_m: 0.105,
    }
}

pub(crate) const WALK: SpeedOnCurve = SpeedOnCurve {
    speed_mps: 0.14,
    curvature_per_m: 0.5,
};

/// One ground: what can be seen of it, and where a robot falls.
pub(crate) struct Ground {
    /// The shape that is seen where it is near.
    pub(crate) shapes: Grid<Option<GroundShape>>,
    /// How bright it is, 0 to 1, where it is near.
    pub(crate) shade: Grid<f64>,
    /// Share of the rays that do not end on the lowest surface, where it is near.
    pub(crate) cover: Grid<f64>,
    /// Its colour from above, of every cell from the start on.
    pub(crate) colour: Grid<[f64; 3]>,
    /// Where a robot falls.
    falls: Grid<bool>,
    /// How near to falling each cell brings it: 1 just does.
    pub(crate) danger: Grid<f64>,
}

/// How a crossing ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    Arrived,
    Fell,
    Stuck,
}

/// A crossing: how it ended and the cells that were walked.
pub(crate) struct Crossing {
    pub(crate) end: End,
    pub(crate) cells: Vec<Cell>,
}

pub(crate) struct Random(SplitMix64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(SplitMix64::new(seed))
    }

    pub(crate) fn within(&mut self, [low, high]: [f64; 2]) -> f64 {
        low + (high - low) * self.0.uniform()
    }

    pub(crate) fn normal(&mut self, sigma: f64) -> f64 {
        let radius = (-2.0 * libm::log(1.0 - self.0.uniform())).sqrt();
        sigma * radius * libm::cos(std::f64::consts::TAU * self.0.uniform())
    }
}

pub(crate) fn grid<T: Clone>(value: impl Fn(Cell) -> T) -> Grid<T> {
    let mut grid = Grid::filled(CELLS, CELLS, value(START));
    for cell in grid.area().cells() {
        *grid.get_mut(cell).unwrap() = value(cell);
    }
    grid
}

pub(crate) fn traversability() -> Traversability {
    Traversability::new(TraversabilityConfig::default(), limits()).unwrap()
}

pub(crate) fn motion() -> MotionCost {
    MotionCost::new(MotionConfig::default(), limits()).unwrap()
}

/// A patch: its middle, in cells, its kind, and what was drawn of each range of that.
type Patch = ([f64; 2], usize, [f64; 5]);

fn patches(random: &mut Random) -> Vec<Patch> {
    let size = CELLS as f64;
    let patch = |index: usize| {
        // Both ends are on the floor.
        let end = [START, GOAL].get(index).map(|end| [end.col, end.row]);
        let at = end.map(|end| end.map(f64::from));
        let at = at.unwrap_or_else(|| [0, 1].map(|_| random.within([0.0, size])));
        let mut pick = random.within([0.0, 1.0]);
        let kind = KINDS.iter().position(|kind| {
            pick -= kind.share;
            pick < 0.0
        });
        let kind = kind.filter(|_| index > 1).unwrap_or(0);
        let of = &KINDS[kind];
        let range = [of.seen_m, of.firm_m, of.friction, of.shade, of.cover];
        (at, kind, range.map(|range| random.within(range)))
    };
    (0..30).map(patch).collect()
}

fn away(from: &[f64; 2], cell: Cell) -> f64 {
    hypot(from[0] - f64::from(cell.col), from[1] - f64::from(cell.row))
}

fn nearest(patches: &[Patch], cell: Cell) -> &Patch {
    let nearer = |a: &&Patch, b: &&Patch| away(&a.0, cell).total_cmp(&away(&b.0, cell));
    patches.iter().min_by(nearer).unwrap()
}

/// Hills, each a wave: two rates (rad/m), phase, height (m); and the middles of boxes, in cells.
struct Relief {
    hills: Vec<[f64; 4]>,
    boxes: Vec<[f64; 2]>,
}

impl Relief {
    fn drawn(random: &mut Random) -> Self {
        let ranges = [
            [-4.0, 4.0],
            [-4.0, 4.0],
            [0.0, std::f64::consts::TAU],
            [0.0, 0.02],
        ];
        let hill = |_| ranges.map(|range| random.within(range));
        let hills = (0..6).map(hill).collect();
        let size = CELLS as f64;
        let boxes = (0..8).map(|_| [0, 1].map(|_| random.within([0.0, size])));
        let boxes = boxes.filter(|at| [START, GOAL].iter().all(|end| away(at, *end) > 6.0));
        Self {
            hills,
            boxes: boxes.collect(),
        }
    }

    fn height_m(&self, cell: Cell) -> f64 {
        let [x, y] = [cell.col, cell.row].map(|at| f64::from(at) * CELL_M);
        let wave = |[a, b, phase, high]: &[f64; 4]| high * libm::sin(a * x + b * y + phase);
        let inside = |at: &[f64; 2]| {
            (at[0] - f64::from(cell.col)).abs() < 1.5 && (at[1] - f64::from(cell.row)).abs() < 1.5
        };
        let box_m = if self.boxes.iter().any(inside) {
            0.4
        } else {
            0.0
        };
        self.hills.iter().map(wave).sum::<f64>() + box_m
    }
}

/// How near to falling a robot comes in each cell by what it stands on; infinite where it cannot go at all.
fn dangers(firm_m: &Grid<Option<f64>>, friction: &Grid<f64>) -> Grid<f64> {
    let (measure, motion) = (traversability(), motion());
    let truth = measure.shapes(firm_m, None, CELL_M);
    grid(|cell| {
        let shape = truth.get(cell).copied().flatten();
        let feasible = shape.filter(|shape| measure.cost(shape).is_finite());
        feasible.map_or(f64::INFINITY, |shape| {
            let tip = motion.demand(&shape, 1.0, &WALK).tip;
            tip.max(motion.friction_asked(&shape, &WALK) / friction.get(cell).unwrap())
        })
    })
}

impl Ground {
    /// The ground of a seed. Drawn again until there is a way over it on which nobody falls.
    pub(crate) fn draw(seed: u64) -> Self {
        (0..1000)
            .map(|again| Self::drawn(&mut Random::new(seed * 1000 + again)))
            .find(|ground| ground.safe_way().is_some())
            .unwrap()
    }

    fn drawn(random: &mut Random) -> Self {
        let patches = patches(random);
        let relief = Relief::drawn(random);
        let mut seen = grid(|_| None);
        let mut firm = grid(|_| None);
        let (mut shade, mut cover) = (grid(|_| 0.0), grid(|_| 0.0));
        let mut colour = grid(|_| [0.0; 3]);
        let mut friction = grid(|_| 0.0);
        let colours = KINDS.map(|_| [0; 3].map(|_| random.within([0.0, 1.0])));
        let light = random.within([0.85, 1.15]);
        for cell in seen.area().cells() {
            let (_, kind, [seen_m, firm_m, grip, bright, covered]) = nearest(&patches, cell);
            let of_kind = &KINDS[*kind];
            let base_m = relief.height_m(cell);
            let seen_m = base_m + random.normal(*seen_m);
            let firm_m = base_m + random.normal(*firm_m);
            *seen.get_mut(cell).unwrap() = Some(seen_m);
            *firm.get_mut(cell).unwrap() = Some(if of_kind.as_seen { seen_m } else { firm_m });
            let bright = light * bright + random.normal(0.05);
            *shade.get_mut(cell).unwrap() = bright.clamp(0.0, 1.0);
            *cover.get_mut(cell).unwrap() = (covered + random.normal(0.05)).clamp(0.0, 1.0);
            *colour.get_mut(cell).unwrap() = colours[*kind].map(|one| one + random.normal(0.06));
            *friction.get_mut(cell).unwrap() = grip * libm::exp(random.normal(0.15));
        }
        let mut ground = Self {
            shapes: traversability().shapes(&seen, None, CELL_M),
            shade,
            cover,
            colour,
            falls: grid(|_| false),
            danger: dangers(&firm, &friction),
        };
        ground.falls = grid(|cell| *ground.danger.get(cell).unwrap() > 1.0);
        ground
    }

    /// The way of who knows where one falls, and stays away from there: what a demonstrator shows.
    pub(crate) fn safe_way(&self) -> Option<Vec<Cell>> {
        let costs = grid(|cell| {
            let danger = *self.danger.get(cell).unwrap();
            if danger > 0.95 {
                f64::INFINITY
            } else {
                1.0 + 3.0 * danger * danger
            }
        });
        let ends = [START, GOAL].map(|end| *costs.get(end).unwrap());
        let open = ends.iter().all(|cost| cost.is_finite());
        open.then(|| CheapestPaths::default().find(&costs, START, GOAL))
            .flatten()
    }

    /// Crosses from start to goal by what `costs` says of the cells that are seen from where the robot has been, and of the others.
    pub(crate) fn cross(&self, mut costs: impl FnMut(&Grid<bool>) -> Grid<f64>) -> Crossing {
        let mut near = grid(|_| false);
        let mut paths = CheapestPaths::default();
        let mut walked = vec![START];
        for _ in 0..MOST_STRETCHES {
            let here = walked[walked.len() - 1];
            for cell in near.area().cells() {
                let away = hypot(
                    f64::from(cell.col - here.col),
                    f64::from(cell.row - here.row),
                );
                *near.get_mut(cell).unwrap() |= away * CELL_M <= SIGHT_M;
            }
            let Some(path) = paths.find(&costs(&near), here, GOAL) else {
                break;
            };
            for &cell in path.iter().skip(1).take(STRETCH) {
                walked.push(cell);
                if *self.falls.get(cell).unwrap() {
                    return Crossing {
                        end: End::Fell,
                        cells: walked,
                    };
                }
            }
            if walked[walked.len() - 1] == GOAL {
                return Crossing {
                    end: End::Arrived,
                    cells: walked,
                };
            }
        }
        Crossing {
            end: End::Stuck,
            cells: walked,
        }
    }

    /// Crosses by hand-made costs: the shape against the robot's limits, and how near it comes to tipping on floor of usual friction.
    pub(crate) fn cross_by_hand(&self) -> Crossing {
        let (measure, motion) = (traversability(), motion());
        let unknown = 1.0 + TraversabilityConfig::default().unknown;
        self.cross(|near| {
            grid(|cell| match self.shapes.get(cell).copied().flatten() {
                Some(shape) if *near.get(cell).unwrap() => {
                    measure.cost(&shape) + motion.cost(&shape, 0.8, &WALK)
                }
                _ => unknown,
            })
        })
    }
}
