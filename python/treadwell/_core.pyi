"""The core, compiled: an observation in, joint targets out."""

from collections.abc import Sequence
from typing import Any, ClassVar, final

import numpy as np
from mujoco import MjData, MjModel
from numpy.typing import ArrayLike, NDArray

from treadwell import protocols
from treadwell.observation import Observation
from treadwell.robot.motor_limits import MotorLimits

__all__ = [
    "BodySenses",
    "BodyState",
    "Climb",
    "Command",
    "DepthCamera",
    "DepthErrors",
    "Embedding",
    "FastSlam",
    "FloorView",
    "FootstepLayer",
    "Goal",
    "GroundCosts",
    "Legs",
    "LocalRegression",
    "MonteCarlo",
    "MovingFilter",
    "OccupancyGrid",
    "OccupancyMap",
    "Octree",
    "PathWeights",
    "Physics",
    "Pilot",
    "Planes",
    "Proprioception",
    "RangeField",
    "RangeMap",
    "Scan",
    "ScanSlam",
    "SceneLabels",
    "Segmenter",
    "Servos",
    "Situation",
    "SlipSense",
    "Stair",
    "Staircase",
    "Step",
    "Stepping",
    "Surfaces",
    "Tick",
    "TrueStance",
    "VoronoiGraph",
    "Walker",
    "Ways",
    "WorldModel",
    "components",
    "distances",
    "find_lines",
    "gait_statistics",
    "ground_points",
    "mesh_file",
    "parameters",
    "point_classes",
    "split_and_merge",
    "squared_distances",
    "standing_things",
    "swept_clearance",
    "tables",
    "textured_mesh",
    "version",
]

_Pose = tuple[float, float, float, float]
_Point = tuple[float, float, float]
_Sole = tuple[float, float, float, tuple[float, float]]
_Edge = tuple[_Point, _Point]
_Fit = tuple[int, float, float]
_Footstep = tuple[str, float, float, float, float, float, float, str, tuple[float, float]]

def components() -> list[tuple[str, str, str, str | None, list[str]]]: ...
def distances(blocked: NDArray[np.bool_], /) -> NDArray[np.float32]: ...
def find_lines(
    points: NDArray[np.float64],
    settings: str = "{}",
    *,
    scan: Sequence[int] | None = None,
    eyes: NDArray[np.float64] | None = None,
    alignment: str = "{}",
) -> dict[str, Any]: ...
def gait_statistics(
    angular_velocity: NDArray[np.float64],
    specific_force: NDArray[np.float64],
    leg_velocities: NDArray[np.float64],
    leg_positions: NDArray[np.float64],
) -> NDArray[np.float64]: ...
def ground_points(points: NDArray[np.float64], settings: str = "{}") -> NDArray[np.bool_]: ...
def mesh_file(
    to: str,
    corners: NDArray[np.float32],
    triangles: NDArray[np.uint32],
    *,
    colours: NDArray[np.uint8] | None = None,
    picture: tuple[bytes, NDArray[np.float32]] | None = None,
) -> bytes: ...
def parameters(description_json: str | None = ...) -> str: ...
def point_classes(points: NDArray[np.float64], settings: str = "{}") -> NDArray[np.uint8]: ...
def split_and_merge(
    points: NDArray[np.float64], settings: str = "{}"
) -> list[tuple[int, int, float, float]]: ...
def squared_distances(blocked: NDArray[np.bool_], /) -> NDArray[np.uint32]: ...
def swept_clearance(
    path: NDArray[np.float64], outline: NDArray[np.float64], radius: float
) -> float: ...
def tables() -> list[str]: ...
def textured_mesh(
    corners: NDArray[np.float32],
    triangles: NDArray[np.uint32],
    views: Sequence[
        tuple[tuple[float, float], tuple[float, float], NDArray[np.float64], NDArray[np.float32]]
    ],
    *,
    settings: str = "{}",
) -> tuple[
    tuple[NDArray[np.float32], NDArray[np.uint32]], NDArray[np.int32], NDArray[np.float32]
]: ...
def version() -> str: ...

