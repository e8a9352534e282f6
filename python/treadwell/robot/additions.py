"""What a `robot.toml` adds to its MJCF: so that a model from elsewhere serves as it is.

Whatever the MJCF has of the robot counts. Only what it lacks is added, from tables that say it, and
then the whole is checked as if the MJCF had had it.
"""

import math
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.mjcf.build import compiled
from treadwell.robot.file import LegTable, RobotFile

STAND = "stand"
"""Name of the keyframe in which the robot stands upright."""
BASE = "base"
"""Name that a free joint without one gets."""
PHYSICS_STEP = 0.002
"""Of every simulation, s, whatever a model says: five steps are a control tick."""
SEEN_GROUPS = 3
"""Geoms of the groups below this are what a camera sees."""

_CONTACT_FORCE_AND_PLACE = 1 << int(mujoco.mjtConDataField.mjCONDATA_FORCE) | 1 << int(
    mujoco.mjtConDataField.mjCONDATA_POS
)
_NET_FORCE, _ONE = 3, 1


def complete(spec: mujoco.MjSpec, file: RobotFile, toml: Path) -> None:
    """Add to a specification what its `robot.toml` says and it lacks.

    Args:
        spec: as read from the MJCF; changed.
        file: the parsed `robot.toml`.
        toml: its path, for messages.

    Raises:
        InputError: a table of `robot.toml` adds what the MJCF has, or to what it has not.
    """
    _leave_out_world(spec)
    _add_options(spec)
    _name_base(spec)
    _add_joint_numbers(spec, file, toml)
    _replace_servos(spec, file)
    _add_imu(spec, file, toml)
    _add_camera(spec, file, toml)
    for leg in (file.legs.left, file.legs.right):
        _add_forces(spec, leg)
    _show_shapes(spec)
    # The last: for it, the rest is compiled.
    _add_stand(spec, file, toml)


def prepare(spec: mujoco.MjSpec) -> None:
    """Prepare a specification for its simulation: our time step, motors' friction in the servos.

    A control is then the motor's torque less the friction: where the motor brakes at its peak that
    is more than the peak, which a control's range must leave room for.
    """
    friction = {joint.name: joint.frictionloss for joint in spec.joints}
    ties = [tie for tie in spec.equalities if tie.type == mujoco.mjtEq.mjEQ_JOINT]
    turned = {actuator.target for actuator in spec.actuators} | {tie.name1 for tie in ties}
    for joint in spec.joints:
        if joint.name in turned:
            joint.frictionloss = 0.0
    for actuator in spec.actuators:
        more = friction.get(actuator.target, 0.0)
        for tie in ties:
            if tie.name2 == actuator.target:
                more += abs(tie.data[1]) * friction.get(tie.name1, 0.0)
        low, high = actuator.ctrlrange
        actuator.ctrlrange = [low - more, high + more]
    spec.option.timestep = PHYSICS_STEP
    # The solver's rows of friction kept the sweeps against slip going: without them they would stop
    # before the soles are held.
    spec.option.noslip_tolerance = 0.0


def _leave_out_world(spec: mujoco.MjSpec) -> None:
    """Leave out what stands on the world and not on the robot, as the floor of a scene does."""
    for geom in list(spec.worldbody.geoms):
        spec.delete(geom)


def _add_options(spec: mujoco.MjSpec) -> None:
    """Give a model that says nothing of the physics what the robots of the testbed have.

    With MuJoCo's own defaults a loaded sole creeps over the floor, which no sole does.
    """
    ours, bare = spec.option, mujoco.MjSpec().option
    fields = ("integrator", "cone", "impratio", "noslip_iterations", "iterations", "solver")
    if any(getattr(ours, field) != getattr(bare, field) for field in fields):
        return
    ours.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    ours.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    ours.impratio = 10.0
    ours.noslip_iterations = 6
    ours.iterations = 30
    ours.ls_iterations = 20


def _name_base(spec: mujoco.MjSpec) -> None:
    joints = list(spec.joints)
    if joints and joints[0].type == mujoco.mjtJoint.mjJNT_FREE and not joints[0].name:
        joints[0].name = BASE


