//! Parameters of the floor and obstacle grid, checked once.

use serde::{Deserialize, Serialize};
use settings::{ConfigError, require};
use volume::{Clearing, Update};

/// Parameters of the floor and obstacle grid: `[navigation.fog]`. The paper names them without values, except for the
/// grid's size; the defaults were tried on scenes with stairs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FogConfig {
    /// Side of a cell, m.
    pub cell: f64,
    /// Cells along each side of the window.
    pub cells: usize,
    /// Layers of the occupancy grid, at most 64.
    pub layers: usize,
    /// Height of a layer, m.
    pub layer: f64,
    /// Where layers begin, m: a lower bound of one of them. -0.02 keeps a floor at 0 in the middle of its layer.
    pub layer_origin: f64,
    /// Whether the layers follow the robot's height in whole layers; false: `layer_origin` is the lowest bound.
    pub follow_height: bool,
    /// Layers below the one that the robot stands in, when they follow its height.
    pub layers_below: usize,
    /// `P_sense` of equation (12): how likely a voxel is occupied where a point lies.
    pub p_sense: f64,
    /// `P_occ` of inequality (7): from where on a voxel counts as occupied.
    pub p_occ: f64,
    /// Lower limit of probabilities: how soon something that appears is believed.
    pub p_min: f64,
    /// Upper limit of probabilities: how soon something that vanished is forgotten.
    pub p_max: f64,
    /// Equation (9): floor heights within this are the same surface, m.
    pub epsilon: f64,
    /// Equation (9): weight of the height that is known, 0 to 1, once a cell and frame (once a point with `per_point`).
    pub nu: f64,
    /// Equation (11): what rises less than this above a floor is no obstacle, m.
    pub delta: f64,
    /// Where a cell's own floor is not known, what does not stand out of the highest floor this near is no obstacle, m; 0: all
    /// that is there is one, as the paper has it.
    pub floor_beside: f64,
    /// Floor that seems to lie this near behind an obstacle is not believed, m; 0: it is, as in the paper.
    pub shadow: f64,
    /// Level surfaces that are more times as rough as the ground, root mean square in disparity, are no floor. None: all are, as in
    /// the paper.
    pub rough: Option<f64>,
    /// Room that the robot needs above a floor, m: what begins higher is a ceiling to pass under. None: whatever rises above a
    /// floor is an obstacle, as the paper has it.
    pub headroom: Option<f64>,
    /// How often a frame may change a voxel: `per_frame` or `per_point`.
    pub update: Update,
    /// How rays are followed with `per_frame`: `shared`, `every_ray` (slower; the same map) or `projected` (faster; frees a bit less).
    pub clearing: Clearing,
    /// Whether points of a horizontal plane are moved along their ray to the plane's height.
    pub snap: bool,
    /// Points further away than this are only used to clear the way up to it, m.
    pub max_range: f64,
    /// Floor that is seen from further away than this counts as no sighting, m: at 1.2 m and beyond, a step of 30 mm is so little
    /// of a pixel that the treads of stairs run into each other and into the ground.
    pub sure_range: f64,
    /// Frames are shifted in height to fit the known floor by at most this, m.
    pub match_gate: f64,
    /// Points that must fit the known floor before a frame is shifted, or used without a ground plane.
    pub min_pairs: usize,
    /// Radius around the robot in which unseen cells are shown as floor at its height (it stands there), m.
    pub footprint: f64,
}

impl Default for FogConfig {
    fn default() -> Self {
        Self {
            cell: 0.04,
            cells: 100,
            layers: 24,
            layer: 0.04,
            layer_origin: -0.02,
            follow_height: true,
            layers_below: 8,
            p_sense: 0.7,
            p_occ: 0.7,
            p_min: 0.05,
            p_max: 0.95,
            epsilon: 0.015,
            nu: 0.9,
            delta: 0.028,
            floor_beside: 0.04,
            shadow: 0.12,
            rough: Some(1.6),
            headroom: None,
            update: Update::PerFrame,
            clearing: Clearing::Shared,
            snap: true,
            max_range: 4.0,
            sure_range: 1.2,
            match_gate: 0.02,
            min_pairs: 150,
            footprint: 0.12,
        }
    }
}

