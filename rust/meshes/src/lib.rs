//! Surfaces as triangles (004, section 36.3.3): of one depth image or cloud, where neighbours are on one surface and nowhere else; of many,
//! fused in a volume; simplified, textured, and as files.

mod cloud;
mod files;
mod fusion;
mod joining;
mod mesh;
mod picture;
mod simplify;
mod texture;
mod topology;

pub use cloud::{CloudMeshError, SeenFrom, mesh_of_cloud};
pub use files::{MeshLook, gltf_file, ply_file};
pub use fusion::{FusedVolume, FusionConfig, PictureRanges, SurfacePiece};
pub use joining::{JoiningConfig, JoiningRule};
pub use mesh::TriangleMesh;
pub use picture::{SeenMesh, mesh_of_picture};
pub use simplify::{SimplifyConfig, simplified};
pub use texture::{TextureView, TexturedMesh, textured};
pub use topology::{Topology, parts};
