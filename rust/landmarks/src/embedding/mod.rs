//! What things look like, laid out in a few dimensions without naming anything: learned landmarks (004, section 36.3.5 and Fig. 36.17).
//!
//! Nonlinear dimension reduction by isometric mapping: distances along the data, from neighbour to neighbour, are kept as far as so few
//! dimensions allow (Tenenbaum, de Silva and Langford 2000). What is seen later is placed by its distances to what was learned from (de Silva and
//! Tenenbaum 2004).

#[cfg(test)]
mod tests;

use std::cmp::Ordering;

use geometry::Dijkstra;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use settings::{ConfigError, Table, at_least, settings, within};

settings! {
    /// How looks are laid out.
    pub struct EmbeddingConfig("landmarks.embedding") {
        /// Of how many numbers the representation is.
        dimensions: usize = 3, "1", within(1.0, 16.0), "004, Fig. 36.17";
        /// To how many of the most alike each look is joined.
        neighbours: usize = 8, "1", at_least(1.0);
    }
}

/// Why nothing could be learned.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EmbeddingError {
    /// A setting cannot be used.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// There are too few looks.
    #[error("there are {found} looks, and more than {least} are needed")]
    TooFew {
        /// How many there are.
        found: usize,
        /// How many are too few.
        least: usize,
    },
    /// A look has not as many numbers as the first, or some that are none.
    #[error("look {index} must be {expected} finite numbers")]
    Uneven {
        /// Which.
        index: usize,
        /// Of how many numbers the first is.
        expected: usize,
    },
}

/// Looks laid out in a few dimensions.
#[derive(Debug, Clone)]
pub struct Embedding {
    config: EmbeddingConfig,
    looks: Vec<DVector<f64>>,
    /// Distances along the data between all pairs.
    along: DMatrix<f64>,
    /// Mean of the squared distances of each to all.
    mean_squared: DVector<f64>,
    /// What squared distances to all are multiplied by to give a place, one row a dimension.
    placing: DMatrix<f64>,
}

impl Embedding {
    /// Learns from looks, each a list of as many numbers.
    pub fn learn(config: EmbeddingConfig, looks: &[Vec<f64>]) -> Result<Self, EmbeddingError> {
        config.check()?;
        let least = config.dimensions.max(config.neighbours);
        if looks.len() <= least {
            let found = looks.len();
            return Err(EmbeddingError::TooFew { found, least });
        }
        let expected = looks[0].len();
        let uneven = |look: &Vec<f64>| {
            look.len() != expected || look.iter().any(|number| !number.is_finite())
        };
        if let Some(index) = looks.iter().position(uneven) {
            return Err(EmbeddingError::Uneven { index, expected });
        }
        let looks: Vec<_> = (looks.iter())
            .map(|look| DVector::from_column_slice(look))
            .collect();
        let along = along_the_data(&looks, config.neighbours);
        let squared = along.component_mul(&along);
        let count = looks.len();
        let mean_squared = squared.column_mean();
        let mean = mean_squared.mean();
        let centred = DMatrix::from_fn(count, count, |row, col| {
            -0.5 * (squared[(row, col)] - mean_squared[row] - mean_squared[col] + mean)
        });
        let parts = SymmetricEigen::new(centred);
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|&one, &other| {
            let by_value = parts.eigenvalues[other].total_cmp(&parts.eigenvalues[one]);
            by_value.then(one.cmp(&other))
        });
        let placing = DMatrix::from_fn(config.dimensions, count, |row, col| {
            let value = parts.eigenvalues[order[row]];
            let vector = parts.eigenvectors.column(order[row]);
            // The sign of an eigenvector is nobody's: its largest part is positive.
            let sign = largest(vector.iter()).signum();
            if value > 0.0 {
                -0.5 * sign * vector[col] / value.sqrt()
            } else {
                0.0
            }
        });
        Ok(Self {
            config,
            looks,
            along,
            mean_squared,
            placing,
        })
    }

    /// Where a look lies that was learned from, by its index.
    pub fn place_of(&self, index: usize) -> Option<DVector<f64>> {
        let along = (index < self.looks.len()).then(|| self.along.column(index))?;
        Some(self.place_at(&along.into_owned()))
    }

    /// Where another look lies; none where it has not as many numbers as those that were learned from.
    pub fn place(&self, look: &[f64]) -> Option<DVector<f64>> {
        let expected = self.looks[0].len();
        if look.len() != expected || look.iter().any(|number| !number.is_finite()) {
            return None;
        }
        let look = DVector::from_column_slice(look);
        let away = self.looks.iter().map(|known| (known - &look).norm());
        let near = nearest(away.enumerate().collect(), self.config.neighbours);
        let along = DVector::from_fn(self.looks.len(), |to, _| {
            let through = near
                .iter()
                .map(|&(known, away)| away + self.along[(known, to)]);
            through.fold(f64::INFINITY, f64::min)
        });
        Some(self.place_at(&along))
    }

    /// Where something lies that is so far along the data from each that was learned from.
    fn place_at(&self, along: &DVector<f64>) -> DVector<f64> {
        &self.placing * (along.component_mul(along) - &self.mean_squared)
    }
}

