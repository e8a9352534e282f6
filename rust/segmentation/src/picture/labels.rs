//! Label images: the number of the region that each pixel belongs to, 0 for none.

/// Most regions that are told apart in one frame; smaller ones are left out.
pub(crate) const MAX_REGIONS: usize = 63;

/// Pixels whose labels are compared together.
const CHUNK: usize = 16;

/// Tells how many pixels have which label, some at a time: most lie among their like.
pub(crate) fn count_labels(labels: &[u16], mut add: impl FnMut(usize, usize)) {
    let (chunks, rest) = labels.as_chunks::<CHUNK>();
    for chunk in chunks {
        let first = chunk[0];
        if chunk
            .iter()
            .fold(0, |differs, label| differs | (label ^ first))
            == 0
        {
            add(usize::from(first), CHUNK);
        } else {
            for &label in chunk {
                add(usize::from(label), 1);
            }
        }
    }
    for &label in rest {
        add(usize::from(label), 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_pixel_is_counted_once(runs in prop::collection::vec((0..4u16, 1..40usize), 0..12)) {
            let labels: Vec<u16> =
                runs.iter().flat_map(|&(label, count)| std::iter::repeat_n(label, count)).collect();
            let mut counts = [0; 4];
            count_labels(&labels, |label, pixels| counts[label] += pixels);
            for (label, &count) in counts.iter().enumerate() {
                let of_label = labels.iter().filter(|&&other| usize::from(other) == label);
                prop_assert_eq!(count, of_label.count());
            }
        }
    }
}