@final
class Servos:
    encoder_offsets: NDArray[np.float64]
    def __new__(cls, limits: MotorLimits, *, play: float, timestep: float) -> Servos: ...
    def command(
        self,
        position: NDArray[np.float64],
        velocity: NDArray[np.float64],
        torque: NDArray[np.float64],
    ) -> bool: ...
    def weaken(self, shares: NDArray[np.float64]) -> None: ...
    def torques(
        self, position: NDArray[np.float64], velocity: NDArray[np.float64]
    ) -> NDArray[np.float64]: ...
    def measured_angle(self, position: NDArray[np.float64]) -> NDArray[np.float64]: ...

@final
class Physics:
    def __new__(
        cls,
        model: MjModel,
        data: MjData,
        joints: int,
        position: int,
        velocity: int,
        motors: list[tuple[int, int]],
    ) -> Physics: ...
    def step(self, servos: Servos, controls: NDArray[np.float64]) -> bool: ...

@final
class BodySenses:
    @property
    def encoder_offsets(self) -> NDArray[np.float64]: ...
    def __new__(cls, settings: str, encoder_offsets: NDArray[np.float64]) -> BodySenses: ...
    def read(
        self, data: MjData, time_ns: int, motors: Servos | None
    ) -> tuple[
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
    ]: ...

@final
class TrueStance:
    def __new__(
        cls, soles: Sequence[tuple[int, _Point]], torso: int, up: Sequence[float]
    ) -> TrueStance: ...
    def look(self, data: MjData) -> tuple[_Sole, _Sole, float]: ...

@final
class Surfaces:
    def __new__(cls, geoms: Sequence[str], sole_on_top: float, lies_on_top: float) -> Surfaces: ...
    def sort(
        self, geoms: NDArray[np.int32], frames: NDArray[np.float64]
    ) -> tuple[bool, bool, int | None, list[tuple[int, int, int]]]: ...

@final
class Tick:
    @property
    def positions(self) -> NDArray[np.float64]: ...
    @property
    def velocities(self) -> NDArray[np.float64]: ...
    @property
    def torques(self) -> NDArray[np.float64]: ...
    @property
    def state(self) -> str: ...
    @property
    def outcome(self) -> str | None: ...
    @property
    def reason(self) -> str | None: ...
    @property
    def footsteps(self) -> list[_Footstep]: ...
    @property
    def estimate(self) -> _Pose: ...
    @property
    def odometry(self) -> _Pose: ...
    @property
    def lost(self) -> bool: ...

