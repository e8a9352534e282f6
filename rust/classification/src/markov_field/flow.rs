//! The least cut between a source and a sink: Dinic 1970, breadth first and then along the levels.

/// What less of is no capacity.
const NOTHING: f64 = 1e-12;

#[derive(Debug, Clone, Copy)]
struct Pipe {
    to: usize,
    left: f64,
}

/// A network of capacities; nodes are numbered from 0 on, then come the source and the sink.
#[derive(Debug)]
pub(super) struct Network {
    arcs: Vec<Pipe>,
    from: Vec<Vec<usize>>,
    levels: Vec<usize>,
    next: Vec<usize>,
}

impl Network {
    /// Without arcs.
    pub(super) fn new(nodes: usize) -> Self {
        Self {
            arcs: Vec::new(),
            from: vec![Vec::new(); nodes + 2],
            levels: Vec::new(),
            next: Vec::new(),
        }
    }

    const fn source(&self) -> usize {
        self.from.len() - 2
    }

    const fn sink(&self) -> usize {
        self.from.len() - 1
    }

    /// A node that costs this on the sink's side, or on the source's side where it is negative, the other sign.
    pub(super) fn prefer_source(&mut self, node: usize, cost: f64) {
        let (source, sink) = (self.source(), self.sink());
        if cost > 0.0 {
            self.join(source, node, cost, 0.0);
        } else if cost < 0.0 {
            self.join(node, sink, -cost, 0.0);
        }
    }

    /// An arc, and one back.
    pub(super) fn join(&mut self, a: usize, b: usize, there: f64, back: f64) {
        self.from[a].push(self.arcs.len());
        self.arcs.push(Pipe { to: b, left: there });
        self.from[b].push(self.arcs.len());
        self.arcs.push(Pipe { to: a, left: back });
    }

    /// Cuts at the least cost: whether each node stays on the sink's side.
    pub(super) fn cut(mut self) -> Vec<bool> {
        while self.level() {
            self.next = vec![0; self.from.len()];
            while self.push() {}
        }
        let nodes = self.from.len() - 2;
        (0..nodes)
            .map(|node| self.levels[node] == usize::MAX)
            .collect()
    }

    /// Numbers the nodes by how far they are from the source; whether the sink can be reached.
    fn level(&mut self) -> bool {
        self.levels = vec![usize::MAX; self.from.len()];
        let mut queue = vec![self.source()];
        self.levels[queue[0]] = 0;
        let mut at = 0;
        while at < queue.len() {
            let node = queue[at];
            at += 1;
            for &arc in &self.from[node] {
                let Pipe { to, left } = self.arcs[arc];
                if left > NOTHING && self.levels[to] == usize::MAX {
                    self.levels[to] = self.levels[node] + 1;
                    queue.push(to);
                }
            }
        }
        self.levels[self.sink()] != usize::MAX
    }

    /// Sends what one way takes, level by level; whether there was one.
    fn push(&mut self) -> bool {
        let (source, sink) = (self.source(), self.sink());
        let mut way: Vec<usize> = Vec::new();
        let mut node = source;
        while node != sink {
            let arcs = &self.from[node];
            let found = arcs[self.next[node]..].iter().position(|&arc| {
                let Pipe { to, left } = self.arcs[arc];
                left > NOTHING && self.levels[to] == self.levels[node].wrapping_add(1)
            });
            if let Some(skipped) = found {
                self.next[node] += skipped;
                let arc = arcs[self.next[node]];
                way.push(arc);
                node = self.arcs[arc].to;
            } else if let Some(arc) = way.pop() {
                node = self.arcs[arc ^ 1].to; // back, and not this way again
                self.next[node] += 1;
            } else {
                return false;
            }
        }
        let least = way.iter().map(|&arc| self.arcs[arc].left);
        let least = least.fold(f64::INFINITY, f64::min);
        for arc in way {
            self.arcs[arc].left -= least;
            self.arcs[arc ^ 1].left += least;
        }
        true
    }
}
