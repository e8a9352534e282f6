//! The diagram as a graph: places where its branches meet or end, and the ways between them.

use std::collections::{BTreeMap, HashSet, VecDeque};

use petgraph::graph::{EdgeIndex, NodeIndex, UnGraph};
use petgraph::visit::EdgeRef as _;

use super::ring::PIECES;
use super::skeleton::Skeleton;

/// A place that the graph knows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Spot {
    /// Its cells; the first is the farthest from everything.
    pub cells: Vec<usize>,
}

/// A way between two places: its cells in order between those where the places are farthest from everything.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Chain {
    pub cells: Vec<usize>,
}

/// Builds the graph of a diagram. Branches that end within so many times the clearance of the place that they hang on are left out, and
/// places that uneven walls split are one.
pub(super) fn graph_of(skeleton: &Skeleton, branch: f64) -> UnGraph<Spot, Chain> {
    let mut graph = UnGraph::default();
    let mut spot_of = vec![None; skeleton.kept.len()];
    for at in 0..skeleton.kept.len() {
        if skeleton.kept[at] && is_spot(skeleton, at) && spot_of[at].is_none() {
            let cells = flood(skeleton, at, |other| is_spot(skeleton, other));
            let _ = add_spot(&mut graph, skeleton, cells, &mut spot_of);
        }
    }
    let mut chained = vec![false; skeleton.kept.len()];
    for at in 0..skeleton.kept.len() {
        if skeleton.kept[at] && spot_of[at].is_none() && !chained[at] {
            let cells = flood(skeleton, at, |other| spot_of[other].is_none());
            for &cell in &cells {
                chained[cell] = true;
            }
            add_chain(&mut graph, skeleton, &cells, &mut spot_of);
        }
    }
    prune(&mut graph, skeleton, branch);
    join(&mut graph);
    unite(&mut graph, skeleton);
    graph
}

/// Whether branches meet or end at a cell: whether it has not just one before and one behind it.
fn is_spot(skeleton: &Skeleton, at: usize) -> bool {
    let around = skeleton.kept_around(at);
    around.count_ones() != 2 || PIECES[around as usize] != 2
}

/// Cells of the diagram that hang together with one.
fn flood(skeleton: &Skeleton, first: usize, belongs: impl Fn(usize) -> bool) -> Vec<usize> {
    let (mut cells, mut seen, mut at) = (vec![first], HashSet::from([first]), 0);
    while let Some(&cell) = cells.get(at) {
        for beside in skeleton.neighbours(cell) {
            if belongs(beside) && seen.insert(beside) {
                cells.push(beside);
            }
        }
        at += 1;
    }
    cells
}

fn add_spot(
    graph: &mut UnGraph<Spot, Chain>,
    skeleton: &Skeleton,
    mut cells: Vec<usize>,
    spot_of: &mut [Option<NodeIndex>],
) -> NodeIndex {
    cells.sort_unstable_by_key(|&at| (std::cmp::Reverse(skeleton.nearest.squared[at]), at));
    let node = graph.add_node(Spot { cells: Vec::new() });
    for &cell in &cells {
        spot_of[cell] = Some(node);
    }
    graph[node].cells = cells;
    node
}

/// Adds a chain between the places at its ends; of a ring without one the widest cell becomes a place.
fn add_chain(
    graph: &mut UnGraph<Spot, Chain>,
    skeleton: &Skeleton,
    cells: &[usize],
    spot_of: &mut [Option<NodeIndex>],
) {
    let own: HashSet<usize> = cells.iter().copied().collect();
    let beside = |&cell: &usize| skeleton.neighbours(cell).map(move |beside| (cell, beside));
    let ends: Vec<(usize, NodeIndex)> = cells
        .iter()
        .flat_map(beside)
        .filter_map(|(cell, beside)| Some((cell, spot_of[beside]?)))
        .collect();
    if let [(first, one), (last, other)] = ends[..] {
        let between = walk(skeleton, |at| own.contains(&at), first, last);
        let cells = reaching(skeleton, [&graph[one], &graph[other]], &between);
        let _ = graph.add_edge(one, other, Chain { cells });
        return;
    }
    let widest = cells
        .iter()
        .max_by_key(|&&at| (skeleton.nearest.squared[at], at));
    let Some(&widest) = widest else { return };
    let around: Vec<usize> = skeleton.neighbours(widest).collect();
    let node = add_spot(graph, skeleton, vec![widest], spot_of);
    if let [first, last] = around[..] {
        let left = |at| at != widest && own.contains(&at);
        let cells = walk(skeleton, left, first, last);
        let _ = graph.add_edge(node, node, Chain { cells });
    }
}

/// A chain and what leads from both of its ends to the middles of the places.
fn reaching(skeleton: &Skeleton, spots: [&Spot; 2], between: &[usize]) -> Vec<usize> {
    let inside = |spot: &Spot, end: Option<&usize>| {
        let door = spot
            .cells
            .iter()
            .find(|&&at| end.is_some_and(|&end| skeleton.neighbours(at).any(|b| b == end)));
        let middle = spot.cells[0];
        let mut way = walk(
            skeleton,
            |at| spot.cells.contains(&at),
            middle,
            *door.unwrap_or(&middle),
        );
        let _ = way.remove(0);
        way
    };
    let mut cells = inside(spots[0], between.first());
    cells.extend(between);
    cells.extend(inside(spots[1], between.last()).into_iter().rev());
    cells
}

