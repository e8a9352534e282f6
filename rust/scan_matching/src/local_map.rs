//! A local map: what the scans of a stretch of the way saw, in a frame of its own.

use crate::config::ScanMatchConfig;
use crate::field::LikelihoodField;
use crate::maxima::FieldMaxima;

/// Levels of bounds above a field's cells.
const LEVELS: usize = 2;

/// A local map; it keeps its shape, and what is dense in it moves with it.
#[derive(Debug, Clone)]
pub struct LocalMap {
    /// Likelihood of points, in its frame.
    pub field: LikelihoodField,
    /// Bounds of that once it is whole.
    pub maxima: Option<FieldMaxima>,
    /// Numbers of the scans that it is made of; they come one after the other.
    pub scans: Vec<usize>,
}

impl LocalMap {
    /// One without a scan.
    pub(crate) fn new(config: &ScanMatchConfig) -> Self {
        Self {
            field: LikelihoodField::new(config),
            maxima: None,
            scans: Vec::new(),
        }
    }

    /// No scan comes any more.
    pub(crate) fn close(&mut self) {
        self.field.close();
        self.maxima = Some(FieldMaxima::new(&self.field, LEVELS));
    }
}
