//! Parameters of the floor and obstacle grid, checked once.

use settings::{
    ConfigError, NOT_NEGATIVE, POSITIVE, SHARE, at_least, between, require, settings, within,
};
use volume::{Clearing, Update};

use super::FogTuning;

settings! {
    /// The floor and obstacle grid of Gutmann, Fukuchi and Fujita 2005 (000). The paper names its parameters without values, but for
    /// the grid's size; the defaults were tried on scenes with stairs.
    pub struct FogConfig("navigation.fog") {
        /// Side of a cell.
        cell: f64 = 0.04, "m", within(0.001, 10.0), "000, section III";
        /// Cells along each side of the window.
        cells: usize = 100, "1", within(4.0, FogConfig::MOST_CELLS as f64), "000, section III";
        /// Layers of the occupancy grid.
        layers: usize = 32, "1", within(1.0, 64.0), "000, section III: 16; the robot's height above the highest floor that it climbs to";
        /// Height of a layer.
        layer: f64 = 0.04, "m", within(0.001, 10.0), "000, section III";
        /// Height at which layers begin: a lower bound of one of them. -0.02 keeps a floor at 0 in the middle of its layer.
        layer_origin: f64 = -0.02, "m", settings::ANY;
        /// The layers follow the robot's height in whole layers; otherwise `layer_origin` is the lowest bound.
        follow_height: bool = true, "-", settings::ANY;
        /// Layers below the one that the robot stands in, where they follow its height.
        layers_below: usize = 8, "1", NOT_NEGATIVE;
        /// How likely a voxel is occupied where a point lies, by the sensor alone.
        p_sense: f64 = 0.7, "1", between(0.5, 1.0), "000, equation (12): P_sense";
        /// A voxel that is more likely occupied than this counts as occupied.
        p_occ: f64 = 0.7, "1", between(0.5, 1.0), "000, inequality (7): P_occ";
        /// No voxel is less likely occupied than this: how soon something that appears is believed.
        p_min: f64 = 0.05, "1", between(0.0, 0.5);
        /// No voxel is more likely occupied than this: how soon something that vanished is forgotten.
        p_max: f64 = 0.95, "1", between(0.5, 1.0);
        /// Floor heights that differ by no more than this are those of one surface.
        epsilon: f64 = 0.015, "m", NOT_NEGATIVE, "000, equation (9)";
        /// Weight of the height that is known beside the one that is seen, once a cell and frame (once a point with `per_point`).
        nu: f64 = 0.9, "1", SHARE, "000, equation (9)";
        /// What rises less than this above a floor is no obstacle.
        delta: f64 = 0.028, "m", NOT_NEGATIVE, "000, equation (11)";
        /// Where a cell's own floor is not known, what does not stand out of the highest floor this near is no obstacle. 0: all that is
        /// there is one, as the paper has it.
        floor_beside: f64 = 0.04, "m", NOT_NEGATIVE;
        /// Floor that seems to lie this near behind an obstacle is not believed. 0: it is, as in the paper.
        shadow: f64 = 0.12, "m", NOT_NEGATIVE;
        /// Level surfaces that are more times as rough as the ground, root mean square in disparity, are no floor. Left out: all are, as
        /// in the paper.
        rough: Option<f64> = Some(1.6), "1", POSITIVE;
        /// Room that the robot needs above a floor: what begins higher is a ceiling to pass under. Left out: the robot's own height;
        /// for a map without a robot whatever rises above a floor is an obstacle, as the paper has it.
        headroom: Option<f64> = None, "m", POSITIVE, "000, section VI";
        /// How often a frame may change a voxel: once (`per_frame`), or with every ray (`per_point`).
        update: Update = Update::PerFrame, "-", settings::ANY;
        /// How rays are followed with `per_frame`: `shared`, `every_ray` (slower; the same map) or `projected` (faster; frees a bit less).
        clearing: Clearing = Clearing::Shared, "-", settings::ANY;
        /// Points of a horizontal plane are moved along their ray to the plane's height.
        snap: bool = true, "-", settings::ANY, "000, section III.A, step 2";
        /// Points that are further away than this only clear the way up to it.
        max_range: f64 = 4.0, "m" of camera, POSITIVE;
        /// Floor that is seen from further away than this counts as no sighting: at 1.2 m and beyond, a step of 30 mm is so little of a
        /// pixel that the treads of stairs run into each other and into the ground.
        sure_range: f64 = 1.2, "m", NOT_NEGATIVE;
        /// Frames are shifted in height to fit the known floor by at most this.
        match_gate: f64 = 0.02, "m", NOT_NEGATIVE, "000, section IV";
        /// Points that must fit the known floor before a frame is shifted, or used without a ground plane.
        min_pairs: usize = 150, "1", at_least(1.0);
        /// Unseen cells up to this far from the robot's middle are shown as floor at its height, since it stands there.
        footprint: f64 = 0.12, "m", NOT_NEGATIVE;
        /// Numbers that few will want to turn.
        tuning: FogTuning;
    }
    require (p_occ) < (p_max);
    check FogConfig::is_ordered;
}

