"""What a `robot.toml` adds to its MJCF: so that a model from elsewhere serves as it is.

Whatever the MJCF has of the robot counts. Only what it lacks is added, from tables that say it, and
then the whole is checked as if the MJCF had had it.
"""

from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.mjcf.build import compiled
from treadwell.robot.anatomy import nearest_to_zero
from treadwell.robot.camera_added import add_camera
from treadwell.robot.file import LegTable, RobotFile
from treadwell.robot.keyframes import STAND
from treadwell.robot.loops import ties_of
from treadwell.robot.model_gaps import fill_gaps, prepare_feet, straighten_ties
from treadwell.robot.motors_found import SAME_FOR_ALL
from treadwell.robot.surfaces import SEEN_GROUPS
from treadwell.robot.turned_links import turn_foot

PHYSICS_STEP = 0.002
"""Of every simulation, s, whatever a model says: five steps are a control tick."""
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
    fill_gaps(spec)
    stand = _keyframe_angles(spec, file, toml)
    legs = {"legs.left": file.legs.left, "legs.right": file.legs.right}
    for key, leg in legs.items():
        turn_foot(spec, leg, key, toml)
        _add_plate(spec, leg)
    add_camera(spec, file, toml)
    _add_joint_numbers(spec, file, toml)
    straighten_ties(spec, {j for group in file.motors.values() for j in group.joints}, str(toml))
    _replace_servos(spec, file)
    _add_imu(spec, file, toml)
    for leg in legs.values():
        _add_forces(spec, leg)
    prepare_feet(spec, {leg.sole.link for leg in legs.values()})
    _show_shapes(spec)
    # The last: for it, the rest is compiled.
    _add_stand(spec, file, stand, toml)


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

    The testbed has servos of its own: what drives the model is torque alone. An actuator that
    drives no joint of `[motors]` goes, too: nothing would tell it what to do.
    """
    peaks = {
        joint: motors.peak_torque for motors in file.motors.values() for joint in motors.joints
    }
    # One that another one's motor turns has none of its own.
    tied = {tie.name1 for tie in spec.equalities if tie.type == mujoco.mjtEq.mjEQ_JOINT}
    kept: set[str] = set()
    # A bound that is alike on all and far above their torques is no motor's.
    one_for_all = len({tuple(actuator.ctrlrange) for actuator in spec.actuators}) == 1
    changed = False
    for actuator in list(spec.actuators):
        name = actuator.target
        if name in peaks and name not in kept and _is_plain_motor(actuator, spec):
            kept.add(name)
            if one_for_all and actuator.ctrlrange[1] > SAME_FOR_ALL * peaks[name]:
                actuator.ctrlrange = [-peaks[name], peaks[name]]
        elif name in peaks or not _moves_joint(actuator):
            spec.delete(actuator)
            changed = True
    for joint in peaks:
        if joint in kept or joint in tied or spec.joint(joint) is None:
            continue
        motor = spec.add_actuator(name=f"{joint} motor", target=joint)
        motor.trntype = mujoco.mjtTrn.mjTRN_JOINT
        motor.set_to_motor()
        motor.ctrllimited = mujoco.mjtLimited.mjLIMITED_TRUE
        motor.ctrlrange = [-peaks[joint], peaks[joint]]
        motor.forcelimited = mujoco.mjtLimited.mjLIMITED_FALSE
        # The servo has this limit.
        spec.joint(joint).actfrclimited = mujoco.mjtLimited.mjLIMITED_FALSE
        changed = True
    if changed:  # what keyframes say of the controls no longer fits
        for key in list(spec.keys):
            key.ctrl = []
            key.act = []


def _moves_joint(actuator: mujoco.MjsActuator) -> bool:
    kinds = (mujoco.mjtTrn.mjTRN_JOINT, mujoco.mjtTrn.mjTRN_JOINTINPARENT)
    return actuator.trntype in kinds


def _is_plain_motor(actuator: mujoco.MjsActuator, spec: mujoco.MjSpec) -> bool:
    """Whether an actuator is a source of torque with gear 1 and a bound on its control."""
    bounded = actuator.ctrllimited == mujoco.mjtLimited.mjLIMITED_TRUE or (
        actuator.ctrllimited == mujoco.mjtLimited.mjLIMITED_AUTO
        and bool(spec.compiler.autolimits)
        and actuator.ctrlrange[0] < actuator.ctrlrange[1]
    )
    return bool(
        bounded
        and actuator.trntype == mujoco.mjtTrn.mjTRN_JOINT
        and actuator.gaintype == mujoco.mjtGain.mjGAIN_FIXED
        and actuator.biastype == mujoco.mjtBias.mjBIAS_NONE
        and actuator.dyntype == mujoco.mjtDyn.mjDYN_NONE
        and actuator.gear[0] == 1.0
        and actuator.gainprm[0] == 1.0
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


def _add_forces(spec: mujoco.MjSpec, leg: LegTable) -> None:
    """Add the sensor that says with what force the sole is pressed, and where."""
    if spec.sensor(leg.forces) is not None or spec.body(leg.sole.link) is None:
        return
    sensor = spec.add_sensor(name=leg.forces, type=mujoco.mjtSensor.mjSENS_CONTACT)
    sensor.objtype = mujoco.mjtObj.mjOBJ_BODY
    sensor.objname = leg.sole.link
    sensor.intprm = [_CONTACT_FORCE_AND_PLACE, _NET_FORCE, _ONE]


def _add_plate(spec: mujoco.MjSpec, leg: LegTable) -> None:
    """Add the plate of a sole whose shapes touch the ground in points, where the file says so."""
    sole, body = leg.sole, spec.body(leg.sole.link)
    if sole.plate is None or body is None:
        return
    x, y, z = sole.position
    geom = body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=[x, y, z + 0.5 * sole.plate],
        size=[0.5 * sole.length, 0.5 * sole.width, 0.5 * sole.plate],
    )
    geom.mass, geom.group, geom.condim = 0.0, SEEN_GROUPS, 3
    # It touches what the foot's own shapes touch.
    own = [other for other in body.geoms if other.contype or other.conaffinity]
    if own:
        geom.contype, geom.conaffinity = own[0].contype, own[0].conaffinity


def _show_shapes(spec: mujoco.MjSpec) -> None:
    """Let a robot be seen as what collides, where its model has nothing else to be seen."""
    geoms = list(spec.geoms)
    if all(geom.group >= SEEN_GROUPS for geom in geoms):
        for geom in geoms:
            geom.group = 2


def _keyframe_angles(spec: mujoco.MjSpec, file: RobotFile, toml: Path) -> dict[str, float] | None:
    """Return the angles of the keyframe `stand`, rad, where it is replaced; None where it stays.

    The keyframes are taken out then: joints may be added that they do not have.
    """
    unit = file.camera.mount is not None and file.camera.mount.pan_tilt
    if not file.stand and not unit:
        return None
    angles = {}
    if any(key.name == STAND for key in spec.keys):
        model = compiled(spec, str(toml))
        qpos = model.key(STAND).qpos
        for joint in range(1, model.njnt):
            angles[model.joint(joint).name] = float(qpos[model.jnt_qposadr[joint]])
    elif not file.stand:
        return None  # `check_robot` says what is missing
    for key in list(spec.keys):
        spec.delete(key)
    return angles


def _add_stand(
    spec: mujoco.MjSpec, file: RobotFile, keyframe: dict[str, float] | None, toml: Path
) -> None:
    """Add the keyframe: upright, the soles on the ground, the joints as `[stand]` says.

    A keyframe `stand` of the model counts for the joints that `[stand]` does not name.
    """
    if keyframe is None:
        return
    model = compiled(spec, str(toml))
    for name in file.stand:
        if mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name) < 1:
            raise InputError(f"{toml}: stand.{name}: there is no such joint in {file.robot.model}")
    spec.add_key(name=STAND, qpos=_standing(model, file, {**keyframe, **file.stand}))


def _standing(
    model: mujoco.MjModel, file: RobotFile, angles: dict[str, float]
) -> NDArray[np.float64]:
    data = mujoco.MjData(model)
    if model.njnt == 0 or model.jnt_type[0] != mujoco.mjtJoint.mjJNT_FREE:
        return np.array(data.qpos)  # `check_robot` says so
    data.qpos[:] = nearest_to_zero(model)
    data.qpos[:7] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
    for name, angle in angles.items():
        data.qpos[model.joint(name).qposadr[0]] = angle
    for follower, tie in ties_of(model).items():
        leader = data.qpos[model.jnt_qposadr[tie.leader]]
        data.qpos[model.jnt_qposadr[follower]] = tie.offset + tie.ratio * leader
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
