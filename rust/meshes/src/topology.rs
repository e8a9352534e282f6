//! How triangles hang together: whether a mesh is a manifold, as its edges and corners say.

use crate::TriangleMesh;

/// What edges and corners of a mesh say of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Topology {
    /// Edges of a single triangle.
    pub border_edges: usize,
    /// Edges of two triangles that go around alike.
    pub inner_edges: usize,
    /// Edges of more than two triangles, or of two of which one is turned over.
    pub wrong_edges: usize,
    /// Corners at which sheets touch that have no edge in common there.
    pub pinched_corners: usize,
}

impl Topology {
    /// That of a mesh.
    pub fn of(mesh: &TriangleMesh) -> Self {
        let mut found = Self::default();
        for edge in edges(mesh).chunk_by(|one, other| one.corners == other.corners) {
            match edge {
                [_] => found.border_edges += 1,
                [one, other] if one.forward != other.forward => found.inner_edges += 1,
                _ => found.wrong_edges += 1,
            }
        }
        found.pinched_corners = Fans::of(mesh).further(mesh).count();
        found
    }

    /// Whether the mesh is a manifold with borders, all of whose triangles go around alike.
    pub const fn is_manifold(&self) -> bool {
        self.wrong_edges == 0 && self.pinched_corners == 0
    }
}

/// The triangles at edges that are wrong, as [`Topology::wrong_edges`] counts them, and at pinched corners; by number, some more than once.
pub(crate) fn wrong_triangles(mesh: &TriangleMesh) -> Vec<usize> {
    let mut wrong = Vec::new();
    for edge in edges(mesh).chunk_by(|one, other| one.corners == other.corners) {
        let right = edge.len() == 1 || edge.len() == 2 && edge[0].forward != edge[1].forward;
        if !right {
            wrong.extend(edge.iter().map(|one| one.slots[0] / 3));
        }
    }
    let pinched: Vec<_> = Fans::of(mesh)
        .further(mesh)
        .map(|(slot, _)| slot / 3)
        .collect();
    wrong.extend(pinched);
    wrong
}

/// Gives each sheet a corner of its own where several touch at one: the mesh looks the same. Returns for each corner which one it was.
pub(crate) fn unpinch(mesh: &mut TriangleMesh) -> Vec<u32> {
    let mut was: Vec<u32> = (0..mesh.corners_m.len() as u32).collect();
    let fans = Fans::of(mesh);
    let mut fresh: Vec<(usize, u32)> = Vec::new();
    for (root, corner) in fans.further(mesh) {
        fresh.push((root, was.len() as u32));
        was.push(corner);
    }
    let places = was[mesh.corners_m.len()..].iter();
    let more: Vec<_> = places.map(|&at| mesh.corners_m[at as usize]).collect();
    mesh.corners_m.extend(more);
    fresh.sort_unstable();
    for (slot, corner) in mesh.triangles.as_flattened_mut().iter_mut().enumerate() {
        let root = fans.root(slot);
        if let Ok(at) = fresh.binary_search_by_key(&root, |one| one.0) {
            *corner = fresh[at].1;
        }
    }
    was
}

/// For each triangle the number of the part of the mesh that it is in: triangles that have a corner in common are in one.
pub fn parts(mesh: &TriangleMesh) -> Vec<u32> {
    let mut joined = DisjointSets::new(mesh.corners_m.len());
    for &[a, b, c] in &mesh.triangles {
        joined.join(a as usize, b as usize);
        joined.join(a as usize, c as usize);
    }
    let first = mesh.triangles.iter();
    first
        .map(|triangle| joined.root(triangle[0] as usize) as u32)
        .collect()
}

/// An edge of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct HalfEdge {
    /// The lower number first.
    corners: [u32; 2],
    /// Whether the triangle goes along it from the lower number to the higher one.
    forward: bool,
    /// Of the two corners their places among those of all triangles.
    slots: [usize; 2],
}

