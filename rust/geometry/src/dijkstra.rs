//! Dijkstra's algorithm over nodes that are numbered: what the cheapest way from each to where it began costs.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The queue of a search, and the search. Reused.
#[derive(Debug, Clone, Default)]
pub struct Dijkstra {
    /// Costs as bits: numbers that are not negative are ordered like them. Of the same cost, the lowest node comes first.
    queue: BinaryHeap<Reverse<(u32, u32)>>,
}

impl Dijkstra {
    /// Begins at a node with this cost, which must not be negative. There may be several.
    pub fn begin_at(&mut self, costs: &mut [f32], node: u32, cost: f32) {
        costs[node as usize] = cost;
        self.queue.push(Reverse((cost.to_bits(), node)));
    }

    /// Forgets what is left of a search that found some costs only.
    pub fn clear(&mut self) {
        self.queue.clear();
    }

    /// Finds all costs; those of nodes that nothing leads to stay as they are. `steps` are the nodes that a step leads to from one, with
    /// what the step costs; `reach` is told of every cheaper way to a node, and the one before it on that way.
    pub fn run<Steps: Iterator<Item = (u32, f32)>>(
        &mut self,
        costs: &mut [f32],
        steps: impl Fn(u32) -> Steps,
        mut reach: impl FnMut(u32, u32),
    ) {
        while let Some(Reverse((bits, from))) = self.queue.pop() {
            self.expand(costs, (f32::from_bits(bits), from), &steps, &mut reach);
        }
    }

    /// Finds the cost of one node as [`Self::run`] does, and no more of the others than that takes; what is left can be found later.
    pub fn run_to<Steps: Iterator<Item = (u32, f32)>>(
        &mut self,
        costs: &mut [f32],
        node: u32,
        steps: impl Fn(u32) -> Steps,
    ) {
        // Nothing comes through what costs as much already.
        while let Some(&Reverse((bits, from))) = self.queue.peek()
            && f32::from_bits(bits) < costs[node as usize]
        {
            let _ = self.queue.pop();
            self.expand(costs, (f32::from_bits(bits), from), &steps, &mut |_, _| {});
        }
    }

    #[inline]
    fn expand<Steps: Iterator<Item = (u32, f32)>>(
        &mut self,
        costs: &mut [f32],
        (cost, from): (f32, u32),
        steps: &impl Fn(u32) -> Steps,
        reach: &mut impl FnMut(u32, u32),
    ) {
        if cost > costs[from as usize] {
            return; // reached more cheaply since
        }
        for (to, step) in steps(from) {
            let through = cost + step;
            if through < costs[to as usize] {
                costs[to as usize] = through;
                reach(to, from);
                self.queue.push(Reverse((through.to_bits(), to)));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cheapest_of_several_ways_is_found_and_what_is_not_joined_stays_far() {
        let links = [(0, 1, 1.0), (1, 2, 1.0), (0, 2, 3.0), (2, 3, 0.5)];
        let steps = |from: u32| {
            let out = links.iter().filter(move |link| link.0 == from);
            out.map(|&(_, to, cost)| (to, cost))
        };
        let (mut costs, mut before) = ([f32::INFINITY; 5], [u32::MAX; 5]);
        let mut dijkstra = Dijkstra::default();
        dijkstra.begin_at(&mut costs, 0, 0.0);
        dijkstra.run(&mut costs, steps, |to, from| before[to as usize] = from);
        assert_eq!(costs, [0.0, 1.0, 2.0, 2.5, f32::INFINITY]);
        assert_eq!(before, [u32::MAX, 0, 1, 2, u32::MAX]);
    }

    #[test]
    fn one_node_costs_what_it_does_when_all_are_found_whichever_is_asked_for_first() {
        let mut random = crate::random::SplitMix64::new(3);
        let links: Vec<_> = (0..400)
            .map(|_| {
                let [from, to] = [0; 2].map(|_| (random.uniform() * 120.0) as u32);
                (from, to, random.uniform() as f32)
            })
            .collect();
        let steps = |from: u32| {
            let out = links.iter().filter(move |link| link.0 == from);
            out.map(|&(_, to, cost)| (to, cost))
        };
        let mut all = [f32::INFINITY; 120];
        let mut dijkstra = Dijkstra::default();
        dijkstra.begin_at(&mut all, 0, 0.0);
        dijkstra.run(&mut all, steps, |_, _| {});
        let mut asked = [f32::INFINITY; 120];
        dijkstra.begin_at(&mut asked, 0, 0.0);
        for node in (0..120).map(|at| at * 77 % 120) {
            dijkstra.run_to(&mut asked, node, steps);
            assert_eq!(asked[node as usize], all[node as usize]);
        }
    }
}