@final
class Pilot:
    stages: ClassVar[list[str]]
    def __new__(
        cls,
        settings: str,
        *,
        static_map: Octree | None = None,
        segmenter: protocols.Segmenter | None = None,
        world_model: protocols.WorldModel | None = None,
        localizer: protocols.Localizer | None = None,
        planner: protocols.Planner | None = None,
        behaviour: protocols.Behaviour | None = None,
        walker: protocols.Walker | None = None,
    ) -> Pilot: ...
    def tick(self, observation: Observation) -> Tick: ...
    def planes(self) -> Planes: ...
    def floor(
        self,
    ) -> tuple[
        tuple[float, float], float, NDArray[np.uint8], NDArray[np.float32], NDArray[np.uint16]
    ]: ...
    def view(self) -> FloorView: ...
    def staircase(self) -> Staircase: ...
    def climbs(self) -> list[Climb] | None: ...
    def path(self) -> NDArray[np.float64] | None: ...
    def robot_from_camera(self) -> NDArray[np.float64]: ...
    def clearance(self) -> NDArray[np.float32] | None: ...
    def ceilings(self) -> NDArray[np.float32] | None: ...
    def guesses(
        self,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]: ...
    def occupied(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    def surface(self) -> tuple[NDArray[np.float32], NDArray[np.uint32]] | None: ...
    @property
    def goals_passed(self) -> int: ...
    @property
    def moving_things(
        self,
    ) -> list[tuple[int, tuple[float, float], tuple[float, float], float, bool]]: ...
    @property
    def replans(self) -> int: ...
    @property
    def footstep_times(self) -> tuple[int, float, float] | None: ...
    def planned_footsteps(self) -> dict[str, Any] | None: ...
    def stepping_ground(
        self,
    ) -> tuple[tuple[float, float], float, NDArray[np.float32]] | None: ...
    @property
    def steps_taken(self) -> int: ...
    @property
    def stepping(self) -> Stepping: ...
    @property
    def maps_forgotten(self) -> int: ...
    @property
    def frames_used(self) -> int: ...
    @property
    def gaze(self) -> tuple[float, float]: ...
    @property
    def timing(self) -> list[float]: ...

@final
class BodyState:
    @property
    def time_ns(self) -> int: ...
    @property
    def odometry_from_robot(self) -> NDArray[np.float64]: ...
    @property
    def foot_loads(self) -> NDArray[np.float64]: ...

@final
class Planes:
    @property
    def exposure_ns(self) -> int: ...
    @property
    def labels(self) -> NDArray[np.uint16]: ...
    @property
    def points_in_robot(self) -> NDArray[np.float32]: ...
    @property
    def floor_height(self) -> NDArray[np.float32]: ...
    @property
    def robot_from_camera(self) -> NDArray[np.float64]: ...
    @property
    def reliable(self) -> bool: ...
    @property
    def ground(self) -> int | None: ...
    @property
    def regions(
        self,
    ) -> list[tuple[int, list[float], list[float], float, float | None]]: ...

@final
class Segmenter:
    def __new__(
        cls,
        name: str,
        *,
        width: int,
        height: int,
        focal: float,
        baseline: float,
        settings: str = "{}",
    ) -> Segmenter: ...
    def segment(
        self, depth: NDArray[np.float32], robot_from_camera: NDArray[np.float64]
    ) -> Planes: ...
    @property
    def seconds(self) -> float: ...

@final
class DepthCamera:
    def __new__(
        cls,
        types: NDArray[np.int32],
        sizes: NDArray[np.float64],
        seen: NDArray[np.bool_],
        data: NDArray[np.int32],
        meshes: Sequence[tuple[NDArray[np.float32], NDArray[np.int32]]],
        height_fields: Sequence[tuple[NDArray[np.float32], tuple[float, float, float, float]]],
        *,
        width: int,
        height: int,
        focal: float,
    ) -> DepthCamera: ...
    @property
    def unknown(self) -> list[int]: ...
    def cast(
        self,
        positions: NDArray[np.float64],
        rotations: NDArray[np.float64],
        position: tuple[float, float, float],
        rotation: NDArray[np.float64],
        *,
        others: tuple[NDArray[np.float64], NDArray[np.int32]] | None = None,
    ) -> tuple[NDArray[np.float64], NDArray[np.int32]]: ...
    def see(
        self,
        positions: NDArray[np.float64],
        rotations: NDArray[np.float64],
        position: tuple[float, float, float],
        rotation: NDArray[np.float64],
        errors: DepthErrors,
        *,
        others: tuple[NDArray[np.float64], NDArray[np.int32]] | None = None,
    ) -> NDArray[np.float32]: ...

@final
class DepthErrors:
    @staticmethod
    def stereo(
        textures: NDArray[np.float64],
        *,
        width: int,
        height: int,
        focal: float,
        settings: str,
        pattern: int,
        noise: int,
    ) -> DepthErrors: ...
    @staticmethod
    def structured_light(
        *, width: int, height: int, focal: float, settings: str, noise: int
    ) -> DepthErrors: ...
    def see(
        self,
        depth: NDArray[np.float64],
        body: NDArray[np.int32],
        position: tuple[float, float, float],
        rotation: NDArray[np.float64],
    ) -> NDArray[np.float32]: ...

@final
class WorldModel:
    def __new__(cls, name: str, *, settings: str = "{}") -> WorldModel: ...
    def insert(self, planes: Planes, pose: tuple[float, float, float, float]) -> bool: ...
    def view(self) -> FloorView: ...
    @property
    def seconds(self) -> float: ...

@final
class MonteCarlo:
    def __new__(
        cls,
        octree: Octree,
        *,
        size: tuple[int, int],
        focal: tuple[float, float],
        centre: tuple[float, float],
        start: NDArray[np.float64] | None = None,
        settings: str = "{}",
    ) -> MonteCarlo: ...
    def update(
        self, depth: NDArray[np.float32], previous_from_current: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], float, float, bool] | None: ...

