"""Why a model has no two legs to walk on: a line for each reason."""

import mujoco
import numpy as np

from treadwell.robot.anatomy import LEG_JOINTS, Anatomy, nameless
from treadwell.robot.joint_roles import shortens
from treadwell.robot.surfaces import solid_geoms

LEAST_KNEE = 0.03
"""Share of a leg's length that its knee changes at least."""
NEAR_M = 0.01
ALONG = 0.95
FULL_TURN_RAD = 2.0 * np.pi
"""The range of a joint that lets a wheel roll, where it has one."""
FEW = 8
"""Names that a line lists."""
_ROUND = (
    int(mujoco.mjtGeom.mjGEOM_SPHERE),
    int(mujoco.mjtGeom.mjGEOM_CYLINDER),
    int(mujoco.mjtGeom.mjGEOM_ELLIPSOID),
)


def leg_faults(anatomy: Anatomy) -> list[str]:
    """Return why there are no two legs of five to seven hinges with soles; none where there are."""
    model = anatomy.model
    if model.njnt < 1 or model.jnt_type[0] != mujoco.mjtJoint.mjJNT_FREE:
        return ["the root body needs a free joint: <freejoint/>"]
    if not anatomy.feet:
        return ["no link has a shape (<geom>) that could stand on the ground"]
    wheels = [foot for foot in anatomy.feet if _is_wheel(anatomy, foot)]
    if wheels:
        names = _list([model.body(foot).name for foot in wheels])
        return [f"stands on wheels ({names}): two legs with feet are needed"]
    if not anatomy.has_two_feet:
        names = _list([model.body(foot).name or f"body {foot}" for foot in anatomy.feet])
        return [
            f"stands on {len(anatomy.feet)} "
            f"{'foot' if len(anatomy.feet) == 1 else 'feet'} ({names}): two legs are needed, one "
            "on each side of the middle (left: +y)"
        ]
    faults = []
    for side, foot in zip(("left", "right"), anatomy.feet, strict=True):
        faults += [f"the {side} leg {line}" for line in _faults(anatomy, foot)]
    left, right = (len(anatomy.leg_chain(foot)) for foot in anatomy.feet)
    if not faults and left != right:
        faults.append(f"the left leg has {left} hinges, the right one {right}: as many are needed")
    return faults


def _faults(anatomy: Anatomy, foot: int) -> list[str]:
    model = anatomy.model
    joints = anatomy.leg_chain(foot)
    names = [model.joint(joint).name for joint in joints]
    fewest, most = LEG_JOINTS
    if not fewest <= len(joints) <= most:
        listed = _list([name or "without a name" for name in names])
        return [f"has {len(joints)} hinges ({listed}): {fewest} to {most} are needed"]
    if not all(names) or not model.body(int(model.jnt_bodyid[joints[-1]])).name:
        parts = _list(nameless(model))
        return [f"has parts without a name ({parts}): two legs of named hinges are needed"]
    sliding = [
        model.joint(joint).name or f"joint {joint}"
        for body in anatomy.links(foot)[1:]
        for joint in range(
            int(model.body_jntadr[body]), int(model.body_jntadr[body] + model.body_jntnum[body])
        )
        if model.jnt_type[joint] != mujoco.mjtJoint.mjJNT_HINGE
    ]
    if sliding:
        return [f"has joints that are no hinges ({_list(sliding)})"]
    link = int(model.jnt_bodyid[joints[-1]])
    sole = anatomy.sole(link)
    # What is round about its joint rolls, however wide the part of it that is near to the ground.
    rolls = _is_round(anatomy, link)
    if rolls or not sole.bears:
        size = f"{1e3 * sole.length:.0f} x {1e3 * sole.width:.0f} mm"
        return [
            f"has no sole: {model.body(link).name!r} touches the ground in a point or a line, "
            f"{'round as it is' if rolls else size}; give it a box, or a small sphere at each of "
            "four corners"
        ]
    if shortens(anatomy.data, joints, anatomy.sole_place(link, sole)) < LEAST_KNEE:
        return ["has no knee: no joint changes the distance from hip to sole"]
    return []


def _is_wheel(anatomy: Anatomy, foot: int) -> bool:
    """Whether a link is round about its own, level joint, and turns all the way round."""
    if not _is_round(anatomy, foot):
        return False
    model, joint = anatomy.model, int(anatomy.model.body_jntadr[foot])
    low, high = model.jnt_range[joint]
    return not model.jnt_limited[joint] or bool(high - low >= FULL_TURN_RAD)


def _is_round(anatomy: Anatomy, foot: int) -> bool:
    """Whether a link is round about its own, level joint."""
    model, data = anatomy.model, anatomy.data
    if not model.body_jntnum[foot]:
        return False
    joint = int(model.body_jntadr[foot])
    axis, anchor = data.xaxis[joint], data.xanchor[joint]
    if abs(float(axis[2])) > 1.0 - ALONG:
        return False
    own = np.flatnonzero((model.geom_bodyid == foot) & solid_geoms(model))
    if not len(own):
        return False
    for geom in own:
        if int(model.geom_type[geom]) not in _ROUND:
            return False
        apart = data.geom_xpos[geom] - anchor
        apart = apart - axis * float(apart @ axis)
        if float(np.linalg.norm(apart)) > NEAR_M:
            return False
    return True


def _list(names: list[str]) -> str:
    more = f" and {len(names) - FEW} more" if len(names) > FEW else ""
    return ", ".join(names[:FEW]) + more
