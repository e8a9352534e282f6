"""A draft of a `robot.toml`: what an MJCF tells by itself, and guesses by mass for the rest."""

import json
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np

from treadwell.errors import InputError
from treadwell.files import write_text
from treadwell.robot.additions import STAND
from treadwell.robot.anatomy import Anatomy, FoundLeg
from treadwell.robot.followers import followers
from treadwell.robot.report import compile_alone, find_mjcf
from treadwell.robot.stance import axis_sign, posed, stance

LEG_RANGES = ((-0.8, 0.8), (-0.8, 0.8), (-2.0, 0.9), (-0.05, 2.4), (-1.4, 1.0), (-0.7, 0.7))
"""For joints without a range, about positive axes: yaw, roll, pitch, knee, ankle pitch and roll."""
OTHER_RANGE = (-1.5, 1.5)
SPEED = 5.0
"""No-load speed where nothing tells it, rad/s."""
REFERENCE_MASS_KG = 7.0
"""Mass of the robot for which the gait's defaults in newtons are."""
CAMERA = """
[camera]
name = {name}
sensor = "stereo"               # or structured_light
width = 88
height = 72
horizontal_fov = 0.8203
vertical_fov = 0.6807
period = 0.08
{mount}[camera.stereo]
baseline = 0.06
window = 5
disparity_noise_fixed = 0.10
disparity_noise_temporal = 0.05
quantum = 0.125
min_disparity = 1.5
max_disparity = 24.0
mismatch_rate = 0.007
dropout_rate = 0.05
"""
SENSES = """
[encoders]
quantum = 0.001534
play = 0.005236
leg_offset = 0.005236
camera_roll_pitch_error = 0.035
camera_yaw_error = 0.01745
camera_position_error = 0.005

[feet]
force_noise = 0.02
force_noise_absolute = 0.1
"""


def write_template(folder: Path) -> Path:
    """Write a draft of `robot.toml` into a folder that has none.

    Args:
        folder: with an MJCF.

    Raises:
        InputError: there is one, no MJCF, no two legs, or the folder cannot be written to.
    """
    path = folder / "robot.toml"
    if path.exists():
        raise InputError(f"{path}: is there already; a draft does not go over it")
    if not folder.is_dir():
        raise InputError(f"{folder}: there is no such folder")
    mjcf = find_mjcf(folder)
    text = draft(folder.resolve().name, mjcf.name, compile_alone(mjcf))
    try:
        write_text(path, text)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from error
    return path


def draft(name: str, mjcf: str, model: mujoco.MjModel) -> str:
    """Return a draft of a `robot.toml`.

    Args:
        name: the robot's.
        mjcf: name of the MJCF file.
        model: compiled from it.

    Raises:
        InputError: the model has no two legs of six hinges on a free root.
    """
    anatomy = Anatomy.of(model)
    legs = anatomy.legs()
    free = model.njnt > 0 and model.jnt_type[0] == mujoco.mjtJoint.mjJNT_FREE
    if len(legs) != 2 or not free:
        raise InputError(
            f"{mjcf}: a draft needs a root with a free joint, and two legs of six named hinges, "
            "one on each side"
        )
    return _Draft(name, mjcf, anatomy, legs).text()


