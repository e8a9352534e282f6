//! Slopes: there neighbouring cells differ by their tilt, and no foot has to be lifted for that.

/// How the cells of a view are tilted. Reused.
#[derive(Debug, Clone, Default)]
pub struct SlopeCells {
    pub(crate) cols: usize,
    pub(crate) cell_m: f32,
    pub(crate) gradients: Vec<[f32; 2]>,
    /// Cells of slopes that may be walked on, and those beside them; empty where there is no slope.
    pub(crate) near: Vec<bool>,
    /// What a level strip of a slope may be off it, m.
    pub(crate) strip_m: f32,
    /// Steepest slope that is walked on: rise per metre.
    pub(crate) most: f32,
}

impl SlopeCells {
    /// Of how much higher one cell is than another what is not the ground's slope, m.
    pub(crate) fn step_m(&self, from: usize, to: usize, rise_m: f32) -> f32 {
        if self.near.is_empty() {
            return rise_m.abs();
        }
        let step_m = (rise_m - self.rise_m(from, to)).abs();
        if self.near[from] && self.near[to] && step_m <= self.strip_m {
            return 0.0;
        }
        step_m
    }

    /// Whether a cell is part of a slope that may be walked on.
    pub(crate) fn is_slope(&self, index: usize) -> bool {
        let is_tilted = self
            .gradients
            .get(index)
            .is_some_and(|gradient| *gradient != [0.0; 2]);
        is_tilted && self.too_steep_at(index).is_none()
    }

    /// Whether a cell is part of a slope that may be walked on, or lies beside one.
    pub(crate) fn is_near(&self, index: usize) -> bool {
        self.near.get(index) == Some(&true)
    }

    /// The cells of slopes that are too steep to be walked on.
    pub(crate) fn too_steep(&self) -> impl Iterator<Item = usize> {
        (0..self.gradients.len()).filter(|&index| self.too_steep_at(index).is_some())
    }

    /// How steep a cell is if that is more than what is walked on: rise per metre.
    pub fn too_steep_at(&self, index: usize) -> Option<f64> {
        let [x, y] = self.gradients.get(index)?.map(f64::from);
        let rise = geometry::hypot(x, y);
        (rise > f64::from(self.most)).then_some(rise)
    }

    /// The steepest slope that is walked on: rise per metre.
    pub fn steepest_walked(&self) -> f64 {
        f64::from(self.most)
    }

    /// How much higher a cell on a slope is than the one beside it by the tilt of both, m; none where it is on no slope.
    pub fn rise_on(&self, from: usize, to: usize) -> Option<f64> {
        let is_tilted = self.gradients.get(to)? != &[0.0; 2] && from < self.gradients.len();
        is_tilted.then(|| f64::from(self.rise_m(from, to)))
    }

    /// How much higher one cell is than another by the tilt of both, m.
    fn rise_m(&self, from: usize, to: usize) -> f32 {
        let [a, b] = [from, to].map(|index| self.gradients[index]);
        let place = |index: usize| [(index % self.cols) as f32, (index / self.cols) as f32];
        let (from, to) = (place(from), place(to));
        let along = |axis: usize| (to[axis] - from[axis]) * 0.5 * (a[axis] + b[axis]);
        self.cell_m * (along(0) + along(1))
    }
}
