//! What the other eye cannot see.

/// Finds the pixels of a row that the right eye cannot see: a pixel appears its disparity further left there, and is hidden by one
/// further right that appears at the same place or left of it. `place` is scratch of the row's length.
pub(super) fn hidden(disparity: &[f32], place: &mut [f32], hidden: &mut [bool]) {
    for (column, (place, disparity)) in place.iter_mut().zip(disparity).enumerate() {
        *place = column as f32 - disparity;
    }
    hidden.fill(false);
    // In most rows each pixel appears right of the one before.
    let turns_back = place
        .iter()
        .zip(&place[1..])
        .fold(false, |any, (a, b)| any || b <= a);
    if !turns_back {
        return;
    }
    let mut leftmost = f32::INFINITY;
    for (hidden, place) in hidden.iter_mut().zip(&*place).rev() {
        *hidden = leftmost <= *place;
        leftmost = if *place < leftmost { *place } else { leftmost };
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn seen(disparity: &[f32]) -> Vec<bool> {
        let mut found = vec![true; disparity.len()];
        hidden(disparity, &mut vec![0.0; disparity.len()], &mut found);
        found
    }

    #[test]
    fn left_of_a_near_object_a_band_as_wide_as_the_parallax_is_hidden() {
        let mut row = [3.0; 60];
        row[30..].fill(8.0);
        let found = seen(&row);
        assert!(found[25..30].iter().all(|hidden| *hidden));
        assert!(!found[..25].iter().chain(&found[30..]).any(|hidden| *hidden));
    }

    #[test]
    fn right_of_a_near_object_nothing_is_hidden() {
        let mut row = [12.0; 60];
        row[30..].fill(3.0);
        assert!(!seen(&row).contains(&true));
    }

    proptest! {
        #[test]
        fn the_band_is_as_wide_as_the_parallax_of_any_two_walls(
            near in 9.0..20.0_f32,
            far in 2.0..9.0_f32,
        ) {
            let mut row = [far; 60];
            row[30..].fill(near);
            let count = seen(&row).iter().filter(|hidden| **hidden).count();
            prop_assert!((count as f32 - (near - far)).abs() <= 1.0);
        }
    }
}
