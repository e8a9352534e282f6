//! A planner of one's own: straight to the goal. It looks at nothing but what it would walk into.

use geometry::{Map, Pose, Robot};
use mapping::{FloorView, Surface};
use planning::{Goal, NoWay, Path, Plan, PlanError, Planner, PlannerPart, Refusal};
use pyo3::prelude::*;
use settings::{ConfigError, POSITIVE, Part, Table, TableDescription, read, settings};
use stairs::Staircase;

settings! {
    /// A planner that goes straight to the goal.
    pub struct BeelineConfig("navigation.beeline") {
        /// Distance between two points of the path.
        spacing: f64 = 0.04, "m", POSITIVE;
    }
}

/// How it is listed and made.
pub const BEELINE: PlannerPart = Part {
    name: "beeline",
    about: "straight to the goal, or not at all",
    source: None,
    tables: &[TableDescription::of::<BeelineConfig>()],
    make: |needs| Ok(Box::new(Beeline::new(&read(needs.tables, "beeline")?)?)),
};

/// The planner.
pub struct Beeline {
    spacing_m: f64,
    planned: bool,
}

impl Beeline {
    /// Takes its parameters.
    pub fn new(config: &BeelineConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            spacing_m: config.spacing,
            planned: false,
        })
    }
}

impl Planner for Beeline {
    fn plan(
        &mut self,
        view: &FloorView,
        _stairs: &Staircase,
        start: &Pose<Map, Robot>,
        goal: &Goal,
    ) -> Result<Plan, PlanError> {
        let from = start.origin().inner;
        let [far_x, far_y] = [goal.x_m - from.x, goal.y_m - from.y];
        let length = far_x.hypot(far_y);
        let count = (length / self.spacing_m).ceil().max(1.0) as usize;
        let points_m: Vec<[f64; 2]> = (0..=count)
            .map(|i| i as f64 / count as f64)
            .map(|share| [from.x + share * far_x, from.y + share * far_y])
            .collect();
        let met = |point: &&[f64; 2]| matches!(view.at(point[0], point[1]), Surface::Obstacle(_));
        let way = match points_m.iter().find(met) {
            Some([x, y]) => Err(NoWay::new(
                Refusal::Blocked,
                format!("something stands at {x:.2}, {y:.2}"),
            )),
            None => Ok(Path {
                unknown: points_m
                    .iter()
                    .map(|[x, y]| view.at(*x, *y) == Surface::Unknown)
                    .collect(),
                clearance_m: vec![f64::INFINITY; points_m.len()],
                cost_m: length,
                points_m,
                ..Path::default()
            }),
        };
        let replanned = !self.planned;
        self.planned = true;
        Ok(Plan { way, replanned })
    }
}

/// The core with the planner in it: what `TREADWELL_CORE` names is imported in the place of `treadwell._core`.
#[pymodule(name = "_core")]
fn own_core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    pilot::PLANNERS.add(BEELINE);
    _core::fill(module)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spacing_that_leads_nowhere_is_refused() {
        for spacing in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(Beeline::new(&BeelineConfig { spacing }).is_err());
        }
        assert!(Beeline::new(&BeelineConfig::default()).is_ok());
    }
}
