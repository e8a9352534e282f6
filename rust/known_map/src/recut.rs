//! The known map in voxels of another size.

use settings::{ConfigError, require};
use volume::octree::{Leaf, Octree, OctreeConfig};

/// A map in voxels of another size, which is refused by its key where it makes more than `most_voxels`: what holds a part of something solid is solid.
pub(crate) fn recut(
    tree: &Octree,
    config: &OctreeConfig,
    key: &str,
    most_voxels: f64,
) -> Result<Octree, ConfigError> {
    let mut other = Octree::new(config.clone())?;
    let solid = || tree.leaves().filter(Leaf::is_occupied);
    let side_m = |leaf: &Leaf| f64::from(leaf.edge()) * tree.config.resolution;
    let parts = |leaf: &Leaf| (side_m(leaf) / config.resolution - 1e-6).ceil();
    let voxels: f64 = solid().map(|leaf| parts(&leaf).powi(3)).sum();
    let allowed = format!("so coarse that the static map has at most {most_voxels} solid voxels");
    let usable = voxels <= most_voxels;
    require(usable, key, &allowed, voxels)?;
    for leaf in solid() {
        let (side_m, parts) = (side_m(&leaf), parts(&leaf));
        let centre_m = tree.centre_m(&leaf);
        let places = |axis: usize| {
            let place = move |part: i32| (f64::from(part) + 0.5) / parts - 0.5;
            (0..parts as i32).map(move |part| centre_m[axis] + place(part) * side_m)
        };
        for (x_m, y_m) in places(0).flat_map(|x_m| places(1).map(move |y_m| (x_m, y_m))) {
            for key in places(2)
                .filter_map(|z_m| other.key_at([x_m, y_m, z_m]))
                .collect::<Vec<_>>()
            {
                other.update_voxel(key, true);
            }
        }
    }
    Ok(other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_holds_a_part_of_something_solid_is_solid() {
        let voxels = |resolution| OctreeConfig {
            resolution,
            ..OctreeConfig::default()
        };
        let mut tree = Octree::new(voxels(0.06)).unwrap();
        let _beyond = tree.occupy(&[[0.03, 0.03, 0.03]]).unwrap();
        let finer = recut(&tree, &voxels(0.04), "size", 100.0).unwrap();
        for (at_m, solid) in [(0.01, Some(true)), (0.05, Some(true)), (0.09, None)] {
            assert_eq!(finer.is_occupied_at([at_m, 0.01, 0.01]), solid, "{at_m}");
        }
        let error = recut(&tree, &voxels(0.01), "size", 100.0).unwrap_err();
        assert!(error.to_string().starts_with("size must be so coarse"));
    }
}
