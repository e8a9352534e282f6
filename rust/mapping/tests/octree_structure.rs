//! Files of OctoMap's whose parts were changed one by one: whatever they say, they are read or refused. `PROPTEST_CASES` says how many.

use std::time::{Duration, Instant};

use proptest::prelude::*;
use volume::octree::{Format, Octree};

/// Numbers from a seed (Steele et al. 2014, SplitMix64).
struct Draws(u64);

impl Draws {
    const fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    const fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    const fn chance(&mut self, of: usize) -> bool {
        self.below(of) == 0
    }
}

/// A tree as a file holds it: header lines, and for each node where it begins.
struct File {
    lines: Vec<String>,
    body: Vec<u8>,
    starts: Vec<usize>,
    nodes: usize,
}

impl File {
    /// Writes the children of a node and what is below, as deep as a tree goes.
    fn node(&mut self, format: Format, depth: u32, draws: &mut Draws) {
        self.starts.push(self.body.len());
        let inner = |draws: &mut Draws, nodes: usize| depth < 15 && nodes < 300 && !draws.chance(3);
        let mut below = Vec::new();
        match format {
            Format::Binary => {
                let mut codes = 0;
                for child in 0..8 {
                    let code = match draws.below(4) {
                        3 if inner(draws, self.nodes) => 3,
                        3 => 1,
                        code => code as u16,
                    };
                    codes |= code << (2 * child);
                    self.nodes += usize::from(code != 0);
                    below.extend((code == 3).then_some(child));
                }
                if codes == 0 {
                    codes = 1;
                    self.nodes += 1;
                }
                self.body.extend(codes.to_le_bytes());
            }
            Format::Full => {
                self.nodes += 1;
                let value = draws.below(8000) as f32 * 0.001 - 4.0;
                self.body.extend(value.to_le_bytes());
                let mask = if depth < 16 && inner(draws, self.nodes) {
                    draws.next() as u8
                } else {
                    0
                };
                self.body.push(mask);
                below.extend((0..8).filter(|child| mask >> child & 1 == 1));
            }
        }
        for _ in below {
            self.node(format, depth + 1, draws);
        }
    }

    fn new(format: Format, draws: &mut Draws) -> Self {
        let mut file = Self {
            lines: Vec::new(),
            body: Vec::new(),
            starts: Vec::new(),
            nodes: usize::from(format == Format::Binary),
        };
        file.node(format, 0, draws);
        let kind = if format == Format::Binary {
            " binary"
        } else {
            ""
        };
        file.lines = vec![
            format!("# Octomap OcTree{kind} file"),
            "#".to_owned(),
            "id OcTree".to_owned(),
            format!("size {}", file.nodes),
            "res 0.1".to_owned(),
            "data".to_owned(),
        ];
        file
    }

    /// Changes a part.
    fn change(&mut self, draws: &mut Draws) {
        let line = draws.below(self.lines.len());
        let at = self.starts[draws.below(self.starts.len())];
        match draws.below(12) {
            kind @ 0..5 => self.change_header(kind, line, draws),
            kind => self.change_body(kind, at, draws),
        }
        self.starts.retain(|&start| start < self.body.len());
        if self.starts.is_empty() || self.lines.is_empty() {
            *self = Self::new(Format::Full, draws);
        }
    }

    fn change_header(&mut self, kind: usize, line: usize, draws: &mut Draws) {
        const WORDS: [&str; 14] = [
            "0",
            "-1",
            "1",
            "nan",
            "inf",
            "1e-320",
            "1e308",
            "18446744073709551615",
            "99999999999999999999",
            "ColorOcTree",
            "OcTree",
            "0.1",
            "10.0",
            "\u{0}",
        ];
        match kind {
            0 => {
                let word = self.lines[line]
                    .split(' ')
                    .next()
                    .unwrap_or_default()
                    .to_owned();
                self.lines[line] = format!("{word} {}", WORDS[draws.below(WORDS.len())]);
            }
            1 => drop(self.lines.remove(line)),
            2 => self.lines.insert(line, self.lines[line].clone()),
            3 => {
                let other = draws.below(self.lines.len());
                self.lines.swap(line, other);
            }
            _ => {
                let nodes = self.nodes + draws.below(5) - 2.min(self.nodes);
                if let Some(size) = self.lines.get_mut(3) {
                    *size = format!("size {nodes}");
                }
            }
        }
    }

    fn change_body(&mut self, kind: usize, at: usize, draws: &mut Draws) {
        match kind {
            5 => self.body.truncate(at),
            6 => self.body.extend(draws.next().to_le_bytes()),
            7 => {
                let end = self.body.len().min(at + 5);
                drop(self.body.drain(at..end));
            }
            8 => {
                let values = [f32::NAN, f32::INFINITY, f32::MAX, f32::MIN_POSITIVE, -1e-42];
                let bytes = values[draws.below(values.len())].to_le_bytes();
                for (to, from) in self.body[at..].iter_mut().zip(bytes) {
                    *to = from;
                }
            }
            9 => {
                let copied = self.body[at..].to_vec();
                self.body.splice(at..at, copied).for_each(drop);
            }
            _ => {
                let off = at + draws.below(5).min(self.body.len() - 1 - at);
                self.body[off] = draws.next() as u8;
            }
        }
    }

    fn bytes(&self) -> Vec<u8> {
        let mut bytes = self.lines.join("\n").into_bytes();
        bytes.push(b'\n');
        bytes.extend(&self.body);
        bytes
    }
}

fn tried(format: Format, seed: u64) -> Result<(), TestCaseError> {
    let mut draws = Draws(seed);
    let mut file = File::new(format, &mut draws);
    let whole = Octree::from_bytes("whole", &file.bytes());
    prop_assert!(whole.is_ok(), "{:?}", whole.err());
    for _ in 0..=draws.below(3) {
        file.change(&mut draws);
    }
    let bytes = file.bytes();
    let begin = Instant::now();
    let read = Octree::from_bytes("changed", &bytes);
    if let Ok(tree) = read {
        prop_assert!(tree.bytes() < (1 << 20) + 1000 * bytes.len());
        // What was taken is a tree: it can be written, and is the same when it is read again.
        let again = Octree::from_bytes("again", &tree.to_bytes(Format::Full));
        prop_assert!(again.as_ref() == Ok(&tree));
    }
    prop_assert!(begin.elapsed() < Duration::from_secs(5));
    Ok(())
}

proptest! {
    #[test]
    fn a_binary_tree_whose_parts_were_changed_is_read_or_refused(seed in any::<u64>()) {
        tried(Format::Binary, seed)?;
    }

    #[test]
    fn a_full_tree_whose_parts_were_changed_is_read_or_refused(seed in any::<u64>()) {
        tried(Format::Full, seed)?;
    }
}
