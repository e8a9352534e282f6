//! Rule: a metre costs more where the floor was seen, but not all of the room that the robot's head needs above it. Around itself the
//! robot cannot look up so steeply; it stands there, and asks no more for it.

use geometry::distance_m;
use mapping::HeadRoom;
use settings::{NOT_NEGATIVE, settings, within};

use crate::{Sight, Terrain};

settings! {
    /// What it costs to go where nobody has looked up.
    pub struct HeadRoomConfig("navigation.terrain.head_room") {
        /// What a metre costs more where the room for the head was not seen.
        unseen_cost: f32 = 0.5, "1", within(0.0, 100.0);
        /// So near to the robot it costs nothing, m: the camera cannot be raised so far.
        near: f64 = 0.4, "m", NOT_NEGATIVE;
    }
}

pub(super) fn apply(terrain: &mut Terrain, sight: &Sight<'_>, config: &HeadRoomConfig) {
    let heads = sight.view.head.values();
    for (index, head) in heads.iter().enumerate() {
        let unseen = *head == HeadRoom::Unseen && !terrain.unknown[index];
        if unseen && distance_m(terrain.center_m(index), sight.stand.at_m) > config.near {
            terrain.weights[index] += config.unseen_cost;
        }
    }
}

#[cfg(test)]
mod tests {
    use mapping::HeadRoom;

    use crate::testing::{Floor, cell};

    #[test]
    fn a_metre_costs_more_where_nobody_looked_up_but_not_beside_the_robot() {
        let mut floor = Floor::new();
        for head in floor.view.head.values_mut() {
            *head = HeadRoom::Unseen;
        }
        let terrain = floor.after("head_room");
        let cost = |x_m: f64| terrain.weights[cell(&terrain, x_m, 0.025)];
        assert_eq!((cost(0.225), cost(0.825)), (1.0, 1.5));
    }
}
