//! What groups are, by their shape: learned from rooms that drew themselves.

use settings::Table;

use super::shapes::{FEATURES, Group, ShapesConfig};
use crate::trained::{TrainedClasses, TrainedConfig, TrainingError};

/// What stands, lies and hangs in rooms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Label {
    /// What one walks on, slopes included.
    Floor = 0,
    /// What one steps up to: thresholds, treads, raised floors, and their risers.
    Step = 1,
    /// Walls, and what of them hangs over a doorway.
    Wall = 2,
    /// Desks, shelves, boards at walls.
    Furniture = 3,
    /// Small things, and who walks about.
    Clutter = 4,
    /// Leaves of doors.
    Door = 5,
}

impl Label {
    /// All, in the order of their numbers.
    pub const ALL: [Self; 6] = [
        Self::Floor,
        Self::Step,
        Self::Wall,
        Self::Furniture,
        Self::Clutter,
        Self::Door,
    ];

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Floor => "floor",
            Self::Step => "step",
            Self::Wall => "wall",
            Self::Furniture => "furniture",
            Self::Clutter => "clutter",
            Self::Door => "door",
        }
    }
}

/// Examples that no labels can be learned from.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LabelError {
    /// A label that is none.
    #[error("example {index} has label {found}, the last is {last}", last = Label::ALL.len() - 1)]
    NoLabel {
        /// Which example.
        index: usize,
        /// Its label.
        found: usize,
    },
    /// What was learned is no table of as many numbers.
    #[error("what was learned of labels cannot be read")]
    Unreadable,
    /// They cannot be learned.
    #[error(transparent)]
    Training(#[from] TrainingError),
}

/// Tells what groups are.
#[derive(Debug, Clone)]
pub struct SceneClasses {
    classes: TrainedClasses,
    shapes: ShapesConfig,
}

impl SceneClasses {
    /// As they were learned from rooms that drew themselves (`benches/learn_labels.py`).
    pub fn known(shapes: ShapesConfig) -> Result<Self, LabelError> {
        shapes.check().map_err(TrainingError::from)?;
        let classes =
            TrainedClasses::of_text(include_str!("learned.txt"), Label::ALL.len(), FEATURES)
                .ok_or(LabelError::Unreadable)?;
        Ok(Self { classes, shapes })
    }

    /// What was learned, as text.
    pub fn text(&self) -> String {
        self.classes.text()
    }

    /// Learned from examples: features of groups ([`Group::features`]) of this kind of shapes, and their labels' numbers.
    pub fn learned(
        config: &TrainedConfig,
        shapes: ShapesConfig,
        examples: &[(Vec<f64>, usize)],
    ) -> Result<Self, LabelError> {
        shapes.check().map_err(TrainingError::from)?;
        let last = Label::ALL.len();
        if let Some(index) = examples.iter().position(|(_, label)| *label >= last) {
            let found = examples[index].1;
            return Err(LabelError::NoLabel { index, found });
        }
        let classes = TrainedClasses::train(config, examples, last)?;
        Ok(Self { classes, shapes })
    }

    /// What labels are told by, of a group.
    pub fn features(&self, group: &Group) -> Vec<f64> {
        group.features(&self.shapes).to_vec()
    }

    /// What each label costs for a group: the negative logarithm of its probability, in the order of [`Label::ALL`].
    pub fn costs(&self, group: &Group) -> Vec<f64> {
        self.classes.costs(&self.features(group))
    }
}
