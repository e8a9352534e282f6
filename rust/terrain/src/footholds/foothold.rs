//! A sole on a height map.

use geometry::{Cell, Grid, PlanarPose};
use mapping::HeightMap;

use super::config::FootholdConfig;
use super::high_blocks::HighBlocks;
use super::raster::{CellUnder, SoleRaster, SoleSize};
use super::resting_plane::{PlaceUnder, RestingPlane};

/// How a sole stands at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foothold {
    /// Height of the plane on which it rests, under its middle, m.
    pub height_m: f32,
    /// How that rises, forward and to the left.
    pub slope: [f32; 2],
    /// Part of the sole that bears, from and to, from its middle forward, m.
    pub bearing_m: [f32; 2],
    /// Share of its cells that bears.
    pub bearing_share: f32,
    /// How far what bears, or may bear, lies from the plane against how far it may: the mean of the squares, 0 to 1. A sole on it rocks.
    pub unevenness: f32,
    /// Share of the ground close beside it that is closed to the next step: not known, or higher or lower than a leg climbs.
    pub closed_share: f32,
}

/// Why a sole does not stand at a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum NoFoothold {
    /// Too little of the ground is known, or the map ends.
    Unseen,
    /// Too little of the sole would bear.
    TooLittle,
    /// Something higher stands too near to the sole, or under it.
    Higher,
    /// The ground is too steep.
    TooSteep,
}

/// Reads footholds at any place of a lattice, for a few headings.
#[derive(Debug, Clone)]
pub struct Footholds {
    config: FootholdConfig,
    sole: SoleSize,
    /// The highest that a leg climbs, m.
    rise_m: f32,
    /// One for each heading.
    rasters: Vec<SoleRaster>,
    ground: Vec<PlaceUnder>,
    strips: Vec<u16>,
}

impl Footholds {
    /// For soles at these headings, rad, whose middles lie `off_m` from the centres of cells of this size, of legs that climb no higher than
    /// `rise_m`.
    pub fn new(
        config: FootholdConfig,
        (sole, rise_m): (SoleSize, f64),
        yaws_rad: impl Iterator<Item = f64>,
        (off_m, cell_m): ([f64; 2], f64),
    ) -> Self {
        let margins_m = [config.higher_margin, config.margin];
        let raster = |yaw_rad| SoleRaster::new(sole, yaw_rad, off_m, cell_m, margins_m);
        Self {
            config,
            sole,
            rise_m: rise_m as f32,
            rasters: yaws_rad.map(raster).collect(),
            ground: Vec::new(),
            strips: Vec::new(),
        }
    }

    /// How a sole stands whose middle is in this cell, at the heading with this index.
    pub fn read(
        &mut self,
        map: &HeightMap,
        middle: Cell,
        heading: usize,
    ) -> Result<Foothold, NoFoothold> {
        let Self {
            config,
            rasters,
            ground,
            strips,
            ..
        } = self;
        let raster = &rasters[heading];
        let cells = CellsAround::of(map, middle, raster.reach).ok_or(NoFoothold::Unseen)?;
        let place = |cell: &CellUnder| cells.ground(map.heights_m(), cell, config);
        let top = |cell: &CellUnder| cells.ground(map.tops_m(), cell, config);
        ground.clear();
        ground.extend(raster.under.iter().map(place).filter(PlaceUnder::is_known));
        let all = raster.under.len() as f32;
        let least = config.least_bearing as f32;
        if (ground.len() as f32) < least * all {
            return Err(NoFoothold::Unseen);
        }
        let plane = RestingPlane::of(ground, &raster.fit).ok_or(NoFoothold::Unseen)?;
        if plane.steepness() > libm::tan(config.most_tilt) {
            return Err(NoFoothold::TooSteep);
        }
        strips.clear();
        strips.resize(raster.strips.len(), 0);
        let [bearing, unevenness] = bearing_on(&plane, ground, strips)?;
        let bears =
            |strip: usize| f32::from(strips[strip]) >= least * f32::from(raster.strips[strip]);
        let edge_m = |strip: usize| strip as f64 * raster.strip_m - raster.half_length_m;
        let bearing_m = run_around_middle(strips.len(), bears).map(edge_m);
        let bearing_share = bearing / all;
        if bearing_share < least || bearing_m[0] > -config.middle || bearing_m[1] < config.middle {
            return Err(NoFoothold::TooLittle);
        }
        // What was not seen is higher than nothing.
        let is_higher = |beside: PlaceUnder| plane.above_m(&beside) > beside.within_m;
        // What is known under the sole was looked at above; where levels meet, nobody knows just where, it may be high.
        let unknown = if ground.len() < raster.under.len() {
            raster.under.as_slice()
        } else {
            &[]
        };
        let mut beside = unknown.iter().chain(&raster.around).map(top);
        if beside.any(is_higher) {
            return Err(NoFoothold::Higher);
        }
        Ok(Foothold {
            height_m: plane.height_m,
            slope: plane.slope,
            bearing_m: bearing_m.map(|place_m| place_m as f32),
            bearing_share,
            unevenness,
            closed_share: raster.closed_share(map, middle, [plane.height_m, self.rise_m]),
        })
    }

