//! Drawn scenes by family.

use geometry::{Goal, Grid, Lattice, PlanarPose, SplitMix64};
use mapping::HeightMap;

/// A map, and a way that is asked for.
pub(crate) struct Scene {
    pub(crate) map: HeightMap,
    pub(crate) start: PlanarPose,
    pub(crate) goal: Goal,
}

/// Something of one height, turned by an angle around its middle: what stands on the floor, or a part of it.
#[derive(Clone, Copy)]
struct Slab {
    middle: PlanarPose,
    half_m: [f64; 2],
    height_m: f64,
    /// How it rises along itself.
    slope: f64,
}

impl Slab {
    fn level(middle: PlanarPose, half_m: [f64; 2], height_m: f64) -> Self {
        Self {
            middle,
            half_m,
            height_m,
            slope: 0.0,
        }
    }

    fn height_m(&self, x_m: f64, y_m: f64) -> Option<f64> {
        let at = self.middle.relative(&PlanarPose::new(x_m, y_m, 0.0));
        let inside = at.x_m.abs() < self.half_m[0] && at.y_m.abs() < self.half_m[1];
        inside.then_some(self.height_m + self.slope * at.x_m)
    }
}

fn between(low: f64, high: f64, random: &mut SplitMix64) -> f64 {
    low + (high - low) * random.uniform()
}

fn scene(slabs: &[Slab], [x_m, y_m]: [f64; 2], random: &mut SplitMix64) -> Scene {
    let lattice = Lattice {
        origin_m: [-0.6, -1.5],
        cell_m: 0.01,
    };
    let mut heights_m = Grid::filled(420, 300, 0.0);
    for cell in heights_m.area().cells() {
        let [x_m, y_m] = lattice.center_of(cell);
        let height_m = slabs.iter().filter_map(|slab| slab.height_m(x_m, y_m));
        if let Some(of_cell) = heights_m.get_mut(cell) {
            *of_cell = height_m.fold(0.0, f64::max) as f32;
        }
    }
    let jitter = |random: &mut SplitMix64| between(-0.05, 0.05, random);
    Scene {
        map: HeightMap::new(lattice, heights_m, 0.0),
        start: PlanarPose::new(jitter(random), jitter(random), between(-0.5, 0.5, random)),
        goal: Goal {
            x_m,
            y_m,
            radius_m: 0.1,
            height_m: None,
        },
    }
}

fn boxes(count: usize, random: &mut SplitMix64) -> Vec<Slab> {
    let mut slabs = Vec::new();
    while slabs.len() < count {
        let middle = PlanarPose::new(
            between(0.5, 2.4, random),
            between(-0.9, 0.9, random),
            between(0.0, 3.0, random),
        );
        slabs.push(Slab::level(
            middle,
            [between(0.04, 0.1, random), between(0.04, 0.1, random)],
            0.4,
        ));
    }
    slabs
}

/// Stairs of treads that lie one behind the other, each turned against the one before around the right end of their edge.
fn flight(
    at: PlanarPose,
    (rise_m, tread_m, count): (f64, f64, usize),
    first_m: f64,
    turn_rad: f64,
) -> (Vec<Slab>, PlanarPose) {
    let half_width_m = 0.4;
    let mut edge = at;
    let mut slabs = Vec::new();
    for step in 0..count {
        // Deep enough that the next one lies on it.
        let deep_m = tread_m + if turn_rad == 0.0 { 0.0 } else { 0.5 };
        let middle = edge.compose(&PlanarPose::new(0.5 * deep_m, 0.0, 0.0));
        let height_m = first_m + rise_m * (step + 1) as f64;
        slabs.push(Slab::level(
            middle,
            [0.5 * deep_m + 0.001, half_width_m],
            height_m,
        ));
        edge = if turn_rad == 0.0 {
            edge.compose(&PlanarPose::new(tread_m, 0.0, 0.0))
        } else {
            let pivot = edge.compose(&PlanarPose::new(tread_m, half_width_m, turn_rad));
            pivot.compose(&PlanarPose::new(0.0, -half_width_m, 0.0))
        };
    }
    (slabs, edge)
}

