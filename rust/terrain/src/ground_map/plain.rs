//! What each cell of the map says by itself.

use std::borrow::Cow;

use geometry::{Cell, CellArea};
use mapping::{FloorView, Surface};

use super::config::GroundMapConfig;

/// What a cell of the view says by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Plain {
    Unseen,
    /// Not seen, in the midst of what is on one level, m.
    Missing(f32),
    /// Not seen, in the midst of ground on more than one level.
    Between,
    /// Ground on which no other level borders, m.
    Level(f32),
    /// Ground beside another level or none, m: where in the cell it ends is not known.
    Border(f32),
    /// Something that nobody stands on, up to this height, m.
    Obstacle(f32),
}

impl Plain {
    /// Its height, m, where it is ground.
    pub(super) const fn ground_m(self) -> Option<f32> {
        match self {
            Self::Level(height_m) | Self::Border(height_m) => Some(height_m),
            Self::Unseen | Self::Missing(_) | Self::Between | Self::Obstacle(_) => None,
        }
    }

    /// What it says of a cell in which something was seen that is no ground: that may be no false match.
    pub(super) const fn seen(self) -> Self {
        match self {
            Self::Between => Self::Unseen,
            other => other,
        }
    }

    /// What a cell of the view says by itself.
    pub(super) fn of(view: &FloorView, cell: Cell, config: &GroundMapConfig) -> Self {
        let level_m = config.level as f32;
        let others = || CellArea::of(cell).grown(1).cells();
        match view.cell(cell) {
            Surface::Obstacle(top_m) if !is_speck(view, cell, config.specks) => {
                Self::Obstacle(top_m)
            }
            Surface::Unknown | Surface::Obstacle(_) => {
                missing(view, cell, (level_m, config.surrounded))
            }
            Surface::Floor(height_m) => {
                let ends = |beside: Cell| match view.cell(beside) {
                    Surface::Floor(other_m) => (other_m - height_m).abs() > level_m,
                    Surface::Obstacle(_) => false,
                    // Beyond the unseen it goes on where the same level is seen again.
                    Surface::Unknown => {
                        let beyond = |times: i32| {
                            Cell::new(
                                cell.col + times * (beside.col - cell.col),
                                cell.row + times * (beside.row - cell.row),
                            )
                        };
                        ![2, 3]
                            .into_iter()
                            .any(|times| match view.cell(beyond(times)) {
                                Surface::Floor(other_m) => (other_m - height_m).abs() <= level_m,
                                Surface::Unknown | Surface::Obstacle(_) => false,
                            })
                    }
                };
                if others().any(ends) {
                    Self::Border(height_m)
                } else {
                    Self::Level(height_m)
                }
            }
        }
    }
}

/// The view without floor in an area that is a false match of the camera's: so few cells of one level, with no others of it near.
pub(super) fn without_strays<'a>(
    view: &'a FloorView,
    area: CellArea,
    config: &GroundMapConfig,
) -> Cow<'a, FloorView> {
    let level_m = config.level as f32;
    let is_stray = |cell: &Cell| {
        let Surface::Floor(height_m) = view.cell(*cell) else {
            return false;
        };
        let same = |other: &Cell| matches!(view.cell(*other), Surface::Floor(other_m) if (other_m - height_m).abs() <= level_m);
        let near = CellArea::of(*cell).grown(2).cells().filter(same);
        near.take(config.specks + 1).count() <= config.specks
    };
    let mut cleaned = Cow::Borrowed(view);
    for stray in area.cells().filter(is_stray) {
        if let Some(surface) = cleaned.to_mut().cells.get_mut(stray) {
            *surface = Surface::Unknown;
        }
    }
    cleaned
}

/// Whether an obstacle is a false match of the camera's: nothing that stands there fills so few cells.
fn is_speck(view: &FloorView, cell: Cell, specks: usize) -> bool {
    let near = CellArea::of(cell).grown(2).cells();
    let obstacles = near.filter(|&near| matches!(view.cell(near), Surface::Obstacle(_)));
    obstacles.take(specks + 1).count() <= specks
}

/// What a cell is of which nothing is known: what is missing in the midst of ground is no end of it.
fn missing(view: &FloorView, cell: Cell, (level_m, surrounded): (f32, usize)) -> Plain {
    let floor = |other: Cell| match view.cell(other) {
        Surface::Floor(height_m) => Some(height_m),
        Surface::Unknown | Surface::Obstacle(_) => None,
    };
    let around = CellArea::of(cell).grown(1);
    let (lowest_m, highest_m, count) = around.cells().filter_map(floor).fold(
        (f32::INFINITY, f32::NEG_INFINITY, 0),
        |(lowest_m, highest_m, count), height_m| {
            (height_m.min(lowest_m), height_m.max(highest_m), count + 1)
        },
    );
    if count < surrounded {
        Plain::Unseen
    } else if highest_m - lowest_m <= level_m {
        Plain::Missing(lowest_m)
    } else {
        Plain::Between
    }
}
