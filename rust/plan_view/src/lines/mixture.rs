//! Lines and points at random as a mixture, and expectation maximization (004, equations 36.9 to 36.16).

use super::line::{PlanarLine, WeightedPoint, WeightedSums};

/// Lines that points lie on, with noise, and a share of points that lie anywhere.
#[derive(Debug, Clone, PartialEq)]
pub struct LineMixture {
    lines: Vec<PlanarLine>,
    /// Share of each line in the points; last that of the random component.
    shares: Vec<f64>,
    /// Standard deviation of the points off their line, m.
    sigma_m: f64,
    /// Length along a line over which its points may lie, m.
    length_m: f64,
    /// Area over which random points lie, m^2.
    area_m2: f64,
}

/// The expectation that a point belongs to each component: `E[c_ij]` of 36.10 to 36.12, where it is not 0.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Assigned {
    /// Component and expectation; the number of lines stands for the random component. They add up to 1.
    pub shares: Vec<(usize, f64)>,
    /// Density of the point, 1/m^2.
    pub density: f64,
}

impl LineMixture {
    /// Lines with equal shares, the points' standard deviation, m, the share that lies at random, and the box that all lie in: its lower
    /// and upper corner, m.
    pub fn new(
        lines: Vec<PlanarLine>,
        sigma_m: f64,
        random: f64,
        [low_m, high_m]: [[f64; 2]; 2],
    ) -> Self {
        let each = (1.0 - random) / lines.len().max(1) as f64;
        let mut shares = vec![each; lines.len()];
        shares.push(if lines.is_empty() { 1.0 } else { random });
        let sides = [0, 1].map(|axis| (high_m[axis] - low_m[axis]).max(sigma_m));
        Self {
            lines,
            shares,
            sigma_m,
            length_m: geometry::hypot(sides[0], sides[1]),
            // A single wall lies in a box without a breadth, and is a line none the less: random points would fill the square.
            area_m2: sides[0].max(sides[1]) * sides[0].max(sides[1]),
        }
    }

    /// The lines.
    pub fn lines(&self) -> &[PlanarLine] {
        &self.lines
    }

    /// The share of each line in the points, last that of the random component; they add up to 1.
    pub fn shares(&self) -> &[f64] {
        &self.shares
    }

    /// Standard deviation of the points off their line, m.
    pub const fn sigma_m(&self) -> f64 {
        self.sigma_m
    }

    /// Density of a point so far off its line, 1/m: a Gaussian (004, equation 36.9).
    pub fn density_off(&self, off_m: f64) -> f64 {
        let off = off_m / self.sigma_m;
        libm::exp(-0.5 * off * off) / (self.sigma_m * (2.0 * std::f64::consts::PI).sqrt())
    }

    /// Likelihood of a point given the lines, by the nearest of them alone (004, equation 36.9), 1/m; 0 without a line.
    pub fn likelihood(&self, at_m: [f64; 2]) -> f64 {
        let off = self
            .lines
            .iter()
            .map(|line| line.signed_distance_m(at_m).abs());
        let nearest_m = off.fold(f64::INFINITY, f64::min);
        if nearest_m.is_finite() {
            self.density_off(nearest_m)
        } else {
            0.0
        }
    }

    /// E-step for one point (004, equations 36.10 to 36.12), the random component among what it may belong to.
    pub fn assign(&self, at_m: [f64; 2]) -> Assigned {
        let mut assigned = Assigned::default();
        let forms: Vec<_> = self.lines.iter().map(PlanarLine::normal_form).collect();
        self.assign_by(&forms, at_m, &mut assigned);
        assigned
    }

    fn assign_by(&self, forms: &[[f64; 3]], at_m: [f64; 2], assigned: &mut Assigned) {
        // Further off the Gaussian is less than 32 bits tell of the random component, whatever its share.
        let far_m = FAR * self.sigma_m;
        assigned.shares.clear();
        let mut density = 0.0;
        for (index, [cos, sin, distance_m]) in forms.iter().enumerate() {
            let off_m = at_m[0] * cos + at_m[1] * sin - distance_m;
            if off_m.abs() < far_m {
                let part = self.shares[index] * self.density_off(off_m) / self.length_m;
                assigned.shares.push((index, part));
                density += part;
            }
        }
        let random = self.shares[self.lines.len()] / self.area_m2;
        density += random;
        assigned.shares.push((self.lines.len(), random));
        for (_, share) in &mut assigned.shares {
            *share /= density;
        }
        assigned.density = density;
    }

    /// Logarithm of the likelihood of points: the sum over them, each with its weight.
    pub fn log_likelihood(&self, points: &[WeightedPoint]) -> f64 {
        let forms: Vec<_> = self.lines.iter().map(PlanarLine::normal_form).collect();
        let mut assigned = Assigned::default();
        let each = points.iter().map(|point| {
            self.assign_by(&forms, point.at_m, &mut assigned);
            point.weight * libm::log(assigned.density)
        });
        each.sum()
    }

