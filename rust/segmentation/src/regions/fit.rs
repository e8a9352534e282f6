//! Fits over eroded regions: the height of each, and the one tilt that all horizontal regions share.
//!
//! With the camera turned wrong by a small tilt `(a, b)` (the true upward direction is `(a, b, 1)` in the robot's axes as
//! believed), a horizontal surface shows `d = q (g - a X - b Y)`, where `X`, `Y`, `g` are linear in the pixel. One step of
//! Gauss and Newton over all regions, each with its own `q`, gives the tilt.

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use settings::{POSITIVE, at_least, settings, within};

use crate::picture::{Picture, View, to_f32};
use crate::regions::region::Region;

settings! {
    /// How regions are fitted: the height of each, and its tilt.
    pub struct FitTuning("navigation.ground.tuning.fits") {
        /// Every so many columns a pixel takes part in a fit: neighbours tell nearly alike. Of finer images as many pixels as of coarse
        /// ones.
        step: usize = 2, "1", within(1.0, 100.0);
        /// Pixels that tell as much as one independent one, because matching windows overlap: as many as a window of 5x5 has.
        alike: f64 = 25.0, "1", at_least(1.0);
        /// Pixels that are off a region's surface by more than so many times their noise are left out of its fit.
        outlier: f32 = 3.5, "1", POSITIVE;
        /// A region counts as tilted when the squared distance of its tilt from none, in its own errors, is above this. By chance one
        /// level region in a thousand is above 13.8 (two degrees of freedom).
        significant: f64 = 13.8, "1", POSITIVE;
    }
}

/// Sums over the pixels of one region; `e` is the residual at the `q` that the sums were made with.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct RegionFit {
    // Pixels that took part, and how many of them tell as much as one independent one.
    count: u32,
    shared_by: f64,
    q: f64,
    // Sums of the products of any two of: g, the change with the tilt's two components, e. Row up to column, the rest is 0.
    moments: [[f64; 4]; 4],
}

impl RegionFit {
    const fn gg(&self) -> f64 {
        self.moments[0][0]
    }

    const fn ge(&self) -> f64 {
        self.moments[0][3]
    }

    const fn gt(&self) -> Vector2<f64> {
        Vector2::new(self.moments[0][1], self.moments[0][2])
    }

    const fn te(&self) -> Vector2<f64> {
        Vector2::new(self.moments[1][3], self.moments[2][3])
    }

    const fn tt(&self) -> Matrix2<f64> {
        let [_, [_, xx, xy, _], [_, _, yy, _], _] = self.moments;
        Matrix2::new(xx, xy, xy, yy)
    }

    /// No pixel yet, of a surface at this `q`; `shared_by` of the pixels to come tell as much as one independent one.
    pub(crate) fn at(q: f32, shared_by: f64) -> Self {
        Self {
            q: f64::from(q),
            shared_by,
            ..Self::default()
        }
    }

    /// Adds the [`terms`] of a pixel.
    #[inline]
    pub(crate) fn add(&mut self, values: [f64; 4]) {
        self.count += 1;
        for row in 0..4 {
            for col in row..4 {
                self.moments[row][col] += values[row] * values[col];
            }
        }
    }

    /// Adds `count` pixels of a row from a column on, one every `step` columns.
    fn add_run(
        &mut self,
        picture: Picture<'_>,
        view: &View,
        [col, row]: [usize; 2],
        [count, step]: [usize; 2],
        outlier: f32,
    ) {
        // Summed up in registers.
        let mut sums = *self;
        let q = sums.q as f32;
        let first = row * picture.width + col;
        let pixels = first..first + (count - 1) * step + 1;
        let [disparity_px, g, sigma_px] = [picture.disparity_px, picture.g, picture.sigma_px]
            .map(|image| image[pixels.clone()].chunks(step));
        let (x, y) = (view.x.along(row), view.y.along(row));
        let mut col = to_f32(col);
        // The noise is that of a block.
        let (mut sigma, mut precision) = (f32::NAN, f32::NAN);
        for ((d, g), sigma_px) in disparity_px.zip(g).zip(sigma_px) {
            let (d, g) = (d[0], g[0]);
            if sigma_px[0] != sigma {
                sigma = sigma_px[0];
                precision = 1.0 / sigma;
            }
            let miss = (d - q * g) * precision;
            // Also false where nothing was seen.
            if miss.abs() < outlier {
                sums.add(terms(q, [g, x.at(col), y.at(col)], precision, miss));
            }
            col += step as f32;
        }
        *self = sums;
    }

    /// What the region tells of the tilt once its own height is eliminated: information and its product with the tilt.
    fn tilt_equation(&self) -> (Matrix2<f64>, Vector2<f64>) {
        if self.gg() <= 0.0 {
            return (Matrix2::zeros(), Vector2::zeros());
        }
        (
            (self.tt() - self.gt() * self.gt().transpose() / self.gg()) / self.shared_by,
            (self.te() - self.gt() * (self.ge() / self.gg())) / self.shared_by,
        )
    }

    /// The region's own tilt, and its squared distance from none in its own errors.
    pub(crate) fn own_tilt(&self) -> (Vector2<f64>, f64) {
        let (information, product) = self.tilt_equation();
        // A wish for no tilt, as weak as a sigma of one radian, keeps regions that are a line from giving nonsense.
        let tilt = (information + Matrix2::identity())
            .try_inverse()
            .map_or_else(Vector2::zeros, |inverse| inverse * product);
        (tilt, tilt.dot(&product))
    }

