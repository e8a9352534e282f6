//! What is in a room: pictures of depth grouped into planes and components, each told by its shape, and a map of labels that its
//! neighbours smooth (handbook, section 36.3.5, Figs 36.18 and 36.19).

mod groups;
mod labels;
mod map;
mod merging;
mod picture;
mod pixels;
mod plane_sums;
mod shapes;

pub use groups::{GroupingConfig, Groups, SceneGrouping};
pub use labels::{Label, LabelError, SceneClasses};
pub use map::{LabelMap, LabelMapConfig, LabelledCube};
pub use picture::{DepthPicture, PictureError};
pub use shapes::{Group, ShapesConfig};

#[cfg(test)]
mod tests;
