//! How large a robot is against `qrio`, whose numbers the defaults of all settings are.

use settings::Scale;

use crate::{BodyError, Description};

/// Mass of `qrio`, kg.
const QRIO_KG: f64 = 7.0;

/// Of what is a metre away `qrio`'s camera sees so many pixels' disparity: focal length times baseline.
const QRIO_DISPARITY_M: f64 = 6.08;

/// Time between two frames of `qrio`'s camera, seconds.
const QRIO_PERIOD_S: f64 = 0.08;

impl Description {
    /// Refuses a size that no robot has.
    pub(crate) fn check_size(&self) -> Result<(), BodyError> {
        if (0.1..=10.0).contains(&self.scale) {
            return Ok(());
        }
        Err(BodyError::BadValue {
            what: "scale".to_owned(),
            allowed: "from 0.1 to 10",
            found: self.scale.to_string(),
        })
    }

    /// Its length, its mass, its camera's disparities and period over those of `qrio`. A robot whose scale is 1 has every number of `qrio`'s, whatever its mass.
    pub fn size(&self) -> Scale {
        if self.scale == 1.0 {
            return Scale::ONE;
        }
        let mass_kg: f64 = self.links.iter().map(|link| link.mass).sum();
        let camera = &self.camera;
        let disparity = camera.focal / camera.pool.max(1) as f64 * camera.stereo.baseline;
        Scale {
            length: self.scale,
            mass: mass_kg / QRIO_KG,
            disparity: disparity / QRIO_DISPARITY_M,
            period: camera.period / QRIO_PERIOD_S,
        }
    }
}
