//! The graph of places, and the cheapest way over it.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use super::local_maps::LocalMaps;
use crate::search::links::{Links, SearchLink};
use crate::search::neighbours::Cells;
use crate::search::steps::ANYWHERE;

/// Where ways begin, end, and lead from one cell to another that is none of its neighbours.
pub(super) struct WayAsked<'a> {
    pub(super) links: Option<&'a Links>,
    pub(super) start: usize,
    pub(super) ends: &'a [(u32, f64)],
}

/// A place within a local map that is no gate: the start, or where a link begins or ends.
#[derive(Debug, Clone)]
struct InnerPlace {
    cell: u32,
    map: usize,
    /// Whether a step may lead there.
    entered: bool,
    /// What it costs to each gate of the local map, in order.
    to_gates: Vec<f32>,
    /// To other places of the same local map, by their number.
    to_places: Vec<(usize, f32)>,
    /// Over links to other places, likewise.
    over_links: Vec<(usize, f64)>,
    /// To an end in the same local map, or over a link.
    to_end: f64,
}

impl InnerPlace {
    /// An end lies over a link, at this cost.
    fn end_at(&mut self, cost: f64) {
        self.to_end = self.to_end.min(cost);
    }
}

/// What is known of a node of the graph.
#[derive(Debug, Clone, Copy)]
struct BestCost {
    cost: f64,
    before: usize,
}

const NEVER_REACHED: BestCost = BestCost {
    cost: f64::INFINITY,
    before: usize::MAX,
};

/// Places of one question, and arrays of a search over the graph: its nodes are the gates, then the places, then the end.
#[derive(Debug, Clone, Default)]
pub(super) struct PlaceGraph {
    places: Vec<InnerPlace>,
    /// Numbers of the places in a local map.
    within: BTreeMap<usize, Vec<usize>>,
    /// In a local map with ends, those, with what ending there costs.
    ends: BTreeMap<usize, Vec<(u32, f32)>>,
    /// In a local map with ends, what it costs to end from each of its gates, in order.
    gates_to_end: BTreeMap<usize, Vec<f32>>,
    known: Vec<BestCost>,
    /// Estimates of the whole way as bits, with the node and what it cost to come there.
    queue: BinaryHeap<Reverse<(u64, usize, u64)>>,
}

impl PlaceGraph {
    /// Finds the places of a question, and what lies between them and the gates around.
    pub(super) fn read(
        &mut self,
        maps: &mut LocalMaps,
        question: &WayAsked<'_>,
        (open, ending): (impl Fn(usize) -> bool, impl Fn(usize) -> Option<f64>),
    ) {
        let links = question.links.map_or(&[][..], Links::all).iter();
        let links = links.enumerate().filter(|&(index, _)| open(index));
        let links: Vec<SearchLink> = links.map(|(_, link)| *link).collect();
        let cells = self.cells_of(maps, question.start, &links);
        self.read_ends(maps, question.ends);
        self.places.clear();
        for (at, &cell) in cells.iter().enumerate() {
            let place = self.place(maps, (at, cell), &cells);
            self.places.push(place);
        }
        let number = |cell: u32| cells.iter().position(|&other| other == cell);
        for link in links {
            let Some(from) = number(link.from) else {
                continue;
            };
            if let Some(to) = number(link.to) {
                self.places[from].over_links.push((to, link.cost));
            } else if let Some(end) = ending(link.to as usize) {
                self.places[from].end_at(link.cost + end);
            }
        }
        for (from, to, cost) in over_borders(maps, &cells) {
            if let (Some(from), Some(to)) = (number(from), number(to)) {
                self.places[from].over_links.push((to, cost));
            }
        }
    }

    /// The cells of all places, the start first, and which of them lie in which local map.
    fn cells_of(&mut self, maps: &LocalMaps, start: usize, links: &[SearchLink]) -> Vec<u32> {
        let mut cells: Vec<u32> = links.iter().flat_map(|link| [link.from, link.to]).collect();
        cells.retain(|&cell| (cell as usize) < maps.weights.len());
        cells.push(start as u32);
        cells.extend(over_borders(maps, &cells).iter().map(|step| step.1));
        cells.sort_unstable();
        cells.dedup();
        cells.retain(|&cell| cell as usize != start);
        cells.insert(0, start as u32);
        self.within.clear();
        for (at, &cell) in cells.iter().enumerate() {
            let map = maps.map_of(cell as usize);
            self.within.entry(map).or_default().push(at);
        }
        cells
    }

    /// A place, and what lies around it in its local map.
    fn place(&self, maps: &mut LocalMaps, (at, cell): (usize, u32), cells: &[u32]) -> InnerPlace {
        let map = maps.map_of(cell as usize);
        maps.spread(map, &[(cell, 0.0)]);
        let gates = maps.gates_of(map).map(|gate| maps.gates[gate].cell);
        let others = self.within[&map].iter().filter(|&&other| other != at);
        let others = others.map(|&other| (other, maps.cost_at(cells[other] as usize)));
        let ends = self.ends.get(&map).into_iter().flatten();
        let ends = ends.map(|&(end, cost)| f64::from(maps.cost_at(end as usize)) + f64::from(cost));
        InnerPlace {
            cell,
            map,
            entered: maps.weights[cell as usize].is_finite(),
            to_gates: gates.map(|gate| maps.cost_at(gate as usize)).collect(),
            to_places: others.collect(),
            over_links: Vec::new(),
            to_end: ends.fold(f64::INFINITY, f64::min),
        }
    }

