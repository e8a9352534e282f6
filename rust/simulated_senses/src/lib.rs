//! The simulator's depth camera. It knows the true scene, so that nothing of the core may use it: only the bindings do.
//!
//! A [`TrueScene`] is drawn into a [`TruePicture`] by a [`DepthRaster`]: the box around each geom is projected, every pixel in it gets
//! a real ray, and the nearest geom wins. [`StereoErrors`] and [`StructuredLightErrors`] make of it what a camera would have measured.

mod error;
mod eye;
mod noise;
mod picture;
mod pinhole;
mod raster;
mod scene;
mod shapes;
mod view;

pub use error::SceneError;
pub use eye::CameraPose;
pub use noise::{
    CreaseTuning, MatchTuning, PatternTuning, StereoConfig, StereoErrors, StereoTuning,
    StructuredLightConfig, StructuredLightErrors,
};
pub use picture::TruePicture;
pub use pinhole::Pinhole;
pub use raster::{DepthRaster, RasterConfig};
pub use scene::{Form, Geom, GeomPoses, TrueScene};
pub use shapes::{HeightField, Mesh};