    /// Whether nothing on the way of a foot is higher than this, m: over straight ground from one place to the other, turning on the way. Where
    /// the foot stands there is nothing, whatever the map has.
    pub fn is_way_free(
        &self,
        (map, blocks): (&HeightMap, &HighBlocks),
        (from, from_heading): (&PlanarPose, usize),
        (to, to_heading): (&PlanarPose, usize),
        than_m: f32,
    ) -> bool {
        let lattice = &map.lattice;
        let reach_m = self.sole.reach_m();
        let area = geometry::CellArea {
            min: lattice.cell_at(
                from.x_m.min(to.x_m) - reach_m,
                from.y_m.min(to.y_m) - reach_m,
            ),
            max: lattice.cell_at(
                from.x_m.max(to.x_m) + reach_m,
                from.y_m.max(to.y_m) + reach_m,
            ),
        };
        if !blocks.may_be_higher(area, than_m) {
            return true;
        }
        // No point of the way lies between two places that are half a sole's breadth apart.
        let places = (from.distance_m(to) / (0.5 * self.sole.width_m))
            .ceil()
            .max(1.0) as i32;
        let map_in_from = from.inverse();
        let half_m = [self.sole.length_m, self.sole.width_m]
            .map(|size_m| 0.5 * size_m + self.config.higher_margin);
        let stands_there = |cell: Cell| {
            let [x_m, y_m] = lattice.center_of(cell);
            let (ahead_m, left_m) = map_in_from.apply(x_m, y_m);
            ahead_m.abs() <= half_m[0] && left_m.abs() <= half_m[1]
        };
        (0..=places).all(|place| {
            let share = f64::from(place) / f64::from(places);
            let between = |from_m: f64, to_m: f64| from_m + share * (to_m - from_m);
            let middle = lattice.cell_at(between(from.x_m, to.x_m), between(from.y_m, to.y_m));
            let heading = if share < 0.5 {
                from_heading
            } else {
                to_heading
            };
            self.rasters[heading].under.iter().all(|cell| {
                let under = Cell::new(middle.col + cell.offset[0], middle.row + cell.offset[1]);
                let top_m = map.tops_m().get(under).copied();
                top_m.is_none_or(|top_m| top_m.is_nan() || top_m <= than_m) || stands_there(under)
            })
        })
    }
}

/// The cells around one, all of which are in the map.
struct CellsAround<'a> {
    map: &'a HeightMap,
    cols: isize,
    middle: isize,
}

impl<'a> CellsAround<'a> {
    /// Those up to so many cells away; `None` where the map ends before.
    fn of(map: &'a HeightMap, middle: Cell, reach: i32) -> Option<Self> {
        let heights_m = map.heights_m();
        let corner =
            |by: i32| Cell::new(middle.col.saturating_add(by), middle.row.saturating_add(by));
        let mut corners = [-reach, reach].into_iter().map(corner);
        corners
            .all(|cell| heights_m.index(cell).is_some())
            .then_some(())?;
        Some(Self {
            map,
            cols: heights_m.cols() as isize,
            middle: heights_m.index(middle)? as isize,
        })
    }

    fn ground(
        &self,
        heights_m: &Grid<f32>,
        cell: &CellUnder,
        config: &FootholdConfig,
    ) -> PlaceUnder {
        let [col, row] = cell.offset.map(|cells| cells as isize);
        let index = (self.middle + row * self.cols + col) as usize;
        let sigma_m = self.map.sigmas_m().values()[index];
        PlaceUnder {
            at_m: cell.at_m,
            height_m: heights_m.values()[index],
            strip: cell.strip,
            within_m: (config.level as f32).max(config.sigmas as f32 * sigma_m),
        }
    }
}

/// How many places bear of those under a sole that rests on a plane, counted by strip, too, and how uneven that is; none may be higher.
fn bearing_on(
    plane: &RestingPlane,
    ground: &[PlaceUnder],
    strips: &mut [u16],
) -> Result<[f32; 2], NoFoothold> {
    let (mut bearing, mut squares) = (0.0, 0.0);
    for place in ground {
        let off = plane.above_m(place) / place.within_m;
        if off > 1.0 {
            return Err(NoFoothold::Higher);
        }
        // What is so little lower may bear, too.
        if off >= -2.0 {
            squares += (off * off).min(1.0);
        }
        if off >= -1.0 {
            bearing += 1.0;
            strips[place.strip] += 1;
        }
    }
    Ok([bearing, squares / ground.len() as f32])
}

/// From which strip to before which all bear, around the middle one.
fn run_around_middle(strips: usize, bears: impl Fn(usize) -> bool) -> [usize; 2] {
    let middle = strips / 2;
    let from = (0..middle).rev().take_while(|&strip| bears(strip)).count();
    let to = (middle..strips).take_while(|&strip| bears(strip)).count();
    [middle - from, middle + to]
}

#[cfg(test)]
mod tests;
