//! How soon footsteps are planned, and how good they are: drawn scenes by family, heights exact.
//!
//! `cargo run --release -p planning --example footstep_scenes` prints, for each family, how many plans were found, the time to the first plan
//! (median and 95th of 100), what it cost against the best plan, and what the plan costs that some 50 ms of a core's expansions find; the
//! best is the cheaper of that and what 10 s find by a field in which nothing is too dear (`-- 3`: 3 s). `-- first` leaves all but the
//! first ones out; `-- json` prints rows of `docs/results`.

#![expect(
    clippy::print_stdout,
    clippy::expect_used,
    reason = "a measurement: it prints, and ends where its settings are wrong"
)]

mod scenes;

use std::time::Instant;

use geometry::SplitMix64;
use planning::footsteps::{FootstepLayer, FootstepPlan, FootstepsConfig, SoleSize, StepLimits};
use scenes::{Draw, FAMILIES, Scene};

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
    walked_both: 1.5,
    careful_sideways_m: 0.05,
    careful_sideways_down_m: 0.015,
    careful_rise_m: 0.055,
    careful_lift_m: 0.11,
    clearance_m: [0.02, 0.02],
    walked_s: 0.5,
    careful_air_s: 0.8,
    careful_ground_s: 0.4,
    careful_speed_mps: 0.195,
    careful_lift_mps: 0.08,
    body_radius_m: 0.14,
    body_from_m: 0.15,
};

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

/// What was measured of the scenes of a family.
#[derive(Default)]
struct Measured {
    found: usize,
    times_ms: Vec<f64>,
    first: Vec<f64>,
    soon: Vec<f64>,
    steps: Vec<f64>,
}

impl Measured {
    fn of(draw: Draw, count: usize, best_s: Option<f64>) -> Self {
        let mut random = SplitMix64::new(1);
        let mut measured = Self::default();
        let mut layer_first = layer(1);
        for _ in 0..count {
            let scene = draw(&mut random);
            let (first, time_s) = repeated(&scene, &mut layer_first);
            measured.times_ms.push(1e3 * time_s);
            let Some(first) = first else { continue };
            measured.found += 1;
            if let Some(best_s) = best_s {
                measured.compare(&scene, first.cost_s, best_s);
            }
        }
        measured
    }

    /// Costs of the first plan and of what 50 ms find against the best.
    fn compare(&mut self, scene: &Scene, first_s: f64, best_s: f64) {
        let speed = measured_speed(scene);
        let soon = plan(scene, &mut layer((0.05 * speed) as usize)).0;
        let best = plan(scene, &mut best_layer((best_s * speed) as usize)).0;
        if let (Some(soon), Some(best)) = (soon.clone(), cheaper(soon, best)) {
            self.first.push(first_s / best.cost_s);
            self.soon.push(soon.cost_s / best.cost_s);
            self.steps.push(soon.steps.len() as f64);
        }
    }
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [only_first, json] = ["first", "json"].map(|word| words.iter().any(|given| given == word));
    let seconds = words.iter().find_map(|word| word.parse().ok());
    let best_s = (!only_first).then_some(seconds.unwrap_or(10.0));
    println!(
        "family: found, first plan ms median / p95, its cost / best, at 50 ms / best (worst), steps"
    );
    for (name, count, draw) in FAMILIES {
        let Measured {
            found,
            mut times_ms,
            mut first,
            mut soon,
            mut steps,
        } = Measured::of(draw, count, best_s);
        let [median_ms, p95_ms] = [0.5, 0.95].map(|part| share(&mut times_ms, part));
        let [soon_median, soon_worst] = [0.5, 1.0].map(|part| share(&mut soon, part));
        let (first, steps) = (share(&mut first, 0.5), share(&mut steps, 0.5));
        let times = format!("{median_ms:.1} / {p95_ms:.1}");
        let costs = format!("{first:.2}, {soon_median:.3} ({soon_worst:.3})");
        if json {
            println!(
                r#"{{"what": "{name}", "measured": "{found} of {count}; {times} ms; {costs}; {steps:.0} steps"}},"#
            );
        } else {
            println!("{name}: {found}/{count}, {times}, {costs}, {steps:.0}");
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
