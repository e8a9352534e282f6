//! Settings of recognition: `[navigation.stairs]`, and under `tuning` the numbers that few will want to turn.

mod edge_model;
mod edges;
mod frame;
mod treads;

use settings::{NOT_NEGATIVE, POSITIVE, settings};

pub use edge_model::{
    BevelTuning, CoarseTuning, EdgeModelTuning, ExcerptTuning, RefineTuning, VisibilityTuning,
    WindowTuning,
};
pub use edges::{BevelMemoryTuning, EdgesTuning, FitsTuning, FusionTuning, JointsTuning};
pub use frame::{FrameTuning, LinesTuning, PlacesTuning, SharedEdgesTuning, ViewTuning};
pub use treads::{BorderTuning, MemoryTuning, MergingTuning, SidesTuning, TreadsTuning};

settings! {
    /// Which level surfaces are taken for stairs, and how long they are remembered.
    pub struct StairsConfig("navigation.stairs") {
        /// A stair whose front or back edge is shorter is discarded.
        min_edge: f64 = 0.15, "m", POSITIVE, "003, section IV.B";
        /// A surface whose front edge is further away is not taken for a stair yet: from afar steps run into each other.
        max_distance: f64 = 0.9, "m", POSITIVE;
        /// A stair that is less deep is discarded.
        min_depth: f64 = 0.07, "m", POSITIVE, "003, section IV.B";
        /// Surfaces within this of the robot's height are the ground that it stands on, unless something lies between.
        own_height: f64 = 0.01, "m", POSITIVE;
        /// Stairs that overlap are one when their heights differ by no more than this.
        similar_height: f64 = 0.009, "m", POSITIVE, "003, section IV.C";
        /// Frames in which a stair must be seen before it is believed.
        min_frames: u32 = 2, "1", POSITIVE;
        /// Frames in a row in which something lower, or a level surface over it, is seen in a stair's place before it is dropped.
        contradicted_frames: u32 = 4, "1", POSITIVE;
        /// Steps after which a stair that was not seen again is forgotten.
        forget_steps: u32 = 80, "1", NOT_NEGATIVE;
        /// Distance beyond which stairs are forgotten.
        forget_distance: f64 = 3.0, "m", POSITIVE;
        /// Numbers of recognition that few will want to turn.
        tuning: StairsTuning;
    }
}

settings! {
    /// Numbers of recognition that few will want to turn.
    pub struct StairsTuning("navigation.stairs.tuning") {
        /// Straight lines through segments and points.
        lines: LinesTuning;
        /// The places of a stair at which the picture and the map are asked.
        places: PlacesTuning;
        /// What the camera saw where a surface lies or ends.
        view: ViewTuning;
        /// Stairs in one frame.
        frame: FrameTuning;
        /// Stairs over time.
        treads: TreadsTuning;
        /// The edges between stairs.
        edges: EdgesTuning;
        /// The step that is fitted to the disparities.
        edge_model: EdgeModelTuning;
    }
}

#[cfg(test)]
mod tests {
    use settings::Table;

    use super::*;

    #[test]
    fn what_is_shipped_can_be_used_and_every_setting_says_what_it_is() {
        assert_eq!(StairsConfig::default().check(), Ok(()));
        for parameter in StairsConfig::parameters() {
            assert!(parameter.meaning.ends_with('.'), "{parameter:?}");
            assert!(parameter.key.starts_with("navigation.stairs."));
        }
    }

    #[test]
    fn places_outside_of_a_stair_are_refused() {
        let mut config = StairsConfig::default();
        config.tuning.places.each_way = 6;
        let said = config.check().unwrap_err().to_string();
        assert_eq!(
            said,
            "navigation.stairs.tuning.places.each_way must be so few that the last place is within the stair, got 6"
        );
    }
}
