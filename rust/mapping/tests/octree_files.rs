//! OctoMap's files: read, written back byte for byte, and refused where they are broken.

#![expect(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests panic, too"
)]

use std::path::PathBuf;

use mapping::Update;
use proptest::prelude::*;
use volume::Ray;
use volume::octree::{Cast, Format, Octree, OctreeConfig, Sighting};

/// A file of OctoMap's, from the folder that `TREADWELL_DATA` names; without it the test says so and is over.
fn real_file(name: &str) -> Option<(PathBuf, Vec<u8>)> {
    let Some(folder) = std::env::var_os("TREADWELL_DATA") else {
        eprintln!("skipped: TREADWELL_DATA is not set");
        return None;
    };
    let path = PathBuf::from(folder).join("octomap").join(name);
    let bytes = std::fs::read(&path).expect("the folder holds OctoMap's files");
    Some((path, bytes))
}

fn tree(resolution: f64) -> Octree {
    Octree::new(OctreeConfig {
        resolution,
        ..OctreeConfig::default()
    })
    .unwrap()
}

fn header(format: &str, size: &str, res: &str) -> Vec<u8> {
    format!("# Octomap OcTree{format} file\n#\nid OcTree\nsize {size}\nres {res}\ndata\n")
        .into_bytes()
}

fn refusal(bytes: &[u8]) -> String {
    Octree::from_bytes("a.bt", bytes).unwrap_err().to_string()
}

#[test]
fn real_maps_are_written_back_byte_for_byte() {
    for (name, nodes) in [("geb079.bt", 532_566), ("fr_079.bt", 1_829_134)] {
        let Some((path, bytes)) = real_file(name) else {
            return;
        };
        let tree = Octree::read(&path).unwrap();
        assert_eq!(tree.node_count(), nodes, "{name}");
        assert!(tree.to_bytes(Format::Binary) == bytes, "{name}");
        // As .ot and back nothing is lost either.
        let full = tree.to_bytes(Format::Full);
        let again = Octree::from_bytes("again.ot", &full).unwrap();
        assert!(
            again.to_bytes(Format::Full) == full && again == tree,
            "{name}"
        );
    }
}

#[test]
fn a_truncated_map_is_refused_at_every_length() {
    let mut tree = tree(0.1);
    let rays = [
        Ray {
            end_m: [1.03, 0.52, 0.21],
            hit: true,
        },
        Ray {
            end_m: [-0.7, 0.3, 0.9],
            hit: true,
        },
    ];
    let _beyond = tree
        .insert([0.01, 0.02, 0.03], &rays, Update::PerFrame)
        .unwrap();
    for format in [Format::Binary, Format::Full] {
        let bytes = tree.to_bytes(format);
        for length in 0..bytes.len() {
            let said = refusal(&bytes[..length]);
            assert!(said.starts_with("a.bt: byte "), "{said}");
        }
        let longer = [&bytes[..], &[0]].concat();
        assert!(refusal(&longer).ends_with("1 bytes follow the last node"));
    }
}

#[test]
fn a_bad_header_is_refused_by_line() {
    let data = |format: &str, size: &str, res: &str, tail: &[u8]| {
        [&header(format, size, res)[..], tail].concat()
    };
    for (bytes, said) in [
        (b"PNG".to_vec(), "byte 0: an octree begins with"),
        (
            data(" binary", "0", "nan", &[]),
            "byte 48: res must be 0.001 to 10, got \"nan\"",
        ),
        (
            data(" binary", "0", "0", &[]),
            "res must be 0.001 to 10, got \"0\"",
        ),
        (data(" binary", "0", "-1", &[]), "res must be 0.001 to 10"),
        (
            data(" binary", "0", "1e-9", &[]),
            "res must be 0.001 to 10, got \"1e-9\"",
        ),
        (
            data(" binary", "0", "1e-320", &[]),
            "res must be 0.001 to 10",
        ),
        (
            data(" binary", "-3", "0.1", &[]),
            "size must be a number of nodes, got \"-3\"",
        ),
        (
            data(" binary", "99999999999999999999", "0.1", &[]),
            "size must be a number of nodes",
        ),
        (
            data(" binary", "18446744073709551615", "0.1", &[1, 0]),
            "the file holds 2 nodes, its header says",
        ),
        (
            data(" binary", "2", "0.1", &[0, 0]),
            "an inner node has no children",
        ),
        (
            data("", "1", "0.1", &[0, 0, 192, 127, 0]),
            "log-odds must be finite, got NaN",
        ),
        (
            b"# Octomap OcTree file\nid OcTreeStamped\n".to_vec(),
            "id must be OcTree or ColorOcTree, got \"OcTreeStamped\"",
        ),
        (
            b"# Octomap OcTree file\nsize 1\nres 1\ndata\n".to_vec(),
            "must say id, size and res",
        ),
        (
            b"# Octomap OcTree file\ncolour red\n".to_vec(),
            "\"colour\" is no line of a header",
        ),
    ] {
        let found = refusal(&bytes);
        assert!(found.contains(said), "{found}");
    }
}