impl FogConfig {
    /// The paper's size: 16 layers that stay where they are.
    pub fn paper() -> Self {
        Self {
            layers: 16,
            follow_height: false,
            floor_beside: 0.0,
            shadow: 0.0,
            rough: None,
            ..Self::default()
        }
    }

    /// Cells along each side of the window at most.
    pub(crate) const MOST_CELLS: usize = 2000;

    /// Refuses what cannot be used.
    pub fn check(&self) -> Result<(), ConfigError> {
        let positive = |key: &str, value: f64| {
            require(value > 0.0 && value.is_finite(), &name(key), "> 0", value)
        };
        let not_negative = |key: &str, value: f64| {
            require(value >= 0.0 && value.is_finite(), &name(key), ">= 0", value)
        };
        let between = |key: &str, value: f64, low: f64, high: f64| {
            let allowed = format!("> {low} and < {high}");
            require(value > low && value < high, &name(key), &allowed, value)
        };
        require_usable_side(&name("cell"), self.cell)?;
        require(
            (4..=Self::MOST_CELLS).contains(&self.cells),
            &name("cells"),
            &format!("4 to {}", Self::MOST_CELLS),
            self.cells,
        )?;
        require(
            (1..=64).contains(&self.layers),
            &name("layers"),
            "1 to 64",
            self.layers,
        )?;
        require_usable_side(&name("layer"), self.layer)?;
        let origin = self.layer_origin;
        require(origin.is_finite(), &name("layer_origin"), "finite", origin)?;
        let below = self.layers_below;
        let allowed = format!("< layers ({})", self.layers);
        let holds = !self.follow_height || below < self.layers;
        require(holds, &name("layers_below"), &allowed, below)?;
        between("p_sense", self.p_sense, 0.5, 1.0)?;
        between("p_min", self.p_min, 0.0, 0.5)?;
        between("p_max", self.p_max, 0.5, 1.0)?;
        between("p_occ", self.p_occ, 0.5, self.p_max)?;
        not_negative("epsilon", self.epsilon)?;
        require(
            (0.0..=1.0).contains(&self.nu),
            &name("nu"),
            "0 to 1",
            self.nu,
        )?;
        not_negative("delta", self.delta)?;
        not_negative("floor_beside", self.floor_beside)?;
        not_negative("shadow", self.shadow)?;
        if let Some(rough) = self.rough {
            positive("rough", rough)?;
        }
        if let Some(headroom) = self.headroom {
            positive("headroom", headroom)?;
        }
        positive("max_range", self.max_range)?;
        not_negative("sure_range", self.sure_range)?;
        not_negative("match_gate", self.match_gate)?;
        require(
            self.min_pairs > 0,
            &name("min_pairs"),
            "> 0",
            self.min_pairs,
        )?;
        not_negative("footprint", self.footprint)
    }
}

/// A side of a cell, m, finer than any robot sees, or coarser than what it walks on, makes maps that take for ever or say nothing.
pub(crate) fn require_usable_side(name: &str, side_m: f64) -> Result<(), ConfigError> {
    require(side_m > 0.0 && side_m.is_finite(), name, "> 0", side_m)?;
    let usable = (0.001..=10.0).contains(&side_m);
    require(usable, name, "0.001 to 10", side_m)
}

fn name(key: &str) -> String {
    format!("navigation.fog.{key}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_and_the_papers_set_are_accepted() {
        FogConfig::default().check().unwrap();
        FogConfig::paper().check().unwrap();
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
            "navigation.fog.cell must be > 0, got 0"
        );
        assert_eq!(
            refused(FogConfig {
                cell: 1e-12,
                ..base()
            }),
            "navigation.fog.cell must be 0.001 to 10, got 0.000000000001"
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
            .contains("< 0.95")
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
            .contains("1 to 64")
        );
        assert!(
            refused(FogConfig {
                layers_below: 24,
                ..base()
            })
            .contains("layers_below")
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
