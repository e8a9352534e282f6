//! Claim: both feet together carry the robot's weight, whatever it does.

use robot::Side;
use sensing::SenseFault;

use super::cells::CELLS;
use super::repair::Repair;
use super::{Check, Finding, Lasting, Moment, foot_name};

/// How long the feet have carried too little.
#[derive(Debug, Clone, Default)]
pub(super) struct Missing {
    smooth_n: Option<f64>,
    too_little: Lasting,
    /// How long each foot has carried nothing at all.
    nothing: [Lasting; 2],
    /// For how long of the time in which its foot carried each cell has told nothing.
    silent: [[Lasting; 4]; 2],
}

impl Missing {
    /// Counts for how long each cell has told nothing while its foot carried at least so much.
    fn listen(&mut self, forces_n: &[[f64; 4]; 2], least_n: f64, passed_s: f64) {
        for (silent, cells_n) in self.silent.iter_mut().zip(forces_n) {
            let carries = cells_n.iter().sum::<f64>() >= least_n;
            for (silent, cell_n) in silent.iter_mut().zip(cells_n) {
                if carries || *cell_n > 0.0 {
                    let _ = silent.count(*cell_n <= 0.0, passed_s);
                }
            }
        }
    }

    /// The cell that has been silent for longest, if for long.
    fn dead_cell(&self, least_s: f64) -> Option<(Side, usize)> {
        let cells = Side::BOTH
            .into_iter()
            .flat_map(|side| [0, 1, 2, 3].map(|cell| (side, cell)));
        let silent_s = |(side, cell): (Side, usize)| self.silent[side.index()][cell].0;
        cells
            .filter(|&cell| silent_s(cell) > least_s)
            .max_by(|&a, &b| silent_s(a).total_cmp(&silent_s(b)))
    }
}

impl Check for Missing {
    fn look(&mut self, moment: &Moment<'_>) -> Option<Finding> {
        let (config, passed_s) = (moment.config, moment.passed_s);
        let loads_n = (moment.observation.foot_forces_n).map(|cells| cells.iter().sum::<f64>());
        let total_n = loads_n[0] + loads_n[1];
        let smooth_n = self.smooth_n.get_or_insert(total_n);
        *smooth_n += (total_n - *smooth_n) * passed_s / (passed_s + config.smooth);
        for (nothing, load_n) in self.nothing.iter_mut().zip(loads_n) {
            let _ = nothing.count(load_n <= 0.0, passed_s);
        }
        let least_n = config.least_load * moment.weight_n;
        let holds = *smooth_n < least_n;
        let share = 100.0 * *smooth_n / moment.weight_n;
        self.listen(&moment.observation.foot_forces_n, 0.5 * least_n, passed_s);
        if self.too_little.count(holds, passed_s) <= config.load_time {
            return None;
        }
        if let Some((side, cell)) = self.dead_cell(config.load_time) {
            let (foot, place) = (foot_name(side), CELLS[cell]);
            return Some(Finding {
                fault: SenseFault::new(
                    format!("the {foot} foot's {place} force cell"),
                    format!("tells nothing: both feet bear {share:.0} % of the weight"),
                ),
                repair: Repair::Cell { side, cell },
            });
        }
        let nothing = self.nothing.map(|lasting| lasting.0 > config.constant);
        let dead = match nothing {
            [true, true] => None,
            [true, false] => Some(Side::Left),
            [false, true] => Some(Side::Right),
            _ if loads_n[0] < loads_n[1] => Some(Side::Left),
            _ => Some(Side::Right),
        };
        let which = dead.map_or_else(
            || "the feet".to_owned(),
            |side| format!("the {} foot's force cells", foot_name(side)),
        );
        let what = match dead {
            Some(_) => {
                format!("do not tell what it carries: both feet bear {share:.0} % of the weight")
            }
            None => {
                "tell that nothing carries the robot: it was lifted, or they are dead".to_owned()
            }
        };
        Some(Finding {
            fault: SenseFault::new(which, what),
            repair: Repair::Foot(dead.unwrap_or(moment.state.support)),
        })
    }
}
