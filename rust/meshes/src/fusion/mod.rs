//! Many frames as one surface: a truncated signed distance volume (Curless and Levoy 1996) in hashed blocks (Niessner et al. 2013), of which
//! a manifold mesh is made.

mod block;
mod cases;
mod config;
mod insertion;
mod sight;
mod surface;

use nalgebra::Vector3;
use sensing::RangeNoise;
use settings::{ConfigError, Table};
use volume::{GridKey, SparseGrid};

use crate::joining::JoiningConfig;
use crate::mesh::TriangleMesh;
use block::{DistanceBlock, EDGE};
pub use config::FusionConfig;
use insertion::SightPrism;
pub use sight::PictureRanges;
pub use surface::SurfacePiece;

/// Signed distances to the surface that all frames saw, near it.
#[derive(Debug, Clone)]
pub struct FusedVolume {
    config: FusionConfig,
    noise: RangeNoise,
    /// Sine of the smallest angle at which a surface is taken to be seen.
    flattest: f64,
    blocks: SparseGrid<DistanceBlock>,
    /// The block of the last voxel.
    last: Option<(GridKey, usize)>,
}

impl FusedVolume {
    /// A volume of which nothing is known, for a sensor.
    pub fn new(
        config: FusionConfig,
        joining: &JoiningConfig,
        noise: RangeNoise,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            flattest: libm::sin(joining.grazing),
            config,
            noise,
            blocks: SparseGrid::new(),
            last: None,
        })
    }

    /// Blocks of voxels of which something is known.
    pub const fn blocks(&self) -> usize {
        self.blocks.len()
    }

    /// How far from the surface distances are measured at a range, m.
    fn reach_m(&self, range_m: f64) -> f64 {
        let deviation_m = f64::from(self.noise.deviation_m(range_m as f32));
        let least_m = self.config.truncation * self.config.voxel;
        least_m.max(self.config.deviations * deviation_m)
    }

    fn weight(&self, range_m: f64) -> f32 {
        self.noise.variance_m2(range_m as f32).recip()
    }

    /// Takes in a mesh of one frame, in the map frame, all of whose triangles face the eye, m.
    pub fn insert(&mut self, mesh: &TriangleMesh, eye_m: [f64; 3]) {
        for position in 0..self.blocks.len() {
            self.blocks.at_mut(position).1.begin_frame();
        }
        let normals = mesh.normals(self.config.smoothing);
        let eye_m = Vector3::from(eye_m);
        let prisms = mesh.triangles.iter().filter_map(|&triangle| {
            let reach_m = |range_m| self.reach_m(range_m);
            SightPrism::new((mesh, &normals), triangle, eye_m, self.flattest, reach_m)
        });
        let prisms: Vec<_> = prisms.collect();
        for prism in &prisms {
            self.measure(prism);
        }
        for prism in &prisms {
            self.measure_before(prism);
        }
    }

    /// The block of a voxel, and where the voxel is stored in it.
    fn voxel(&mut self, voxel: GridKey) -> (&mut DistanceBlock, usize) {
        let key = voxel.map(|at| at.div_euclid(EDGE));
        let position = match self.last {
            Some((last, position)) if last == key => position,
            _ => self.blocks.position_or_insert(key, DistanceBlock::unknown),
        };
        self.last = Some((key, position));
        let index = DistanceBlock::index(voxel.map(|at| at.rem_euclid(EDGE)));
        (self.blocks.at_mut(position).1, index)
    }

    /// Takes in what lies straight before a triangle where no line of sight told of it: near an edge lines of sight pass over it.
    fn measure_before(&mut self, prism: &SightPrism) {
        let (weight, most) = (self.weight(prism.range_m), self.config.memory as f32);
        let voxel_m = self.config.voxel;
        prism.each_before(voxel_m, self.config.solid * voxel_m, |voxel, before_m| {
            let (block, index) = self.voxel(voxel);
            if !block.is_fresh(index) {
                block.voxels[index].fuse(before_m as f32, weight, most, true);
                block.mark(index);
            }
        });
    }

    fn measure(&mut self, prism: &SightPrism) {
        let reach_m = self.reach_m(prism.range_m);
        let weight = self.weight(prism.range_m);
        let most = self.config.memory as f32;
        // As far behind the surface as noise goes nothing is deep.
        let solid_m = self.config.solid * self.config.voxel;
        let noise_m = self.config.deviations * f64::from(weight.sqrt().recip());
        let solid_m = solid_m.max(noise_m);
        prism.each(self.config.voxel, |voxel, before_m| {
            let across_m = before_m * prism.lean;
            if across_m < -reach_m || across_m > reach_m {
                return;
            }
            let (block, index) = self.voxel(voxel);
            let voxel = &mut block.voxels[index];
            // Deep behind a surface is only taken to be solid: what was measured nearer to another one is surer.
            let (deep, was_deep) = (across_m < -solid_m, f64::from(voxel.mean_m) < -solid_m);
            if deep && voxel.weight > 0.0 && !was_deep {
                return;
            }
            if was_deep && !deep {
                voxel.weight = 0.0;
            }
            voxel.fuse(across_m as f32, weight, most, false);
            block.mark(index);
        });
    }

    /// Takes back what lines of sight of the frame that was just taken in pass through: what is there is free, whatever was before.
    pub fn see_through(&mut self, seen: &PictureRanges) {
        let (voxel_m, patience) = (self.config.voxel, self.config.patience as f32);
        let radius_m = voxel_m * f64::from(EDGE);
        for position in 0..self.blocks.len() {
            let (key, _) = self.blocks.at(position);
            let corner_m = Vector3::from(key.map(|at| f64::from(at * EDGE) * voxel_m));
            if !seen.may_hold(corner_m.add_scalar(0.5 * radius_m), radius_m) {
                continue;
            }
            let count = self.blocks.at(position).1.voxels.len();
            for index in 0..count {
                let block = self.blocks.at(position).1;
                if block.voxels[index].weight == 0.0 || block.is_fresh(index) {
                    continue;
                }
                let place = Vector3::from(DistanceBlock::place(index).map(f64::from));
                let Some((there_m, range_m)) = seen.at(corner_m + place * voxel_m) else {
                    continue;
                };
                let reach_m = self.reach_m(range_m);
                if range_m - there_m > reach_m {
                    let weight = self.weight(range_m);
                    let voxel = &mut self.blocks.at_mut(position).1.voxels[index];
                    voxel.fuse(reach_m as f32, weight, patience, true);
                }
            }
        }
    }

    /// Forgets what is further than this from a place, m.
    pub fn forget_beyond(&mut self, place_m: [f64; 3], most_m: f64) {
        let side_m = self.config.voxel * f64::from(EDGE);
        let place = Vector3::from(place_m);
        self.last = None;
        self.blocks.retain(|key, _| {
            let middle = Vector3::from(key.map(|at| (f64::from(at) + 0.5) * side_m));
            (middle - place).norm() <= most_m
        });
    }
}
