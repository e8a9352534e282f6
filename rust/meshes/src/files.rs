//! Meshes as files that other tools open: PLY and binary glTF.

use std::borrow::Cow;
use std::fmt::Write;

use gltf::binary::{Glb, Header};
use serde_json::{Value, json};

use crate::TriangleMesh;

/// What a mesh looks like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MeshLook<'a> {
    /// Nothing is known of it.
    Plain,
    /// Red, green and blue of each corner.
    Colours(&'a [[u8; 3]]),
    /// A picture, and where each corner is in it: from its left and upper border, shares of its width and height.
    Picture {
        /// The picture as a PNG file.
        png: &'a [u8],
        /// One a corner.
        places: &'a [[f32; 2]],
    },
}

/// Turns z up, as our frames have it, to y up, as glTF has it: a unit quaternion, x first.
const Y_UP: [f64; 4] = [
    -std::f64::consts::FRAC_1_SQRT_2,
    0.0,
    0.0,
    std::f64::consts::FRAC_1_SQRT_2,
];
// Numbers of the glTF specification: kinds of components and of what lies in a buffer.
const FLOAT: u16 = 5126;
const UNSIGNED_INT: u16 = 5125;
const UNSIGNED_BYTE: u16 = 5121;
const CORNERS: u16 = 34962;
const INDICES: u16 = 34963;

/// A PLY file: binary, little-endian, metres. Of a picture it holds the places alone, as `s` and `t`, since PLY holds no pictures; `t` goes up.
pub fn ply_file(mesh: &TriangleMesh, looks: MeshLook<'_>) -> Vec<u8> {
    let mut head = String::from("ply\nformat binary_little_endian 1.0\ncomment metres, z up\n");
    let more = match looks {
        MeshLook::Plain => "",
        MeshLook::Colours(_) => "property uchar red\nproperty uchar green\nproperty uchar blue\n",
        MeshLook::Picture { .. } => "property float s\nproperty float t\n",
    };
    let (corners, triangles) = (mesh.corners_m.len(), mesh.triangles.len());
    // To a string nothing fails.
    let _ = write!(
        head,
        "element vertex {corners}\nproperty float x\nproperty float y\nproperty float z\n{more}\
         element face {triangles}\nproperty list uchar int vertex_indices\nend_header\n"
    );
    let mut file = head.into_bytes();
    for (number, at_m) in mesh.corners_m.iter().enumerate() {
        file.extend(at_m.iter().flat_map(|part| part.to_le_bytes()));
        match looks {
            MeshLook::Plain => {}
            MeshLook::Colours(colours) => file.extend(colours.get(number).unwrap_or(&[0; 3])),
            MeshLook::Picture { places, .. } => {
                let [s, t] = places.get(number).copied().unwrap_or_default();
                file.extend([s, 1.0 - t].iter().flat_map(|part| part.to_le_bytes()));
            }
        }
    }
    for triangle in &mesh.triangles {
        file.push(triangle.len() as u8);
        file.extend(triangle.iter().flat_map(|corner| corner.to_le_bytes()));
    }
    file
}

/// A binary glTF file (`.glb`), with the picture in it; y is up, as the format wants it.
pub fn gltf_file(mesh: &TriangleMesh, looks: MeshLook<'_>) -> Result<Vec<u8>, gltf::Error> {
    let mut parts = GltfParts::default();
    let corners = mesh.corners_m.len();
    let mut low = [f32::INFINITY; 3];
    let mut high = [f32::NEG_INFINITY; 3];
    for at_m in &mesh.corners_m {
        for axis in 0..3 {
            low[axis] = low[axis].min(at_m[axis]);
            high[axis] = high[axis].max(at_m[axis]);
        }
    }
    let places = bytes_of(mesh.corners_m.as_flattened());
    let positions = parts.array(&places, (CORNERS, FLOAT), ("VEC3", corners));
    parts.arrays[positions]["min"] = json!(low);
    parts.arrays[positions]["max"] = json!(high);
    let numbers = mesh.triangles.as_flattened();
    let bytes: Vec<u8> = numbers.iter().flat_map(|one| one.to_le_bytes()).collect();
    let indices = parts.array(&bytes, (INDICES, UNSIGNED_INT), ("SCALAR", numbers.len()));
    let mut attributes = json!({ "POSITION": positions });
    let (material, more) = parts.appearance(looks, corners, &mut attributes);
    let mut root = json!({
        "asset": { "version": "2.0", "generator": "treadwell" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "rotation": Y_UP }],
        "meshes": [{ "primitives": [{ "attributes": attributes, "indices": indices, "material": 0 }] }],
        "materials": [material],
        "accessors": parts.arrays,
        "bufferViews": parts.views,
        "buffers": [{ "byteLength": parts.bytes.len() }],
    });
    if let (Some(root), Value::Object(more)) = (root.as_object_mut(), more) {
        root.extend(more);
    }
    let file = Glb {
        header: Header {
            magic: *b"glTF",
            version: 2,
            // Found by what writes it.
            length: 0,
        },
        json: Cow::Owned(root.to_string().into_bytes()),
        bin: Some(Cow::Owned(parts.bytes)),
    };
    file.to_vec()
}

