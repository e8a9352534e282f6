//! Where one can stand in the known map.

use volume::{InnerSurfaces, SolidVoxels};

use crate::StandingTuning;

/// A place to stand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standing {
    /// The solid voxel that one stands on.
    pub voxel: [usize; 3],
    /// Middle of its top, or of the surface in it where that was measured, m.
    pub top_m: [f64; 3],
}

/// Room that a body needs where it stands: an upright cylinder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StandingRoom {
    /// Its radius, m; 0 for a body without a width.
    pub radius_m: f64,
    /// Its height, m.
    pub height_m: f64,
}

/// Tops of solid voxels above which a body has room: a cylinder that stands a step's height above them, on every level of the map.
/// In the order of the voxels' layers, rows and columns.
pub(crate) fn standing(
    (solid, surfaces): (&SolidVoxels, Option<&InnerSurfaces>),
    room: StandingRoom,
    tuning: &StandingTuning,
) -> Vec<Standing> {
    let StandingRoom { radius_m, height_m } = room;
    let side_m = solid.resolution_m;
    let layers = solid.size()[2] as i64;
    let reach = (radius_m / side_m).ceil() as i64;
    let disc: Vec<[i64; 2]> = (-reach..=reach)
        .flat_map(|y| (-reach..=reach).map(move |x| [x, y]))
        .filter(|[x, y]| ((x * x + y * y) as f64).sqrt() * side_m <= radius_m)
        .collect();
    // Above the highest layer nothing is solid.
    let steps = ((tuning.step / side_m).round().max(1.0) as i64).min(layers);
    let body = steps + 1..=((height_m / side_m).ceil() as i64).min(layers);
    let mut places = Vec::new();
    for voxel in solid.solid() {
        let [x, y, z] = voxel.map(|at| at as i64);
        let bare = (1..=steps).all(|dz| !solid.is_solid([x, y, z + dz]));
        let free = bare
            && !disc.iter().any(|[dx, dy]| {
                body.clone()
                    .any(|dz| solid.is_solid([x + dx, y + dy, z + dz]))
            });
        if free {
            let low = solid.corner_m(voxel);
            let surface_m = surfaces.and_then(|surfaces| surfaces.height_m(voxel));
            places.push(Standing {
                voxel,
                top_m: [
                    low[0] + 0.5 * side_m,
                    low[1] + 0.5 * side_m,
                    surface_m.unwrap_or(low[2] + side_m),
                ],
            });
        }
    }
    places.sort_unstable_by_key(|place| {
        let [x, y, z] = place.voxel;
        [z, y, x]
    });
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_can_stand_on_every_level_where_there_is_room() {
        let boxes = [
            [[0.0, 0.0, -0.04], [2.0, 1.0, 0.0]],
            // A deck with room below, a shelf with none, a wall.
            [[0.0, 0.0, 0.68], [0.8, 1.0, 0.72]],
            [[1.2, 0.0, 0.4], [1.6, 1.0, 0.44]],
            [[1.96, 0.0, 0.0], [2.0, 1.0, 1.6]],
        ];
        let solid = SolidVoxels::of_boxes(&boxes, 0.04).unwrap();
        let room = StandingRoom {
            radius_m: 0.1,
            height_m: 0.55,
        };
        let places = standing((&solid, None), room, &StandingTuning::default());
        let any = |x: [f64; 2], z_m: f64| {
            places.iter().any(|place| {
                let [px, _, pz] = place.top_m;
                (x[0]..x[1]).contains(&px) && (pz - z_m).abs() < 1e-9
            })
        };
        assert!(any([0.0, 0.8], 0.0) && any([0.0, 0.8], 0.72));
        assert!(any([0.95, 1.05], 0.0) && !any([1.2, 1.6], 0.0));
        assert!(any([1.2, 1.6], 0.44) && any([1.75, 1.85], 0.0));
        assert!(!any([1.9, 1.96], 0.0));
        assert!(places.iter().all(|place| place.top_m[2] > -1e-9));
        // A step over everything: only the highest of each column is left, at once.
        let over = StandingTuning { step: 1e9 };
        assert!(standing((&solid, None), room, &over).len() < places.len());
    }
}
