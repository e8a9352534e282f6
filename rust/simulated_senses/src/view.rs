//! What lies in the picture: whole bodies by the spheres around them, pixels by the boxes around them.

use std::ops::Range;

use crate::eye::{LocalEye, Triple, dot};
use crate::pinhole::Pinhole;

/// What misses the picture by less is looked for all the same: of a body's distance, and pixels.
const MARGIN: f64 = 1e-6;
/// What is nearer to the lens' plane is cut off before it is projected, m.
const NEAR_M: f64 = 1e-9;

/// Pixels of a rectangle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct PixelArea {
    pub(crate) rows: Range<usize>,
    pub(crate) columns: Range<usize>,
}

/// A box in a body's frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Around {
    pub(crate) centre: Triple,
    pub(crate) half: Triple,
}

impl Around {
    /// Radius of the sphere around it, m.
    pub(crate) fn radius_m(&self) -> f64 {
        dot(self.half, self.half).sqrt()
    }
}

/// The planes through the outermost rays, and how points come into pixels.
#[derive(Debug, Clone)]
pub(crate) struct ViewBorders {
    /// Unit normals inwards, in the optical frame.
    borders: [Triple; 4],
    pinhole: Pinhole,
}

impl ViewBorders {
    pub(crate) fn new(pinhole: Pinhole) -> Self {
        let across = pinhole.middle_column() / pinhole.focal_px;
        let down = pinhole.middle_row() / pinhole.focal_px;
        let unit = |normal: Triple| {
            let length = dot(normal, normal).sqrt();
            normal.map(|part| part / length)
        };
        Self {
            borders: [
                unit([1.0, 0.0, across]),
                unit([-1.0, 0.0, across]),
                unit([0.0, 1.0, down]),
                unit([0.0, -1.0, down]),
            ],
            pinhole,
        }
    }

    /// Whether a ray can meet a sphere, whose centre is in the optical frame.
    pub(crate) fn reaches(&self, centre: Triple, radius_m: f64) -> bool {
        let least = -radius_m * (1.0 + MARGIN) - MARGIN;
        centre[2] >= least
            && self
                .borders
                .iter()
                .all(|border| dot(*border, centre) >= least)
    }

    /// The whole picture.
    pub(crate) const fn everything(&self) -> PixelArea {
        PixelArea {
            rows: 0..self.pinhole.height,
            columns: 0..self.pinhole.width,
        }
    }

    /// The pixels in which a box can appear.
    pub(crate) fn project(&self, around: &Around, eye: &LocalEye) -> Option<PixelArea> {
        let middle = eye.look(around.centre);
        let sides = [0, 1, 2].map(|axis| {
            let half = around.half[axis];
            [
                half * eye.across[axis],
                half * eye.down[axis],
                half * eye.ahead[axis],
            ]
        });
        let corners: [Triple; 8] = std::array::from_fn(|corner| {
            let signs = [1, 2, 4].map(|bit| if corner & bit == 0 { -1.0 } else { 1.0 });
            [0, 1, 2].map(|i| {
                middle[i] + signs[0] * sides[0][i] + signs[1] * sides[1][i] + signs[2] * sides[2][i]
            })
        });
        let mut bounds = Extent::new();
        for (index, corner) in corners.iter().enumerate() {
            if corner[2] >= NEAR_M {
                bounds.add(corner[0] / corner[2], corner[1] / corner[2]);
            }
            for bit in [1, 2, 4] {
                let other = &corners[index | bit];
                if (corner[2] < NEAR_M) != (other[2] < NEAR_M) {
                    let share = (NEAR_M - corner[2]) / (other[2] - corner[2]);
                    let cut = [0, 1].map(|i| corner[i] + share * (other[i] - corner[i]));
                    bounds.add(cut[0] / NEAR_M, cut[1] / NEAR_M);
                }
            }
        }
        let pinhole = &self.pinhole;
        let pixels = |low: f64, high: f64, middle: f64, count: usize| {
            let first = (low * pinhole.focal_px + middle - MARGIN).ceil().max(0.0) as usize;
            let last = (high * pinhole.focal_px + middle + MARGIN).floor() + 1.0;
            first..(last.clamp(0.0, count as f64) as usize)
        };
        let area = PixelArea {
            rows: pixels(
                bounds.low[1],
                bounds.high[1],
                pinhole.middle_row(),
                pinhole.height,
            ),
            columns: pixels(
                bounds.low[0],
                bounds.high[0],
                pinhole.middle_column(),
                pinhole.width,
            ),
        };
        (!area.rows.is_empty() && !area.columns.is_empty()).then_some(area)
    }
}

/// The rectangle around points of the picture at one metre.
struct Extent {
    low: [f64; 2],
    high: [f64; 2],
}

impl Extent {
    const fn new() -> Self {
        Self {
            low: [f64::INFINITY; 2],
            high: [f64::NEG_INFINITY; 2],
        }
    }

    fn add(&mut self, x: f64, y: f64) {
        self.low = [self.low[0].min(x), self.low[1].min(y)];
        self.high = [self.high[0].max(x), self.high[1].max(y)];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AHEAD: LocalEye = LocalEye {
        place: [0.0; 3],
        across: [1.0, 0.0, 0.0],
        down: [0.0, 1.0, 0.0],
        ahead: [0.0, 0.0, 1.0],
    };

    fn frustum() -> ViewBorders {
        ViewBorders::new(Pinhole::new(11, 11, 10.0).unwrap())
    }

    fn area(centre: Triple, half: Triple) -> Option<PixelArea> {
        frustum().project(&Around { centre, half }, &AHEAD)
    }

    #[test]
    fn a_box_before_the_camera_covers_the_pixels_of_its_nearer_face() {
        let found = area([0.0, 0.1, 1.0], [0.1, 0.2, 0.5]).unwrap();
        // Nearer face at 0.5 m: columns 5 -+ 2, rows from 5 - 2 to 5 + 6, of which the picture has 5.
        assert_eq!(found.columns, 3..8);
        assert_eq!(found.rows, 3..11);
    }

    #[test]
    fn a_box_that_the_camera_is_in_covers_the_picture_and_one_behind_it_nothing() {
        assert_eq!(area([0.0; 3], [1.0; 3]), Some(frustum().everything()));
        assert_eq!(area([0.0, 0.0, -2.0], [1.0; 3]), None);
        assert_eq!(area([5.0, 0.0, 1.0], [0.1; 3]), None);
    }

    #[test]
    fn a_box_that_reaches_behind_the_camera_is_cut_off_there() {
        // Beside the camera on its right: seen from where the picture's right border meets it.
        let found = area([0.5, 0.0, 0.0], [0.3, 0.1, 3.0]).unwrap();
        assert!(
            found.columns.start > 5 && found.columns.end == 11,
            "{found:?}"
        );
    }

    #[test]
    fn spheres_beside_and_behind_the_picture_are_out_of_reach() {
        let frustum = frustum();
        assert!(frustum.reaches([0.0, 0.0, 1.0], 0.1));
        assert!(!frustum.reaches([0.0, 0.0, -1.0], 0.9));
        assert!(frustum.reaches([0.0, 0.0, -1.0], 1.1));
        // The border's slope is 0.5: the sphere's centre is 0.5 / sqrt(1.25) = 0.447 outside.
        assert!(!frustum.reaches([1.0, 0.0, 1.0], 0.44));
        assert!(frustum.reaches([1.0, 0.0, 1.0], 0.45));
        assert!(!frustum.reaches([0.0, -1.0, 1.0], 0.44));
    }
}
