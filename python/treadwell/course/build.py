"""The course: a scenario's elements and the robot as one MuJoCo model, and what stands where."""

import math
from dataclasses import dataclass, field
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from treadwell.course.assets import mjcf_pieces, read_mjcf
from treadwell.course.check import check_start
from treadwell.course.geometry import PREFIX, add_ground, add_movable_body, add_pieces
from treadwell.course.levels import levels, surface_height
from treadwell.course.outlines import Floats
from treadwell.course.pieces import Piece, Top, about_z
from treadwell.course.plan import PlannedElement, plan_elements
from treadwell.errors import InputError
from treadwell.mjcf.build import compiled
from treadwell.robot.load import Robot
from treadwell.scenario.model import Scenario

LEVEL_TOLERANCE: Final = 0.02
"""Metres: a height that a scenario names means the surface within this."""


@dataclass(frozen=True)
class CourseElement:
    """One element as it was built.

    Attributes:
        name: unique on the course.
        kind: as in the scenario file.
        mapped: whether an a-priori map has it.
        texture: how well stereo sees it, 0 to 1.
        pieces: its convex solids in the world frame, where the scenario file puts them.
        tops: its walkable surfaces in the world frame; empty for an obstacle.
        geom_ids: its geoms; geom `geom_ids[i]` is piece `i`.
        mocap_id: its row of `data.mocap_pos` when events can move it, else None.
        origin: (3,) world: where its body stands when it is where the file puts it.
        present: whether it is there from the beginning.
    """

    name: str
    kind: str
    mapped: bool
    texture: float
    pieces: tuple[Piece, ...]
    tops: tuple[Top, ...]
    geom_ids: tuple[int, ...]
    mocap_id: int | None
    origin: Floats
    present: bool

    @property
    def walkable(self) -> bool:
        """Whether it has tops to walk on."""
        return bool(self.tops)


@dataclass(frozen=True)
class Place:
    """A pose on the course: world x, y, height of the surface there (m) and yaw (rad)."""

    position: tuple[float, float]
    height: float
    yaw: float


@dataclass(frozen=True, eq=False)
class Course:
    """The model, with the robot standing at the start, and what stands where.

    Attributes:
        model: compiled; options are the robot's.
        elements: in the order of the file, scattered ones in place, those of events last.
        start: where the robot stands.
        goal_height: height of the surface at the goal, metres.
        qpos: (nq,) the robot in its standing posture at the start.
        texture: (ngeom,) how well stereo sees each geom, 0 to 1.
        geom_element: (ngeom,) index into `elements`, -1 for the ground and the robot.
    """

    model: mujoco.MjModel
    elements: tuple[CourseElement, ...]
    start: Place
    goal_height: float
    qpos: Floats
    texture: Floats
    geom_element: npt.NDArray[np.intp]
    _by_name: dict[str, CourseElement] = field(default_factory=dict)

    def element(self, name: str) -> CourseElement | None:
        """Return an element by its name, None when there is none."""
        if not self._by_name:
            self._by_name.update({element.name: element for element in self.elements})
        return self._by_name.get(name)

    def tops(self) -> list[tuple[CourseElement, Top]]:
        """Return every walkable top that is there from the beginning, with its element."""
        return [(e, top) for e in self.elements if e.present for top in e.tops]

    def height_at(self, points: Floats) -> Floats:
        """Return the height of the highest surface at world points (n, 2), metres."""
        points = np.atleast_2d(np.asarray(points, dtype=np.float64))
        return surface_height([top for _, top in self.tops()], points)

    def levels_at(self, x: float, y: float) -> list[float]:
        """Return the heights of all surfaces at a world point that something can stand on."""
        return levels_at(self.elements, x, y)


def levels_at(elements: tuple[CourseElement, ...], x: float, y: float) -> list[float]:
    """Return the heights of all surfaces of elements, and of the ground, at a world point."""
    there = [element for element in elements if element.present and element.walkable]
    tops = [top for element in there for top in element.tops]
    return levels(tops, [piece for element in there for piece in element.pieces], x, y)


def build_course(scenario: Scenario, robot: Robot) -> Course:
    """Build the model of a scenario: ground, elements, robot at the start.

    Elements that events add, remove or move are mocap bodies; what is not there yet is parked far
    below the ground.

    Raises:
        InputError: a file is broken, no scattered layout leaves a way, the robot would start inside
            an obstacle or over a void, or an event names a joint that the robot does not have.
    """
    plans = plan_elements(scenario, robot)
    friction = scenario.physics.friction
    spec = robot.spec()
    add_ground(spec, friction)
    names = [_add(spec, plan, scenario, friction) for plan in plans]
    _place_root(spec, robot, scenario)
    model = compiled(spec, str(scenario.path or scenario.name))
    _scale_masses(model, robot, scenario.physics.mass_scale)
    model.geom_friction[:, 0] = friction
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    elements = tuple(
        _built(model, data, plan, geoms) for plan, geoms in zip(plans, names, strict=True)
    )
    start = _start(scenario, elements)
    texture = np.ones(model.ngeom)
    geom_element = np.full(model.ngeom, -1, dtype=np.intp)
    for index, element in enumerate(elements):
        texture[list(element.geom_ids)] = element.texture
        geom_element[list(element.geom_ids)] = index
    course = Course(
        model=model,
        elements=elements,
        start=start,
        goal_height=_level(
            scenario, elements, "goal", scenario.goal.position, scenario.goal.height
        ),
        qpos=_standing(model, robot, start),
        texture=texture,
        geom_element=geom_element,
    )
    check_start(scenario, robot, course)
    return course