fn l_stairs(
    (rise_m, tread_m): (f64, f64),
    [first, second]: [usize; 2],
    random: &mut SplitMix64,
) -> Scene {
    let (mut slabs, end) = flight(
        PlanarPose::new(0.5, 0.0, 0.0),
        (rise_m, tread_m, first),
        0.0,
        0.0,
    );
    let top_m = rise_m * first as f64;
    let landing = end.compose(&PlanarPose::new(0.4, 0.0, 0.0));
    slabs.push(Slab::level(landing, [0.4 + 0.001, 0.4], top_m));
    let turned = landing.compose(&PlanarPose::new(0.0, 0.4, std::f64::consts::FRAC_PI_2));
    let (more, end) = flight(turned, (rise_m, tread_m, second), top_m, 0.0);
    slabs.extend(more);
    let platform = end.compose(&PlanarPose::new(0.15, 0.0, 0.0));
    slabs.push(Slab::level(
        platform,
        [0.25, 0.4],
        top_m + rise_m * second as f64,
    ));
    scene(&slabs, [platform.x_m, platform.y_m.min(1.35)], random)
}

fn winder(random: &mut SplitMix64) -> Scene {
    let turn_rad = if random.uniform() < 0.5 {
        15.0_f64
    } else {
        23.0
    }
    .to_radians();
    let steps = (between(0.03, 0.04, random), 0.03, 5);
    let (slabs, end) = flight(PlanarPose::new(0.5, -0.3, 0.0), steps, 0.0, turn_rad);
    let last = slabs[slabs.len() - 1].middle;
    let goal = last.compose(&PlanarPose::new(0.05, -0.05, 0.0));
    let _ = end;
    scene(&slabs, [goal.x_m, goal.y_m], random)
}

fn plates(random: &mut SplitMix64) -> Scene {
    let mut slabs = boxes(5, random);
    for plate in 0..3 {
        let x_m = 0.6 + 0.65 * f64::from(plate);
        let middle = PlanarPose::new(x_m, between(-0.2, 0.2, random), between(-0.4, 0.4, random));
        slabs.push(Slab::level(
            middle,
            [between(0.1, 0.25, random), 0.8],
            between(0.015, 0.05, random),
        ));
    }
    scene(&slabs, [2.6, 0.0], random)
}

fn rubble(random: &mut SplitMix64) -> Scene {
    let mut slabs = Vec::new();
    for row in 0..8 {
        for col in 0..10 {
            let [x_m, y_m] = [0.45 + 0.2 * f64::from(col), -0.75 + 0.2 * f64::from(row)];
            let middle = PlanarPose::new(x_m, y_m, between(-0.3, 0.3, random));
            let slope = between(-0.12, 0.12, random);
            slabs.push(Slab {
                slope,
                ..Slab::level(middle, [0.1, 0.1], between(0.012, 0.04, random))
            });
        }
    }
    scene(&slabs, [2.6, 0.0], random)
}

/// Draws one of a family.
pub(crate) type Draw = fn(&mut SplitMix64) -> Scene;

/// Families with how many scenes are drawn of each.
pub(crate) const FAMILIES: [(&str, usize, Draw); 7] = [
    ("boxes", 15, |random| {
        let slabs = boxes(10, random);
        scene(&slabs, [2.6, 0.0], random)
    }),
    ("plates and boxes", 15, plates),
    ("L-stairs 3+3 of 40 mm", 15, |random| {
        l_stairs((0.04, between(0.16, 0.25, random)), [3, 3], random)
    }),
    ("L-stairs 4+3 of 30 mm, treads of 12 cm", 15, |random| {
        l_stairs((0.03, 0.12), [4, 3], random)
    }),
    ("winders", 15, winder),
    ("4 of 50 mm, treads of 11 cm", 15, |random| {
        let (mut slabs, end) = flight(PlanarPose::new(0.5, 0.0, 0.0), (0.05, 0.11, 4), 0.0, 0.0);
        slabs.push(Slab::level(
            end.compose(&PlanarPose::new(0.4, 0.0, 0.0)),
            [0.401, 0.4],
            0.2,
        ));
        scene(&slabs, [1.4, 0.0], random)
    }),
    ("rubble", 10, rubble),
];
