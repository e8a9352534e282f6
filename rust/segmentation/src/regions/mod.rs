//! Regions of one surface each: how they are fitted, cut, told apart and described.

pub(crate) mod cuts;
pub(crate) mod finder;
pub(crate) mod fit;
pub(crate) mod region;
pub(crate) mod roughness;
pub(crate) mod slivers;
pub(crate) mod slopes;
pub(crate) mod steps;
pub(crate) mod surfaces;
pub(crate) mod tilted;
pub(crate) mod walls;

pub(crate) use cuts::{Cuts, TiltPrior};
pub(crate) use finder::{Finder, Look};
pub(crate) use fit::{FitTuning, shared_tilt};
pub(crate) use region::Region;
pub(crate) use roughness::{Roughness, RoughnessTuning};
pub(crate) use slivers::{SliverTuning, Slivers};
pub(crate) use slopes::SlopeSearch;
pub(crate) use steps::{StepMarks, StepTuning};
pub(crate) use surfaces::{FrameSurfaces, SurfaceParts, SurfaceTuning};
pub(crate) use tilted::{PlaneSums, TiltedRecord, TiltedTuning, over_rays};
pub(crate) use walls::{WallTuning, Walls};
