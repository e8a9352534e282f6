//! The triangles of the surface, gathered by the columns in which they are: what one can stand on, and how high.

use meshes::SurfacePiece;
use nalgebra::Vector3;

use crate::columns::Span;

/// What there is of a triangle in a column of cells.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ColumnPiece {
    column: [i32; 2],
    /// Height of its middle, m.
    height_m: f32,
    /// Its lowest and its highest corner, m.
    ends_m: [f32; 2],
    /// As large as it looks from above, m²; 0 where nobody can stand on it.
    ground_m2: f32,
    frames: u16,
    /// Standard deviation of where it is, m.
    sigma_m: f32,
}

/// Pieces of the surface by columns. Reused from frame to frame.
#[derive(Debug, Clone, Default)]
pub(super) struct Pieces(Vec<ColumnPiece>);

/// When triangles are ground, and when they are one thing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PieceRule {
    /// Side of a column, m.
    pub(super) cell_m: f64,
    /// The upward part of a triangle's direction with which it is ground.
    pub(super) upright: f64,
    /// What lies less than this apart in a column is one thing, m.
    pub(super) apart_m: f32,
    /// Surfaces that fewer frames saw do not count.
    pub(super) least_frames: u16,
}

impl Pieces {
    /// Begins anew.
    pub(super) fn begin(&mut self) {
        self.0.clear();
    }

    /// Puts a triangle into the column of its middle: it is no larger than a voxel.
    pub(super) fn add(&mut self, piece: &SurfacePiece, rule: &PieceRule) {
        if piece.frames < rule.least_frames {
            return;
        }
        let [a, b, c] = piece.corners_m.map(|at| Vector3::from(at.map(f64::from)));
        let middle = (a + b + c) / piece.corners_m.len() as f64;
        let across = (b - a).cross(&(c - a));
        let is_ground = across.z >= rule.upright * across.norm();
        let heights_m = piece.corners_m.map(|at| at[2]);
        self.0.push(ColumnPiece {
            column: [middle.x, middle.y].map(|at| libm::floor(at / rule.cell_m) as i32),
            height_m: middle.z as f32,
            ends_m: [
                heights_m.iter().copied().fold(f32::INFINITY, f32::min),
                heights_m.iter().copied().fold(f32::NEG_INFINITY, f32::max),
            ],
            ground_m2: if is_ground {
                (0.5 * across.z) as f32
            } else {
                0.0
            },
            frames: piece.frames,
            sigma_m: piece.sigma_m,
        });
    }

    /// Tells of each thing in each column: as high as the mean of its ground, where it has such, and else as its highest corner.
    pub(super) fn spans(&mut self, rule: &PieceRule, take: &mut dyn FnMut([i32; 2], Span)) {
        self.0.sort_by(|one, other| {
            (one.column.cmp(&other.column))
                .then(one.ends_m[0].total_cmp(&other.ends_m[0]))
                .then(one.height_m.total_cmp(&other.height_m))
        });
        for column in self.0.chunk_by(|one, other| one.column == other.column) {
            let mut rest = column;
            while let Some(first) = rest.first() {
                let mut high_m = first.ends_m[1];
                let count = rest.iter().take_while(|one| {
                    let joins = one.ends_m[0] - high_m < rule.apart_m;
                    high_m = if joins {
                        high_m.max(one.ends_m[1])
                    } else {
                        high_m
                    };
                    joins
                });
                let count = count.count();
                let (thing, beyond) = rest.split_at(count);
                take(first.column, span_of(thing, high_m, rule.apart_m));
                rest = beyond;
            }
        }
    }
}

/// What a thing is whose highest corner is at a height, m.
fn span_of(thing: &[ColumnPiece], high_m: f32, apart_m: f32) -> Span {
    let low_m = thing[0].ends_m[0];
    // Its top is ground where there is such near its highest corner.
    let top = thing.iter().filter(|one| one.ends_m[1] > high_m - apart_m);
    let (sum, area) = top.clone().fold((0.0, 0.0), |(sum, area), one| {
        (sum + one.ground_m2 * one.height_m, area + one.ground_m2)
    });
    Span {
        low_m,
        high_m: if area > 0.0 { sum / area } else { high_m },
        frames: top.clone().map(|one| one.frames).max().unwrap_or(0),
        sigma_m: top.map(|one| one.sigma_m).fold(0.0, f32::max),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RULE: PieceRule = PieceRule {
        cell_m: 0.1,
        upright: 0.7,
        apart_m: 0.05,
        least_frames: 1,
    };

    /// What a column has of level squares at these heights, m, the upper sides of things.
    fn spans(heights_m: &[f32]) -> Vec<Span> {
        let mut pieces = Pieces::default();
        for &z in heights_m {
            let corners_m = [[0.02, 0.02, z], [0.06, 0.02, z], [0.02, 0.06, z]];
            pieces.add(
                &SurfacePiece {
                    corners_m,
                    frames: 3,
                    sigma_m: 0.004,
                },
                &RULE,
            );
        }
        let mut found = Vec::new();
        pieces.spans(&RULE, &mut |column, span| {
            assert_eq!(column, [0, 0]);
            found.push(span);
        });
        found
    }

    #[test]
    fn surfaces_above_each_other_are_things_of_their_own_in_any_order() {
        for heights in [[0.0, 0.7, 0.01], [0.7, 0.01, 0.0]] {
            let found = spans(&heights);
            assert_eq!(found.len(), 2);
            assert!((found[0].high_m - 0.005).abs() < 1e-6 && found[0].low_m == 0.0);
            assert_eq!(
                (found[1].low_m, found[1].high_m, found[1].frames),
                (0.7, 0.7, 3)
            );
        }
    }

    #[test]
    fn an_underside_is_no_ground() {
        let mut pieces = Pieces::default();
        let corners_m = [[0.02, 0.02, 0.5], [0.02, 0.06, 0.5], [0.06, 0.02, 0.5]];
        pieces.add(
            &SurfacePiece {
                corners_m,
                frames: 1,
                sigma_m: 0.004,
            },
            &RULE,
        );
        assert_eq!(pieces.0[0].ground_m2, 0.0);
    }
}