impl FogConfig {
    /// Cells along each side of the window at most: more would not fit into memory.
    pub(crate) const MOST_CELLS: usize = 2000;

    /// The settings with what follows from the robot: the room that it needs above a floor, m, where nothing else is set.
    #[must_use]
    pub fn for_robot(self, headroom_m: Option<f64>) -> Self {
        Self {
            headroom: self.headroom.or(headroom_m),
            ..self
        }
    }

    fn is_ordered(&self, key: &str) -> Result<(), ConfigError> {
        let below = self.layers_below;
        let allowed = format!("< layers ({})", self.layers);
        let holds = !self.follow_height || below < self.layers;
        require(holds, &format!("{key}.layers_below"), &allowed, below)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use settings::Table;

    #[test]
    fn defaults_are_accepted() {
        FogConfig::default().check().unwrap();
    }

    #[test]
    fn a_bad_value_is_refused_by_its_key() {
        let refused = |config: FogConfig| config.check().unwrap_err().to_string();
        let base = FogConfig::default;
        assert_eq!(
            refused(FogConfig {
                cell: 0.0,
                ..base()
            }),
            "navigation.fog.cell must be from 0.001 to 10, got 0"
        );
        assert_eq!(
            refused(FogConfig {
                cell: 1e-12,
                ..base()
            }),
            "navigation.fog.cell must be from 0.001 to 10, got 1e-12"
        );
        assert!(
            refused(FogConfig {
                nu: f64::NAN,
                ..base()
            })
            .contains("navigation.fog.nu")
        );
        assert!(
            refused(FogConfig {
                p_occ: 0.5,
                ..base()
            })
            .contains("navigation.fog.p_occ")
        );
        assert!(
            refused(FogConfig {
                p_occ: 0.96,
                ..base()
            })
            .contains("< p_max (0.95)")
        );
        assert!(
            refused(FogConfig {
                headroom: Some(-0.6),
                ..base()
            })
            .contains("navigation.fog.headroom")
        );
        assert!(
            refused(FogConfig {
                layers: 65,
                ..base()
            })
            .contains("from 1 to 64")
        );
        assert!(
            refused(FogConfig {
                layers_below: 32,
                ..base()
            })
            .contains("layers_below")
        );
    }

    #[test]
    fn the_numbers_behind_are_refused_by_their_keys_too() {
        let mut config = FogConfig::default();
        config.tuning.matching.window = 41;
        assert_eq!(
            config.check().unwrap_err().to_string(),
            "navigation.fog.tuning.matching.window must be <= bins (40), got 41"
        );
    }

    #[test]
    fn an_unknown_key_is_refused() {
        let error = serde_json::from_str::<FogConfig>(r#"{"cel": 1}"#).unwrap_err();
        assert!(error.to_string().contains("unknown field `cel`"));
        let paper: FogConfig =
            serde_json::from_str(r#"{"update": "per_point", "layers": 16}"#).unwrap();
        assert_eq!((paper.update, paper.cell), (Update::PerPoint, 0.04));
    }
}
