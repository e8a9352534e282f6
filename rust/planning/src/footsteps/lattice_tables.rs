//! What depends on the size of the map's cells alone.

use geometry::PlanarPose;
use mapping::HeightMap;
use robot::Side;
use terrain::footholds::{Foothold, Footholds};

use super::config::FootstepsConfig;
use super::limits::StepLimits;
use super::plan::NoFootsteps;
use super::spots::StandingFoot;
use super::step_table::StepTable;

/// How finely steps are looked at: as the settings have it, and finer where there is no plan.
pub(super) const FINENESSES: usize = 2;

/// What depends on the size of the cells alone: steps between them, and the cells under a sole.
#[derive(Debug, Clone)]
pub(super) struct LatticeTables {
    pub(super) cell_m: f64,
    /// As the settings have them, and twice as fine.
    pub(super) steps: [StepTable; FINENESSES],
    pub(super) footholds: Footholds,
}

impl LatticeTables {
    pub(super) fn new(config: &FootstepsConfig, limits: &StepLimits, cell_m: f64) -> Self {
        let steps = [1, 2].map(|times| {
            let finer = FootstepsConfig {
                along: times * config.along,
                across: times * config.across,
                ..config.clone()
            };
            StepTable::new(&finer, limits, cell_m)
        });
        let foothold = config.foothold.clone();
        // Feet stand in the middles of cells.
        let on = ([0.0; 2], cell_m);
        let footholds = Footholds::new(
            foothold,
            (limits.sole, limits.careful_rise_m),
            steps[0].yaws_rad(),
            on,
        );
        Self {
            cell_m,
            steps,
            footholds,
        }
    }
}

/// How both feet stand where they do, whatever the map says of that: there they are.
pub(super) fn stand(
    map: &HeightMap,
    tables: &mut LatticeTables,
    feet: &[PlanarPose; 2],
) -> Result<[StandingFoot; 2], NoFootsteps> {
    let mut foot = |side: Side| {
        let pose = feet[side.index()];
        let cell = map.lattice.cell_at(pose.x_m, pose.y_m);
        let heading = tables.steps[0].nearest(pose.yaw_rad);
        let read = tables.footholds.read(map, cell, heading).ok();
        let on_height = |height_m: f32| Foothold {
            height_m,
            slope: [0.0; 2],
            bearing_m: [0.0; 2],
            bearing_share: 0.0,
            unevenness: 0.0,
            closed_share: 1.0,
        };
        let foothold = read.or_else(|| map.height_m(cell).map(on_height));
        let foothold = foothold.ok_or(NoFootsteps::UnseenStart(side))?;
        Ok(StandingFoot {
            side,
            pose,
            cell,
            heading,
            foothold,
        })
    };
    Ok([foot(Side::Left)?, foot(Side::Right)?])
}