    fn read_ends(&mut self, maps: &mut LocalMaps, ends: &[(u32, f64)]) {
        self.ends.clear();
        for &(cell, cost) in ends {
            let map = maps.map_of(cell as usize);
            self.ends.entry(map).or_default().push((cell, cost as f32));
        }
        self.gates_to_end.clear();
        for (&map, ends) in &self.ends {
            let mut entered = ends.clone();
            entered.retain(|&(cell, _)| maps.weights[cell as usize].is_finite());
            maps.spread(map, &entered);
            let gates = maps.gates_of(map).map(|gate| maps.gates[gate].cell);
            let costs = gates.map(|cell| maps.cost_at(cell as usize)).collect();
            let _ = self.gates_to_end.insert(map, costs);
        }
    }

    /// The local maps through which the cheapest way over the graph leads.
    pub(super) fn way(
        &mut self,
        maps: &mut LocalMaps,
        heuristic: impl Fn(usize) -> f64,
    ) -> Option<Vec<usize>> {
        let gates = maps.gates.len();
        let end = gates + self.places.len();
        self.known.clear();
        self.known.resize(end + 1, NEVER_REACHED);
        self.queue.clear();
        let cell_of =
            |maps: &LocalMaps, places: &[InnerPlace], node: usize| match node.checked_sub(gates) {
                None => maps.gates[node].cell as usize,
                Some(place) => places[place].cell as usize,
            };
        self.known[gates] = BestCost {
            cost: 0.0,
            ..NEVER_REACHED
        };
        self.queue.push(Reverse((0, gates, 0)));
        let mut reached = Vec::new();
        while let Some(Reverse((_, node, cost_bits))) = self.queue.pop() {
            let cost = f64::from_bits(cost_bits);
            if cost > self.known[node].cost {
                continue;
            }
            if node == end {
                return Some(self.maps_to(maps, end));
            }
            reached.clear();
            self.steps_from(maps, node, &mut reached);
            for &(to, step) in &reached {
                let through = cost + step;
                if through < self.known[to].cost {
                    self.known[to] = BestCost {
                        cost: through,
                        before: node,
                    };
                    let left = if to == end {
                        0.0
                    } else {
                        heuristic(cell_of(maps, &self.places, to))
                    };
                    self.queue
                        .push(Reverse(((through + left).to_bits(), to, through.to_bits())));
                }
            }
        }
        None
    }

    /// Where steps lead from a node, with what each costs.
    fn steps_from(&self, maps: &mut LocalMaps, node: usize, steps: &mut Vec<(usize, f64)>) {
        let gates = maps.gates.len();
        let end = gates + self.places.len();
        if let Some(number) = node.checked_sub(gates) {
            let place = &self.places[number];
            let (to_gates, to_places) = (place.to_gates.iter(), place.to_places.iter());
            steps.extend(
                maps.gates_of(place.map)
                    .zip(to_gates.map(|&cost| f64::from(cost))),
            );
            steps.extend(to_places.map(|&(to, cost)| (gates + to, f64::from(cost))));
            steps.extend(
                place
                    .over_links
                    .iter()
                    .map(|&(to, cost)| (gates + to, cost)),
            );
            steps.push((end, place.to_end));
        } else {
            let gate = maps.gates[node];
            let map = gate.map as usize;
            let own = maps.gates_of(map);
            let at = node - own.start;
            let between = maps.between_gates(node).iter().map(|&cost| f64::from(cost));
            steps.extend(own.zip(between));
            steps.push((gate.beyond as usize, f64::from(gate.cost)));
            let within = self.within.get(&map).into_iter().flatten();
            let entered = within.filter(|&&place| self.places[place].entered);
            steps.extend(entered.map(|&to| (gates + to, f64::from(self.places[to].to_gates[at]))));
            steps.extend(
                self.gates_to_end
                    .get(&map)
                    .map(|costs| (end, f64::from(costs[at]))),
            );
        }
    }

    /// The local maps of the nodes on the way to one.
    fn maps_to(&self, maps: &LocalMaps, end: usize) -> Vec<usize> {
        let gates = maps.gates.len();
        let mut found = Vec::new();
        let mut node = self.known[end].before;
        while node != usize::MAX {
            found.push(match node.checked_sub(gates) {
                None => maps.gates[node].map as usize,
                Some(place) => self.places[place].map,
            });
            node = self.known[node].before;
        }
        found.sort_unstable();
        found.dedup();
        found
    }
}

/// Steps out of cells that may not be entered, as the one where the robot stands, into another local map: such a cell is no gate. Where a
/// diagonal step is free, so are two straight ones.
fn over_borders(maps: &LocalMaps, places: &[u32]) -> Vec<(u32, u32, f64)> {
    let grid = Cells::new(&maps.weights, maps.cols);
    let mut found = Vec::new();
    for &cell in places {
        let from = cell as usize;
        if maps.weights[from].is_finite() {
            continue;
        }
        grid.for_each_neighbour((from, ANYWHERE), |to, half_length, _| {
            let straight = to.abs_diff(from) == 1 || to.abs_diff(from) == maps.cols;
            if straight && maps.map_of(to) != maps.map_of(from) {
                let weight = grid.weight_to_leave(from) + maps.weights[to];
                found.push((cell, to as u32, half_length * f64::from(weight)));
            }
        });
    }
    found
}
