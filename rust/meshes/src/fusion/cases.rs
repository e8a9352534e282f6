//! Where a surface passes through a cube of eight voxels: the 256 cases of marching cubes (Lorensen and Cline 1987), found by rule.
//!
//! On each face of the cube the surface separates every run of corners inside from the others, so that two cubes agree on the face that they
//! share. The pieces of the faces close to loops, one for each sheet, and no triangle of a loop has a side across a face: each edge of the
//! mesh then has two triangles at most, and it is a manifold, which it is not with the table of 1987.

use std::sync::LazyLock;

/// Corners of a cube, a bit an axis.
pub(super) const CORNERS: usize = 8;
/// Edges of a cube: of each its lower corner and its axis.
pub(super) const EDGES: [(usize, usize); 12] = edges();

const fn edges() -> [(usize, usize); 12] {
    let mut edges = [(0, 0); 12];
    let mut count = 0;
    let mut axis = 0;
    while axis < 3 {
        let mut corner = 0;
        while corner < CORNERS {
            if corner >> axis & 1 == 0 {
                edges[count] = (corner, axis);
                count += 1;
            }
            corner += 1;
        }
        axis += 1;
    }
    edges
}

/// Of each case, by the corners that are inside, a bit each: the triangles, by the edges of the cube on which their corners lie. From outside
/// they go around against the clock.
pub(super) static CASES: LazyLock<Vec<Vec<[u8; 3]>>> =
    LazyLock::new(|| (0..1 << CORNERS).map(triangles).collect());

/// The edge between two corners.
fn edge(one: usize, other: usize) -> u8 {
    let low = one.min(other);
    let found = EDGES
        .iter()
        .position(|&(corner, axis)| corner == low && one ^ other == 1 << axis);
    found.unwrap_or(0) as u8
}

/// Corners around each face, against the clock from outside.
fn faces() -> impl Iterator<Item = [usize; 4]> {
    (0..3).flat_map(|axis| {
        let [u, v] = [1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3)];
        let high = 1 << axis;
        [[high, high | u, high | u | v, high | v], [0, v, u | v, u]]
    })
}

/// Whether two edges are on one face.
fn share_a_face(one: u8, other: u8) -> bool {
    faces().any(|face| {
        let around = (0..4).map(|at| edge(face[at], face[(at + 1) % 4]));
        around.filter(|&at| at == one || at == other).count() == 2
    })
}

fn triangles(inside: usize) -> Vec<[u8; 3]> {
    let is_inside = |corner: usize| inside >> corner & 1 != 0;
    let mut next = [None; EDGES.len()];
    for face in faces() {
        for at in 0..4 {
            // Of each run of corners inside from where it is left to where it was entered.
            if is_inside(face[at]) && !is_inside(face[(at + 1) % 4]) {
                let mut first = at;
                while is_inside(face[(first + 3) % 4]) {
                    first = (first + 3) % 4;
                }
                let (left, entered) = (
                    edge(face[at], face[(at + 1) % 4]),
                    edge(face[(first + 3) % 4], face[first]),
                );
                next[left as usize] = Some(entered);
            }
        }
    }
    let mut found = Vec::new();
    for first in 0..EDGES.len() {
        let mut sheet = Vec::new();
        let mut at = first;
        while let Some(beyond) = next[at].take() {
            sheet.push(at as u8);
            at = beyond as usize;
        }
        if sheet.len() >= 3 {
            found.extend(without_face_diagonals(&sheet).unwrap_or_default());
        }
    }
    found
}

/// Triangles of a loop whose inner sides all pass through the cube; none if there are no such.
fn without_face_diagonals(sheet: &[u8]) -> Option<Vec<[u8; 3]>> {
    let count = sheet.len();
    let (first, last) = (sheet[0], sheet[count - 1]);
    if count < 3 {
        return Some(Vec::new());
    }
    (1..count - 1).find_map(|apex| {
        let allowed = |end: u8, neighbours: bool| neighbours || !share_a_face(end, sheet[apex]);
        if !allowed(first, apex == 1) || !allowed(last, apex == count - 2) {
            return None;
        }
        let mut found = vec![[first, last, sheet[apex]]];
        found.extend(without_face_diagonals(&sheet[..=apex])?);
        found.extend(without_face_diagonals(&sheet[apex..])?);
        Some(found)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_has_triangles_at_each_edge_that_the_surface_crosses_and_its_border_is_on_the_faces()
     {
        for (inside, triangles) in CASES.iter().enumerate() {
            let crossed = EDGES.iter().enumerate().filter(|(_, (corner, axis))| {
                (inside >> corner & 1) != (inside >> (corner | 1 << axis) & 1)
            });
            let crossed: Vec<u8> = crossed.map(|(at, _)| at as u8).collect();
            let mut used: Vec<u8> = triangles.iter().flatten().copied().collect();
            used.sort_unstable();
            used.dedup();
            assert_eq!(used, crossed, "case {inside}");
            let sides = triangles
                .iter()
                .flat_map(|one| (0..3).map(|at| (one[at], one[(at + 1) % 3])));
            let sides: Vec<_> = sides.collect();
            for &(from, to) in &sides {
                let here = sides.iter().filter(|&&side| side == (from, to)).count();
                let back = sides.iter().filter(|&&side| side == (to, from)).count();
                assert_eq!(here, 1, "case {inside}");
                assert!(back <= 1);
                assert_eq!(back == 0, share_a_face(from, to), "case {inside}");
            }
        }
    }

    #[test]
    fn the_outer_side_is_the_one_without_the_corner() {
        let middle = |at: u8| {
            let (corner, axis) = EDGES[at as usize];
            [0, 1, 2].map(|one| (corner >> one & 1) as f64 + if one == axis { 0.5 } else { 0.0 })
        };
        let [a, b, c] = CASES[1][0].map(|at| nalgebra::Vector3::from(middle(at)));
        assert!((b - a).cross(&(c - a)).sum() > 0.0);
    }
}
