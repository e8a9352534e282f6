"""What a stranger's model is given so that it is a robot alone: whatever its `robot.toml` says."""

import mujoco
import numpy as np

from treadwell.mjcf.build import compiled
from treadwell.robot.loops import Tie, connects, drivers, ties_of
from treadwell.robot.surfaces import SEEN_GROUPS

BASE = "base"
"""Name that a free joint without one gets."""
GEAR_SOLREF = (0.004, 1.0)
GEAR_SOLIMP = (0.999, 0.9999, 0.0001, 0.5, 2.0)
"""How hard the joints of a gear hold together, as MuJoCo's `solref` and `solimp` have it."""
SOLE_SOLREF = (0.01, 1.0)
SOLE_SOLMIX = 1e3
"""How hard a sole is, as those of `qrio` are, and by how much it counts for that against the
ground. Friction, and what decides it, stay as the model and the scenario say."""


def fill_gaps(spec: mujoco.MjSpec) -> None:
    """Make a model one robot on a free root, with the physics of the testbed where it says none.

    Args:
        spec: as read; changed.
    """
    _leave_out_world(spec)
    _merge_options(spec)
    _free_root(spec)


def straighten_ties(spec: mujoco.MjSpec, motors: set[str], what: str) -> None:
    """Make every joint that a motor moves by gears or rods follow that motor's joint directly.

    Ties between joints of which none has a motor, or whose first one has it, are turned round and
    shortened; the rods of a closed loop become ties where they move their joints along a line.

    Args:
        spec: the model; changed.
        motors: names of the joints that have one; none: those with an actuator.
        what: begins the message where MuJoCo cannot build it.

    Raises:
        InputError: MuJoCo cannot build the model.
    """
    if not len(list(spec.equalities)):
        return
    _stiffen_gears(spec)
    model = compiled(spec, what)
    numbers = {model.joint(name).id for name in motors if _has_joint(model, name)}
    numbers = numbers or drivers(model)
    ties = ties_of(model, numbers)
    if not connects(model) and all(_is_straight(model, n, numbers) for n in range(model.neq)):
        return
    loops = {joint for joint, tie in ties.items() if tie.loop}
    _replace(spec, model, ties, loops)


def _stiffen_gears(spec: mujoco.MjSpec) -> None:
    """Make gears rigid of which the model does not say how they give: `[encoders]` has their play.

    By MuJoCo's defaults, which are made for contacts, a leg's gear winds up by 3 degrees.
    """
    plain = mujoco.MjSpec().add_equality()
    for equality in spec.equalities:
        says = np.any(equality.solref != plain.solref) or np.any(equality.solimp != plain.solimp)
        if equality.type == mujoco.mjtEq.mjEQ_JOINT and not says:
            equality.solref, equality.solimp = GEAR_SOLREF, GEAR_SOLIMP


def _is_straight(model: mujoco.MjModel, number: int, motors: set[int]) -> bool:
    """Whether an equality says that a joint without a motor follows one that has it."""
    if model.eq_type[number] != mujoco.mjtEq.mjEQ_JOINT:
        return True
    one, other = int(model.eq_obj1id[number]), int(model.eq_obj2id[number])
    return one not in motors and other in motors


def _has_joint(model: mujoco.MjModel, name: str) -> bool:
    return bool(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name) >= 0)


def _replace(
    spec: mujoco.MjSpec, model: mujoco.MjModel, ties: dict[int, Tie], loops: set[int]
) -> None:
    """Put the ties in the place of the equalities that they are made of."""
    closed = set(_explained(model, loops))
    for number, equality in enumerate(list(spec.equalities)):
        is_gear = model.eq_type[number] == mujoco.mjtEq.mjEQ_JOINT
        if number in closed or (is_gear and int(model.eq_obj1id[number]) in _ends(ties)):
            spec.delete(equality)
    for joint, tie in ties.items():
        equality = spec.add_equality(type=mujoco.mjtEq.mjEQ_JOINT)
        equality.solref, equality.solimp = GEAR_SOLREF, GEAR_SOLIMP
        equality.objtype = mujoco.mjtObj.mjOBJ_JOINT
        equality.name1, equality.name2 = model.joint(joint).name, model.joint(tie.leader).name
        data = np.zeros(len(equality.data))
        data[:2] = tie.offset, tie.ratio
        equality.data = data