@final
class MovingFilter:
    def __new__(cls, settings: str = "{}") -> MovingFilter: ...
    def insert_picture(
        self,
        time: float,
        depth: NDArray[np.float32],
        map_from_camera: NDArray[np.float64],
        *,
        focal: tuple[float, float],
        centre: tuple[float, float],
        ground: float,
        pool: int = 1,
    ) -> None: ...
    def insert_scan(
        self, time: float, points: NDArray[np.float64], eye: tuple[float, float]
    ) -> None: ...
    def are_static(self) -> list[NDArray[np.bool_]]: ...

@final
class SceneLabels:
    @property
    def learned(self) -> str: ...
    def __new__(
        cls,
        settings: str = "{}",
        examples: tuple[NDArray[np.float64], list[int]] | None = None,
    ) -> SceneLabels: ...
    def insert(
        self,
        depth: NDArray[np.float32],
        map_from_camera: NDArray[np.float64],
        *,
        focal: Sequence[float],
        centre: Sequence[float],
        noise: float | None = None,
        keep: bool = True,
    ) -> bool: ...
    @property
    def groups(self) -> NDArray[np.uint16]: ...
    @property
    def labels(self) -> NDArray[np.uint8]: ...
    @property
    def features(self) -> NDArray[np.float64]: ...
    def points(self) -> tuple[NDArray[np.float64], NDArray[np.uint8], NDArray[np.uint8]]: ...
    @staticmethod
    def names() -> list[str]: ...

@final
class OccupancyMap:
    def __new__(cls, settings: str = "{}") -> OccupancyMap: ...
    def insert(self, points: NDArray[np.float64], eye: tuple[float, float]) -> int: ...
    def insert_sonar(
        self,
        pose: tuple[float, float, float],
        bearings: Sequence[float],
        ranges: Sequence[float],
        settings: str = "{}",
    ) -> int: ...
    def cells(
        self,
    ) -> tuple[tuple[float, float], float, NDArray[np.float32], NDArray[np.uint16]]: ...
    def log_likelihood(
        self, points: NDArray[np.float64], eye: tuple[float, float], settings: str = "{}"
    ) -> tuple[float, int]: ...

@final
class ScanSlam:
    def __new__(cls, settings: str = "{}") -> ScanSlam: ...
    def insert(self, points: NDArray[np.float64], odometry: tuple[float, float, float]) -> None: ...
    def finish(self) -> None: ...
    def poses(self) -> NDArray[np.float64]: ...
    def counts(self) -> list[int]: ...

@final
class VoronoiGraph:
    def __new__(
        cls,
        free: NDArray[np.bool_],
        cell: float,
        origin: tuple[float, float],
        settings: str = "{}",
    ) -> VoronoiGraph: ...
    def places(
        self,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.uint32]]: ...
    def ways(self) -> list[tuple[tuple[int, int], float, NDArray[np.float64]]]: ...
    def plan(
        self, start: tuple[float, float], goal: tuple[float, float], clearance: float
    ) -> NDArray[np.float64] | None: ...
    def rooms(
        self,
    ) -> tuple[
        NDArray[np.uint32], NDArray[np.float64], NDArray[np.float64], NDArray[np.uint32]
    ]: ...
    def is_like(self, other: VoronoiGraph) -> bool: ...

