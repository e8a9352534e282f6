"""Whether a `robot.toml` fits its MJCF: names that exist, a body that can be driven."""

import math
from pathlib import Path

import mujoco
import numpy as np

from treadwell.errors import InputError
from treadwell.robot.check_motors import Lookup, check_motors, legs_of
from treadwell.robot.file import LegTable, RobotFile
from treadwell.robot.followers import is_tie

SQUARE_PIXELS = 0.02
"""How far the focal lengths of the two fields of view may differ, as a share."""
FORCE_AND_PLACE = 6
"""Numbers of a contact sensor that tells a force and where it acts."""
STEEP = 0.8
"""A camera that looks more down than this, as a sine, looks at the ground, wherever it faces."""
FLAT = 1e-3
"""How far the soles may be from the ground in the keyframe, m, and from level, rad."""


def check_robot(toml: Path, mjcf: Path, model: mujoco.MjModel, file: RobotFile) -> None:
    """Check that both files describe one robot.

    Args:
        toml: path of the `robot.toml`, for messages.
        mjcf: path of the MJCF, for messages.
        model: the compiled MJCF.
        file: the parsed `robot.toml`.

    Raises:
        InputError: they do not; names the file, the key, what was found and what is allowed.
    """
    _check_links(mjcf, model)
    _check_joints(mjcf, model)
    _check_ties(mjcf, model)
    check_motors(Lookup(toml, mjcf, model, file))
    _Checker(toml, mjcf, model, file).check()


def _check_links(mjcf: Path, model: mujoco.MjModel) -> None:
    """Refuse what is not one free root with named links, one joint at most for each."""
    for field in ("body_mass", "body_pos", "body_ipos", "body_inertia", "jnt_range", "jnt_axis"):
        if not np.isfinite(getattr(model, field)).all():
            raise InputError(f"{mjcf}: a number is not finite ({field})")
    if model.njnt < 2 or model.jnt_type[0] != mujoco.mjtJoint.mjJNT_FREE:
        raise InputError(f"{mjcf}: the root body needs a free joint, and joints must follow it")
    for body in range(1, model.nbody):
        joints, name = int(model.body_jntnum[body]), model.body(body).name
        if not name:
            raise InputError(f"{mjcf}: body {body} has no name")
        if model.body_parentid[body] == 0 and body > 1:
            raise InputError(f"{mjcf}: there must be one root body, {name!r} is another")
        if joints > 1:
            raise InputError(f"{mjcf}: body {name!r} has {joints} joints, 1 is the limit")


def _check_joints(mjcf: Path, model: mujoco.MjModel) -> None:
    """Refuse what is not a named hinge with a range."""
    if not 0.0 < model.opt.timestep < math.inf:
        raise InputError(f"{mjcf}: option.timestep must be > 0, got {model.opt.timestep:g}")
    for joint in range(1, model.njnt):
        name = model.joint(joint).name
        if not name:
            raise InputError(f"{mjcf}: joint {joint} has no name")
        if model.jnt_type[joint] != mujoco.mjtJoint.mjJNT_HINGE:
            raise InputError(f"{mjcf}: joint {name!r} must be a hinge")
        low, high = model.jnt_range[joint]
        if not model.jnt_limited[joint] or low >= high:
            raise InputError(
                f"{mjcf}: joint {name!r} needs a range, got {low:g} to {high:g}; "
                "it may also stand in robot.toml, [ranges]"
            )


def _check_ties(mjcf: Path, model: mujoco.MjModel) -> None:
    """Refuse equalities other than between a joint without a motor and one that has one."""
    driven = {int(model.actuator_trnid[i, 0]) for i in range(model.nu)}
    tied = [int(joint) for joint in model.eq_obj1id]
    for i in range(model.neq):
        if model.eq_type[i] != mujoco.mjtEq.mjEQ_JOINT:
            continue  # what holds links together is the physics' own
        fits = is_tie(model, i) and tied.count(tied[i]) == 1
        if not fits or tied[i] in driven or int(model.eq_obj2id[i]) not in driven:
            raise InputError(
                f"{mjcf}: equality {model.equality(i).name!r} must tie a joint1 without a motor "
                'to a joint2 with one, by polycoef="offset ratio 0 0 0"'
            )