def _add_joint_numbers(spec: mujoco.MjSpec, file: RobotFile, toml: Path) -> None:
    """Ranges of the joints that have none; what motors do to their joints besides torque."""
    for name, bounds in file.ranges.items():
        joint = spec.joint(name)
        if joint is None:
            raise InputError(f"{toml}: ranges.{name}: there is no such joint in {file.robot.model}")
        if _is_limited(joint, spec):
            raise InputError(f"{toml}: ranges.{name}: {file.robot.model} has a range for it")
        joint.range = bounds
        joint.limited = mujoco.mjtLimited.mjLIMITED_TRUE
    for motors in file.motors.values():
        for name in motors.joints:
            joint = spec.joint(name)
            if joint is None:  # `check_robot` says so
                continue
            if motors.damping is not None:
                joint.damping = [motors.damping, 0.0, 0.0]
            if motors.friction is not None:
                joint.frictionloss = motors.friction
            if motors.armature is not None:
                joint.armature = motors.armature


def _is_limited(joint: mujoco.MjsJoint, spec: mujoco.MjSpec) -> bool:
    if joint.limited == mujoco.mjtLimited.mjLIMITED_AUTO:
        return bool(spec.compiler.autolimits) and joint.range[0] < joint.range[1]
    return bool(joint.limited == mujoco.mjtLimited.mjLIMITED_TRUE)


def _replace_servos(spec: mujoco.MjSpec, file: RobotFile) -> None:
    """Put a torque motor on each joint of `[motors]` that has none, or a servo of MuJoCo's.

    The testbed has servos of its own: what drives the model is torque alone.
    """
    # One that another one's motor turns has none of its own.
    driven = {actuator.target for actuator in spec.actuators if _is_motor(actuator)}
    driven |= {tie.name1 for tie in spec.equalities if tie.type == mujoco.mjtEq.mjEQ_JOINT}
    peaks = {
        joint: motors.peak_torque for motors in file.motors.values() for joint in motors.joints
    }
    wanted = [joint for joint in peaks if joint not in driven and spec.joint(joint) is not None]
    if not wanted:
        return
    for actuator in list(spec.actuators):
        if actuator.target in wanted and actuator.trntype == mujoco.mjtTrn.mjTRN_JOINT:
            spec.delete(actuator)
    for joint in wanted:
        motor = spec.add_actuator(name=f"{joint} motor", target=joint)
        motor.trntype = mujoco.mjtTrn.mjTRN_JOINT
        motor.set_to_motor()
        motor.ctrllimited = mujoco.mjtLimited.mjLIMITED_TRUE
        motor.ctrlrange = [-peaks[joint], peaks[joint]]
        motor.forcelimited = mujoco.mjtLimited.mjLIMITED_FALSE
    # What keyframes say of the controls no longer fits.
    for key in list(spec.keys):
        key.ctrl = []
        key.act = []


def _is_motor(actuator: mujoco.MjsActuator) -> bool:
    """Whether an actuator is a plain source of torque; `check_robot` looks at its gear."""
    return bool(
        actuator.trntype == mujoco.mjtTrn.mjTRN_JOINT
        and actuator.gaintype == mujoco.mjtGain.mjGAIN_FIXED
        and actuator.biastype == mujoco.mjtBias.mjBIAS_NONE
        and actuator.dyntype == mujoco.mjtDyn.mjDYN_NONE
    )


def _add_imu(spec: mujoco.MjSpec, file: RobotFile, toml: Path) -> None:
    imu = file.imu
    if imu.link is not None:
        if spec.site(imu.site) is not None:
            raise InputError(f"{toml}: imu.link: {file.robot.model} has a site {imu.site!r}")
        _body(spec, imu.link, "imu.link", toml).add_site(name=imu.site, pos=imu.position)
    for name, kind in (
        (imu.gyro, mujoco.mjtSensor.mjSENS_GYRO),
        (imu.accelerometer, mujoco.mjtSensor.mjSENS_ACCELEROMETER),
    ):
        if spec.sensor(name) is None and spec.site(imu.site) is not None:
            sensor = spec.add_sensor(name=name, type=kind)
            sensor.objtype = mujoco.mjtObj.mjOBJ_SITE
            sensor.objname = imu.site


