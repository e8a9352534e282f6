//! How soon footsteps are planned, and how good they are: drawn scenes by family, heights exact.
//!
//! `cargo run --release -p planning --example footstep_scenes` prints, for each family, how many plans were found, the time to the first plan
//! (median and 95th of 100), what it cost against the best plan, and what the plan costs that some 50 ms of a core's expansions find; the
//! best is the cheaper of that and what 10 s find by a field in which nothing is too dear (`-- 3`: 3 s). `-- quick` leaves the best ones out, `-- first` all but the first; `-- json` prints rows of `docs/results`.

#![expect(
    clippy::print_stdout,
    clippy::expect_used,
    reason = "a measurement: it prints, and ends where its settings are wrong"
)]

use std::time::Instant;

use geometry::{Goal, Grid, Lattice, PlanarPose, SplitMix64};
use mapping::HeightMap;
use planning::footsteps::{FootstepLayer, FootstepPlan, FootstepsConfig, SoleSize, StepLimits};

/// The robot `qrio`.
const LIMITS: StepLimits = StepLimits {
    sole: SoleSize {
        length_m: 0.105,
        width_m: 0.075,
    },
    stance_width_m: 0.085,
    foot_gap_m: 0.008,
    max_forward_m: 0.07,
    max_backward_m: 0.05,
    max_sideways_m: 0.1,
    max_turn_rad: 0.3,
    careful_forward_m: 0.135,
    careful_rise_m: 0.055,
    clearance_m: [0.02, 0.02],
    walked_s: 0.5,
    careful_air_s: 0.8,
    careful_ground_s: 0.4,
    careful_speed_mps: 0.195,
    careful_lift_mps: 0.08,
    body_radius_m: 0.14,
    body_from_m: 0.15,
};

struct Scene {
    map: HeightMap,
    start: PlanarPose,
    goal: Goal,
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

type Draw = fn(&mut SplitMix64) -> Scene;

/// Families with how many scenes are drawn of each.
const FAMILIES: [(&str, usize, Draw); 7] = [
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

fn plan(scene: &Scene, layer: &mut FootstepLayer) -> (Option<FootstepPlan>, f64) {
    let feet = layer.feet_around(&scene.start);
    let began = Instant::now();
    let found = layer.plan(&scene.map, feet, &scene.goal);
    (found.ok(), began.elapsed().as_secs_f64())
}

/// The plan, and the median time of five times that it was made, s.
fn repeated(scene: &Scene, layer: &mut FootstepLayer) -> (Option<FootstepPlan>, f64) {
    let mut times_s = [0.0; 5];
    let mut found = None;
    for time_s in &mut times_s {
        (found, *time_s) = plan(scene, layer);
    }
    (found, share(&mut times_s, 0.5))
}

/// Plans with at most so many expansions.
fn layer(expansions: usize) -> FootstepLayer {
    layer_with(expansions, FootstepsConfig::default())
}

/// Plans as cheaply as can be: nothing in the field is dearer than it may turn out to be.
fn best_layer(expansions: usize) -> FootstepLayer {
    let config = FootstepsConfig {
        poor_cost: 1.0,
        ..FootstepsConfig::default()
    };
    layer_with(expansions, config)
}

fn layer_with(expansions: usize, config: FootstepsConfig) -> FootstepLayer {
    let config = FootstepsConfig {
        expansions: expansions.clamp(1, 10_000_000),
        most_expansions: 10_000_000,
        ..config
    };
    FootstepLayer::new(config, LIMITS).expect("the settings are within their bounds")
}

fn share(of: &mut [f64], share: f64) -> f64 {
    of.sort_by(f64::total_cmp);
    let last = of.len().saturating_sub(1);
    of.get((share * last as f64).round() as usize)
        .copied()
        .unwrap_or(f64::NAN)
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [only_first, quick, json] =
        ["first", "quick", "json"].map(|word| words.iter().any(|given| given == word));
    let seconds = words.iter().find_map(|word| word.parse().ok());
    let best_s: f64 = seconds.unwrap_or(10.0);
    if !json {
        println!(
            "family, found, first plan ms median / p95, its cost / best, at 50 ms / best (worst), steps, s"
        );
    }
    let mut first = layer(1);
    for (name, count, draw) in FAMILIES {
        let mut random = SplitMix64::new(1);
        let (mut times_ms, mut firsts, mut soons, mut steps, mut costs_s) =
            (vec![], vec![], vec![], vec![], vec![]);
        let mut found = 0;
        for _ in 0..count {
            let scene = draw(&mut random);
            let (plan_first, time_s) = repeated(&scene, &mut first);
            let Some(plan_first) = plan_first else {
                times_ms.push(1e3 * time_s);
                continue;
            };
            found += 1;
            times_ms.push(1e3 * time_s);
            if only_first {
                continue;
            }
            let speed = measured_speed(&scene);
            let soon = plan(&scene, &mut layer((0.05 * speed) as usize)).0;
            let best = if quick {
                soon.clone()
            } else {
                cheaper(
                    soon.clone(),
                    plan(&scene, &mut best_layer((best_s * speed) as usize)).0,
                )
            };
            let (Some(soon), Some(best)) = (soon, best) else {
                continue;
            };
            firsts.push(plan_first.cost_s / best.cost_s);
            soons.push(soon.cost_s / best.cost_s);
            steps.push(soon.steps.len() as f64);
            costs_s.push(soon.cost_s);
        }
        let times = [share(&mut times_ms, 0.5), share(&mut times_ms, 0.95)];
        let soon = [share(&mut soons, 0.5), share(&mut soons, 1.0)];
        let [first_cost, steps, cost_s] = [
            share(&mut firsts, 0.5),
            share(&mut steps, 0.5),
            share(&mut costs_s, 0.5),
        ];
        if json {
            println!(
                "[\"{name}\", \"{found} of {count}\", \"{:.1} / {:.1}\", \"{first_cost:.2}\", \"{:.3} ({:.3})\", \"{steps:.0}\"],",
                times[0], times[1], soon[0], soon[1]
            );
        } else {
            println!(
                "{name}: {found}/{count}, {:.1} / {:.1}, {first_cost:.2}, {:.3} ({:.3}), {steps:.0}, {cost_s:.1}",
                times[0], times[1], soon[0], soon[1]
            );
        }
    }
}

fn cheaper(a: Option<FootstepPlan>, b: Option<FootstepPlan>) -> Option<FootstepPlan> {
    let both = a.into_iter().chain(b);
    both.min_by(|a, b| a.cost_s.total_cmp(&b.cost_s))
}

/// Expansions a second in a scene.
fn measured_speed(scene: &Scene) -> f64 {
    let (found, time_s) = plan(scene, &mut layer(3000));
    found.map_or(0.0, |plan| plan.expanded as f64 / time_s)
}
