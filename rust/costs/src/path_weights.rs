//! Weights of costs learned from ways that were walked: demonstrated ones, and the robot's own with how they ended.

use geometry::{Cell, Grid, hypot};
use nalgebra::DVector;
use settings::{ConfigError, NOT_NEGATIVE, POSITIVE, Table, above_to, settings};

use crate::paths::CheapestPaths;

settings! {
    /// How weights are learned from ways.
    pub struct PathWeightsConfig("costs.path_weights") {
        /// How far a way moves the weights.
        rate: f64 = 0.1, "1", POSITIVE, "Ratliff, Bagnell and Zinkevich 2006, equation (10)";
        /// How strongly weights are drawn back to those that they began with, at each way.
        ridge: f64 = 0.0002, "1", NOT_NEGATIVE, "Ratliff, Bagnell and Zinkevich 2006, equation (8)";
        /// A way that was not shown should cost more than the one that was by this, for each metre that it is beside it.
        margin: f64 = 0.5, "1", NOT_NEGATIVE, "Ratliff, Bagnell and Zinkevich 2006, equation (6)";
        /// Nearer than this to what was shown a way counts as the same.
        same: f64 = 0.12, "m", NOT_NEGATIVE;
        /// Logarithms of costs are no further from 0 than this.
        most: f64 = 4.0, "1", above_to(0.0, 20.0);
    }
}

/// What weights cannot be learned from.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WeightsError {
    /// Settings that cannot be used.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// Another number of features than there are weights.
    #[error("a cell has {found} features, there are {expected} weights")]
    WrongLength {
        /// How many it has.
        found: usize,
        /// How many it should have.
        expected: usize,
    },
    /// A feature or weight that is no number.
    #[error("feature {index} is not finite")]
    NotFinite {
        /// Which.
        index: usize,
    },
    /// A way that leaves the grid, or leads through cells without features.
    #[error("the way leads through cell ({col}, {row}), which has no features")]
    NoFeatures {
        /// Its column.
        col: i32,
        /// Its row.
        row: i32,
    },
}

/// The features of each cell; `None` where there is no way.
pub type Features = Grid<Option<DVector<f64>>>;

/// Costs of a metre whose logarithms are weighted sums of features, the weights learned from ways: maximum margin planning (Ratliff, Bagnell
/// and Zinkevich 2006; with logarithms, so that no cost is negative, Ratliff, Silver and Bagnell 2009) from demonstrations, and steps of a
/// perceptron from places of which one turned out better.
#[derive(Debug, Clone)]
pub struct PathWeights {
    config: PathWeightsConfig,
    first: DVector<f64>,
    weights: DVector<f64>,
}

impl PathWeights {
    /// With weights to begin with, one a feature.
    pub fn new(config: PathWeightsConfig, weights: &[f64]) -> Result<Self, WeightsError> {
        config.check()?;
        if let Some(index) = weights.iter().position(|one| !one.is_finite()) {
            return Err(WeightsError::NotFinite { index });
        }
        let first = DVector::from_column_slice(weights);
        Ok(Self {
            config,
            weights: first.clone(),
            first,
        })
    }

    /// The weights as they are now.
    pub fn weights(&self) -> &[f64] {
        self.weights.as_slice()
    }

    /// What a metre costs where these are the features.
    pub fn cost(&self, features: &DVector<f64>) -> f64 {
        let most = self.config.most;
        libm::exp(self.weights.dot(features).clamp(-most, most))
    }

    /// What a metre costs in each cell; infinite where there is no way.
    pub fn costs(&self, features: &Features) -> Result<Grid<f64>, WeightsError> {
        let mut costs = Grid::filled(features.cols(), features.rows(), f64::INFINITY);
        for (cost, of) in costs.values_mut().iter_mut().zip(features.values()) {
            if let Some(of) = of {
                self.check(of)?;
                *cost = self.cost(of);
            }
        }
        Ok(costs)
    }

    /// Learns that one place turned out better than another, both by their features: the worse one should cost more by `margin` in
    /// logarithms. Does nothing where it does already. Says whether it learned.
    pub fn prefer(
        &mut self,
        better: &DVector<f64>,
        worse: &DVector<f64>,
        margin: f64,
    ) -> Result<bool, WeightsError> {
        self.check(better)?;
        self.check(worse)?;
        let is_wrong = self.weights.dot(worse) < self.weights.dot(better) + margin;
        if is_wrong {
            self.step(better, worse);
        }
        Ok(is_wrong)
    }

    /// Learns from a way that somebody showed over cells of `cell_m`: of all others, the one that costs least for how far it is beside it
    /// becomes dearer. Says by how much that one seemed better before; 0 or less where the shown one is the cheapest already.
    pub fn learn_shown(
        &mut self,
        features: &Features,
        shown: &[Cell],
        cell_m: f64,
    ) -> Result<f64, WeightsError> {
        let better = self.slope(features, shown, cell_m)?;
        let ([Some(&start), Some(&goal)], mut costs) =
            ([shown.first(), shown.last()], self.costs(features)?)
        else {
            return Ok(0.0);
        };
        let plain = costs.clone();
        let is_same = |cell: Cell| {
            shown.iter().any(|one| {
                let apart = hypot(f64::from(cell.col - one.col), f64::from(cell.row - one.row));
                apart * cell_m <= self.config.same
            })
        };
        for cell in plain.area().cells() {
            if let Some(cost) = costs.get_mut(cell).filter(|_| !is_same(cell)) {
                *cost = (*cost - self.config.margin).max(libm::exp(-self.config.most));
            }
        }
        let Some(other) = CheapestPaths::default().find(&costs, start, goal) else {
            return Ok(0.0);
        };
        let worse = self.slope(features, &other, cell_m)?;
        let [seemed, shown_cost] = [&other[..], shown].map(|way| length(&costs, way, cell_m));
        self.step(&better, &worse);
        Ok(shown_cost - seemed)
    }

