//! Whether the robot gets on.

/// Since when a plan may tell that the robot got on: as it stands and looks, steps that were planned anew on the way count as not taken yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Since {
    /// Since the last plan of a robot that stood.
    Look = 0,
    /// Since the last plan of a robot that stepped.
    Step = 1,
}

/// How far the robot has come, by what its plans cost.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct CostToGo {
    /// The least that the way on has cost, s.
    least_s: Option<f64>,
    /// How often it was found to be longer than it had seemed.
    longer: u32,
}

impl CostToGo {
    /// Takes in what the way on costs; whether that tells that the robot gets on: it is shorter by this than before, or, so often at most,
    /// so much longer that something new is known.
    pub(super) fn gets_on(&mut self, whole_s: f64, by_s: f64, most: u32) -> bool {
        let shorter = self.least_s.is_none_or(|least_s| whole_s < least_s - by_s);
        let longer = self.least_s.is_some_and(|least_s| whole_s > least_s + by_s);
        self.longer += u32::from(longer);
        let counts = shorter || longer && self.longer <= most;
        if counts {
            self.least_s = Some(whole_s);
        }
        counts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_way_that_gets_shorter_gets_on_and_one_that_gets_longer_does_so_often_only() {
        let mut to_go = CostToGo::default();
        let gets_on = [20.0, 19.9, 18.0, 18.2, 25.0, 24.8, 31.0, 40.0]
            .map(|whole_s| to_go.gets_on(whole_s, 0.5, 2));
        assert_eq!(
            gets_on,
            [true, false, true, false, true, false, true, false]
        );
        assert!(to_go.gets_on(30.0, 0.5, 2));
    }
}
