//! What every segmenter produces: planes, labels, and points with the height of the floor they belong to.

use geometry::{Camera, Outline, Plane, Point, Pose, Robot};
use sensing::{Intrinsics, PinholeCamera, Scan};

/// Why a scan could not be segmented. The segmenter's state is unchanged.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SegmentError {
    /// The scan has another size than the one the segmenter was made for.
    #[error("a scan must have {expected} pixels, got {found}")]
    WrongSize {
        /// Pixels expected.
        expected: usize,
        /// Pixels found.
        found: usize,
    },
    /// A segmenter of the user's failed.
    #[error("{0}")]
    Failed(String),
}

/// One planar region, in the robot's frame after the ground plane corrected the camera's pose.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaneRegion {
    /// Number of supporting points.
    pub support: usize,
    /// Mean of the supporting points.
    pub mean: Point<Robot>,
    /// Unit normal (towards the camera) and signed distance, robot frame.
    pub plane: Plane,
    /// Convex boundary of the supporting points, seen from above; none for planes seen as a line from above.
    pub boundary: Option<Outline>,
    /// Height of the surface above the robot's ground, m, when the plane is horizontal.
    pub floor_height_m: Option<f64>,
    /// How many times as rough as the ground it is, when it is horizontal or a slope and enough of both was seen to tell.
    pub roughness: Option<f32>,
}

/// The product of a segmenter; reused from frame to frame.
#[derive(Debug, Clone)]
pub struct Planes {
    /// When the picture was taken, nanoseconds since the start.
    pub exposure_ns: u64,
    /// The regions.
    pub regions: Vec<PlaneRegion>,
    /// Index of the ground among the regions, where it was found.
    pub ground: Option<usize>,
    /// Camera in the robot's frame after correction by the ground plane; the measured one where no ground was found.
    pub robot_from_camera: Pose<Robot, Camera>,
    /// The camera of which the pixels are the picture: each point lies on its pixel's line of sight. None where that is not so.
    pub camera: Option<Intrinsics>,
    /// Of a picture of which no surfaces are known its camera, whichever it is.
    pub any_camera: Option<PinholeCamera>,
    /// Region of each pixel plus one, row by row; 0 where it belongs to none.
    pub labels: Vec<u16>,
    /// Position of each pixel's point in the robot's frame, m; NaN where nothing was seen.
    pub points_in_robot_m: Vec<[f32; 3]>,
    /// Height of the horizontal plane that a pixel belongs to, m: `h` of the paper (000, section III.A); NaN is *invalid*.
    pub floor_height_m: Vec<f32>,
    /// Pixels beside an edge between two level surfaces that are a step apart: the matching window saw both, so that
    /// neither their height nor their place is that of one of them.
    pub at_step: Vec<bool>,
    /// Whether the points' heights may be trusted: the ground is tracked, and was found in this frame or not long ago.
    pub reliable: bool,
}

impl Planes {
    /// An empty product for images of `pixels` pixels.
    pub fn new(pixels: usize) -> Self {
        Self {
            exposure_ns: 0,
            regions: Vec::new(),
            ground: None,
            robot_from_camera: Pose::identity(),
            camera: None,
            any_camera: None,
            labels: vec![0; pixels],
            points_in_robot_m: vec![[f32::NAN; 3]; pixels],
            floor_height_m: vec![f32::NAN; pixels],
            at_step: vec![false; pixels],
            reliable: false,
        }
    }

    /// Points of a range sensor in the robot's frame, m, of which no surfaces are known; NaN where nothing was seen. Their places are
    /// trusted: nothing corrects the sensor's pose.
    pub fn of_points(
        points_in_robot_m: Vec<[f32; 3]>,
        robot_from_camera: Pose<Robot, Camera>,
    ) -> Self {
        Self {
            robot_from_camera,
            reliable: true,
            points_in_robot_m,
            ..Self::new(0)
        }
        .sized()
    }

    /// The camera of which the pixels are the picture, whichever it is.
    pub fn pinhole(&self) -> Option<PinholeCamera> {
        let camera = self.camera.map(|camera| {
            let (col, row) = camera.principal_point_px();
            PinholeCamera {
                size_px: [camera.width, camera.height],
                focal_px: [camera.focal_px; 2],
                centre_px: [col, row],
            }
        });
        camera.or(self.any_camera)
    }

    /// The product with as many labels as it has points.
    fn sized(mut self) -> Self {
        let pixels = self.points_in_robot_m.len();
        self.labels.resize(pixels, 0);
        self.floor_height_m.resize(pixels, f32::NAN);
        self.at_step.resize(pixels, false);
        self
    }
}

/// Height of the floor at a place `(x_m, y_m)` of the robot's frame, above the robot's ground, m; none where it is not known.
pub type KnownFloor<'a> = dyn Fn(f64, f64) -> Option<f64> + 'a;

/// Finds planes in a scan.
pub trait Segmenter: Send + Sync {
    /// Fills `planes` from `scan`. Finding nothing is an ordinary product: no regions, no ground, not reliable.
    fn segment(&mut self, scan: &Scan, planes: &mut Planes) -> Result<(), SegmentError>;

    /// Fills `planes` from `scan` where some of the floor is known; a segmenter that makes no use of that leaves it out.
    fn segment_known(
        &mut self,
        scan: &Scan,
        _known: &KnownFloor<'_>,
        planes: &mut Planes,
    ) -> Result<(), SegmentError> {
        self.segment(scan, planes)
    }
}