def _ends(ties: dict[int, Tie]) -> set[int]:
    return set(ties) | {tie.leader for tie in ties.values()}


def _explained(model: mujoco.MjModel, loops: set[int]) -> list[int]:
    """Return the connects that hold nothing but joints of solved loops."""
    if not loops:
        return []
    found = []
    bodies = {int(model.jnt_bodyid[joint]) for joint in loops}
    for number in connects(model):
        ends = []
        for obj in (int(model.eq_obj1id[number]), int(model.eq_obj2id[number])):
            site = model.eq_objtype[number] == mujoco.mjtObj.mjOBJ_SITE
            ends.append(int(model.site_bodyid[obj]) if site else obj)
        if any(end in bodies for end in ends):
            found.append(number)
    return found


def prepare_feet(spec: mujoco.MjSpec, links: set[str]) -> None:
    """Let feet touch the ground, and be as hard as those of the testbed's robots.

    Args:
        spec: changed.
        links: names of the feet's links.
    """
    _let_feet_touch(spec, links)
    _harden_soles(spec, links)


def _harden_soles(spec: mujoco.MjSpec, links: set[str]) -> None:
    """Give soles the hardness of the testbed's where the model does not say how they give.

    With MuJoCo's own default a foot that is light for what it carries sinks into an edge by 5 mm,
    and the robot on it leans over that edge.
    """
    plain = mujoco.MjSpec().worldbody.add_geom()
    for name in links:
        body = spec.body(name)
        for geom in _with_children(body) if body is not None else []:
            says = np.any(geom.solref != plain.solref) or np.any(geom.solimp != plain.solimp)
            if (geom.contype or geom.conaffinity) and not says:
                geom.solref, geom.solmix = SOLE_SOLREF, SOLE_SOLMIX


def _with_children(body: mujoco.MjsBody) -> list[mujoco.MjsGeom]:
    """Return the shapes of a link and of those that hang on it."""
    return list(body.geoms) + [geom for child in body.bodies for geom in child.geoms]


def _let_feet_touch(spec: mujoco.MjSpec, links: set[str]) -> None:
    """Let the shapes of feet touch the ground where the model says by pairs alone what touches."""
    for name in links:
        body = spec.body(name)
        if body is None:
            continue
        geoms = _with_children(body)
        if any(geom.contype or geom.conaffinity for geom in geoms):
            continue
        hidden = [geom for geom in geoms if geom.group >= SEEN_GROUPS]
        for geom in hidden or geoms:
            geom.contype, geom.conaffinity = 1, 1
            geom.condim = max(geom.condim, 3)


def _leave_out_world(spec: mujoco.MjSpec) -> None:
    """Leave out what stands on the world and not on the robot, as the floor of a scene does."""
    for geom in list(spec.worldbody.geoms):
        spec.delete(geom)
    roots = list(spec.worldbody.bodies)
    free = [body for body in roots if _is_free(body)]
    if len(free) == 1 and len(roots) > 1:
        for body in roots:
            if body != free[0]:
                spec.delete(body)


def _is_free(body: mujoco.MjsBody) -> bool:
    return any(joint.type == mujoco.mjtJoint.mjJNT_FREE for joint in body.joints)


def _merge_options(spec: mujoco.MjSpec) -> None:
    """Give a model what the robots of the testbed have, wherever it says nothing else.

    With MuJoCo's own defaults a loaded sole creeps over the floor, which no sole does.
    """
    own, bare = spec.option, mujoco.MjSpec().option
    ours = {
        "integrator": mujoco.mjtIntegrator.mjINT_IMPLICITFAST,
        "cone": mujoco.mjtCone.mjCONE_ELLIPTIC,
        "impratio": 10.0,
        "noslip_iterations": 6,
        "iterations": 30,
        "ls_iterations": 20,
    }
    for name, value in ours.items():
        if getattr(own, name) == getattr(bare, name):
            setattr(own, name, value)


def _free_root(spec: mujoco.MjSpec) -> None:
    """Give a root that is fixed to the world a free joint, and a free joint without one a name."""
    roots = list(spec.worldbody.bodies)
    if len(roots) == 1 and not list(roots[0].joints):
        roots[0].add_freejoint()
        for key in list(spec.keys):
            spec.delete(key)  # their positions lack the root's
    joints = list(spec.joints)
    if joints and joints[0].type == mujoco.mjtJoint.mjJNT_FREE and not joints[0].name:
        joints[0].name = BASE
