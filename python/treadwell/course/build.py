"""Builds a course: a scenario's elements and the robot as one MuJoCo model."""

import mujoco
import numpy as np

from treadwell.course.assets import mjcf_pieces, multiply, read_mjcf
from treadwell.course.check import check_start
from treadwell.course.course import LEVEL_TOLERANCE, Course, CourseElement, Place, levels_at
from treadwell.course.geometry import (
    PREFIX,
    STEMS,
    add_ground,
    add_movable_body,
    add_pieces,
    add_stems,
)
from treadwell.course.outlines import Floats
from treadwell.course.plan import PlannedElement, plan_course
from treadwell.errors import InputError
from treadwell.mjcf.build import compiled
from treadwell.robot.load import Robot
from treadwell.robot.standing import ROOT, standing_root
from treadwell.scenario.ground_elements import Patch
from treadwell.scenario.model import Scenario
from treadwell.scenario.scaling import to_robot


def build_course(scenario: Scenario, robot: Robot) -> Course:
    """Build the model of a scenario, fitted to the robot: ground, elements, robot at the start.

    Elements that events add, remove or move are mocap bodies; what is not there yet is parked far
    below the ground.

    Raises:
        InputError: a file is broken, no scattered layout leaves a way, the robot would start inside
            an obstacle or over a void, or an event names a joint or a door that is not there.
    """
    scenario = to_robot(scenario, robot)
    planned = plan_course(scenario, robot)
    plans = planned.elements
    friction = scenario.physics.friction
    spec = robot.spec()
    add_ground(spec, friction)
    added = [_add(spec, plan, scenario, friction) for plan in plans]
    _place_root(spec, robot, scenario)
    model = compiled(spec, str(scenario.path or scenario.name))
    _scale_masses(model, robot, scenario.physics.mass_scale)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    elements = tuple(
        _built(model, data, plan, names) for plan, names in zip(plans, added, strict=True)
    )
    start = _start(scenario, elements)
    texture = np.ones(model.ngeom)
    geom_element = np.full(model.ngeom, -1, dtype=np.intp)
    for index, element in enumerate(elements):
        geoms = [*element.geom_ids, *element.soft_ids]
        texture[geoms] = element.texture
        geom_element[geoms] = index
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
        events=tuple(planned.events),
        scale=scenario.scale.length,
    )
    course.set_friction(model.geom_friction, friction)
    _put_first(course)
    check_start(scenario, robot, course)
    return course


def _add(
    spec: mujoco.MjSpec, plan: PlannedElement, scenario: Scenario, friction: float
) -> list[str] | None:
    """Add one element and return its geoms' names; None for an MJCF world, which has its own."""
    if plan.mjcf is not None:
        what = f"{scenario.path or scenario.name}: course.{plan.name}.file: {plan.mjcf}"
        child = read_mjcf(scenario.folder, plan.mjcf, what)
        multiply(child, scenario.scale.length)
        spec.attach(child, frame=spec.worldbody.add_frame(), prefix=f"{PREFIX}{plan.name}/")
        return None
    body, origin = spec.worldbody, np.zeros(3)
    if plan.stems is not None:
        add_stems(spec, plan.name, plan.element, plan.stems)
        return []
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
        hinge=plan.hinge,
        soft_ids=() if plan.stems is None else (model.geom(f"{PREFIX}{plan.name}/{STEMS}").id,),
        slippery=isinstance(plan.element, Patch),
    )


def _belongs(model: mujoco.MjModel, geom: int, prefix: str) -> bool:
    """Say whether a geom that can be touched came with an attached world (never a plane)."""
    if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_PLANE or (
        not model.geom_contype[geom] and not model.geom_conaffinity[geom]
    ):
        return False
    return bool(model.geom(geom).name.startswith(prefix))


def _put_first(course: Course) -> None:
    """Let what has a friction of its own decide it, against soles that decide theirs otherwise.

    Of two geoms MuJoCo takes the larger friction, or that of the one with the higher priority. The
    rest of what that one decides is as it is on the ground, where soles do.
    """
    model = course.model
    own = [geom for element in course.elements if element.slippery for geom in element.geom_ids]
    if own:
        sole = int(np.argmax(model.geom_priority))
        model.geom_priority[own] = model.geom_priority[sole] + 1
        for field in ("condim", "solmix", "solref", "solimp"):
            values = getattr(model, f"geom_{field}")
            values[own] = values[sole]


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
    address = int(model.joint(robot.base).qposadr[0])
    place = (*start.position, start.height)
    qpos[address : address + ROOT] = standing_root(robot, place, start.yaw)
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
    if abs(best - height) > LEVEL_TOLERANCE * scenario.scale.length:
        listed = ", ".join(f"{h:g}" for h in heights)
        raise InputError(
            f"{scenario.path or scenario.name}: {key}.height: found {height:g}; there "
            f"is a void, the surfaces at {list(position)} are at {listed}"
        )
    return best