fn bytes_of(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|one| one.to_le_bytes()).collect()
}

/// What a glTF file holds beside its description.
#[derive(Default)]
struct GltfParts {
    bytes: Vec<u8>,
    views: Vec<Value>,
    arrays: Vec<Value>,
}

impl GltfParts {
    /// Puts bytes behind the others, from a whole number of words on; the number of their view.
    fn view(&mut self, bytes: &[u8]) -> usize {
        let words = self.bytes.len().next_multiple_of(size_of::<u32>());
        self.bytes.resize(words, 0);
        let view = json!({ "buffer": 0, "byteOffset": words, "byteLength": bytes.len() });
        self.bytes.extend(bytes);
        self.views.push(view);
        self.views.len() - 1
    }

    /// An array of so many elements; its number.
    fn array(
        &mut self,
        bytes: &[u8],
        (target, component): (u16, u16),
        (kind, count): (&str, usize),
    ) -> usize {
        let view = self.view(bytes);
        self.views[view]["target"] = json!(target);
        self.arrays.push(json!({
            "bufferView": view, "componentType": component, "type": kind, "count": count,
        }));
        self.arrays.len() - 1
    }

    /// Puts what the mesh looks like into the arrays and into the attributes of its so many corners; the material, and what else the description
    /// holds.
    fn appearance(
        &mut self,
        looks: MeshLook<'_>,
        corners: usize,
        attributes: &mut Value,
    ) -> (Value, Value) {
        let mut material = json!({
            "doubleSided": true,
            "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": 1.0 },
        });
        let mut more = json!({});
        match looks {
            MeshLook::Plain => {}
            MeshLook::Colours(colours) => {
                // Four bytes each: arrays of corners are aligned.
                let bytes: Vec<u8> = colours
                    .iter()
                    .flat_map(|&[r, g, b]| [r, g, b, u8::MAX])
                    .collect();
                let at = self.array(&bytes, (CORNERS, UNSIGNED_BYTE), ("VEC4", corners));
                self.arrays[at]["normalized"] = json!(true);
                attributes["COLOR_0"] = json!(at);
            }
            MeshLook::Picture { png, places } => {
                let bytes = bytes_of(places.as_flattened());
                attributes["TEXCOORD_0"] =
                    json!(self.array(&bytes, (CORNERS, FLOAT), ("VEC2", corners)));
                let view = self.view(png);
                more = json!({
                    "images": [{ "bufferView": view, "mimeType": "image/png" }],
                    "textures": [{ "source": 0 }],
                });
                material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 0 });
            }
        }
        (material, more)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh() -> TriangleMesh {
        TriangleMesh {
            corners_m: vec![[0.0; 3], [1.0, 0.0, 0.5], [0.0, 2.0, 0.0], [1.0, 2.0, -1.0]],
            triangles: vec![[0, 1, 2], [2, 1, 3]],
        }
    }

    #[test]
    fn what_a_gltf_file_holds_is_read_back_by_another_reader() {
        let places = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
        let colours = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [9, 8, 7]];
        let png = b"no picture";
        for looks in [
            MeshLook::Plain,
            MeshLook::Colours(&colours),
            MeshLook::Picture {
                png,
                places: &places,
            },
        ] {
            let file = gltf_file(&mesh(), looks).unwrap();
            let read_back = gltf::Gltf::from_slice(&file).unwrap();
            let blob = read_back.blob.clone().unwrap();
            let primitive = read_back
                .meshes()
                .next()
                .unwrap()
                .primitives()
                .next()
                .unwrap();
            let reader = primitive.reader(|_| Some(&blob));
            let positions: Vec<_> = reader.read_positions().unwrap().collect();
            assert_eq!(positions, mesh().corners_m);
            let numbers: Vec<_> = reader.read_indices().unwrap().into_u32().collect();
            assert_eq!(numbers, mesh().triangles.as_flattened());
            match looks {
                MeshLook::Plain => assert!(reader.read_colors(0).is_none()),
                MeshLook::Colours(_) => {
                    let read: Vec<_> = reader.read_colors(0).unwrap().into_rgb_u8().collect();
                    assert_eq!(read, colours);
                }
                MeshLook::Picture { .. } => {
                    let read: Vec<_> = reader.read_tex_coords(0).unwrap().into_f32().collect();
                    assert_eq!(read, places);
                    let image = read_back.images().next().unwrap();
                    let gltf::image::Source::View { view, .. } = image.source() else {
                        panic!("no picture in the file");
                    };
                    let at = view.offset()..view.offset() + view.length();
                    assert_eq!(&blob[at], png);
                }
            }
        }
    }

    #[test]
    fn a_ply_file_is_as_long_as_its_head_says() {
        let plain = ply_file(&mesh(), MeshLook::Plain);
        let end = b"end_header\n";
        let head = plain.windows(end.len()).position(|at| at == end).unwrap() + end.len();
        assert_eq!(plain.len() - head, 4 * 12 + 2 * 13);
        let colours = ply_file(&mesh(), MeshLook::Colours(&[[1, 2, 3]; 4]));
        assert!(colours.windows(3).filter(|at| *at == [1, 2, 3]).count() >= 4);
    }
}
