//! Clouds of points from anywhere, held against what can be worked with.

/// A point of a cloud, metres: x, y level, z up.
pub type Point3 = [f64; 3];

/// A cloud that nothing can be said of.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CloudError {
    /// There are too few points.
    #[error("the cloud has {found} points, at least {least} are needed")]
    TooFew {
        /// How many there are.
        found: usize,
        /// How many it takes.
        least: usize,
    },
    /// A coordinate is no finite number.
    #[error("point {index} is not finite: {point:?}")]
    NotFinite {
        /// Which point, counted from 0.
        index: usize,
        /// The point itself, m.
        point: Point3,
    },
    /// The cloud lies too far apart for the cells that its spacing asks for.
    #[error(
        "the cloud spans {across_m:.0} m by {along_m:.0} m: at cells of {cell_m} m that is more than {most} cells"
    )]
    TooWide {
        /// Its extent along x, m.
        across_m: f64,
        /// Its extent along y, m.
        along_m: f64,
        /// Side of a cell, m.
        cell_m: f64,
        /// The most cells that are allowed.
        most: usize,
    },
}

/// Refuses a cloud with fewer points than `least`, or with one that is no number.
pub(crate) fn check(points: &[Point3], least: usize) -> Result<(), CloudError> {
    if points.len() < least {
        let found = points.len();
        return Err(CloudError::TooFew { found, least });
    }
    let wrong = |point: &&Point3| point.iter().any(|value| !value.is_finite());
    match points.iter().find(wrong) {
        Some(point) => Err(CloudError::NotFinite {
            index: points.iter().take_while(|one| !wrong(one)).count(),
            point: *point,
        }),
        None => Ok(()),
    }
}