/// Distances between all pairs, from neighbour to neighbour. Pieces that do not hang together are joined where they are nearest.
fn along_the_data(looks: &[DVector<f64>], neighbours: usize) -> DMatrix<f64> {
    let count = looks.len();
    let away = DMatrix::from_fn(count, count, |row, col| (&looks[row] - &looks[col]).norm());
    let mut joined = vec![Vec::new(); count];
    let mut join = |one: usize, other: usize| {
        joined[one].push((other as u32, away[(one, other)] as f32));
        joined[other].push((one as u32, away[(one, other)] as f32));
    };
    let mut piece: Vec<usize> = (0..count).collect();
    let mut unite = |piece: &mut Vec<usize>, one: usize, other: usize| {
        join(one, other);
        let (kept, gone) = (piece[one], piece[other]);
        for each in piece.iter_mut().filter(|each| **each == gone) {
            *each = kept;
        }
    };
    for one in 0..count {
        let others = (0..count).filter(|&other| other != one);
        let others = others.map(|other| (other, away[(one, other)])).collect();
        for (other, _) in nearest(others, neighbours) {
            unite(&mut piece, one, other);
        }
    }
    loop {
        let apart = |&(one, other): &(usize, usize)| piece[one] != piece[other];
        let pairs = (0..count).flat_map(|one| (0..one).map(move |other| (one, other)));
        let nearest_pair = pairs.filter(apart).min_by(|&one, &other| {
            away[one]
                .partial_cmp(&away[other])
                .unwrap_or(Ordering::Equal)
        });
        let Some((one, other)) = nearest_pair else {
            break;
        };
        unite(&mut piece, one, other);
    }
    let mut search = Dijkstra::default();
    let mut along = DMatrix::zeros(count, count);
    let mut costs = vec![f32::INFINITY; count];
    for from in 0..count {
        costs.fill(f32::INFINITY);
        search.begin_at(&mut costs, from as u32, 0.0);
        search.run(
            &mut costs,
            |at| joined[at as usize].iter().copied(),
            |_, _| {},
        );
        for (to, &cost) in costs.iter().enumerate() {
            along[(to, from)] = f64::from(cost);
        }
    }
    along
}

/// So many with the least distance; of the same distance the first.
fn nearest(mut each: Vec<(usize, f64)>, count: usize) -> Vec<(usize, f64)> {
    each.sort_by(|one, other| one.1.total_cmp(&other.1).then(one.0.cmp(&other.0)));
    each.truncate(count);
    each
}

/// The number with the largest absolute value.
fn largest<'a>(numbers: impl Iterator<Item = &'a f64>) -> f64 {
    numbers.fold(0.0, |largest: f64, &number| {
        if number.abs() > largest.abs() {
            number
        } else {
            largest
        }
    })
}
