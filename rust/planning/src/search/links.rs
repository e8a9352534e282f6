//! Ways of a search that do not go from a cell to its neighbour.

/// No further link.
const NONE: u32 = u32::MAX;

/// Links between the nodes of a search: cells, and beyond their indices nodes that are no cells. Reused.
#[derive(Debug, Clone, Default)]
pub struct Links {
    /// First link of a cell.
    first: Vec<u32>,
    all: Vec<SearchLink>,
    nodes: usize,
}

/// A way from one node to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchLink {
    /// Where it begins: a cell.
    pub from: u32,
    /// Where it ends.
    pub to: u32,
    /// Its cost in cells.
    pub cost: f64,
    /// Next link from the same cell.
    next: u32,
}

impl Links {
    /// Forgets all links; there are `cells` cells.
    pub fn clear(&mut self, cells: usize) {
        self.all.clear();
        self.nodes = cells;
        self.first.clear();
        self.first.resize(cells, NONE);
    }

    /// Adds a link from a cell and says its index.
    pub fn add(&mut self, from: usize, to: usize, cost: f64) -> usize {
        self.nodes = self.nodes.max(to + 1);
        let next = std::mem::replace(&mut self.first[from], self.all.len() as u32);
        self.all.push(SearchLink {
            from: from as u32,
            to: to as u32,
            cost,
            next,
        });
        self.all.len() - 1
    }

    /// Whether there is none.
    pub const fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Number of nodes: the cells, and those beyond them.
    pub const fn nodes(&self) -> usize {
        self.nodes
    }

    /// All links, in the order in which they were added.
    pub fn all(&self) -> &[SearchLink] {
        &self.all
    }

    /// The links from a node with their indices.
    pub fn from(&self, node: usize) -> impl Iterator<Item = (usize, &SearchLink)> {
        let mut at = self.first.get(node).copied().unwrap_or(NONE);
        std::iter::from_fn(move || {
            let index = at as usize;
            let link = self.all.get(index)?;
            at = link.next;
            Some((index, link))
        })
    }
}
