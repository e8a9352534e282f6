//! Label images: the number of the region that each pixel belongs to, 0 for none.

use std::ops::Range;

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

/// The runs of pixels of one region each, in order; pixels without a region are left out.
pub(crate) fn label_runs(labels: &[u16]) -> impl Iterator<Item = (u16, Range<usize>)> {
    let mut next = 0;
    std::iter::from_fn(move || {
        loop {
            let first = next;
            let label = *labels.get(first)?;
            next += run_length(&labels[first..], label);
            if label > 0 {
                return Some((label, first..next));
            }
        }
    })
}

/// How many pixels have a label before the first one that has another; most are passed over by the chunk.
fn run_length(labels: &[u16], label: u16) -> usize {
    let (chunks, _) = labels.as_chunks::<CHUNK>();
    let own = |chunk: &&[u16; CHUNK]| {
        chunk
            .iter()
            .fold(0, |differs, other| differs | (other ^ label))
            == 0
    };
    let whole = CHUNK * chunks.iter().take_while(own).count();
    let rest = labels[whole..].iter();
    whole + rest.take_while(|other| **other == label).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn runs_are_as_long_as_can_be_and_hold_every_pixel_of_a_region(
            parts in prop::collection::vec((0..3u16, 1..40usize), 0..12),
        ) {
            let labels: Vec<u16> =
                parts.iter().flat_map(|&(label, count)| std::iter::repeat_n(label, count)).collect();
            let mut first = 0;
            let mut plain = Vec::new();
            for run in labels.chunk_by(|a, b| a == b) {
                plain.push((run[0], first..first + run.len()));
                first += run.len();
            }
            plain.retain(|(label, _)| *label > 0);
            prop_assert_eq!(label_runs(&labels).collect::<Vec<_>>(), plain);
        }

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
