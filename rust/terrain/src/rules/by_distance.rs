//! What a length costs by its distance to what it has to stay clear of.

use crate::CellSettings;

/// Weight of a cell by its squared distance, in cells, as far as being near costs anything. Reused.
#[derive(Debug, Clone, Default)]
pub(super) struct Costs {
    by_squared: Vec<f32>,
}

impl Costs {
    /// For who needs this room, m, and pays for being near up to `soft_m` beyond it; `clearance_m` of a distance in cells.
    pub(super) fn fill(
        &mut self,
        settings: &CellSettings,
        needed_m: f64,
        soft_m: f64,
        clearance_m: impl Fn(f64) -> f64,
    ) {
        self.by_squared.clear();
        for squared in 0_u32.. {
            let clearance_m = clearance_m(f64::from(squared).sqrt());
            let weight = settings.weight(clearance_m - needed_m, soft_m) as f32;
            let allowed = clearance_m >= needed_m;
            self.by_squared
                .push(if allowed { weight } else { f32::INFINITY });
            if allowed && weight <= 1.0 {
                break;
            }
        }
    }

    /// The weight at a squared distance, in cells.
    #[inline]
    pub(super) fn at(&self, squared: u32) -> f32 {
        let furthest = self.by_squared.len() - 1;
        self.by_squared[furthest.min(squared as usize)]
    }
}