@final
class RangeMap:
    def __new__(
        cls,
        name: str,
        *,
        settings: str = "{}",
        headroom: float | None = None,
        model: object | None = None,
    ) -> RangeMap: ...
    @property
    def needs_surfaces(self) -> bool: ...
    def set_camera(
        self,
        size: tuple[int, int],
        focal: tuple[float, float],
        centre: tuple[float, float],
        *,
        segmenter: str,
        pool: int,
        baseline: float,
        stairs: bool = False,
        own: object | None = None,
    ) -> None: ...
    def planes(self) -> Planes | None: ...
    def staircase(self) -> Staircase | None: ...
    def insert_depth(
        self, depth: NDArray[np.float32], map_from_sensor: NDArray[np.float64], ground: float
    ) -> bool: ...
    def insert_points(
        self, points: NDArray[np.float32], map_from_sensor: NDArray[np.float64], ground: float
    ) -> bool: ...
    def view(self) -> FloorView: ...
    def occupied(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    def surface(self) -> tuple[NDArray[np.float32], NDArray[np.uint32]] | None: ...
    @property
    def seconds(self) -> float: ...

@final
class LocalRegression:
    def __new__(cls, inputs: int, prior: float = 0.0, settings: str = "{}") -> LocalRegression: ...
    def learn(self, inputs: NDArray[np.float64], measured: NDArray[np.float64]) -> None: ...
    def predict(
        self, inputs: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...

@final
class PathWeights:
    def __new__(cls, weights: NDArray[np.float64], settings: str = "{}") -> PathWeights: ...
    @property
    def weights(self) -> NDArray[np.float64]: ...
    def costs(self, features: NDArray[np.float64]) -> NDArray[np.float64]: ...
    def learn_shown(
        self, features: NDArray[np.float64], way: NDArray[np.int64], cell: float
    ) -> float: ...
    def prefer(
        self, better: NDArray[np.float64], worse: NDArray[np.float64], margin: float
    ) -> bool: ...

@final
class OccupancyGrid:
    def __new__(
        cls,
        size: tuple[int, int, int],
        corner: tuple[float, float, float],
        *,
        settings: str = "{}",
    ) -> OccupancyGrid: ...
    def insert(self, points: NDArray[np.float64], eye: tuple[float, float, float]) -> int: ...
    def insert_picture(
        self,
        points: NDArray[np.float64],
        camera: NDArray[np.float64],
        focal: tuple[float, float],
        centre: tuple[float, float],
    ) -> int: ...
    def probability(self) -> NDArray[np.float32]: ...
    @property
    def seconds(self) -> float: ...

@final
class Octree:
    def __new__(cls, resolution: float = 0.04, *, settings: str = "{}") -> Octree: ...
    @staticmethod
    def read(path: str) -> Octree: ...
    def write(self, path: str) -> None: ...
    def insert(
        self,
        points: ArrayLike,
        eye: tuple[float, float, float],
        *,
        max_range: float = ...,
        each_point: bool = False,
    ) -> int: ...
    def occupy(self, points: ArrayLike) -> int: ...
    def occupied(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    def free(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    def log_odds(self, points: ArrayLike) -> NDArray[np.float32]: ...
    def cast_rays(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        max_range: float = ...,
        *,
        through_unknown: bool = True,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    @property
    def resolution(self) -> float: ...
    @property
    def nodes(self) -> int: ...
    @property
    def size_bytes(self) -> int: ...
    @property
    def seconds(self) -> float: ...

@final
class RangeField:
    def __new__(cls, octree: Octree) -> RangeField: ...
    def cast(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        max_range: float,
    ) -> NDArray[np.float32]: ...

@final
class FloorView:
    @staticmethod
    def of(view: object) -> FloorView: ...
    def moved(self, by: tuple[float, float, float]) -> FloorView: ...
    def clearance(self) -> NDArray[np.float32]: ...
    def passable(
        self, z: float, rise: float, radius: float, *, unknown: bool = True
    ) -> NDArray[np.bool_]: ...
    @property
    def origin(self) -> tuple[float, float]: ...
    @property
    def cell(self) -> float: ...
    @property
    def kind(self) -> NDArray[np.uint8]: ...
    @property
    def height(self) -> NDArray[np.float32]: ...
    @property
    def gradient(self) -> NDArray[np.float32]: ...
    @property
    def sightings(self) -> NDArray[np.uint16]: ...

@final
class Goal:
    def __new__(
        cls, position: tuple[float, float], radius: float, height: float | None = None
    ) -> Goal: ...
    @property
    def position(self) -> tuple[float, float]: ...
    @property
    def radius(self) -> float: ...
    @property
    def height(self) -> float | None: ...

@final
class Scan:
    @property
    def exposure_ns(self) -> int: ...
    @property
    def disparity(self) -> NDArray[np.float32]: ...
    @property
    def depth(self) -> NDArray[np.float32]: ...
    @property
    def points_in_camera(self) -> NDArray[np.float32]: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def fx(self) -> float: ...
    @property
    def fy(self) -> float: ...
    @property
    def cx(self) -> float: ...
    @property
    def cy(self) -> float: ...
    @property
    def focal(self) -> float: ...
    @property
    def baseline(self) -> float: ...
    @property
    def robot_from_camera(self) -> NDArray[np.float64]: ...

@final
class Situation:
    @property
    def time_ns(self) -> int: ...
    @property
    def estimate(self) -> _Pose: ...
    @property
    def goal(self) -> tuple[float, float]: ...
    @property
    def goal_radius(self) -> float: ...
    @property
    def last_goal(self) -> bool: ...
    @property
    def path(self) -> list[tuple[float, float]] | None: ...
    @property
    def no_way(self) -> str | None: ...
    @property
    def standing(self) -> bool: ...
    @property
    def gaze(self) -> tuple[float, float]: ...
    @property
    def frames_used(self) -> int: ...
    @property
    def stairs(self) -> Staircase: ...
    @property
    def climbs(self) -> list[Climb]: ...
    @property
    def takes_footsteps(self) -> bool: ...
    @property
    def stepping(self) -> Stepping: ...
    def view(self) -> FloorView: ...

@final
class Staircase:
    def __new__(cls) -> Staircase: ...
    @property
    def frames(self) -> int: ...
    @property
    def stairs(self) -> list[Stair]: ...

@final
class SlipSense:
    def __new__(
        cls,
        statistics: NDArray[np.float64],
        slip: NDArray[np.float64],
        settings: str = "{}",
    ) -> SlipSense: ...
    def slip(self, statistics: NDArray[np.float64]) -> NDArray[np.float64]: ...

@final
class Stair:
    @property
    def front(self) -> _Edge: ...
    @property
    def back(self) -> _Edge: ...
    @property
    def reference(self) -> _Point: ...
    @property
    def height(self) -> float: ...
    @property
    def depth(self) -> float: ...
    @property
    def margins(self) -> tuple[float, float]: ...
    @property
    def support(self) -> int: ...
    @property
    def steps_ago(self) -> int: ...
    @property
    def seen_from(self) -> float: ...
    @property
    def front_fit(self) -> _Fit | None: ...
    @property
    def back_fit(self) -> _Fit | None: ...

@final
class Climb:
    @property
    def span(self) -> tuple[int, int]: ...
    @property
    def steps(self) -> list[Step]: ...

@final
class Step:
    @property
    def stair(self) -> Stair: ...
    @property
    def rise(self) -> float: ...
    @property
    def crossing(self) -> tuple[float, float]: ...

@final
class Stepping:
    def __new__(
        cls,
        landed: int = 0,
        height_error: float = 0.0,
        *,
        stumbled: bool = False,
        misstep: str | None = None,
    ) -> Stepping: ...
    @property
    def landed(self) -> int: ...
    @property
    def height_error(self) -> float: ...
    @property
    def misstep(self) -> str | None: ...
    @property
    def stumbled(self) -> bool: ...

@final
class Command:
    @property
    def velocity(self) -> tuple[float, float, float] | None: ...
    @property
    def footsteps(self) -> list[_Footstep]: ...
    @property
    def gaze(self) -> tuple[float, float]: ...
    @property
    def head(self) -> dict[int, float]: ...
    @property
    def arms_raised(self) -> bool: ...

@final
class Proprioception:
    @property
    def time_ns(self) -> int: ...
    @property
    def joint_names(self) -> list[str]: ...
    @property
    def stand(self) -> NDArray[np.float64]: ...
    @property
    def joint_ranges(self) -> NDArray[np.float64]: ...
    @property
    def joint_positions(self) -> NDArray[np.float64]: ...
    @property
    def joint_velocities(self) -> NDArray[np.float64]: ...
    @property
    def gravity(self) -> NDArray[np.float64]: ...
    @property
    def angular_velocity(self) -> NDArray[np.float64]: ...
    @property
    def odometry_from_torso(self) -> NDArray[np.float64]: ...
    @property
    def odometry_from_robot(self) -> NDArray[np.float64]: ...
    @property
    def foot_forces(self) -> NDArray[np.float64]: ...
    @property
    def foot_loads(self) -> NDArray[np.float64]: ...
    @property
    def contacts(self) -> tuple[bool, bool]: ...
    @property
    def support(self) -> str: ...

@final
class Walker:
    def __new__(cls, description_json: str) -> Walker: ...
    def step(
        self,
        observation: Observation,
        motion: tuple[float, float, float] | list[_Footstep] | None,
        pan: float = 0.0,
        down: float = 0.0,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]: ...
    @property
    def standing(self) -> bool: ...
    @property
    def steps_taken(self) -> int: ...
    @property
    def odometry(self) -> tuple[float, float, float]: ...
    @property
    def ground(self) -> float: ...
    @property
    def slope(self) -> tuple[float, float, float] | None: ...
    @slope.setter
    def slope(self, value: tuple[float, float, float] | None, /) -> None: ...
    @property
    def arms_raised(self) -> bool: ...
    @arms_raised.setter
    def arms_raised(self, value: bool, /) -> None: ...
    @property
    def stepping(self) -> tuple[int, float, str | None]: ...

@final
class GroundCosts:
    def __new__(cls, description_json: str, settings: str = "{}") -> GroundCosts: ...
    @property
    def limits(self) -> dict[str, float]: ...
    def map(
        self,
        heights: NDArray[np.float64],
        cell: float,
        head_room: NDArray[np.float64] | None = None,
    ) -> NDArray[np.float64]: ...
    def demand(
        self, slope: float, roughness: float, friction: float, speed: float, curvature: float
    ) -> tuple[float, float]: ...
    def motion_cost(
        self, slope: float, roughness: float, friction: float, speed: float, curvature: float
    ) -> float: ...
    def fastest(
        self, slope: float, roughness: float, friction: float, curvature: float
    ) -> float | None: ...

def standing_things(
    points: NDArray[np.float64], eye: float, settings: str = "{}"
) -> list[tuple[tuple[float, float, float, float], bool]]: ...

@final
class Embedding:
    def __new__(cls, looks: NDArray[np.float64], settings: str = "{}") -> Embedding: ...
    def place(self, looks: NDArray[np.float64]) -> NDArray[np.float64]: ...

@final
class FastSlam:
    def __new__(cls, settings: str = "{}") -> FastSlam: ...
    def advance(self, forward: float, left: float, turn: float, passed: float) -> None: ...
    def see(self, readings: NDArray[np.float64], names: Sequence[int | None]) -> None: ...
    def pose(self) -> tuple[float, float, float]: ...
    def scales(self) -> list[tuple[float, float]]: ...
    def landmarks(
        self,
    ) -> list[tuple[tuple[float, float], tuple[float, float, float], int | None, float, int]]: ...

@final
class Ways:
    def __new__(cls, planner: str, description_json: str, settings: str = "{}") -> Ways: ...
    def plan(
        self,
        view: FloorView,
        start: tuple[float, float, float, float],
        goal: tuple[float, float, float, float | None],
        seen: RangeMap | None = None,
    ) -> tuple[NDArray[np.float64] | None, str | None, float, list[Climb], str | None]: ...
    def unfit(
        self, rise: float, width: float, edge: tuple[float, float] | None = None
    ) -> str | None: ...

@final
class FootstepLayer:
    def __new__(cls, description_json: str, settings: str = "{}") -> FootstepLayer: ...
    def plan(
        self,
        heights: NDArray[np.float32],
        lattice: tuple[tuple[float, float], float],
        start: tuple[float, float, float],
        goal: tuple[float, float, float],
    ) -> tuple[dict[str, Any] | None, str | None]: ...

@final
class Legs:
    def __new__(cls, description_json: str) -> Legs: ...
    def solve(
        self, side: str, place: tuple[float, float, float], yaw: float = 0.0
    ) -> tuple[NDArray[np.float64], bool]: ...
    def carries_ahead(self, side: str, place: tuple[float, float, float]) -> float: ...
    def lengths(self, side: str) -> tuple[list[float], float, float, float]: ...
    def solved_by(self, side: str) -> tuple[str | None, str | None]: ...
    @property
    def gait_json(self) -> str: ...
