//! A new path: to the goal, to stairs of which a limit is in doubt, or to a place to look from.

use crate::keep::{End, Kept};
use crate::legs::Draft;
use crate::levels::Stand;
use crate::portals::Fit;
use crate::refusal::{explain, first_limit};
use crate::route::{Ends, end_of, run};
use crate::search::Route;
use crate::terrain::Terrain;
use crate::{AStar, Goal, NoWay, Refusal};

/// A way to a goal in the window that costs more than so many times the straight one and these m may be shorter around.
const FAR: f64 = 2.0;
const FAR_M: f64 = 0.5;
/// A route over more unseen ground than this is but a guess, m.
const GUESS_M: f64 = 1.0;

/// A route and what it is for.
struct Found {
    route: Route,
    /// Ways up to this one are part of it.
    worst: Fit,
    end: End,
}

impl AStar {
    /// A new path over the terrain.
    pub(crate) fn find(&mut self, stand: &Stand, goal: &Goal) -> Result<Kept, NoWay> {
        let outside = || NoWay {
            refusal: Refusal::NoPath,
            sentence: "the robot stands outside of its map".into(),
        };
        let start = self.terrain.index_at(stand.at_m).ok_or_else(outside)?;
        let found = self.route(stand, start, goal)?;
        let (terrain, portals) = (&self.terrain, &self.portals);
        let end_m = |last: usize| {
            let middle = [goal.x_m, goal.y_m];
            if terrain.index_at(middle) == Some(last) {
                middle
            } else {
                terrain.center_m(last)
            }
        };
        let route = (&found.route, found.worst);
        Ok(Kept {
            draft: Draft::of(terrain, portals, route, stand.at_m, end_m),
            goal: *goal,
            end: found.end,
            inside: terrain.index_at([goal.x_m, goal.y_m]).is_some(),
            unknown: 0,
        })
    }

    /// The cheapest route over what is known to fit; and whether it may lead out of the window and back to a goal in it.
    fn known(&mut self, stand: &Stand, start: usize, goal: &Goal) -> (Option<Route>, bool) {
        let (terrain, portals) = (&self.terrain, &self.portals);
        let (height_m, climb_cost) = (stand.height_m, self.config.climb_cost);
        let search = &mut self.search;
        let ends = Ends::new(terrain, &self.beyond, goal, height_m, climb_cost);
        let known = run(search, terrain, portals, &ends, start, Fit::Holds);
        let straight = ends.away(start) + FAR_M / terrain.lattice.cell_m;
        let is_around = (self.kept.as_ref()).is_some_and(|kept| kept.end == End::Border);
        let is_far = |route: &Route| route.cost > FAR * straight;
        // What was seen of the ground outside of the window tells no levels apart.
        let looks_around = ends.inside && !ends.on_another_level();
        if !(looks_around && known.as_ref().map_or(is_around, is_far)) {
            return (known, false);
        }
        self.beyond.look_around(terrain, goal);
        let mut ends = Ends::new(terrain, &self.beyond, goal, height_m, climb_cost);
        ends.around = true;
        (
            run(search, terrain, portals, &ends, start, Fit::Holds),
            true,
        )
    }

    /// The cheapest route to the goal. Where there is none, or none that is more than a hope: to the stairs that would lead
    /// there if they were other than they look from afar; else to where more is to be seen.
    fn route(&mut self, stand: &Stand, start: usize, goal: &Goal) -> Result<Found, NoWay> {
        let (known, around) = self.known(stand, start, goal);
        let (terrain, portals) = (&self.terrain, &self.portals);
        let climb_cost = self.config.climb_cost;
        let mut ends = Ends::new(terrain, &self.beyond, goal, stand.height_m, climb_cost);
        ends.around = around;
        let search = &mut self.search;
        let hoped = |route: &Route| {
            let last = route.cells.last();
            let blind = last.is_some_and(|&cell| ends.is_blind(cell as usize));
            blind || unseen_m(terrain, route) > GUESS_M
        };
        let mut limit = None;
        if known.as_ref().is_none_or(hoped) {
            let cheaper =
                |route: &Route| known.as_ref().is_none_or(|known| route.cost < known.cost);
            // Without a way that fits just so badly, a search would find what is known already.
            let mut search_with = |worst| {
                let any = portals.has(worst);
                let found = any.then(|| run(search, terrain, portals, &ends, start, worst));
                found.flatten().filter(cheaper)
            };
            if let Some(route) = search_with(Fit::Doubtful) {
                return Ok(Found {
                    route,
                    worst: Fit::Doubtful,
                    end: End::Look,
                });
            }
            let lifted = search_with(Fit::Broken);
            limit = lifted.and_then(|route| first_limit(terrain, portals, &self.climbing, &route));
        }
        // From where the robot stands stairs may lead down elsewhere; what is too high or too short stays so.
        let here =
            |(no_way, before): &(NoWay, usize)| no_way.refusal == Refusal::Drop && *before == 0;
        if let Some((no_way, _)) = limit.take_if(|limit| !here(limit)) {
            return Err(no_way);
        }
        let (route, end) = if let Some(route) = known {
            let end = end_of(&route, terrain, portals, &ends);
            (route, end)
        } else {
            let levels = terrain.levels.any || ends.on_another_level();
            let route = levels.then(|| self.seek.route(search, terrain, portals, &ends, start));
            let no_way = || match limit {
                Some((no_way, _)) => no_way,
                None => explain(terrain, &self.climbing, &ends, start, goal),
            };
            (route.flatten().ok_or_else(no_way)?, End::Look)
        };
        Ok(Found {
            route,
            worst: Fit::Holds,
            end,
        })
    }
}

/// How far a route leads over ground that was not seen, m.
fn unseen_m(terrain: &Terrain, route: &Route) -> f64 {
    let unseen = |&&cell: &&u32| terrain.unknown.get(cell as usize) == Some(&true);
    route.cells.iter().filter(unseen).count() as f64 * terrain.lattice.cell_m
}