def _add(
    spec: mujoco.MjSpec, plan: PlannedElement, scenario: Scenario, friction: float
) -> list[str] | None:
    """Add one element and return its geoms' names; None for an MJCF world, which has its own."""
    if plan.mjcf is not None:
        what = f"{scenario.path or scenario.name}: course.{plan.name}.file: {plan.mjcf}"
        child = read_mjcf(scenario.folder, plan.mjcf, what)
        spec.attach(child, frame=spec.worldbody.add_frame(), prefix=f"{PREFIX}{plan.name}/")
        return None
    body, origin = spec.worldbody, np.zeros(3)
    if plan.movable:
        origin = plan.origin
        body = add_movable_body(spec, plan.name, origin, present=plan.present)
    return add_pieces(
        spec,
        body,
        plan.name,
        plan.element,
        plan.pieces,
        origin=origin,
        friction=friction,
        shape=plan.shape,
    )


def _built(
    model: mujoco.MjModel, data: mujoco.MjData, plan: PlannedElement, names: list[str] | None
) -> CourseElement:
    pieces, tops = list(plan.pieces), list(plan.tops)
    if names is None:
        prefix = f"{PREFIX}{plan.name}/"
        ids = [i for i in range(model.ngeom) if _belongs(model, i, prefix)]
        pieces, tops = mjcf_pieces(model, data, ids)
    else:
        ids = [model.geom(name).id for name in names]
    body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, PREFIX + plan.name)
    return CourseElement(
        name=plan.name,
        kind=str(getattr(plan.element, "kind", "")),
        mapped=plan.element.mapped,
        texture=plan.element.texture,
        pieces=tuple(pieces),
        tops=tuple(tops),
        geom_ids=tuple(ids),
        mocap_id=int(model.body_mocapid[body]) if plan.movable else None,
        origin=plan.origin,
        present=plan.present,
    )


def _belongs(model: mujoco.MjModel, geom: int, prefix: str) -> bool:
    """Say whether a geom that can be touched came with an attached world (never a plane)."""
    if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_PLANE or (
        not model.geom_contype[geom] and not model.geom_conaffinity[geom]
    ):
        return False
    return bool(model.geom(geom).name.startswith(prefix))


def _place_root(spec: mujoco.MjSpec, robot: Robot, scenario: Scenario) -> None:
    """Put the robot's root where it starts, as seen from above; its height follows later."""
    root = spec.body(robot.root)
    root.pos = [*scenario.start.position, float(robot.stand_qpos[2])]


def _scale_masses(model: mujoco.MjModel, robot: Robot, scale: float) -> None:
    """Scale the masses and inertias of the robot's links."""
    if scale == 1.0:
        return
    root = model.body(robot.root).id
    links = model.body_rootid == root
    model.body_mass[links] *= scale
    model.body_inertia[links] *= scale
    mujoco.mj_setConst(model, mujoco.MjData(model))


def _standing(model: mujoco.MjModel, robot: Robot, start: Place) -> Floats:
    """Return the positions (nq,) with the robot standing at the start."""
    qpos: Floats = model.qpos0.copy()
    stand = robot.stand_qpos
    address = int(model.joint(robot.base).qposadr[0])
    turn = about_z(start.yaw)
    ahead = np.array(
        [
            stand[0] * math.cos(start.yaw) - stand[1] * math.sin(start.yaw),
            stand[0] * math.sin(start.yaw) + stand[1] * math.cos(start.yaw),
        ]
    )
    qpos[address : address + 2] = np.array(start.position) + ahead
    qpos[address + 2] = stand[2] + start.height
    mujoco.mju_mulQuat(qpos[address + 3 : address + 7], turn, stand[3:7])
    for joint, angle in zip(robot.joints, robot.stand, strict=True):
        qpos[int(model.joint(joint).qposadr[0])] = angle
    return qpos


def _start(scenario: Scenario, elements: tuple[CourseElement, ...]) -> Place:
    start = scenario.start
    height = _level(scenario, elements, "start", start.position, start.height)
    return Place(start.position, height, start.yaw)


def _level(
    scenario: Scenario,
    elements: tuple[CourseElement, ...],
    key: str,
    position: tuple[float, float],
    height: float | None,
) -> float:
    """Return the surface that a start or a goal means.

    Raises:
        InputError: there is no surface at the height that is named.
    """
    heights = levels_at(elements, *position) or [0.0]
    if height is None:
        return heights[-1]
    best = min(heights, key=lambda candidate: abs(candidate - height))
    if abs(best - height) > LEVEL_TOLERANCE:
        listed = ", ".join(f"{h:g}" for h in heights)
        raise InputError(
            f"{scenario.path or scenario.name}: {key}.height: found {height:g}; there "
            f"is a void, the surfaces at {list(position)} are at {listed}"
        )
    return best
