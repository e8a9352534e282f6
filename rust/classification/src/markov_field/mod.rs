//! Labels of cells or points smoothed by those of their neighbours: a Markov random field.

mod flow;

use settings::{ConfigError, NOT_NEGATIVE, Table, at_least, settings};

use crate::cloud::Point3;
use crate::neighbours::Neighbours;

settings! {
    /// How labels are smoothed over neighbours.
    pub struct MarkovFieldConfig("classification.markov_field") {
        /// Cost of a pair of neighbours with two labels, beside the negative logarithm of a label's likelihood.
        smoothness: f64 = 1.0, "1", NOT_NEGATIVE, "Anguelov et al. 2005, equation (2)";
        /// Neighbours of a point in a cloud.
        neighbours: usize = 6, "1", at_least(1.0);
        /// Most sweeps over all labels.
        sweeps: usize = 10, "1", at_least(1.0);
    }
}

/// Cells or points with their pairs of neighbours: handbook, section 36.3.5 (Potts model; cuts of Boykov, Veksler and Zabih 2001).
#[derive(Debug, Clone)]
pub struct MarkovField {
    config: MarkovFieldConfig,
    count: usize,
    pairs: Vec<[usize; 2]>,
}

impl MarkovField {
    /// Over the cells of a grid, row by row, each with the four beside it.
    pub fn of_grid(
        config: MarkovFieldConfig,
        cols: usize,
        rows: usize,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        let mut pairs = Vec::new();
        for cell in 0..cols * rows {
            if cell % cols + 1 < cols {
                pairs.push([cell, cell + 1]);
            }
            if cell + cols < cols * rows {
                pairs.push([cell, cell + cols]);
            }
        }
        let count = cols * rows;
        Ok(Self {
            config,
            count,
            pairs,
        })
    }

    /// Over the points of a cloud, each with those nearest to it.
    pub fn of_cloud(config: MarkovFieldConfig, points: &[Point3]) -> Result<Self, ConfigError> {
        config.check()?;
        let tree = Neighbours::new(points);
        let mut pairs = Vec::new();
        for (index, place) in points.iter().enumerate() {
            for (other, _) in tree.nearest(*place, config.neighbours + 1) {
                if other != index {
                    pairs.push([index.min(other), index.max(other)]);
                }
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        let count = points.len();
        Ok(Self {
            config,
            count,
            pairs,
        })
    }

    /// What labels cost: the sum of their own costs, and of what pairs with two labels cost.
    pub fn energy(&self, costs: &[Vec<f64>], labels: &[usize]) -> f64 {
        let own: f64 = costs
            .iter()
            .zip(labels)
            .map(|(costs, label)| costs[*label])
            .sum();
        let apart = self.pairs.iter().filter(|[a, b]| labels[*a] != labels[*b]);
        own + self.config.smoothness * apart.count() as f64
    }

    /// The labels of least energy, `costs` (0 or more, finite) a row a cell or point with the cost of each label. With two labels no
    /// others cost less; with more the labels cannot be bettered by any change of some to one (expansion moves), and cost at most
    /// twice the least.
    pub fn labels(&self, costs: &[Vec<f64>]) -> Vec<usize> {
        let labels = costs.first().map_or(0, Vec::len);
        let mut best: Vec<usize> = costs.iter().map(|costs| least(costs)).collect();
        let mut energy = self.energy(costs, &best);
        for _ in 0..self.config.sweeps {
            let before = energy;
            for label in 0..labels {
                let grown = self.expanded(costs, &best, label);
                let of_grown = self.energy(costs, &grown);
                if of_grown < energy {
                    best = grown;
                    energy = of_grown;
                }
            }
            if energy >= before {
                break;
            }
        }
        if labels == 2 {
            // From one label everywhere an expansion of the other decides each cell: the least of all.
            return self.expanded(costs, &vec![0; self.count], 1);
        }
        best
    }

    /// The best labels among those where each keeps its own or changes to `label`, by a least cut.
    fn expanded(&self, costs: &[Vec<f64>], labels: &[usize], label: usize) -> Vec<usize> {
        let mut network = flow::Network::new(self.count);
        // Positive: costs this to change, which is the sink's side.
        let mut change: Vec<f64> = (costs.iter().zip(labels))
            .map(|(costs, old)| costs[label] - costs[*old])
            .collect();
        let smoothness = self.config.smoothness;
        let cost = |one: usize, other: usize| if one == other { 0.0 } else { smoothness };
        for &[a, b] in &self.pairs {
            let (of_a, of_b) = (labels[a], labels[b]);
            // By whether a and b change: neither, b alone, a alone; both cost nothing.
            let (none, only_b, only_a) = (cost(of_a, of_b), cost(of_a, label), cost(label, of_b));
            change[a] += only_a - none;
            change[b] += 0.0 - only_a;
            network.join(a, b, only_b + only_a - none, 0.0);
        }
        for (node, cost) in change.into_iter().enumerate() {
            network.prefer_source(node, cost);
        }
        let changed = network.cut();
        (labels.iter().zip(changed))
            .map(|(old, changed)| if changed { label } else { *old })
            .collect()
    }
}

/// The index of the least value; of equals the first.
fn least(values: &[f64]) -> usize {
    let better = |a: usize, b: usize| if values[b] < values[a] { b } else { a };
    (0..values.len()).reduce(better).unwrap_or(0)
}

#[cfg(test)]
mod tests;