def _add_camera(spec: mujoco.MjSpec, file: RobotFile, toml: Path) -> None:
    mount = file.camera.mount
    if mount is None:
        return
    if spec.camera(file.camera.name) is not None:
        raise InputError(
            f"{toml}: camera.mount: {file.robot.model} has a camera {file.camera.name!r}"
        )
    link = _body(spec, mount.link, "camera.mount.link", toml)
    # MuJoCo's camera looks along its -z with y up: x to the robot's right, then tipped down.
    sin, cos = math.sin(mount.down), math.cos(mount.down)
    axes = np.array([[0.0, -1.0, 0.0], [sin, 0.0, cos], [-cos, 0.0, sin]])
    quat = np.empty(4)
    mujoco.mju_mat2Quat(quat, axes.T.reshape(-1))
    fovy = math.degrees(file.camera.vertical_fov)
    link.add_camera(name=file.camera.name, pos=mount.position, quat=quat, fovy=fovy)


def _add_forces(spec: mujoco.MjSpec, leg: LegTable) -> None:
    """Add the sensor that says with what force the sole is pressed, and where."""
    if spec.sensor(leg.forces) is not None or spec.body(leg.sole.link) is None:
        return
    sensor = spec.add_sensor(name=leg.forces, type=mujoco.mjtSensor.mjSENS_CONTACT)
    sensor.objtype = mujoco.mjtObj.mjOBJ_BODY
    sensor.objname = leg.sole.link
    sensor.intprm = [_CONTACT_FORCE_AND_PLACE, _NET_FORCE, _ONE]


def _show_shapes(spec: mujoco.MjSpec) -> None:
    """Let a robot be seen as what collides, where its model has nothing else to be seen."""
    geoms = list(spec.geoms)
    if all(geom.group >= SEEN_GROUPS for geom in geoms):
        for geom in geoms:
            geom.group = 2


def _add_stand(spec: mujoco.MjSpec, file: RobotFile, toml: Path) -> None:
    """Add the keyframe: upright, the soles on the ground, the joints as `[stand]` says."""
    if not file.stand:
        return
    if any(key.name == STAND for key in spec.keys):
        raise InputError(f"{toml}: stand: {file.robot.model} has a keyframe {STAND!r}")
    model = compiled(spec, str(toml))
    for name in file.stand:
        if mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name) < 1:
            raise InputError(f"{toml}: stand.{name}: there is no such joint in {file.robot.model}")
    spec.add_key(name=STAND, qpos=_standing(model, file))


def _standing(model: mujoco.MjModel, file: RobotFile) -> NDArray[np.float64]:
    data = mujoco.MjData(model)
    if model.njnt == 0 or model.jnt_type[0] != mujoco.mjtJoint.mjJNT_FREE:
        return np.array(data.qpos)  # `check_robot` says so
    data.qpos[:7] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
    data.qpos[7:] = 0.0
    for name, angle in file.stand.items():
        data.qpos[model.joint(name).qposadr[0]] = angle
    mujoco.mj_kinematics(model, data)
    heights = []
    for leg in (file.legs.left, file.legs.right):
        link = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, leg.sole.link)
        if link > 0:
            rotation = data.xmat[link].reshape(3, 3)
            heights.append(float(data.xpos[link][2] + rotation[2] @ np.array(leg.sole.position)))
    qpos = np.array(data.qpos)
    qpos[2] = -sum(heights) / max(1, len(heights))
    return qpos


def _body(spec: mujoco.MjSpec, name: str, key: str, toml: Path) -> mujoco.MjsBody:
    body = spec.body(name)
    if body is None or body == spec.worldbody:
        raise InputError(f"{toml}: {key}: there is no link {name!r} in the model")
    return body
