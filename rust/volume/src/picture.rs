//! A frame's lines of sight as a picture: which of them goes by a place, and how deep it reaches.

use geometry::{Camera, Map, Pose};

use super::placement::Placement;

/// A pinhole camera's picture: where its lines of sight lie side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Picture {
    /// Columns and rows.
    pub size_px: [usize; 2],
    /// Focal lengths along columns and rows, pixels.
    pub focal_px: [f64; 2],
    /// Column and row at which the optical axis meets the picture, pixels.
    pub centre_px: [f64; 2],
    /// The camera's axes in the map frame: right, down, forward.
    pub axes: [[f64; 3]; 3],
}

impl Picture {
    /// The axes of a camera with this pose.
    pub fn axes_of(map_from_camera: &Pose<Map, Camera>) -> [[f64; 3]; 3] {
        let rotation = map_from_camera.inner.rotation.to_rotation_matrix();
        std::array::from_fn(|axis| rotation.matrix().column(axis).into_owned().into())
    }
}

/// A function of the place that is linear in column, row and layer.
#[derive(Debug, Clone, Copy)]
pub(super) struct PictureLinear {
    /// Value in the middle of voxel (0, 0, 0).
    pub(super) origin: f32,
    /// Change per column, row and layer.
    pub(super) step: [f32; 3],
}

impl PictureLinear {
    /// Value in the middle of the lowest voxel of a cell.
    #[inline]
    pub(super) fn at(&self, col: usize, row: usize) -> f32 {
        self.origin + self.step[0] * col as f32 + self.step[1] * row as f32
    }

    /// `k * self + l * other`.
    pub(super) fn combined(&self, k: f32, other: &Self, l: f32) -> Self {
        Self {
            origin: k * self.origin + l * other.origin,
            step: std::array::from_fn(|a| k * self.step[a] + l * other.step[a]),
        }
    }
}

/// A picture seen from the voxels of a grid: `depth` along the axis, m, and where a place shows, times its depth, counted from the
/// picture's corner: a place shows in the pixel of column `across / depth` and row `down / depth`, both rounded down.
#[derive(Debug, Clone, Copy)]
pub(super) struct PictureSight {
    pub(super) size_px: [usize; 2],
    pub(super) depth: PictureLinear,
    pub(super) across: PictureLinear,
    pub(super) down: PictureLinear,
    /// Up to this depth, m, a line of sight that lies a pixel beside a voxel's middle, both ways, still goes through the voxel.
    pub(super) one_pixel_m: f32,
    /// How far the next line of sight is at a depth of 1 m, along the grid's axes, in half voxels: along columns, and along rows.
    apart: [[f32; 3]; 2],
    /// The first pixel's line of sight at a depth of 1 m, along the grid's axes, in half voxels.
    corner: [f32; 3],
    /// From the eye to the middle of voxel (0, 0, 0), half voxels.
    from_eye: [f32; 3],
    /// How far a voxel reaches from its middle along columns and rows, times depth, pixels.
    pub(super) halves_px: [f32; 2],
    /// How much deeper than its middle a voxel's furthest corner is, m.
    pub(super) half_m: f32,
    /// The camera's axis in the map frame, and its depth at the map's origin, m.
    forward: [f64; 3],
    origin_m: f64,
}

/// Share of half a voxel that counts as within it: the rest is more than what 32 bits may lose, a rounding guard.
const WITHIN: f32 = 0.98;