/// All edges of all triangles, those of the same corners side by side.
fn edges(mesh: &TriangleMesh) -> Vec<HalfEdge> {
    let mut edges = Vec::with_capacity(3 * mesh.triangles.len());
    for (at, triangle) in mesh.triangles.iter().enumerate() {
        for side in 0..3 {
            let next = (side + 1) % 3;
            let (from, to) = (triangle[side], triangle[next]);
            let slots = [3 * at + side, 3 * at + next];
            let forward = from < to;
            edges.push(HalfEdge {
                corners: if forward { [from, to] } else { [to, from] },
                forward,
                slots: if forward { slots } else { [slots[1], slots[0]] },
            });
        }
    }
    edges.sort_unstable();
    edges
}

/// Which triangles around a corner hang together by edges at it.
struct Fans(DisjointSets);

impl Fans {
    fn of(mesh: &TriangleMesh) -> Self {
        let mut joined = DisjointSets::new(3 * mesh.triangles.len());
        for edge in edges(mesh).chunk_by(|one, other| one.corners == other.corners) {
            for two in edge.windows(2) {
                for end in 0..2 {
                    joined.join(two[0].slots[end], two[1].slots[end]);
                }
            }
        }
        Self(joined)
    }

    /// The fan of a triangle's corner, given by its place among those of all triangles.
    fn root(&self, slot: usize) -> usize {
        self.0.root(slot)
    }

    /// The fans that touch an earlier one at their corner, and that corner.
    fn further<'a>(&'a self, mesh: &'a TriangleMesh) -> impl Iterator<Item = (usize, u32)> + 'a {
        let mut seen = vec![false; mesh.corners_m.len()];
        let corners = mesh.triangles.as_flattened().iter().enumerate();
        let roots = corners.filter(|&(slot, _)| self.root(slot) == slot);
        roots.filter_map(move |(slot, &corner)| {
            let again = std::mem::replace(&mut seen[corner as usize], true);
            again.then_some((slot, corner))
        })
    }
}

/// Sets of numbers, each with its lowest for a name.
struct DisjointSets(Vec<u32>);

impl DisjointSets {
    fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    fn root(&self, mut at: usize) -> usize {
        while self.0[at] as usize != at {
            at = self.0[at] as usize;
        }
        at
    }

    fn join(&mut self, one: usize, other: usize) {
        let (one, other) = (self.root(one), self.root(other));
        let low = one.min(other) as u32;
        self.0[one] = low;
        self.0[other] = low;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(corners: usize, triangles: &[[u32; 3]]) -> TriangleMesh {
        TriangleMesh {
            corners_m: vec![[0.0; 3]; corners],
            triangles: triangles.to_vec(),
        }
    }

    #[test]
    fn a_closed_tetrahedron_is_a_manifold_without_a_border() {
        let closed = Topology::of(&mesh(4, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]));
        assert!(closed.is_manifold());
        assert_eq!((closed.border_edges, closed.inner_edges), (0, 6));
    }

    #[test]
    fn a_fin_a_turned_triangle_and_a_touching_corner_are_none() {
        let fin = mesh(5, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]);
        assert_eq!(Topology::of(&fin).wrong_edges, 1);
        let turned = mesh(4, &[[0, 1, 2], [0, 1, 3]]);
        assert_eq!(Topology::of(&turned).wrong_edges, 1);
        let mut touching = mesh(5, &[[0, 1, 2], [0, 3, 4]]);
        assert_eq!(Topology::of(&touching).pinched_corners, 1);
        assert_eq!(parts(&touching), [0, 0]);
        assert_eq!(unpinch(&mut touching), [0, 1, 2, 3, 4, 0]);
        assert!(Topology::of(&touching).is_manifold());
        assert_eq!(touching.corners_m.len(), 6);
        assert_eq!(parts(&touching), [0, 3]);
    }
}