class _Checker(Lookup):
    """Looks up what `robot.toml` names."""

    def check(self) -> None:
        file = self.file
        self.find("body.torso", file.body.torso, self.links, "link")
        for joint in file.trunk.joints:
            self.find("trunk.joints", joint, self.joints, "joint")
        self._check_stand()
        for side, leg in legs_of(file):
            self._check_leg(f"legs.{side}", leg)
        self._check_arms("arms.rest", file.arms.rest)
        self._check_arms("arms.raised", file.arms.raised)
        self._check_imu()
        self._check_camera()

    def _check_arms(self, table: str, angles: dict[str, float]) -> None:
        for joint, angle in angles.items():
            number = self.find(table, joint, self.joints, "joint")
            low, high = self.model.jnt_range[number]
            if not low <= angle <= high:
                self.fail(f"{table}.{joint}", f"must be within {low:g} to {high:g}, got {angle}")

    def _check_leg(self, key: str, leg: LegTable) -> None:
        model = self.model
        bodies = []
        for name in leg.joints:
            joint = self.find(f"{key}.joints", name, self.joints, "joint")
            bodies.append(int(model.jnt_bodyid[joint]))
        for above, below, name in zip(bodies, bodies[1:], leg.joints[1:], strict=False):
            if above == below or not self._carries(above, below):
                self.fail(
                    f"{key}.joints",
                    f"must be a chain from the hip down, but {name!r} "
                    f"does not follow the one before it in {self.mjcf.name}",
                )
        link = self.find(f"{key}.sole.link", leg.sole.link, self.links, "link")
        if not self._carries(bodies[-1], link):
            end = model.body(bodies[-1]).name
            self.fail(
                f"{key}.sole.link",
                f"must be the leg's last, {end!r}, or fixed to it, got {leg.sole.link!r}",
            )
        self._check_forces(f"{key}.forces", leg)
        data = mujoco.MjData(model)
        mujoco.mj_resetDataKeyframe(model, data, model.key("stand").id)
        mujoco.mj_kinematics(model, data)
        rotation = data.xmat[link].reshape(3, 3)
        height = float(data.xpos[link][2] + rotation[2] @ np.array(leg.sole.position))
        tilt = math.hypot(rotation[2, 0], rotation[2, 1])
        if abs(height) > FLAT or tilt > FLAT:
            self.fail(
                f"{key}.sole",
                f"must lie flat on the ground in {self._stance()}, "
                f"its centre is {1e3 * height:.1f} mm above it, and it is tilted by {tilt:.3f} rad",
            )

    def _carries(self, above: int, below: int) -> bool:
        """Whether a link is another one or carries it."""
        while below > above:
            below = int(self.model.body_parentid[below])
        return below == above

    def _stance(self) -> str:
        """Return which place says how the robot stands."""
        if self.file.stand:
            return "the stance of [stand]"
        return f"the keyframe 'stand' of {self.mjcf.name}"

    def _check_forces(self, key: str, leg: LegTable) -> None:
        kind = mujoco.mjtSensor.mjSENS_CONTACT
        sensor = self._check_sensor(key, leg.forces, kind, "contact", None)
        if self.model.sensor_dim[sensor] != FORCE_AND_PLACE:
            self.fail(key, f"sensor {leg.forces!r} must have num 1 and data 'force pos'")

    def _check_stand(self) -> None:
        model = self.model
        if "stand" not in [model.key(i).name for i in range(model.nkey)]:
            raise InputError(
                f"{self.mjcf}: has no keyframe 'stand', and robot.toml no table [stand]"
            )
        angles = model.key("stand").qpos[7:]
        for name, joint in self.joints.items():
            low, high = model.jnt_range[joint]
            angle = angles[joint - 1]
            if not low <= angle <= high:
                if name in self.file.stand:
                    self.fail(f"stand.{name}", f"must be within {low:g} to {high:g}, got {angle:g}")
                raise InputError(
                    f"{self.mjcf}: keyframe 'stand': joint {name!r} must be within "
                    f"{low:g} to {high:g}, got {angle:g}"
                )

    def _check_imu(self) -> None:
        imu = self.file.imu
        site = self.find("imu.site", imu.site, self.sites, "site")
        self._check_sensor("imu.gyro", imu.gyro, mujoco.mjtSensor.mjSENS_GYRO, "gyro", site)
        kind = mujoco.mjtSensor.mjSENS_ACCELEROMETER
        self._check_sensor("imu.accelerometer", imu.accelerometer, kind, "accelerometer", site)

    def _check_sensor(
        self, key: str, name: str, kind: mujoco.mjtSensor, word: str, site: int | None
    ) -> int:
        sensor = self.find(key, name, self.sensors, "sensor")
        if self.model.sensor_type[sensor] != kind:
            self.fail(key, f"sensor {name!r} of {self.mjcf.name} must be a <{word}>")
        if site is not None and self.model.sensor_objid[sensor] != site:
            self.fail(key, f"sensor {name!r} of {self.mjcf.name} must sit on the site imu.site")
        return sensor

    def _check_view(self, camera: int) -> None:
        """Refuse a camera that looks backwards, or up, in the stance."""
        data = mujoco.MjData(self.model)
        mujoco.mj_resetDataKeyframe(self.model, data, self.model.key("stand").id)
        mujoco.mj_kinematics(self.model, data)
        mujoco.mj_camlight(self.model, data)
        link = self.model.body(self.file.legs.left.sole.link).id
        ahead = data.xmat[link].reshape(3, 3)[:, 0]
        view = -data.cam_xmat[camera].reshape(3, 3)[:, 2]
        if float(view @ ahead) <= 0.0 and view[2] > -STEEP:
            where = "backwards" if view[2] < STEEP else "up"
            self.fail(
                "camera.name",
                f"camera {self.file.camera.name!r} looks {where} in the stance; give it a "
                "[camera.mount], or turn it in the model",
            )

    def _check_camera(self) -> None:
        file, model = self.file, self.model
        camera = self.find("camera.name", file.camera.name, self.cameras, "camera")
        link = int(model.cam_bodyid[camera])
        if link == 0:
            self.fail("camera.name", f"camera {file.camera.name!r} must be on a link of the robot")
        above = set()
        while link > 0:
            above.add(link)
            link = int(model.body_parentid[link])
        for key, name in (("head.pan", file.head.pan), ("head.tilt", file.head.tilt)):
            if name is None:
                continue
            joint = self.find(key, name, self.joints, "joint")
            if int(model.jnt_bodyid[joint]) not in above:
                self.fail(key, f"joint {name!r} does not move the camera")
        self._check_view(camera)
        horizontal = 0.5 * file.camera.width / math.tan(0.5 * file.camera.horizontal_fov)
        vertical = 0.5 * file.camera.height / math.tan(0.5 * file.camera.vertical_fov)
        if abs(horizontal / vertical - 1.0) > SQUARE_PIXELS:
            self.fail(
                "camera",
                "pixels must be square, but the fields of view give focal lengths of "
                f"{horizontal:.1f} pixels across and {vertical:.1f} down",
            )
