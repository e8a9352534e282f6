//! Claim: what a loaded force cell measures changes from tick to tick, as that of its neighbours does.

use robot::Side;
use sensing::SenseFault;

use super::repair::Repair;
use super::{Check, Finding, Lasting, Moment, foot_name};

pub(super) const CELLS: [&str; 4] = ["front left", "front right", "rear left", "rear right"];

/// How long each cell has been constant.
#[derive(Debug, Clone, Default)]
pub(super) struct ConstantCell {
    before_n: Option<[[f64; 4]; 2]>,
    constant: [[Lasting; 4]; 2],
}

impl Check for ConstantCell {
    fn look(&mut self, moment: &Moment<'_>) -> Option<Finding> {
        let now_n = moment.observation.foot_forces_n;
        let before_n = self.before_n.replace(now_n)?;
        let mut found = None;
        for side in Side::BOTH {
            let foot = side.index();
            let same = [0, 1, 2, 3]
                .map(|cell: usize| now_n[foot][cell].to_bits() == before_n[foot][cell].to_bits());
            let all = (now_n.as_flattened().iter())
                .zip(before_n.as_flattened())
                .all(|(now, before)| now.to_bits() == before.to_bits());
            for cell in 0..4 {
                let force_n = now_n[foot][cell];
                let holds = same[cell] && force_n > 0.0 && !all;
                let lasted_s = self.constant[foot][cell].count(holds, moment.passed_s);
                if lasted_s > moment.config.constant && found.is_none() {
                    let (foot, place) = (foot_name(side), CELLS[cell]);
                    found = Some(Finding {
                        fault: SenseFault::new(
                            format!("the {foot} foot's {place} force cell"),
                            format!("is stuck at {force_n:.1} N"),
                        ),
                        repair: Repair::Cell { side, cell },
                    });
                }
            }
        }
        found
    }
}
