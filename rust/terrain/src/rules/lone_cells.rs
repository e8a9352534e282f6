//! Rule: lonely obstacle cells are unknown. Two false matches of the stereo camera make one, nothing that a robot runs into does.
//!
//! What really stands there fills more cells when it is looked at again, as unknown ground on the way is.

use crate::{Terrain, cells::around};

/// Finds obstacles of a few cells. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct LoneCells {
    visited: Vec<bool>,
    patch: Vec<usize>,
}

impl LoneCells {
    pub(super) fn apply(&mut self, terrain: &mut Terrain) {
        let most = terrain.settings.lone_cells;
        let (blocked, unknown) = (&mut terrain.blocked, &mut terrain.unknown);
        self.clear(blocked, unknown, terrain.cols, most);
    }

    /// Turns every patch of at most `most` blocked cells (eight neighbours) into unknown ones. Row by row, `cols` wide.
    fn clear(&mut self, blocked: &mut [bool], unknown: &mut [bool], cols: usize, most: usize) {
        if most == 0 {
            return;
        }
        self.visited.clear();
        self.visited.resize(blocked.len(), false);
        for seed in 0..blocked.len() {
            if !blocked[seed] || self.visited[seed] {
                continue;
            }
            let size = [cols, blocked.len() / cols];
            let together = around(seed, 1, size).filter(|&cell| blocked[cell]);
            if together.count() > most {
                continue; // whatever else belongs to its patch
            }
            self.grow(seed, blocked, cols);
            if self.patch.len() <= most {
                for &cell in &self.patch {
                    blocked[cell] = false;
                    unknown[cell] = true;
                }
            }
        }
    }

    /// Collects the patch around `seed`.
    fn grow(&mut self, seed: usize, blocked: &[bool], cols: usize) {
        self.patch.clear();
        self.patch.push(seed);
        self.visited[seed] = true;
        let mut next = 0;
        while next < self.patch.len() {
            let here = self.patch[next];
            next += 1;
            for cell in around(here, 1, [cols, blocked.len() / cols]) {
                if blocked[cell] && !self.visited[cell] {
                    self.visited[cell] = true;
                    self.patch.push(cell);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cleared(picture: &str, most: usize) -> (String, usize) {
        let cols = picture.find('\n').unwrap();
        let mut blocked: Vec<bool> = picture
            .chars()
            .filter(|c| *c != '\n')
            .map(|c| c == '#')
            .collect();
        let mut unknown = vec![false; blocked.len()];
        LoneCells::default().clear(&mut blocked, &mut unknown, cols, most);
        let text = blocked.iter().map(|&b| if b { '#' } else { '.' }).collect();
        (text, unknown.iter().filter(|&&u| u).count())
    }

    #[test]
    fn small_patches_become_unknown_and_larger_ones_stay() {
        let picture = "#....\n..##.\n.....\n#...#\n.#.#.\n#....\n";
        let (text, unknown) = cleared(picture, 2);
        // The cell in the corner, the pair and the pair on a diagonal go; the three that touch by corners stay.
        let expected = [".....", ".....", ".....", "#....", ".#...", "#...."].concat();
        assert_eq!(text, expected);
        assert_eq!(unknown, 1 + 2 + 2);
    }

    #[test]
    fn nothing_is_cleared_when_it_is_switched_off() {
        assert_eq!(cleared("#..\n...\n", 0).1, 0);
    }
}
