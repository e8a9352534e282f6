//! A new path: to the goal, to stairs of which a limit is in doubt, or to a place to look from.

use mapping::FloorView;
use stairs::Staircase;
use terrain::{StandingAt, Terrain};

use crate::climb_links::{ClimbLinks, Fit};
use crate::path::ends::{PathEnds, end_of, run};
use crate::refusal::{explain, first_limit};
use crate::search::Route;
use crate::steep_slopes::steep_way;
use crate::{AStar, Goal, NoWay, Path, PathEnd, Refusal};

impl AStar {
    /// A new path over the terrain.
    pub(crate) fn find(&mut self, stand: &StandingAt, goal: &Goal) -> Result<Path, NoWay> {
        let outside = || {
            let sentence = "the robot stands outside of its map".to_owned();
            NoWay::new(Refusal::NoPath, sentence)
        };
        let start = self.terrain.index_at(stand.at_m).ok_or_else(outside)?;
        let (route, worst, end) = self.route(stand, start, goal)?;
        let (terrain, links) = (&self.terrain, &self.links);
        let end_m = |last: usize| {
            let middle = [goal.x_m, goal.y_m];
            if terrain.index_at(middle) == Some(last) {
                middle
            } else {
                terrain.center_m(last)
            }
        };
        let mut path = Path {
            points_m: vec![stand.at_m],
            end,
            ..Path::default()
        };
        let tuning = &self.config.tuning.legs;
        let ground = (terrain, self.chosen.ground(terrain, &route));
        path.go_along(ground, links, (&route, worst), end_m, tuning);
        Ok(path)
    }

    /// The way that there would be if the map were this one.
    pub(super) fn way_in(
        &self,
        (view, stairs): (&FloorView, &Staircase),
        stand: &StandingAt,
        goal: &Goal,
    ) -> Option<Path> {
        let mut other = self.clone();
        other.look(view, stairs, *stand, goal);
        let mut path = other.find(stand, goal).ok()?;
        path.annotate(&other.terrain, &other.config);
        Some(path)
    }

    /// The cheapest route over what is known to fit; and whether it may lead out of the window and back to a goal in it.
    fn known(&mut self, stand: &StandingAt, start: usize, goal: &Goal) -> (Option<Route>, bool) {
        let (terrain, links) = (&self.terrain, &self.links);
        let (height_m, config) = (stand.height_m, &self.config);
        let by = (config, &self.climbing.levels);
        let tuning = &config.tuning.path_search;
        let search = &mut self.search;
        let ends = PathEnds::new(terrain, &self.outside, goal, height_m, by);
        let known = (self.chosen).run(search, (terrain, links), &ends, start);
        let straight = ends.away(start) + tuning.far_more / terrain.lattice.cell_m;
        let is_around =
            (self.followed.as_ref()).is_some_and(|followed| followed.end == PathEnd::Border);
        let is_far = |route: &Route| route.cost > tuning.far * straight;
        // What was seen of the ground outside of the window tells no levels apart.
        let looks_around = ends.inside && !ends.on_another_level();
        if !(looks_around && known.as_ref().map_or(is_around, is_far)) {
            return (known, false);
        }
        self.outside.look_around(terrain, goal);
        let mut ends = PathEnds::new(terrain, &self.outside, goal, height_m, by);
        ends.around = true;
        (run(search, terrain, links, &ends, start, Fit::Holds), true)
    }

    /// The cheapest route to the goal, the worst ways that are part of it, and its end. Where there is none, or none that is more than a hope: to the stairs that would lead
    /// there if they were other than they look from afar; else to where more is to be seen.
    fn route(
        &mut self,
        stand: &StandingAt,
        start: usize,
        goal: &Goal,
    ) -> Result<(Route, Fit, PathEnd), NoWay> {
        let (known, around) = self.known(stand, start, goal);
        let (terrain, links) = (&self.terrain, &self.links);
        let config = &self.config;
        let (guess_m, refusal) = (config.tuning.path_search.guess, &config.tuning.refusal);
        let by = (config, &self.climbing.levels);
        let mut ends = PathEnds::new(terrain, &self.outside, goal, stand.height_m, by);
        ends.around = around;
        let search = &mut self.search;
        let hoped = |route: &Route| {
            let last = route.cells.last();
            let blind = last.is_some_and(|&cell| ends.is_blind(cell as usize));
            blind || unseen_m(terrain, route) > guess_m
        };
        let mut limit = None;
        if known.as_ref().is_none_or(hoped) {
            let cheaper =
                |route: &Route| known.as_ref().is_none_or(|known| route.cost < known.cost);
            // Without a way that fits just so badly, a search would find what is known already.
            let mut search_with = |worst| {
                let any = links.has(worst);
                let found = any.then(|| run(search, terrain, links, &ends, start, worst));
                found.flatten().filter(cheaper)
            };
            if let Some(route) = search_with(Fit::Doubtful) {
                return Ok((route, Fit::Doubtful, PathEnd::Look));
            }
            let lifted = search_with(Fit::Broken);
            let steep = steep_way(terrain, &ends, start).filter(|way| {
                let seen = (self.climbing.levels.told, guess_m);
                way.leads_to(terrain, (goal, stand), seen)
                    && (known.as_ref().is_none_or(|known| way.cost() < known.cost))
                    && (lifted.as_ref()).is_none_or(|lifted| way.cost() < lifted.cost)
            });
            if let Some(way) = steep {
                return Err(way.refused(terrain));
            }
            limit = lifted
                .and_then(|route| first_limit(terrain, links, (&self.climbing, refusal), &route));
        }
        // From where the robot stands stairs may lead down elsewhere; what is too high or too short stays so.
        let here =
            |(no_way, before): &(NoWay, usize)| no_way.refusal == Refusal::Drop && *before == 0;
        if let Some((no_way, _)) = limit.take_if(|limit| !here(limit)) {
            return Err(no_way);
        }
        let (route, end) = if let Some(route) = known {
            let look = || (self.viewpoints).route(search, terrain, links, &ends, start);
            or_look(route, (terrain, links), &ends, look)
        } else {
            let levels = terrain.any_edge || ends.on_another_level();
            let route = levels.then(|| self.viewpoints.route(search, terrain, links, &ends, start));
            let no_way = || match limit {
                Some((no_way, _)) => no_way,
                None => explain(terrain, (&self.climbing, refusal), &ends, start, goal),
            };
            (route.flatten().ok_or_else(no_way)?, PathEnd::Look)
        };
        Ok((route, Fit::Holds, end))
    }
}

/// A known route, and its end. Who knows but a way out of the window looks first where a level ends, if that is the cheaper way to the goal: what
/// goes on there may not have been in sight, and the window's border is reached the other way round.
fn or_look(
    known: Route,
    (terrain, links): (&Terrain, &ClimbLinks),
    ends: &PathEnds<'_>,
    look: impl FnOnce() -> Option<Route>,
) -> (Route, PathEnd) {
    let end = end_of(&known, terrain, links, ends);
    let leaves = end == PathEnd::Border && terrain.any_edge;
    let look = leaves.then(look).flatten();
    match look.filter(|look| look.cost < known.cost) {
        Some(look) => (look, PathEnd::Look),
        None => (known, end),
    }
}

/// How far a route leads over ground that was not seen, m.
fn unseen_m(terrain: &Terrain, route: &Route) -> f64 {
    let unseen = |&&cell: &&u32| terrain.unknown.get(cell as usize) == Some(&true);
    route.cells.iter().filter(unseen).count() as f64 * terrain.lattice.cell_m
}