#[test]
fn colours_are_passed_over() {
    let coloured = [
        b"# Octomap OcTree file\nid ColorOcTree\nsize 2\nres 0.1\ndata\n".to_vec(),
        [&0.5_f32.to_le_bytes()[..], &[1, 2, 3], &[0b10]].concat(),
        [&0.5_f32.to_le_bytes()[..], &[255, 0, 9], &[0]].concat(),
    ];
    let tree = Octree::from_bytes("a.ot", &coloured.concat()).unwrap();
    assert_eq!((tree.node_count(), tree.leaves().count()), (2, 1));
    assert_eq!(
        tree.leaves().next().unwrap().log_odds.to_bits(),
        0.5_f32.to_bits()
    );
    let short = [&coloured[0][..], &coloured[1], &coloured[2][..7]].concat();
    assert!(refusal(&short).ends_with("the file ends within the tree"));
}

#[test]
fn a_tree_for_which_memory_has_no_room_is_refused() {
    // Every inner node has four inner children: most bytes of memory for a byte of the file.
    fn node(depth: u32, body: &mut Vec<u8>) {
        if depth == 14 {
            body.extend([1, 0]);
            return;
        }
        body.extend([0xFF, 0xFF]);
        (0..8).for_each(|_| node(depth + 1, body));
    }
    let mut body = vec![];
    (0..6).for_each(|_| body.extend([3, 0]));
    node(6, &mut body);
    let bytes = [header(" binary", "1", "0.1"), body].concat();
    let said = refusal(&bytes);
    assert!(said.contains("the tree takes more than"), "{said}");
}

#[test]
fn a_tree_that_is_too_deep_is_refused() {
    // Every node has one inner child, for ever.
    let binary = [header(" binary", "100", "0.1"), [3, 0].repeat(99)].concat();
    let full = [header("", "100", "0.1"), [0, 0, 0, 0, 1].repeat(100)].concat();
    for bytes in [binary, full] {
        assert!(refusal(&bytes).contains("deeper than 16 levels"));
    }
}

#[test]
fn a_leaf_of_any_size_is_read_in_no_time() {
    // A quarter of all space is free, a quarter occupied: 2^46 voxels each.
    let bytes = [header(" binary", "5", "0.1"), vec![0b1010_0101, 0]].concat();
    let tree = Octree::from_bytes("a.bt", &bytes).unwrap();
    assert_eq!((tree.node_count(), tree.leaves().count()), (5, 4));
    assert!(tree.bytes() < 1000);
    assert!(
        tree.to_bytes(Format::Binary)
            .ends_with(&bytes[bytes.len() - 9..])
    );
    assert_eq!(tree.is_occupied_at([-1.0, 1.0, -1.0]), Some(true));
    assert_eq!(tree.is_occupied_at([-1.0, -1.0, -1.0]), Some(false));
    assert_eq!(tree.is_occupied_at([-1.0, 1.0, 1.0]), None);
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let said = Octree::read(&PathBuf::from("/no/such.bt"))
        .unwrap_err()
        .to_string();
    assert!(said.starts_with("/no/such.bt: "), "{said}");
    let said = tree(0.1)
        .write(&PathBuf::from("tree.xyz"))
        .unwrap_err()
        .to_string();
    assert_eq!(said, "tree.xyz: an octree's file must end in .bt or .ot");
}

