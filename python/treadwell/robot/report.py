"""A report on a robot's folder: what was found, what is missing, what its gait can do."""

import math
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from treadwell.errors import InputError
from treadwell.robot.anatomy import Anatomy, nameless
from treadwell.robot.file import SoleTable
from treadwell.robot.leg_faults import leg_faults
from treadwell.robot.leg_loads import leg_loads, too_weak
from treadwell.robot.load import Robot, load_folder
from treadwell.robot.model_file import compile_alone, find_model
from treadwell.robot.reach import Reach, Rise, what_ends
from treadwell.robot.reading import required_keys
from treadwell.robot.soles import Sole
from treadwell.robot.step_blocks import TREAD_M

SCHEMA = "treadwell.robot/1"
SOLE_APART_M = 0.006
"""By how much a sole may differ from what touches the ground before the report says so."""


def report_on(folder: Path) -> dict[str, Any]:
    """Return a report on a robot's folder as plain data.

    It goes as far as the folder lets it: an MJCF alone gives its own part.

    Args:
        folder: with an MJCF, and a `robot.toml` or not.

    Raises:
        InputError: there is no folder, or no MJCF that MuJoCo reads.
    """
    if not folder.is_dir():
        raise InputError(f"{folder}: there is no such folder")
    mjcf = find_model(folder)
    bare = compile_alone(mjcf)
    document: dict[str, Any] = {
        "schema": SCHEMA,
        "folder": str(folder),
        "name": folder.resolve().name,
        "model": mjcf.name,
        "problems": [],
        "notes": [],
    }
    robot = None
    try:
        robot = load_folder(folder)
    except InputError as error:
        document["problems"] += str(error).splitlines()
        if not (folder / "robot.toml").exists():
            document["problems"] = [
                f"{folder / 'robot.toml'}: is missing; `treadwell robot check "
                f"{shlex.quote(str(folder))} --write-template` drafts it",
                *required_keys(),
            ]
        told = "\n".join(document["problems"])
        parts = [f"{mjcf}: {part} has no name" for part in nameless(bare)]
        document["problems"] += [line for line in parts if line not in told]
    anatomy = Anatomy.of(bare if robot is None else robot.nominal)
    document |= _found(anatomy)
    if robot is not None:
        document |= _told(robot, anatomy, document)
        document["problems"] += too_weak(document["loads"])
        try:
            document["gait"] = _gait(robot)
        except InputError as error:
            document["problems"] += str(error).splitlines()
    document["fits"] = not document["problems"]
    return document


def _found(anatomy: Anatomy) -> dict[str, Any]:
    """Return what the model shows by itself."""
    model = anatomy.model
    links = [
        {"name": model.body(body).name, "mass": float(model.body_mass[body])}
        for body in range(1, model.nbody)
    ]
    legs = anatomy.legs()
    chains = {
        side: {"joints": _joints(anatomy, leg.joints, leg.foot), "foot": leg.foot}
        for side, leg in legs.items()
    }
    faults = leg_faults(anatomy)
    unlike = []
    if not faults:
        unlike = anatomy.differences(legs["left"].joints, legs["right"].joints)
    return {
        "mass": {"total": float(sum(link["mass"] for link in links)), "links": links},
        "legs": chains,
        "leg_faults": faults,
        "mirrored": not faults and not unlike,
        "unlike": unlike,
        "soles": {side: _sole(leg.sole) for side, leg in legs.items()},
        "actuators": [_actuator(model, number) for number in range(model.nu)],
        "cameras": [model.camera(number).name for number in range(model.ncam)],
        "sites": [model.site(number).name for number in range(model.nsite)],
        "keyframes": [model.key(number).name for number in range(model.nkey)],
        "without_range": [
            model.joint(joint).name
            for joint in range(model.njnt)
            if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE and not model.jnt_limited[joint]
        ],
    }


def _joints(anatomy: Anatomy, names: Sequence[str], foot: str) -> list[dict[str, Any]]:
    """Return what is known of a leg's joints, from the hip down."""
    what = anatomy.roles(names, anatomy.model.body(foot).id)
    return [_joint(anatomy, name, role) for name, role in zip(names, what, strict=True)]


def _joint(anatomy: Anatomy, name: str, role: str) -> dict[str, Any]:
    model = anatomy.model
    joint = model.joint(name).id
    limited = bool(model.jnt_limited[joint])
    return {
        "name": name,
        "role": role,
        "axis": [round(float(value), 4) + 0.0 for value in anatomy.axis(joint)],
        "range": [float(value) for value in model.jnt_range[joint]] if limited else None,
    }


def _sole(sole: Sole) -> dict[str, Any]:
    position = [round(value, 5) for value in sole.position]
    return {"position": position, "length": sole.length, "width": sole.width}


def _actuator(model: mujoco.MjModel, number: int) -> dict[str, Any]:
    on_joint = model.actuator_trntype[number] == mujoco.mjtTrn.mjTRN_JOINT
    servo = model.actuator_biastype[number] != mujoco.mjtBias.mjBIAS_NONE
    bounds = model.actuator_forcerange[number] if servo else model.actuator_ctrlrange[number]
    return {
        "name": model.actuator(number).name,
        "joint": model.joint(int(model.actuator_trnid[number, 0])).name if on_joint else None,
        "kind": "servo" if servo else "motor",
        "torque": float(bounds[1]) if bounds[0] < bounds[1] else None,
        "stiffness": float(model.actuator_gainprm[number, 0]) if servo else None,
    }


