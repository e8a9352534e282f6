//! How deep the lines of sight of a picture reach: pixel by pixel, and the deepest of those around each.

/// Depths of one kind of neighbourhood, row by row: tiles of pixels, or tiles and their neighbours.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Level {
    /// Columns and rows.
    pub(super) size: [usize; 2],
    /// Depth to which lines of sight reach, m; 0 where there is none.
    pub(super) depths_m: Vec<f32>,
    /// Side of a tile, pixels.
    pub(super) tile_px: f32,
    /// How far a line of sight of the neighbourhood may be from a place in its tile, along columns or rows, pixels.
    pub(super) apart_px: f32,
    /// Lines of sight that are nearer to any place in a tile than this, along columns and rows, are of its neighbourhood, pixels.
    pub(super) covers_px: f32,
}

impl Level {
    fn clear(&mut self, size: [usize; 2]) {
        self.size = size;
        self.depths_m.clear();
        self.depths_m.resize(size[0] * size[1], 0.0);
        (self.tile_px, self.apart_px, self.covers_px) = (1.0, 0.5, 0.5);
    }

    /// Takes the deepest of tiles of 2 x 2.
    fn gather(&mut self, finer: &Self) {
        let [width, height] = finer.size;
        self.clear([width.div_ceil(2), height.div_ceil(2)]);
        self.tile_px = 2.0 * finer.tile_px;
        self.apart_px = finer.apart_px + finer.tile_px;
        let tiles = self.depths_m.chunks_exact_mut(self.size[0].max(1));
        for (tiles, rows) in tiles.zip(finer.depths_m.chunks(2 * width)) {
            for row in rows.chunks_exact(width) {
                let (pairs, left) = row.as_chunks::<2>();
                for (tile, &[a, b]) in tiles.iter_mut().zip(pairs) {
                    *tile = deeper(*tile, deeper(a, b));
                }
                if let (Some(tile), Some(&last)) = (tiles.last_mut(), left.first()) {
                    *tile = deeper(*tile, last);
                }
            }
        }
    }

    /// Takes the deepest of each tile and the eight around it. `line` is room for a row.
    fn widen(&mut self, narrower: &Self, line: &mut Vec<f32>) {
        let [width, height] = narrower.size;
        self.size = narrower.size;
        self.depths_m.resize(width * height, 0.0);
        self.tile_px = narrower.tile_px;
        self.apart_px = narrower.apart_px + narrower.tile_px;
        self.covers_px = narrower.covers_px + narrower.tile_px;
        let row = |index: usize| &narrower.depths_m[index * width..][..width];
        // A place more at both ends, of no depth.
        line.clear();
        line.resize(width + 2, 0.0);
        for (index, wide) in self.depths_m.chunks_exact_mut(width.max(1)).enumerate() {
            let (above, below) = (index.saturating_sub(1), (index + 1).min(height - 1));
            let three = row(above).iter().zip(row(index)).zip(row(below));
            for (deepest, ((&a, &b), &c)) in line[1..=width].iter_mut().zip(three) {
                *deepest = deeper(deeper(a, b), c);
            }
            let three = line.iter().zip(&line[1..]).zip(&line[2..]);
            for (deepest, ((&a, &b), &c)) in wide.iter_mut().zip(three) {
                *deepest = deeper(deeper(a, b), c);
            }
        }
    }
}

/// One instruction, unlike `f32::max`, which looks for NaN.
#[inline]
fn deeper(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Neighbourhoods, from the smallest to the largest.
pub(super) const LEVELS: usize = 5;

/// Depths at which the lines of sight of a frame end. Reused from frame to frame.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Reaches {
    levels: [Level; LEVELS],
    tiles: Level,
    line: Vec<f32>,
}

impl Reaches {
    /// Forgets the last frame.
    pub(super) fn clear(&mut self, size: [usize; 2]) {
        self.levels[0].clear(size);
    }

    /// Notes how deep a pixel's line of sight reaches.
    #[inline]
    pub(super) fn note(&mut self, pixel: usize, depth_m: f32) {
        if let Some(slot) = self.levels[0].depths_m.get_mut(pixel) {
            *slot = depth_m;
        }
    }

    /// Makes the neighbourhoods of the pixels' depths.
    pub(super) fn gather(&mut self) {
        let Self {
            levels: [pixels, three, five, threes, fives],
            tiles,
            line,
        } = self;
        three.widen(pixels, line);
        five.widen(three, line);
        tiles.gather(pixels);
        threes.widen(tiles, line);
        fives.widen(threes, line);
    }

    pub(super) const fn levels(&self) -> &[Level; LEVELS] {
        &self.levels
    }
}