    /// One iteration: E-step, and M-step (004, equation 36.13) by weighted lines in closed form (36.14 to 36.16). Returns the logarithm of the
    /// likelihood before it, which no iteration makes smaller. A line that no point belongs to stays as it is, with a share of 0.
    pub fn improve(&mut self, points: &[WeightedPoint]) -> f64 {
        let forms: Vec<_> = self.lines.iter().map(PlanarLine::normal_form).collect();
        let mut sums = vec![WeightedSums::default(); self.lines.len()];
        let (mut random, mut all, mut log_likelihood) = (0.0, 0.0, 0.0);
        let mut assigned = Assigned::default();
        for point in points {
            self.assign_by(&forms, point.at_m, &mut assigned);
            log_likelihood += point.weight * libm::log(assigned.density);
            all += point.weight;
            for &(component, share) in &assigned.shares {
                match sums.get_mut(component) {
                    Some(sums) => sums.add(point.at_m, share * point.weight),
                    None => random += share * point.weight,
                }
            }
        }
        if all <= 0.0 {
            return log_likelihood;
        }
        for (index, sums) in sums.iter().enumerate() {
            self.shares[index] = sums.weight() / all;
            self.lines[index] = sums.line().unwrap_or(self.lines[index]);
        }
        self.shares[self.lines.len()] = random / all;
        log_likelihood
    }

    /// Iterates until the logarithm of the likelihood grows by less than `least_gain` a unit of weight, at most so often; returns it.
    pub fn fit(&mut self, points: &[WeightedPoint], most: usize, least_gain: f64) -> f64 {
        let weight: f64 = points.iter().map(|point| point.weight).sum();
        let mut before = f64::NEG_INFINITY;
        for _ in 0..most {
            let now = self.improve(points);
            if now - before < least_gain * weight {
                break;
            }
            before = now;
        }
        self.log_likelihood(points)
    }

    /// Bayesian information criterion (004, section 36.2.2), less is better: for each line an angle, a distance and a share are fitted to so
    /// many points, which is their weight.
    pub fn information_criterion(&self, log_likelihood: f64, weight: f64) -> f64 {
        let parameters = (3 * self.lines.len()) as f64;
        parameters * libm::log(weight.max(1.0)) - 2.0 * log_likelihood
    }

    /// Density of each point, 1/m^2.
    pub(crate) fn densities(&self, points: &[WeightedPoint]) -> Vec<f64> {
        let forms: Vec<_> = self.lines.iter().map(PlanarLine::normal_form).collect();
        let mut assigned = Assigned::default();
        let density = |point: &WeightedPoint| {
            self.assign_by(&forms, point.at_m, &mut assigned);
            assigned.density
        };
        points.iter().map(density).collect()
    }

    /// Density, 1/m^2, of points that lie so far off a line, m, and belong to it.
    pub(crate) fn density_on_line(&self, off_m: f64) -> f64 {
        if off_m.abs() < FAR * self.sigma_m {
            self.density_off(off_m) / self.length_m
        } else {
            0.0
        }
    }

    /// By how much the logarithm of the likelihood falls without each of the lines, if its points are the random component's from then on.
    pub(crate) fn losses(&self, points: &[WeightedPoint]) -> Vec<f64> {
        let forms: Vec<_> = self.lines.iter().map(PlanarLine::normal_form).collect();
        let mut losses = vec![0.0; self.lines.len()];
        let mut assigned = Assigned::default();
        for point in points {
            self.assign_by(&forms, point.at_m, &mut assigned);
            for &(component, share) in &assigned.shares {
                if let Some(loss) = losses.get_mut(component) {
                    let instead = self.shares[component] / self.area_m2;
                    *loss -= point.weight * libm::log(1.0 - share + instead / assigned.density);
                }
            }
        }
        losses
    }

    /// Adds a line with this share, which all others give up in proportion.
    pub(crate) fn add(&mut self, line: PlanarLine, share: f64) {
        for other in &mut self.shares {
            *other *= 1.0 - share;
        }
        self.shares.insert(self.lines.len(), share);
        self.lines.push(line);
    }

    /// Takes out a line; its share goes to the random component.
    pub(crate) fn remove(&mut self, index: usize) -> PlanarLine {
        let share = self.shares.remove(index);
        if let Some(random) = self.shares.last_mut() {
            *random += share;
        }
        self.lines.remove(index)
    }

    /// Puts another line in the place of one.
    pub(crate) fn replace(&mut self, index: usize, line: PlanarLine) {
        self.lines[index] = line;
    }

    /// Puts the lines in order, those with most points first.
    pub(crate) fn sort(&mut self) {
        let mut order: Vec<_> = (0..self.lines.len()).collect();
        order.sort_by(|&one, &other| self.shares[other].total_cmp(&self.shares[one]));
        self.lines = order.iter().map(|&index| self.lines[index]).collect();
        let random = self.shares[order.len()];
        let shares = order.iter().map(|&index| self.shares[index]);
        self.shares = shares.chain([random]).collect();
    }
}

/// Standard deviations off a line beyond which a point does not belong to it: there a Gaussian is 1e-22 of its middle.
const FAR: f64 = 10.0;
