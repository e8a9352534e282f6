//! What stands in each cell of the window, seen from above: the spans of a column, joined where there is no room between them.

/// What is in a column of cells: from which height on up to which, m in the map frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Its lowest, m.
    pub low_m: f32,
    /// Its highest, m.
    pub high_m: f32,
    /// Frames that saw it.
    pub frames: u16,
    /// Standard deviation of its highest, m.
    pub sigma_m: f32,
}

impl Span {
    /// Nothing is known.
    pub(crate) const UNKNOWN: Self = Self {
        low_m: f32::NAN,
        high_m: f32::NAN,
        frames: 0,
        sigma_m: 0.0,
    };
}

/// Things one above the other, cell by cell. Reused from frame to frame.
#[derive(Debug, Clone, Default)]
pub(crate) struct Columns {
    /// By cell, then by height.
    spans: Vec<(u32, Span)>,
    /// Where the things of a cell begin, and behind the last one's end.
    starts: Vec<u32>,
    things: Vec<Span>,
}

impl Columns {
    /// Begins anew.
    pub(crate) fn begin(&mut self) {
        self.spans.clear();
    }

    /// Puts a span into the cell that is stored at an index.
    pub(crate) fn add(&mut self, index: usize, span: Span) {
        self.spans.push((index as u32, span));
    }

    /// Makes things of so many cells: spans with less room than `room_m` between them are one.
    pub(crate) fn finish(&mut self, cells: usize, room_m: f32) {
        self.spans.sort_by(|(a, one), (b, other)| {
            (a.cmp(b))
                .then(one.low_m.total_cmp(&other.low_m))
                .then(one.high_m.total_cmp(&other.high_m))
        });
        self.starts.clear();
        self.things.clear();
        let mut spans = self.spans.iter().peekable();
        for cell in 0..cells as u32 {
            let start = self.things.len();
            self.starts.push(start as u32);
            while let Some((_, span)) = spans.next_if(|(at, _)| *at == cell) {
                match self.things[start..].last_mut() {
                    Some(last) if span.low_m - last.high_m < room_m => {
                        if span.high_m > last.high_m {
                            (last.high_m, last.sigma_m) = (span.high_m, span.sigma_m);
                        }
                        last.frames = last.frames.max(span.frames);
                    }
                    _ => self.things.push(*span),
                }
            }
        }
        self.starts.push(self.things.len() as u32);
    }

    /// The things of the cell that is stored at an index, the lowest first.
    #[inline]
    pub(crate) fn things(&self, index: usize) -> &[Span] {
        match self.starts.get(index..=index + 1) {
            Some(&[from, to]) => &self.things[from as usize..to as usize],
            _ => &[],
        }
    }
}