impl PictureSight {
    pub(super) fn new(picture: &Picture, eye_m: [f64; 3], placement: &Placement) -> Self {
        let Placement {
            lattice,
            bottom_m,
            layer_m,
        } = *placement;
        let corner_m = [lattice.origin_m[0], lattice.origin_m[1], bottom_m];
        let voxel_m = [lattice.cell_m, lattice.cell_m, layer_m];
        let along = |axis: [f64; 3]| -> (f64, [f64; 3]) {
            let corner = (0..3).map(|a| axis[a] * (corner_m[a] - eye_m[a])).sum();
            (corner, std::array::from_fn(|a| axis[a] * voxel_m[a]))
        };
        let middle = |(corner, step): (f64, [f64; 3])| PictureLinear {
            origin: (corner + 0.5 * step.iter().sum::<f64>()) as f32,
            step: step.map(|part| part as f32),
        };
        let [right, below, forward] = picture.axes;
        let shown = |axis: [f64; 3], way: usize| {
            let from_corner = picture.centre_px[way] + 0.5;
            let direction = |a: usize| picture.focal_px[way] * axis[a] + from_corner * forward[a];
            middle(along(std::array::from_fn(direction)))
        };
        let apart = [(right, picture.focal_px[0]), (below, picture.focal_px[1])]
            .map(|(axis, px)| std::array::from_fn(|a| (2.0 * axis[a] / (px * voxel_m[a])) as f32));
        let both: [f32; 3] = std::array::from_fn(|a| apart[0][a].abs() + apart[1][a].abs());
        Self {
            size_px: picture.size_px,
            depth: middle(along(forward)),
            across: shown(right, 0),
            down: shown(below, 1),
            one_pixel_m: WITHIN / both.into_iter().fold(0.0, f32::max),
            apart,
            corner: std::array::from_fn(|a| {
                let [right, below] = [right, below].map(|axis| axis[a]);
                let [u, v] = [0, 1].map(|way| picture.centre_px[way] / picture.focal_px[way]);
                (2.0 * (forward[a] - u * right - v * below) / voxel_m[a]) as f32
            }),
            from_eye: std::array::from_fn(|a| {
                (2.0 * (corner_m[a] - eye_m[a]) / voxel_m[a] + 1.0) as f32
            }),
            halves_px: [(right, 0), (below, 1)].map(|(axis, way)| {
                let parts = axis.iter().zip(&voxel_m);
                let half_m = 0.5
                    * parts
                        .map(|(part, side_m)| (part * side_m).abs())
                        .sum::<f64>();
                (picture.focal_px[way] * half_m) as f32
            }),
            half_m: (0..3)
                .map(|a| 0.5 * (forward[a] * voxel_m[a]).abs())
                .sum::<f64>() as f32,
            forward,
            origin_m: -(0..3).map(|a| forward[a] * eye_m[a]).sum::<f64>(),
        }
    }

    /// Depth, and place in the picture times depth.
    #[inline]
    pub(super) const fn shown(&self) -> [&PictureLinear; 3] {
        [&self.depth, &self.across, &self.down]
    }

    /// Whether a line of sight so many pixels beside the middle of a voxel at this depth goes through the voxel.
    #[inline]
    pub(super) fn within(&self, depth_m: f32, [across_px, down_px]: [f32; 2]) -> bool {
        let [across, down] = self.apart;
        let (across_m, down_m) = (across_px * depth_m, down_px * depth_m);
        let holds = |a: usize| (across_m * across[a] + down_m * down[a]).abs() <= WITHIN;
        holds(0) && holds(1) && holds(2)
    }

    /// From the eye to the middle of a voxel, half voxels.
    #[inline]
    pub(super) fn beyond_eye(&self, voxel: [usize; 3]) -> [f32; 3] {
        std::array::from_fn(|a| 2.0 * voxel[a] as f32 + self.from_eye[a])
    }

    /// Whether the line of sight of a pixel goes into the voxel that is there from the eye, before it ends so deep.
    #[inline]
    pub(super) fn enters(&self, middle: [f32; 3], [col, row]: [usize; 2], reach_m: f32) -> bool {
        let [across, down] = &self.apart;
        let (mut enter_m, mut leave_m) = (0.0_f32, reach_m);
        for a in 0..3 {
            let per_m = self.corner[a] + across[a] * col as f32 + down[a] * row as f32;
            let (one, other) = ((middle[a] - WITHIN) / per_m, (middle[a] + WITHIN) / per_m);
            enter_m = enter_m.max(one.min(other));
            leave_m = leave_m.min(one.max(other));
        }
        enter_m < leave_m
    }

    /// Depth of a place, m.
    #[inline]
    pub(super) fn depth_of(&self, at_m: [f64; 3]) -> f32 {
        let [x, y, z] = self.forward;
        (self.origin_m + x * at_m[0] + y * at_m[1] + z * at_m[2]) as f32
    }
}
