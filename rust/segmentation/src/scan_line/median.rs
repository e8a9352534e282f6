//! A 3x3 median over the pixels that were seen: takes single mismatches out before anything is fitted.

/// Fewest pixels of the nine that must be seen for the middle one to count.
const MIN_SEEN: usize = 5;

fn sort_pair(values: &mut [f32; 9], a: usize, b: usize) {
    let (x, y) = (values[a], values[b]);
    values[a] = x.min(y);
    values[b] = x.max(y);
}

/// The median of nine by Paeth's exchange network (Graphics Gems, 1990).
fn median_of_nine(mut v: [f32; 9]) -> f32 {
    for (a, b) in [
        (1, 2),
        (4, 5),
        (7, 8),
        (0, 1),
        (3, 4),
        (6, 7),
        (1, 2),
        (4, 5),
        (7, 8),
        (0, 3),
        (5, 8),
        (4, 7),
        (3, 6),
        (1, 4),
        (2, 5),
        (4, 7),
        (4, 2),
        (6, 4),
        (4, 2),
    ] {
        sort_pair(&mut v, a, b);
    }
    v[4]
}

fn median_of_seen(values: &[f32; 9]) -> f32 {
    let mut seen = [0.0_f32; 9];
    let mut count = 0;
    for &value in values {
        if value.is_nan() {
            continue;
        }
        let mut at = count;
        while at > 0 && seen[at - 1] > value {
            seen[at] = seen[at - 1];
            at -= 1;
        }
        seen[at] = value;
        count += 1;
    }
    if count < MIN_SEEN {
        f32::NAN
    } else {
        f32::midpoint(seen[(count - 1) / 2], seen[count / 2])
    }
}

/// Fills `target` with the 3x3 median of `source` (row by row, NaN where nothing was seen). A pixel that was not seen
/// stays so; the outermost pixels are not seen.
pub(super) fn median(source: &[f32], width: usize, target: &mut [f32]) {
    target.fill(f32::NAN);
    let height = source.len() / width;
    for row in 1..height.saturating_sub(1) {
        let (above, here, below) = (
            &source[(row - 1) * width..row * width],
            &source[row * width..(row + 1) * width],
            &source[(row + 1) * width..(row + 2) * width],
        );
        let out = &mut target[row * width..(row + 1) * width];
        for col in 1..width.saturating_sub(1) {
            if here[col].is_nan() {
                continue;
            }
            let v = [
                above[col - 1],
                above[col],
                above[col + 1],
                here[col - 1],
                here[col],
                here[col + 1],
                below[col - 1],
                below[col],
                below[col + 1],
            ];
            // A sum is NaN as soon as one of its terms is.
            out[col] = if v.iter().sum::<f32>().is_nan() {
                median_of_seen(&v)
            } else {
                median_of_nine(v)
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn it_equals_the_middle_of_the_sorted_values(values in prop::array::uniform9(-10.0..10.0f32)) {
            let mut sorted = values;
            sorted.sort_by(f32::total_cmp);
            prop_assert_eq!(median_of_nine(values), sorted[4]);
            prop_assert_eq!(median_of_seen(&values), sorted[4]);
        }
    }

    #[test]
    fn a_lone_mismatch_vanishes_and_holes_stay_holes() {
        let mut source = vec![5.0_f32; 7 * 6];
        source[2 * 7 + 3] = 20.0;
        source[3 * 7 + 5] = f32::NAN;
        let mut target = vec![0.0; source.len()];
        median(&source, 7, &mut target);
        assert_eq!(target[2 * 7 + 3], 5.0);
        assert!(target[3 * 7 + 5].is_nan() && target[0].is_nan());
    }
}
