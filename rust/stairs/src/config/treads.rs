//! Settings of stairs over time: how sightings become one stair, and when it is believed or dropped.

use settings::{NOT_NEGATIVE, POSITIVE, SHARE, at_least, settings};

settings! {
    /// How sightings of a stair become one, and when a stair is believed or dropped.
    pub struct TreadsTuning("navigation.stairs.tuning.treads") {
        /// Sightings that a stair is worth after a step: those that follow soon weigh more.
        remembered_sightings: f64 = 2.0, "1", POSITIVE;
        /// From which sides a stair was seen.
        sides: SidesTuning;
        /// Where an edge of a stair ends.
        border: BorderTuning;
        /// Which stairs are one.
        merging: MergingTuning;
        /// What is dropped.
        memory: MemoryTuning;
    }
}

settings! {
    /// From which sides a stair was seen: each has a front and a back, and the robot goes over one pair.
    pub struct SidesTuning("navigation.stairs.tuning.treads.sides") {
        /// Cosine of the angle between two fronts beyond which they are different sides.
        same_side: f64 = 0.82, "1", SHARE;
        /// How far outside of a side the robot must be for it to become the front.
        outside: f64 = 0.05, "m", NOT_NEGATIVE;
        /// How much farther outside of another side than of the present one the robot must be for the other to become the front.
        farther: f64 = 0.02, "m", NOT_NEGATIVE;
        /// Share of the heaviest side's weight that another must have to be no skewed look: weight of the sightings in which an
        /// edge was seen to end it, where there are any.
        believed: f64 = 0.2, "1", SHARE;
        /// Sightings, with those before a step worth less, without which none is another side: the head turns past a stair, and a
        /// few looks in a row are cut off by the picture's border and a wall.
        least_sightings: f64 = 4.0, "1", NOT_NEGATIVE;
        /// Directions in which a stair is crossed that are kept: its two, and one that something stood before.
        most: usize = 3, "1", at_least(1.0);
    }
}

settings! {
    /// Where an edge of a stair lies and ends, by all sightings.
    pub struct BorderTuning("navigation.stairs.tuning.treads.border") {
        /// Share of the sightings that must have seen where a side ends for it to end there, against those that saw it go on.
        believed: f64 = 0.2, "1", SHARE;
        /// Sightings that go on for less than this beyond the end agree with it.
        agrees: f64 = 0.02, "m", NOT_NEGATIVE;
    }
}

settings! {
    /// Which stairs are one, and which cannot both be there.
    pub struct MergingTuning("navigation.stairs.tuning.treads.merging") {
        /// Share of the smaller of two stairs that must lie in both for them to be one.
        shared: f64 = 0.25, "1", SHARE, "003, section IV.C";
        /// Share of a stair from which on a higher one that lies over it hides it.
        covered: f64 = 0.5, "1", SHARE;
        /// Edges of one stair that was seen in two pieces lie on one line, within this, and are no further apart than this.
        one_line: f64 = 0.03, "m", POSITIVE;
    }
}

settings! {
    /// Which remembered stairs are dropped because something else is seen in their place, or lies there in the map.
    pub struct MemoryTuning("navigation.stairs.tuning.treads.memory") {
        /// Places of a stair that must be seen to tell that it is not there: more than a strip along each side, which shows what
        /// lies beside a stair that is taken for wider than it is, and may be all that is not too near to be seen.
        looked_at: usize = 11, "1", at_least(1.0);
        /// How much of a stair behind its front is looked at.
        front_depth: f64 = 0.3, "m", POSITIVE;
        /// Share of the places that are seen which must show something lower, or a level surface that lies over the stair.
        seen_through: f64 = 0.6, "1", SHARE;
        /// Share of a stair's places from which on it lies on a slope of the map, and is no stair; and share of the places along its
        /// front beyond which it lies along a slope, which leads to it.
        on_slope: f64 = 0.5, "1", SHARE;
        /// Places along a front that are looked at for a slope before it, as shares of its length.
        front_places: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9], "1", SHARE;
        /// How far before and behind a front the map is asked for a slope, besides on it.
        beside: f64 = 0.06, "m", NOT_NEGATIVE;
    }
}
