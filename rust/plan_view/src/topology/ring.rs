//! The eight cells around a cell, as bits: which of them hang together.

/// Columns and rows to the eight cells around, counterclockwise from +x.
pub(super) const AROUND: [[i32; 2]; 8] = [
    [1, 0],
    [1, 1],
    [0, 1],
    [-1, 1],
    [-1, 0],
    [-1, -1],
    [0, -1],
    [1, -1],
];

/// The four that share a side with the cell.
pub(super) const SIDES: u8 = 0b0101_0101;

/// Which of the eight touch which, by a side or a corner.
const TOUCHING: [u8; 8] = touching();

/// Pieces into which a set of the eight falls.
pub(super) const PIECES: [u8; 256] = pieces();

const fn touching() -> [u8; 8] {
    let mut found = [0; 8];
    let mut one = 0;
    while one < 8 {
        let mut other = 0;
        while other < 8 {
            let across = (AROUND[one][0] - AROUND[other][0]).abs();
            let along = (AROUND[one][1] - AROUND[other][1]).abs();
            if across <= 1 && along <= 1 {
                found[one] |= 1 << other;
            }
            other += 1;
        }
        one += 1;
    }
    found
}

const fn pieces() -> [u8; 256] {
    let mut counts = [0; 256];
    let mut set = 0_usize;
    while set < 256 {
        let mut left = set as u8;
        while left != 0 {
            let mut piece = left & left.wrapping_neg();
            let mut grown = 0;
            while piece != grown {
                grown = piece;
                let mut one = 0;
                while one < 8 {
                    if grown & (1 << one) != 0 {
                        piece |= TOUCHING[one] & left;
                    }
                    one += 1;
                }
            }
            left &= !piece;
            counts[set] += 1;
        }
        set += 1;
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_touch_over_a_corner_and_corners_do_not() {
        assert_eq!(PIECES[0b0000_0101], 1, "right and above");
        assert_eq!(PIECES[0b0000_1010], 2, "two corners");
        assert_eq!(PIECES[0b0001_0001], 2, "right and left");
        assert_eq!(PIECES[0], 0);
        assert_eq!(PIECES[255], 1);
    }
}
