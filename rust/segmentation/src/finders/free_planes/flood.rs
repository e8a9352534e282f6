//! Labels that spread from pixel to pixel.

use crate::picture::neighbours;

/// Gives each pixel without a label that of a neighbour, where `takes(label, pixel)` says so. Keeps its buffer in `queue`.
pub(crate) fn flood(
    labels: &mut [u16],
    width: usize,
    queue: &mut Vec<usize>,
    takes: impl Fn(u16, usize) -> bool,
) {
    queue.clear();
    queue.extend((0..labels.len()).filter(|&at| labels[at] > 0));
    let mut next = 0;
    while next < queue.len() {
        let at = queue[next];
        next += 1;
        for beside in neighbours(at, width, labels.len()) {
            if labels[beside] == 0 && takes(labels[at], beside) {
                labels[beside] = labels[at];
                queue.push(beside);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_spread_over_what_takes_them_and_not_round_the_picture_s_ends() {
        // Two columns that take nothing part three others; the label starts in the middle one.
        let (width, takes) = (5, |_, at: usize| at % 5 != 1 && at % 5 != 3);
        let mut labels = vec![0; 20];
        labels[7] = 2;
        flood(&mut labels, width, &mut Vec::new(), takes);
        for (at, label) in labels.iter().enumerate() {
            assert_eq!(*label, if at % width == 2 { 2 } else { 0 }, "{at}");
        }
    }
}
