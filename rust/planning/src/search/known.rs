//! What a search knows of the cells: the cheapest way to each that was found.

/// No cell before this one.
pub(super) const NONE: u32 = u32::MAX;

/// What is known of a cell or node.
#[derive(Debug, Clone, Copy)]
struct Node {
    /// Of the cheapest way there that was found.
    cost: f64,
    /// By which cell it was reached.
    parent: u32,
    /// In which search.
    search: u32,
}

/// A cell that no search came upon.
const UNKNOWN: Node = Node {
    cost: f64::INFINITY,
    parent: NONE,
    search: 0,
};

/// What a search knows of the cells.
#[derive(Debug, Clone, Default)]
pub(crate) struct Known {
    /// Those of earlier searches count as unknown.
    nodes: Vec<Node>,
    search: u32,
}

impl Known {
    /// Forgets all but the start.
    pub(super) fn begin(&mut self, nodes: usize, start: usize) {
        if self.search == u32::MAX {
            self.nodes.fill(UNKNOWN);
            self.search = 0;
        }
        self.search += 1;
        if self.nodes.len() < nodes {
            self.nodes.resize(nodes, UNKNOWN);
        }
        self.reach(start, 0.0, NONE);
    }

    #[inline]
    pub(super) fn cost(&self, cell: usize) -> f64 {
        let node = &self.nodes[cell];
        // No branch of its own: it would be as hard to guess as the comparison that follows.
        let known = node.search == self.search;
        std::hint::select_unpredictable(known, node.cost, f64::INFINITY)
    }

    #[inline]
    pub(super) fn reach(&mut self, cell: usize, cost: f64, parent: u32) {
        self.nodes[cell] = Node {
            cost,
            parent,
            search: self.search,
        };
    }

    /// Keeps a way to a cell if it is cheaper than what was known, and says whether it is. Cells may be new.
    #[inline]
    pub(super) fn reach_cheaper(&mut self, cell: u32, cost: f64, parent: u32) -> bool {
        if self.nodes.len() <= cell as usize {
            self.grow_to(cell as usize + 1);
        }
        let cheaper = cost < self.cost(cell as usize);
        if cheaper {
            self.reach(cell as usize, cost, parent);
        }
        cheaper
    }

    #[cold]
    fn grow_to(&mut self, nodes: usize) {
        self.nodes.resize(nodes, UNKNOWN);
    }

    /// The cell before this one on the cheapest way that is known.
    pub(super) fn parent(&self, cell: usize) -> Option<u32> {
        let parent = self.nodes[cell].parent;
        (parent != NONE).then_some(parent)
    }

    pub(super) fn back_from(&self, end: usize) -> Vec<u32> {
        let mut cells = vec![end as u32];
        let mut parent = self.nodes[end].parent;
        while parent != NONE {
            cells.push(parent);
            parent = self.nodes[parent as usize].parent;
        }
        cells.reverse();
        cells
    }
}
