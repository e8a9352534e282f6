//! How footsteps are searched for.

use settings::{POSITIVE, SHARE, above_to, at_least, settings, within};
use terrain::footholds::FootholdConfig;
use terrain::ground_map::GroundMapConfig;

use crate::search::ara_star::AraStarConfig;

settings! {
    /// How footsteps are searched for: time is what a step costs.
    pub struct FootstepsConfig("navigation.footsteps") {
        /// Headings of a foot in a full turn.
        headings: usize = 24, "1", within(4.0, 72.0);
        /// Places along the way of a foot from the farthest back to the farthest forward, walked or careful, among which a step ends.
        along: usize = 6, "1", within(2.0, 20.0);
        /// Places across, from beside the other foot to the farthest side step.
        across: usize = 2, "1", within(1.0, 10.0);
        /// Cells along a sole at most: a finer map is refused, since each foothold would take as many times longer.
        sole_cells: usize = 200, "1", within(2.0, 1000.0);
        /// What it costs at most that a sole bears only in part.
        partial_cost: f64 = 1.0, "s", within(0.0, 100.0);
        /// What it costs at most that what bears is not even.
        uneven_cost: f64 = 6.0, "s", within(0.0, 100.0);
        /// What it costs at most that ground beside a foot is not known or out of reach: at the side of a flight and at its corners it has little room,
        /// and the next step less.
        margin_cost: f64 = 1.5, "s", within(0.0, 100.0);
        /// What a turn of a foot costs beside its time: of two ways as long, the straight one.
        turn_cost: f64 = 0.1, "s/rad", within(0.0, 100.0);
        /// Ground whose height differs by no more from that of the standing foot is walked on; other heights take careful steps.
        walk_height: f64 = 0.006, "m", within(0.0, 1.0);
        /// Of a walked step the ground under both feet rises by no more per metre: on steeper ground the weight is shifted with care.
        walk_slope: f64 = 0.03, "1", within(0.0, 1.0);
        /// Of a walked step both soles bear at least in this part: where less does, the weight is shifted with care.
        walk_bearing: f64 = 0.95, "1", SHARE;
        /// A careful step goes no higher and no lower than what the legs do, less this: heights are known to so much.
        height_margin: f64 = 0.003, "m", within(0.0, 1.0);
        /// Of the height to which a foot is lifted over the higher end of its step, so much is kept from what it goes over.
        way_margin: f64 = 0.005, "m", within(0.0, 1.0);
        /// Side of the cells of the field that leads the search.
        field_cell: f64 = 0.04, "m", above_to(0.0, 10.0);
        /// So many times as dear is a way in that field over ground that carries no sole: edges, and what is narrow. At 1 nothing in the field
        /// is too dear, and the best plan takes seconds.
        poor_cost: f64 = 3.0, "1", at_least(1.0);
        /// Rounds in which levels that are guessed where nothing was seen are evened out: where two guesses meet, so many cells to both sides.
        guess_rounds: usize = 8, "1", within(0.0, 1000.0);
        /// So many times as dear is a way in that field over ground that was not seen, where a plan may lead there.
        unseen_cost: f64 = 2.0, "1", at_least(1.0);
        /// So many times as dear is a climb there: stairs that nobody saw may be a drop.
        unseen_climb_cost: f64 = 5.0, "1", at_least(1.0);
        /// What it costs to look, where a plan ends before what is not known.
        look_cost: f64 = 2.5, "s", within(0.0, 100.0);
        /// From there on the way costs so many times what that field says, as the steps of a plan do.
        field_short: f64 = 1.5, "1", at_least(1.0);
        /// The first plan costs no more than so many times the cheapest, as far as the field is right.
        epsilon: f64 = 5.0, "1", at_least(1.0), "Likhachev et al. 2003: ARA*: anytime A* with provable bounds on sub-optimality";
        /// By how much that falls from pass to pass.
        epsilon_step: f64 = 1.0, "1", POSITIVE;
        /// Places of a foot that are expanded before the best plan so far is taken.
        expansions: usize = 10_000, "1", at_least(1.0);
        /// Where no more places of a foot than these were reached and no plan was found, steps are looked at that are twice as fine.
        cornered: usize = 300, "1", within(0.0, 1e9);
        /// Places of a foot that are expanded in search of steps that lead to the goal itself, where a plan may end before what is not known.
        to_goal: usize = 3_000, "1", at_least(1.0);
        /// Places of a foot that are expanded before the search for a first plan is given up.
        most_expansions: usize = 30_000, "1", at_least(1.0);
        /// How the ground around the robot is read.
        ground: GroundMapConfig;
        /// What a sole needs.
        foothold: FootholdConfig;
    }
}

impl FootstepsConfig {
    /// The search's own part.
    pub(super) fn search(&self) -> AraStarConfig {
        AraStarConfig {
            epsilon: self.epsilon,
            epsilon_step: self.epsilon_step,
            expansions: self.expansions,
        }
    }
}