    /// How the cost of a way grows with each weight: its features, each metre by its cost.
    fn slope(
        &self,
        features: &Features,
        way: &[Cell],
        cell_m: f64,
    ) -> Result<DVector<f64>, WeightsError> {
        let of = |cell: Cell| {
            let found = features.get(cell).and_then(Option::as_ref);
            found.ok_or(WeightsError::NoFeatures {
                col: cell.col,
                row: cell.row,
            })
        };
        let mut sum = DVector::zeros(self.weights.len());
        for step in way.windows(2) {
            for cell in step {
                let features = of(*cell)?;
                self.check(features)?;
                let metres = 0.5 * step_m(step, cell_m) * self.cost(features);
                sum.axpy(metres, features, 1.0);
            }
        }
        Ok(sum)
    }

    fn step(&mut self, better: &DVector<f64>, worse: &DVector<f64>) {
        let back = (&self.first - &self.weights) * self.config.ridge;
        self.weights += (worse - better) * self.config.rate + back;
    }

    fn check(&self, features: &DVector<f64>) -> Result<(), WeightsError> {
        let (found, expected) = (features.len(), self.weights.len());
        if found != expected {
            return Err(WeightsError::WrongLength { found, expected });
        }
        (features.iter().position(|one| !one.is_finite()))
            .map_or(Ok(()), |index| Err(WeightsError::NotFinite { index }))
    }
}

fn step_m(step: &[Cell], cell_m: f64) -> f64 {
    let [from, to] = [step[0], step[1]];
    cell_m * hypot(f64::from(to.col - from.col), f64::from(to.row - from.row))
}

/// What a way costs.
fn length(costs: &Grid<f64>, way: &[Cell], cell_m: f64) -> f64 {
    let price = |cell: &Cell| costs.get(*cell).copied().unwrap_or(f64::INFINITY);
    let step = |step: &[Cell]| 0.5 * step_m(step, cell_m) * (price(&step[0]) + price(&step[1]));
    way.windows(2).map(step).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Length and two kinds of ground, one on either side.
    fn sides() -> Features {
        let mut features = Grid::filled(21, 21, None);
        for cell in features.area().cells() {
            let [left, right] = [
                f64::from(u8::from(cell.row < 8)),
                f64::from(u8::from(cell.row > 12)),
            ];
            *features.get_mut(cell).unwrap() = Some(DVector::from_vec(vec![1.0, left, right]));
        }
        features
    }

    #[test]
    fn who_is_shown_a_way_around_takes_it_from_then_on() {
        let features = sides();
        let (start, goal) = (Cell::new(0, 10), Cell::new(20, 10));
        let mut around: Vec<_> = (0..=6).map(|at| Cell::new(at, 10 + at)).collect();
        around.extend((7..=14).map(|col| Cell::new(col, 16)));
        around.extend((15..=20).map(|col| Cell::new(col, 30 - col)));
        let mut weights = PathWeights::new(PathWeightsConfig::default(), &[0.0; 3]).unwrap();
        let walks_on_right = |weights: &PathWeights| {
            let costs = weights.costs(&features).unwrap();
            let way = CheapestPaths::default().find(&costs, start, goal).unwrap();
            way.iter().filter(|cell| cell.row > 12).count()
        };
        assert_eq!(walks_on_right(&weights), 0);
        for _ in 0..60 {
            let _ = weights.learn_shown(&features, &around, 0.1).unwrap();
        }
        assert!(walks_on_right(&weights) > 5, "{:?}", weights.weights());
        assert!(weights.weights()[2] < weights.weights()[1]);
    }

    proptest! {
        #[test]
        fn a_way_that_turned_out_worse_comes_to_cost_more(
            better in prop::array::uniform4(0.0..2.0f64), worse in prop::array::uniform4(0.0..2.0f64),
        ) {
            let apart: f64 = better.iter().zip(&worse).map(|(a, b)| (a - b) * (a - b)).sum();
            prop_assume!(apart > 0.1);
            let config = PathWeightsConfig { ridge: 0.0, ..PathWeightsConfig::default() };
            let mut weights = PathWeights::new(config, &[1.0; 4]).unwrap();
            let [better, worse] = [better, worse].map(|one| DVector::from_row_slice(&one));
            let gap = |weights: &PathWeights| {
                let of = DVector::from_column_slice(weights.weights());
                of.dot(&worse) - of.dot(&better)
            };
            let before = gap(&weights);
            let mut steps = 0;
            while weights.prefer(&better, &worse, 1.0).unwrap() {
                steps += 1;
                prop_assert!(steps < 2000);
            }
            prop_assert!(gap(&weights) >= 1.0 && gap(&weights) >= before - 1e-12);
        }
    }

    #[test]
    fn bad_features_are_refused_by_name() {
        let mut weights = PathWeights::new(PathWeightsConfig::default(), &[1.0, 2.0]).unwrap();
        let [short, nan] = [vec![1.0], vec![1.0, f64::NAN]].map(DVector::from_vec);
        let said = weights.prefer(&short, &short, 0.0).unwrap_err().to_string();
        assert_eq!(said, "a cell has 1 features, there are 2 weights");
        let said = weights.prefer(&nan, &nan, 0.0).unwrap_err().to_string();
        assert_eq!(said, "feature 1 is not finite");
        let way = [Cell::new(0, 0), Cell::new(1, 0)];
        let nothing = Grid::filled(3, 3, None);
        let said = weights.learn_shown(&nothing, &way, 0.1).unwrap_err();
        assert!(
            said.to_string()
                .contains("cell (0, 0), which has no features")
        );
    }
}