    /// How the region lies, with the tilt drawn towards `expected`.
    pub(crate) fn lie(&self, expected: &Vector2<f64>, expected_sigma_rad: f64) -> Option<Lie> {
        let prior = 1.0 / (expected_sigma_rad * expected_sigma_rad);
        let (gt, tt) = (self.gt(), self.tt());
        let mut information = Matrix3::new(
            self.gg(),
            gt.x,
            gt.y,
            gt.x,
            tt[(0, 0)],
            tt[(0, 1)],
            gt.y,
            tt[(1, 0)],
            tt[(1, 1)],
        ) / self.shared_by;
        information += Matrix3::from_diagonal(&Vector3::new(0.0, prior, prior));
        let te = self.te();
        let mut product = Vector3::new(self.ge(), te.x, te.y) / self.shared_by;
        product += Vector3::new(0.0, expected.x, expected.y) * prior;
        let covariance = information.try_inverse()?;
        Some(Lie {
            covariance,
            shared_by: self.shared_by,
            best: covariance * product,
        })
    }

    /// Whether the region may be horizontal when the camera's tilt is known to `limit_rad`; `significant` as in [`FitTuning`].
    pub(crate) fn is_level(&self, limit_rad: f64, significant: f64) -> bool {
        let (tilt, certainty) = self.own_tilt();
        certainty < significant || tilt.norm() < limit_rad
    }

    /// Disparity over `g` when the camera is tilted by `tilt`.
    pub(crate) fn q(&self, tilt: &Vector2<f64>) -> f64 {
        if self.gg() <= 0.0 {
            return self.q;
        }
        self.q + (self.ge() - self.gt().dot(tilt)) / self.gg()
    }

    /// Root mean square residual in noises, at the best `q`.
    pub(crate) fn roughness(&self) -> f64 {
        if self.count == 0 || self.gg() <= 0.0 {
            return f64::INFINITY;
        }
        ((self.moments[3][3] - self.ge() * self.ge() / self.gg()).max(0.0) / f64::from(self.count))
            .sqrt()
    }
}

/// What a region's pixels say of its height and tilt.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lie {
    covariance: Matrix3<f64>,
    shared_by: f64,
    /// Change of `q`, and tilt.
    best: Vector3<f64>,
}

impl Lie {
    /// That a part of the region has another height than the rest. `sums`: of the part's g times each of its [`terms`].
    pub(crate) fn step(&self, sums: [f64; 4]) -> Option<LevelStep> {
        let [gg, gx, gy, ge] = sums.map(|sum| sum / self.shared_by);
        let part = Vector3::new(gg, gx, gy);
        let drawn = self.covariance * part;
        let information = gg - part.dot(&drawn);
        let product = ge - part.dot(&self.best);
        (information > 0.0).then(|| LevelStep {
            rise: product / information,
            certainty: product * product / information,
            rest: self.best - drawn * (product / information),
        })
    }
}

/// Two heights in one region.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LevelStep {
    /// How much larger the part's `q` is than that of the rest, 1/m.
    pub(crate) rise: f64,
    /// By how much two heights explain the disparities better than one, in squared noise.
    pub(crate) certainty: f64,
    /// Change of `q` of the rest, and tilt.
    pub(crate) rest: Vector3<f64>,
}

/// What a pixel adds to a fit, in noises: `g`, how its disparity changes with the tilt's two components, and how far it is off
/// the level surface of this `q`. `gxy`: what the view has of the pixel.
#[inline]
pub(crate) fn terms(q: f32, gxy: [f32; 3], precision: f32, miss: f32) -> [f64; 4] {
    let [g, x, y] = gxy;
    [g * precision, -q * x * precision, -q * y * precision, miss].map(f64::from)
}

/// Adds up the fit of every region over the pixels that `labels` gives it.
pub(crate) fn fit_regions(
    picture: Picture<'_>,
    view: &View,
    regions: &[Region],
    labels: &[u16],
    tuning: &FitTuning,
    fits: &mut Vec<RegionFit>,
) {
    // Of so many rows one is looked at, and of so many columns: those between tell nearly the same.
    let (rows, step) = (picture.finer, tuning.step * picture.finer);
    let shared_by = (tuning.alike / (step * rows) as f64).max(1.0);
    fits.clear();
    fits.extend(
        regions
            .iter()
            .map(|region| RegionFit::at(region.q, shared_by)),
    );
    for (row, line) in labels.chunks_exact(picture.width).enumerate().step_by(rows) {
        let mut col = row % step;
        while col < line.len() {
            let label = line[col];
            let same = |other: &&u16| **other == label;
            let count = line[col..].iter().step_by(step).take_while(same).count();
            if label > 0 {
                let fit = &mut fits[usize::from(label) - 1];
                fit.add_run(picture, view, [col, row], [count, step], tuning.outlier);
            }
            col += count * step;
        }
    }
}

/// The tilt that the level regions share, drawn towards `expected` as far as they leave it open.
pub(crate) fn shared_tilt(
    fits: &[RegionFit],
    level_rad: f64,
    expected: &Vector2<f64>,
    expected_sigma_rad: f64,
) -> Vector2<f64> {
    let prior = 1.0 / (expected_sigma_rad * expected_sigma_rad);
    let mut information = Matrix2::identity() * prior;
    let mut product = expected * prior;
    for fit in fits
        .iter()
        .filter(|fit| fit.own_tilt().0.norm() < level_rad)
    {
        let (a, b) = fit.tilt_equation();
        information += a;
        product += b;
    }
    information
        .try_inverse()
        .map_or(*expected, |inverse| inverse * product)
}