@dataclass
class _Draft:
    name: str
    mjcf: str
    anatomy: Anatomy
    legs: dict[str, FoundLeg]

    def text(self) -> str:
        stand = stance(self.anatomy, self.legs)
        parts = [
            f"# A draft for {self.mjcf}: what the model tells, and guesses for what it does not.\n"
            "# Metres, radians, seconds, newtons, newton metres.\n",
            f'\n[robot]\nname = {_toml(self.name)}\ndescription = ""\nmodel = {_toml(self.mjcf)}\n',
            self._body(stand),
            self._stand_table(stand),
            self._ranges(),
            *(self._leg(leg) for leg in self.legs.values()),
            self._head(),
            self._imu(),
            SENSES,
            self._camera(),
            self._motors(),
            self._gait(),
        ]
        return "".join(parts)

    def _body(self, stand: dict[str, float]) -> str:
        model = self.anatomy.model
        data = posed(model, stand)
        least, most = np.full(3, np.inf), np.full(3, -np.inf)
        for geom in np.flatnonzero(model.geom_bodyid > 0):
            rotation = data.geom_xmat[geom].reshape(3, 3)
            centre = data.geom_xpos[geom] + rotation @ model.geom_aabb[geom, :3]
            half = np.abs(rotation) @ model.geom_aabb[geom, 3:]
            least, most = np.minimum(least, centre - half), np.maximum(most, centre + half)
        radius = float(np.max(np.abs([least[:2], most[:2]]))) + 0.02
        return (
            f"\n[body]                          # radius and height: of the shape in the stance\n"
            f"torso = {_toml(model.body(self._torso()).name)}\nradius = {radius:.2f}\n"
            f"height = {float(most[2] - least[2]):.2f}\n"
        )

    def _stand_table(self, stand: dict[str, float]) -> str:
        model = self.anatomy.model
        if STAND in [model.key(number).name for number in range(model.nkey)]:
            return ""
        lines = "".join(f"{name} = {angle:g}\n" for name, angle in stand.items())
        return f"\n[stand]                         # the others are at 0\n{lines}"

    def _ranges(self) -> str:
        model = self.anatomy.model
        of_legs = {
            name: bounds
            for leg in self.legs.values()
            for name, bounds in zip(leg.joints, LEG_RANGES, strict=True)
        }
        lines = ""
        for joint in range(1, model.njnt):
            name = model.joint(joint).name
            if model.jnt_limited[joint]:
                continue
            low, high = of_legs.get(name, OTHER_RANGE)
            if axis_sign(self.anatomy, name) < 0.0:
                low, high = -high, -low
            lines += f"{name} = [{low:g}, {high:g}]\n"
        return f"\n[ranges]                        # guesses\n{lines}" if lines else ""

    def _leg(self, leg: FoundLeg) -> str:
        (x, y, z), length, width = leg.sole
        names = ", ".join(_toml(joint) for joint in leg.joints)
        return (
            f"\n[legs.{leg.side}]\njoints = [{names}]\n[legs.{leg.side}.sole]\n"
            f"link = {_toml(leg.foot)}\nposition = [{x:.4f}, {y:.4f}, {z:.5f}]\n"
            f"length = {length:.4f}\nwidth = {width:.4f}\n"
        )

    def _camera_body(self) -> int:
        """Return the link that carries the first camera, or else the highest one."""
        model = self.anatomy.model
        carried = [int(body) for body in model.cam_bodyid if body > 0]
        return carried[0] if carried else 1 + int(np.argmax(self.anatomy.data.xpos[1:, 2]))

    def _head(self) -> str:
        pan, tilt = self.anatomy.head_joints(self._camera_body())
        lines = f"pan = {_toml(pan or 'TODO')}\ntilt = {_toml(tilt or 'TODO')}\n"
        trunk = self._trunk()
        joints = ", ".join(_toml(joint) for joint in trunk)
        told = f"\n[trunk]\njoints = [{joints}]\n" if trunk else ""
        return f"{told}\n[head]                          # they turn the camera\n{lines}"

    def _camera(self) -> str:
        model = self.anatomy.model
        for camera in range(model.ncam):
            if model.cam_bodyid[camera] > 0 and model.camera(camera).name:
                return CAMERA.format(name=_toml(model.camera(camera).name), mount="")
        link = _toml(model.body(self._camera_body()).name)
        mount = f"[camera.mount]\nlink = {link}\nposition = [0.05, 0.0, 0.05]\ndown = 0.0\n"
        return CAMERA.format(name='"depth"', mount=mount)

    def _imu(self) -> str:
        """Return the unit's table: where the model has a gyro, or a site on the torso."""
        model = self.anatomy.model
        torso = self._torso()
        sites = [int(site) for site in np.flatnonzero(model.site_bodyid == torso)]
        for sensor in np.flatnonzero(model.sensor_type == int(mujoco.mjtSensor.mjSENS_GYRO)):
            sites.insert(0, int(model.sensor_objid[sensor]))
        lines = "\n[imu]\n"
        if sites:
            site = sites[0]
            lines += f"site = {_toml(model.site(site).name)}\n"
            for key, kind in (
                ("gyro", mujoco.mjtSensor.mjSENS_GYRO),
                ("accelerometer", mujoco.mjtSensor.mjSENS_ACCELEROMETER),
            ):
                of_kind = (model.sensor_type == int(kind)) & (model.sensor_objid == site)
                for sensor in np.flatnonzero(of_kind)[:1]:
                    lines += f"{key} = {_toml(model.sensor(int(sensor)).name)}\n"
        else:
            link = _toml(model.body(torso).name)
            lines += f'site = "unit"\nlink = {link}\nposition = [0.0, 0.0, 0.0]\n'
        return lines + (
            "gyro_noise = 0.002\ngyro_bias = 0.00087\n"
            "accelerometer_noise = 0.15\naccelerometer_bias = 0.05\n"
        )

    def _trunk(self) -> list[str]:
        """Return the joints between the root and what carries the head, from below."""
        model = self.anatomy.model
        chain = [model.joint(j).name for j in self.anatomy.chain(self._camera_body())]
        head = self.anatomy.head_joints(self._camera_body())
        first = min([chain.index(joint) for joint in head if joint in chain], default=0)
        return chain[:first]

    def _torso(self) -> int:
        """Return the link that the head hangs on."""
        trunk = self._trunk()
        return int(self.anatomy.model.joint(trunk[-1]).bodyid[0]) if trunk else 1

    def _motors(self) -> str:
        model = self.anatomy.model
        tied, of_legs = followers(model), {j for leg in self.legs.values() for j in leg.joints}
        groups: dict[tuple[bool, float, float], list[str]] = {}
        for joint in range(1, model.njnt):
            if joint not in tied:
                name = model.joint(joint).name
                damping = float(model.dof_damping[model.jnt_dofadr[joint]])
                key = (name in of_legs, self._torque(joint), damping)
                groups.setdefault(key, []).append(name)
        text = "\n# Servos: guesses, but for the torques that the model tells.\n"
        for number, ((leg, torque, damping), names) in enumerate(groups.items(), 1):
            kp = (20.0 if leg else 5.0) * torque
            # A damping as large as this stands for what a motor loses by its speed.
            losing = damping > 0.1 * torque
            speed = torque / damping if losing else SPEED
            text += (
                f"[motors.{'leg' if leg else 'other'}{number}]\n"
                f"joints = [{', '.join(_toml(name) for name in names)}]\n"
                f"peak_torque = {torque:g}\nno_load_speed = {speed:.3g}\n"
                f"kp = {kp:g}\nkv = {kp / 50.0:g}\n{'damping = 0.1' if losing else ''}\n"
            )
        return text

    def _torque(self, joint: int) -> float:
        model = self.anatomy.model
        for number in range(model.nu):
            if int(model.actuator_trnid[number, 0]) == joint:
                for bounds in (model.actuator_forcerange[number], model.actuator_ctrlrange[number]):
                    if bounds[0] < bounds[1]:
                        return float(bounds[1])
        # Half of the body on a lever of 6 cm, and as much again.
        return round(0.06 * 9.81 * float(model.body_subtreemass[1]), 1)

    def _gait(self) -> str:
        share = float(self.anatomy.model.body_subtreemass[1]) / REFERENCE_MASS_KG
        return (
            "\n[gait]                          # careful; forces go by the mass\n"
            "step_time = 0.6\ndouble_support = 0.2\nstep_height = 0.025\nmax_forward = 0.06\n"
            "max_backward = 0.04\nmax_sideways = 0.06\nmax_turn = 0.3\nsupport_inward = 0.005\n"
            f"sole_margin = 0.008\nload_gain = {0.0006 / share:.2g}\n"
            f"ankle_gain = {min(30.0, 22.0 * share):.2g}\n"
            "climb_speed = 0.12\nclimb_lift_speed = 0.12\n"
        )


def _toml(text: str) -> str:
    """Return a string as TOML writes it."""
    return json.dumps(text, ensure_ascii=False)