/// The way of the fewest cells from one cell of a chain to another.
fn walk(
    skeleton: &Skeleton,
    belongs: impl Fn(usize) -> bool,
    first: usize,
    last: usize,
) -> Vec<usize> {
    let mut before = BTreeMap::from([(last, last)]);
    let mut queue = VecDeque::from([last]);
    while let Some(at) = queue.pop_front() {
        if at == first {
            break;
        }
        for beside in skeleton.neighbours(at) {
            if belongs(beside) && !before.contains_key(&beside) {
                let _ = before.insert(beside, at);
                queue.push_back(beside);
            }
        }
    }
    let mut way = vec![first];
    let mut at = first;
    while at != last
        && let Some(&next) = before.get(&at)
    {
        at = next;
        way.push(at);
    }
    way
}

/// Takes away ends within so many times the clearance of the place that they hang on.
fn prune(graph: &mut UnGraph<Spot, Chain>, skeleton: &Skeleton, branch: f64) {
    let within =
        |end: usize, hub: usize| apart(skeleton, end, hub) <= branch * radius(skeleton, hub) + 1.0;
    loop {
        let spur = graph.node_indices().find(|&node| {
            let mut ways = graph.edges(node);
            let (Some(way), None) = (ways.next(), ways.next()) else {
                return false;
            };
            let hub = if way.source() == node {
                way.target()
            } else {
                way.source()
            };
            hub != node
                && graph.edges(hub).count() > 2
                && within(graph[node].cells[0], graph[hub].cells[0])
        });
        let Some(spur) = spur else { return };
        let _ = graph.remove_node(spur);
    }
}

/// Makes one place of two where one lies in the circle around the other, and so does the way between them.
fn unite(graph: &mut UnGraph<Spot, Chain>, skeleton: &Skeleton) {
    loop {
        let short = graph.edge_indices().find_map(|edge| {
            let (one, other) = graph.edge_endpoints(edge)?;
            let middles = [graph[one].cells[0], graph[other].cells[0]];
            let radii = middles.map(|at| radius(skeleton, at));
            let meet = graph.edges(one).count() > 2 && graph.edges(other).count() > 2;
            let close = graph[edge].cells.len() as f64 + 1.0 <= radii[0].max(radii[1]);
            let wider_first = if radii[0] < radii[1] {
                (other, one)
            } else {
                (one, other)
            };
            (one != other && meet && close).then_some((edge, wider_first))
        });
        let Some((short, (hub, gone))) = short else {
            return;
        };
        let mut to_gone = oriented(graph, short, hub);
        to_gone.push(graph[gone].cells[0]);
        let moved: Vec<EdgeIndex> = graph
            .edges(gone)
            .map(|way| way.id())
            .filter(|&way| way != short)
            .collect();
        for way in moved {
            let mut cells = to_gone.clone();
            cells.extend(oriented(graph, way, gone));
            let (from, to) = graph.edge_endpoints(way).unwrap_or((gone, gone));
            let mut beyond = if from == gone { to } else { from };
            if beyond == gone {
                cells.extend(to_gone.iter().rev());
                beyond = hub;
            }
            let _ = graph.add_edge(hub, beyond, Chain { cells });
        }
        let _ = graph.remove_node(gone);
    }
}

/// Clearance of a cell, in cells.
fn radius(skeleton: &Skeleton, at: usize) -> f64 {
    f64::from(skeleton.nearest.squared[at]).sqrt()
}

/// Distance of two cells, in cells.
fn apart(skeleton: &Skeleton, one: usize, other: usize) -> f64 {
    let across = (one % skeleton.cols).abs_diff(other % skeleton.cols);
    let along = (one / skeleton.cols).abs_diff(other / skeleton.cols);
    libm::hypot(across as f64, along as f64)
}

/// Makes one way of two that meet at a place where no third begins.
fn join(graph: &mut UnGraph<Spot, Chain>) {
    loop {
        let through = graph.node_indices().find_map(|node| {
            let ways: Vec<_> = graph.edges(node).collect();
            let [one, other] = &ways[..] else { return None };
            let ring = [one, other].iter().any(|way| way.source() == way.target());
            (!ring).then(|| (node, one.id(), other.id()))
        });
        let Some((node, one, other)) = through else {
            return;
        };
        let far = |way| {
            let ends = graph.edge_endpoints(way).unwrap_or((node, node));
            if ends.0 == node { ends.1 } else { ends.0 }
        };
        let (from, to) = (far(one), far(other));
        let mut cells = oriented(graph, one, from);
        cells.push(graph[node].cells[0]);
        cells.extend(oriented(graph, other, node));
        let _ = graph.add_edge(from, to, Chain { cells });
        let _ = graph.remove_node(node);
    }
}

/// Cells of a way, from one of its ends on.
fn oriented(graph: &UnGraph<Spot, Chain>, way: EdgeIndex, from: NodeIndex) -> Vec<usize> {
    let mut cells = graph[way].cells.clone();
    if graph.edge_endpoints(way).is_some_and(|ends| ends.0 != from) {
        cells.reverse();
    }
    cells
}
