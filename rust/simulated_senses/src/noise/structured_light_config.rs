//! What a structured-light camera is like.

use std::f64::consts::FRAC_PI_2;

use settings::{ConfigError, NOT_NEGATIVE, POSITIVE, SHARE, above_to, require, settings, within};

settings! {
    /// The errors of a structured-light camera.
    pub struct StructuredLightConfig("camera.structured_light") {
        /// Distance from the camera to the projector, which is on its right.
        baseline: f64 = 0.075, "m", POSITIVE;
        /// Pixels a side over which the noise is the same.
        window: usize = 2, "px", within(1.0, 101.0);
        /// Deviation of the whole error of a disparity, its rounding included.
        disparity_noise: f64 = 0.03125, "px", NOT_NEGATIVE, "Khoshelham and Oude Elberink, Sensors 12, 2012";
        /// Step of the disparities; 0 for none.
        quantum: f64 = 0.0625, "px", NOT_NEGATIVE;
        /// What is nearer is not seen.
        nearest: f64 = 0.5, "m", POSITIVE;
        /// What is farther is not seen.
        farthest: f64 = 4.0, "m", POSITIVE;
        /// Deviation of where a border is seen.
        lateral_noise: f64 = 0.4, "px", within(0.0, 20.0), "Nguyen, Izadi and Lovell, 3DIMPVT 2012";
        /// A larger step in disparity between neighbours is a border.
        edge_jump: f64 = 0.5, "px", POSITIVE;
        /// Share of the pixels at borders that are missing.
        edge_dropout: f64 = 0.015, "1", SHARE;
        /// What is looked at more slantingly is not seen; from the surface's normal.
        steepest: f64 = 1.396, "rad", above_to(0.0, FRAC_PI_2);
    }
    check StructuredLightConfig::fits;
}

impl StructuredLightConfig {
    fn fits(&self, key: &str) -> Result<(), ConfigError> {
        let ordered = self.nearest < self.farthest;
        require(
            ordered,
            &format!("{key}.nearest"),
            "below farthest",
            self.nearest,
        )?;
        let wanted = "at least the deviation of rounding to the quantum";
        let enough = self.disparity_noise >= rounding_px(self.quantum);
        require(
            enough,
            &format!("{key}.disparity_noise"),
            wanted,
            self.disparity_noise,
        )
    }

    /// Deviation of what is added to a disparity before it is rounded, px.
    pub(super) fn unrounded_px(&self) -> f64 {
        let rounding = rounding_px(self.quantum);
        let rest = self.disparity_noise * self.disparity_noise - rounding * rounding;
        rest.max(0.0).sqrt()
    }
}

/// Deviation of what rounding to steps of `quantum` adds, px.
fn rounding_px(quantum: f64) -> f64 {
    quantum / f64::from(12_u32).sqrt()
}

#[cfg(test)]
mod tests {
    use settings::Table;

    use super::*;

    #[test]
    fn what_no_camera_could_be_is_refused_by_its_key() {
        assert_eq!(StructuredLightConfig::default().check(), Ok(()));
        let noise = StructuredLightConfig {
            disparity_noise: 0.01,
            ..StructuredLightConfig::default()
        };
        let refused = noise.check().unwrap_err().to_string();
        assert!(refused.starts_with("camera.structured_light.disparity_noise must be at least"));
        let near = StructuredLightConfig {
            nearest: 5.0,
            ..StructuredLightConfig::default()
        };
        assert!(near.check().is_err());
    }
}