def _told(robot: Robot, anatomy: Anatomy, document: dict[str, Any]) -> dict[str, Any]:
    """Return what `robot.toml` says of the model, and write notes where the two differ."""
    file, limits = robot.file, robot.limits
    legs = {"left": file.legs.left, "right": file.legs.right}
    for side, leg in legs.items():
        seen = anatomy.sole(robot.nominal.body(leg.sole.link).id)
        apart = _apart(leg.sole, seen)
        if apart > SOLE_APART_M:
            document["notes"].append(
                f"legs.{side}.sole: differs by {1e3 * apart:.0f} mm from what touches the ground, "
                f"{1e3 * seen.length:.0f} x {1e3 * seen.width:.0f} mm"
            )
    data = mujoco.MjData(robot.nominal)
    data.qpos[:] = robot.stand_qpos
    mujoco.mj_kinematics(robot.nominal, data)
    mujoco.mj_comPos(robot.nominal, data)
    mujoco.mj_camlight(robot.nominal, data)
    camera = robot.nominal.camera(file.camera.name).id
    looks = -data.cam_xmat[camera].reshape(3, 3)[:, 2]
    soles = {
        side: {**leg.sole.model_dump(exclude={"link"}), "position": list(leg.sole.position)}
        for side, leg in legs.items()
    }
    return {
        "legs": {
            side: {"joints": _joints(anatomy, leg.joints, leg.sole.link), "foot": leg.sole.link}
            for side, leg in legs.items()
        },
        "leg_faults": [],
        "unlike": anatomy.differences(legs["left"].joints, legs["right"].joints),
        "soles": soles,
        "motors": [
            {
                "joint": name,
                "peak_torque": float(limits.peak_torque[order]),
                "no_load_speed": float(limits.no_load_speed[order]),
                "kp": float(limits.kp[order]),
                "kv": float(limits.kv[order]),
            }
            for order, name in enumerate(robot.joints)
        ],
        "loads": leg_loads(robot, data),
        "camera": {
            "name": file.camera.name,
            "link": robot.nominal.body(int(robot.nominal.cam_bodyid[camera])).name,
            "height": float(data.cam_xpos[camera][2]),
            "ahead": float(data.cam_xpos[camera][0]),
            "down": math.atan2(-float(looks[2]), float(np.hypot(looks[0], looks[1]))),
            "fields_of_view": [file.camera.horizontal_fov, file.camera.vertical_fov],
            "size": [file.camera.width, file.camera.height],
            "period": file.camera.period,
            "sensor": file.camera.sensor,
        },
        "imu": {"site": file.imu.site, "link": _site_link(robot, file.imu.site)},
        "stand": {
            "height_of_mass": float(data.subtree_com[1][2]),
            "mass_ahead_of_soles": _ahead(robot, data),
        },
    }


def _site_link(robot: Robot, site: str) -> str:
    model = robot.nominal
    return str(model.body(int(model.site_bodyid[model.site(site).id])).name)


def _ahead(robot: Robot, data: mujoco.MjData) -> float:
    """Return how far the centre of mass is ahead of the soles' middle in the stance, m."""
    middle = 0.0
    for leg in (robot.file.legs.left, robot.file.legs.right):
        link = robot.nominal.body(leg.sole.link).id
        rotation = data.xmat[link].reshape(3, 3)
        middle += 0.5 * float(data.xpos[link][0] + rotation[0] @ np.array(leg.sole.position))
    return float(data.subtree_com[1][0]) - middle


def _apart(told: SoleTable, seen: Sole) -> float:
    """Return the largest distance between the edges of two rectangles, m."""
    position, length, width = seen.position, seen.length, seen.width
    ends = []
    for centre, size, other, extent in (
        (told.position[0], told.length, position[0], length),
        (told.position[1], told.width, position[1], width),
    ):
        ends += [abs(centre - other + sign * 0.5 * (size - extent)) for sign in (-1, 1)]
    return max(*ends, abs(told.position[2] - position[2]))


def _gait(robot: Robot) -> dict[str, Any]:
    """Return what the gait asks for, and what the legs could do."""
    reach = Reach(robot)
    gait = reach.gait
    hip, thigh, shank, ankle = reach.legs.lengths("left")
    up, down = reach.rises(1.0), reach.rises(-1.0)
    by, open_turn = reach.legs.solved_by("left")
    return {
        "tread": TREAD_M * robot.scale,
        "scale": robot.scale,
        "solved_by": "closed form" if by is None else "Newton's method",
        "left_open": open_turn,
        "thigh": thigh,
        "shank": shank,
        "ankle_height": ankle,
        "hips_apart": 2.0 * abs(float(hip[1])),
        "hip_height": gait["hip_height"],
        "speed": gait["max_forward"] / gait["step_time"],
        "step": {"asked": gait["max_forward"], "reached": reach.longest_step_m()},
        "sideways": {"asked": gait["max_sideways"], "reached": reach.widest_step_m()},
        "turn": {"asked": gait["max_turn"], "reached": reach.largest_turn_rad()},
        "up": {"asked": gait["climb_rise"], **_steps(up)},
        "down": {"asked": gait["climb_rise"], **_steps(down)},
    }


def _steps(rises: list[Rise]) -> dict[str, Any]:
    possible = [rise for rise in rises if rise.possible]
    return {
        "highest": abs(possible[-1].height_m) if possible else 0.0,
        "ends": what_ends(rises[-1]),
        "steps": [
            {
                "height": abs(rise.height_m),
                "hips": rise.hips_m,
                "knee_torque": rise.knee_torque_nm,
                "share": rise.torque_share,
                "joint": rise.joint,
            }
            for rise in possible
        ],
    }