proptest! {
    #[test]
    fn any_bytes_are_read_or_refused(tail in proptest::collection::vec(any::<u8>(), 0..400), binary in any::<bool>(), size in 0..60_usize) {
        let bytes = [header(if binary { " binary" } else { "" }, &size.to_string(), "0.05"), tail].concat();
        match Octree::from_bytes("fuzz", &bytes) {
            Ok(tree) => prop_assert!(tree.node_count() <= size),
            Err(error) => prop_assert!(error.to_string().starts_with("fuzz: byte ")),
        }
        prop_assert!(Octree::from_bytes("fuzz", &bytes[bytes.len() / 2..]).is_err());
    }

    #[test]
    fn a_broken_map_never_panics(at in any::<prop::sample::Index>(), byte in any::<u8>(), full in any::<bool>()) {
        let mut tree = tree(0.1);
        let rays: Vec<_> = (0..40).map(|i| {
            let angle = 0.15 * f64::from(i);
            Ray { end_m: [3.0 * libm::cos(angle), 3.0 * libm::sin(angle), 0.3 + 0.1 * angle], hit: true }
        }).collect();
        let _beyond = tree.insert([0.01, 0.02, 0.03], &rays, Update::PerFrame).unwrap();
        let mut bytes = tree.to_bytes(if full { Format::Full } else { Format::Binary });
        let at = at.index(bytes.len());
        bytes[at] = byte;
        if let Ok(tree) = Octree::from_bytes("fuzz", &bytes) {
            let _count = tree.leaves().count();
        }
    }
}

/// A ray and where it ends.
struct Reference {
    file: &'static str,
    origin: [f64; 3],
    direction: [f64; 3],
    through_unknown: bool,
    max_range_m: f64,
    /// Centre of the occupied voxel.
    end: Option<[f64; 3]>,
}

const FAR: f64 = f64::INFINITY;

/// What pyoctomap 1.2.2 says: `OcTree.readBinary`, `castRay(origin, direction, end, ignoreUnknownCells, maxRange)`.
#[rustfmt::skip]
const REFERENCES: [Reference; 8] = [
    Reference { file: "geb079.bt", origin: [20.109, 0.339, 0.648], direction: [-0.654, -0.13, 0.235], through_unknown: true, max_range_m: FAR, end: Some([14.68, -0.76, 2.6]) },
    Reference { file: "geb079.bt", origin: [24.44, 4.255, 0.427], direction: [-0.004, 0.656, -0.386], through_unknown: true, max_range_m: FAR, end: None },
    Reference { file: "geb079.bt", origin: [28.971, -0.638, 2.044], direction: [2.002, 0.189, -0.19], through_unknown: false, max_range_m: FAR, end: None },
    Reference { file: "geb079.bt", origin: [13.587, 4.593, 1.429], direction: [0.268, 0.359, 0.397], through_unknown: true, max_range_m: 4.0, end: Some([14.28, 5.48, 2.36]) },
    Reference { file: "fr_079.bt", origin: [26.202, -2.44, 2.297], direction: [-0.109, -0.804, 0.324], through_unknown: false, max_range_m: 4.0, end: None },
    Reference { file: "fr_079.bt", origin: [6.89, -2.178, 1.189], direction: [0.513, -0.298, -0.159], through_unknown: true, max_range_m: FAR, end: Some([8.025, -2.825, 0.825]) },
    Reference { file: "fr_079.bt", origin: [-6.592, -0.9, 2.018], direction: [-0.476, 0.163, -0.388], through_unknown: true, max_range_m: 4.0, end: None },
    Reference { file: "fr_079.bt", origin: [25.25, -1.241, 2.244], direction: [1.297, -0.346, 0.256], through_unknown: true, max_range_m: FAR, end: Some([25.675, -1.375, 2.325]) },
];

#[test]
fn rays_end_where_octomap_says() {
    for file in ["geb079.bt", "fr_079.bt"] {
        let Some((path, _)) = real_file(file) else {
            return;
        };
        let tree = Octree::read(&path).unwrap();
        for reference in REFERENCES.iter().filter(|reference| reference.file == file) {
            let &Reference {
                origin,
                direction,
                through_unknown,
                max_range_m,
                end,
                ..
            } = reference;
            match (
                tree.cast_ray(
                    origin,
                    direction,
                    Sighting {
                        max_range_m,
                        through_unknown,
                    },
                ),
                end,
            ) {
                (Cast::Occupied(found), Some(end)) => {
                    assert!(
                        (0..3).all(|a| (found[a] - end[a]).abs() < 1e-4),
                        "{found:?} {end:?}"
                    );
                }
                (Cast::Nothing | Cast::Unknown(_), None) => {}
                (found, end) => panic!("{found:?}, expected {end:?}"),
            }
        }
    }
}
