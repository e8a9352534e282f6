//! What a robot makes of things that its feet meet: one that it did not know of teaches it another way, the same one again does not.

use mapping::FeltPlace;

/// Things that the feet met so far.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ThingsMet {
    /// Places that the map knew when a foot last met something.
    known: usize,
    /// Things that were met for the first time.
    learnt: u32,
    /// How often what was known was met again since then.
    vain: u32,
}

impl ThingsMet {
    /// Counts a thing that a foot met, which the map has among these. Whether to go on: no more than `touches` things were met, and
    /// none of them again more than `tries` times.
    pub(crate) const fn count(&mut self, felt: &[FeltPlace], [tries, touches]: [u32; 2]) -> bool {
        if felt.len() > self.known {
            self.learnt += 1;
            self.vain = 0;
        } else {
            self.vain += 1;
        }
        self.known = felt.len();
        self.vain <= tries && self.learnt <= touches
    }
}

/// Why a robot gives up whose feet meet things again and again.
pub(crate) fn given_up(felt: &[FeltPlace]) -> String {
    felt.last().map_or_else(
        || "blocked: the feet come upon something that cannot be seen".to_owned(),
        |felt| format!("blocked: {}", felt.told()),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn felt(count: usize) -> Vec<FeltPlace> {
        let at = |index| FeltPlace {
            at_m: [0.5, 0.2 * index as f64],
            heading_rad: 0.0,
            top_m: 0.115,
            ground_m: 0.1,
            half_width_m: 0.04,
            thing: 0,
        };
        (0..count).map(at).collect()
    }

    #[test]
    fn the_same_thing_is_met_so_often_and_new_ones_more_often() {
        let (most, mut met) = ([2, 12], ThingsMet::default());
        assert!((1..=12).all(|count| met.count(&felt(count), most)));
        assert!(!met.count(&felt(13), most));
        let (mut met, one) = (ThingsMet::default(), felt(1));
        assert!((0..=2).all(|_| met.count(&one, most)));
        assert!(!met.count(&one, most));
    }

    #[test]
    fn who_gives_up_says_what_was_met_last_and_where() {
        let told = given_up(&felt(2));
        assert!(
            told.contains("(0.50, 0.20)") && told.contains("15 mm"),
            "{told}"
        );
        assert!(told.starts_with("blocked: "));
    }
}
