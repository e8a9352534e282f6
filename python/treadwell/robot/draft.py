"""The text of a drafted `robot.toml`: what a model tells, and what is guessed, said as such."""

import json
import re
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.robot.anatomy import Anatomy, FoundLeg, posed_at
from treadwell.robot.draft_motors import draft_motors, gait_of, motor_roles, peaks_of, size_of
from treadwell.robot.keyframes import STAND, arms_of_keyframes, stands_well
from treadwell.robot.loops import ties_of
from treadwell.robot.motors_found import Fitting
from treadwell.robot.stance import Stance
from treadwell.robot.surfaces import cloud_of
from treadwell.robot.upper_body import FoundHead, UpperBody

LEG_RANGES = {
    "hip yaw": (-0.8, 0.8),
    "hip roll": (-0.8, 0.8),
    "hip pitch": (-2.0, 0.9),
    "knee": (-0.05, 2.4),
    "ankle pitch": (-1.4, 1.0),
    "ankle roll": (-0.7, 0.7),
}
"""For joints without a range, about axes that point ahead, left and up."""
OTHER_RANGE = (-1.5, 1.5)
REFERENCE_LEG_M = 0.25
BASELINE_M, MOST_BASELINE_M = 0.06, 0.2
"""Between the lenses of a stereo camera: by the robot's size, up to a limit."""
CLEAR_M = 0.02
"""How much wider than the robot the cylinder is that holds it."""
LEVEL_RAD = 1e-3
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
baseline = {baseline:.3g}
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
[encoders]                      # how the senses err: as cheap ones do
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


@dataclass
class Draft:
    """Writes a draft for a model that has two legs.

    Attributes:
        name: the robot's.
        mjcf: name of the model's file.
        anatomy: of the model.
        legs: both.
    """

    name: str
    mjcf: str
    anatomy: Anatomy
    legs: dict[str, FoundLeg]

    def text(self) -> str:
        """Return the whole file."""
        upper = UpperBody(self.anatomy)
        leg_m = size_of(self.anatomy, self.legs)
        fitting = Fitting(self.anatomy.model, leg_m)
        stand = self._stand(upper, fitting)
        head = upper.head()
        parts = [
            f"# A draft for {self.mjcf}: what the model tells, and guesses, which are said.\n"
            "# Metres, radians, seconds, newtons, newton metres.\n",
            f'\n[robot]\nname = {toml(self.name)}\ndescription = ""\nmodel = {toml(self.mjcf)}\n',
            self._body(stand, upper),
            self._stand_table(stand),
            self._ranges(),
            *(self._leg(leg) for leg in self.legs.values()),
            self._trunk(upper),
            self._head(head),
            self._imu(upper.torso),
            SENSES,
            self._camera(head, leg_m),
            draft_motors(
                self.anatomy.model,
                self._qpos(stand),
                self.legs,
                upper.trunk,
                fitting,
                not head.turns,
            ),
            self._gait(fitting, leg_m),
        ]
        return "".join(parts)

    def _stand(self, upper: UpperBody, fitting: Fitting) -> dict[str, float]:
        """Return the angles of the stance that are not zero, rad."""
        model = self.anatomy.model
        if stands_well(model, self.legs):
            qpos = model.key(STAND).qpos
            return {
                model.joint(j).name: float(qpos[model.jnt_qposadr[j]]) for j in range(1, model.njnt)
            }
        of_legs = {joint for leg in self.legs.values() for joint in leg.joints}
        arms = arms_of_keyframes(model, of_legs) or upper.resting_arms({})
        return Stance(self.anatomy, self.legs).angles(peaks_of(self.legs, model, fitting), arms)

    def _body(self, stand: dict[str, float], upper: UpperBody) -> str:
        model = self.anatomy.model
        data = posed_at(model, self._qpos(stand))
        cloud = cloud_of(model, data, np.flatnonzero(model.geom_bodyid > 0))
        reach = cloud.radii[:, None]
        least, most = (cloud.centres - reach).min(axis=0), (cloud.centres + reach).max(axis=0)
        radius = float(np.max(np.abs([least[:2], most[:2]]))) + CLEAR_M
        return (
            "\n[body]                          # the size of the shape in the stance\n"
            f"torso = {toml(model.body(upper.torso).name)}\nradius = {radius:.2f}\n"
            f"height = {float(most[2] - least[2]):.2f}\n"
        )

    def _qpos(self, stand: dict[str, float]) -> NDArray[np.float64]:
        model = self.anatomy.model
        qpos: NDArray[np.float64] = self.anatomy.data.qpos.copy()
        for joint in range(1, model.njnt):
            name = model.joint(joint).name
            if name in stand:
                qpos[model.jnt_qposadr[joint]] = stand[name]
        return qpos

    def _stand_table(self, stand: dict[str, float]) -> str:
        if stands_well(self.anatomy.model, self.legs):
            return ""
        tied = {self.anatomy.model.joint(joint).name for joint in ties_of(self.anatomy.model)}
        lines = "".join(
            f"{key(name)} = {angle:.7g}\n" for name, angle in stand.items() if name not in tied
        )
        return (
            "\n[stand]                         # knees bent, soles level under the centre of mass; "
            f"the others: the model's keyframe {STAND!r}, or 0\n{lines}"
        )

    def _ranges(self) -> str:
        model, data = self.anatomy.model, self.anatomy.data
        roles = {
            name: role
            for leg in self.legs.values()
            for name, role in zip(leg.joints, leg.roles, strict=True)
        }
        lines = ""
        for joint in range(1, model.njnt):
            name = model.joint(joint).name
            if model.jnt_limited[joint]:
                continue
            low, high = LEG_RANGES.get(roles.get(name, ""), OTHER_RANGE)
            axis = data.xaxis[joint]
            if axis[int(np.argmax(np.abs(axis)))] < 0.0:
                low, high = -high, -low
            lines += f"{key(name)} = [{low:g}, {high:g}]\n"
        return (
            f"\n[ranges]                        # guesses: the model has none\n{lines}"
            if lines
            else ""
        )

    def _leg(self, leg: FoundLeg) -> str:
        sole = leg.sole
        x, y, z = sole.position
        names = ", ".join(toml(joint) for joint in leg.joints)
        filled = (
            "" if sole.filled > 0.8 else f"  # it fills {100 * sole.filled:.0f} % of its outline"
        )
        plate, turned = "", ""
        if sole.plate:
            plate = (
                f"plate = {sole.plate:.3g}".ljust(32)
                + "# the model's foot stands on points: a plate over them, which edges hold\n"
            )
        if sole.orientation is not None:
            numbers = ", ".join(f"{value:.6f}" for value in sole.orientation)
            turned = f"orientation = [{numbers}]  # the link's axes are not ahead, left and up\n"
        return (
            f"\n[legs.{leg.side}]".ljust(33) + f"# {', '.join(leg.roles)}\njoints = [{names}]\n"
            f"[legs.{leg.side}.sole]\nlink = {toml(leg.foot)}\n"
            f"position = [{x:.4f}, {y:.4f}, {z:.5f}]\n{turned}"
            f"length = {sole.length:.4f}\nwidth = {sole.width:.4f}{filled}\n{plate}"
        )

    def _trunk(self, upper: UpperBody) -> str:
        joints = ", ".join(toml(joint) for joint in upper.trunk)
        return f"\n[trunk]\njoints = [{joints}]\n" if joints else ""

    def _head(self, head: FoundHead) -> str:
        pan, tilt, how = head.pan, head.tilt, head.how
        if pan is None or tilt is None:
            pan, tilt = "camera_pan", "camera_tilt"
            how += "; it does not both pan and tilt: see [camera.mount]"
        return (
            f"\n[head]                          # {how}\npan = {toml(pan)}\ntilt = {toml(tilt)}\n"
        )

    def _camera(self, head: FoundHead, leg_m: float) -> str:
        model, data = self.anatomy.model, self.anatomy.data
        baseline = min(BASELINE_M * leg_m / REFERENCE_LEG_M, MOST_BASELINE_M)
        turns = not head.turns
        if head.camera is not None and not turns:
            return CAMERA.format(name=toml(head.camera), mount="", baseline=baseline)
        x, y, z = (float(value) + 0.0 for value in np.round(head.lens, 3))
        lines = (
            "[camera.mount]                  # the model has no camera that looks ahead: a guess\n"
            f"link = {toml(model.body(head.link).name)}\nposition = [{x:.3f}, {y:.3f}, {z:.3f}]\n"
        )
        axes = data.xmat[head.link].reshape(3, 3)
        if np.arccos(np.clip(0.5 * (np.trace(axes) - 1.0), -1.0, 1.0)) > LEVEL_RAD:
            quat = np.empty(4)
            mujoco.mju_mat2Quat(quat, axes.T.reshape(-1))
            lines += f"orientation = [{', '.join(f'{value:.6f}' for value in quat)}]\n"
        lines += f"down = {head.down:.2f}\n"
        if turns:
            lines += "pan_tilt = true                 # on a small unit of its own that turns it\n"
        return CAMERA.format(name='"depth"', mount=lines, baseline=baseline)

    def _imu(self, torso: int) -> str:
        """Return the unit's table: where the model has a gyro, or a site on root or torso."""
        model = self.anatomy.model
        gyros = np.flatnonzero(model.sensor_type == int(mujoco.mjtSensor.mjSENS_GYRO))
        sites = [int(model.sensor_objid[sensor]) for sensor in gyros]
        sites += [
            int(site)
            for body in (torso, 1)
            for site in np.flatnonzero(model.site_bodyid == body)
            if "imu" in model.site(site).name.lower()
        ]
        lines = "\n[imu]\n"
        if sites:
            site = sites[0]
            lines += f"site = {toml(model.site(site).name)}\n"
            for word, kind in (
                ("gyro", mujoco.mjtSensor.mjSENS_GYRO),
                ("accelerometer", mujoco.mjtSensor.mjSENS_ACCELEROMETER),
            ):
                of_kind = (model.sensor_type == int(kind)) & (model.sensor_objid == site)
                for sensor in np.flatnonzero(of_kind)[:1]:
                    lines += f"{word} = {toml(model.sensor(int(sensor)).name)}\n"
        else:
            link = toml(model.body(torso).name)
            lines += f'site = "unit"\nlink = {link}                  # added there\n'
        return lines + (
            "gyro_noise = 0.002\ngyro_bias = 0.00087\n"
            "accelerometer_noise = 0.15\naccelerometer_bias = 0.05\n"
        )

    def _gait(self, fitting: Fitting, leg_m: float) -> str:
        model = self.anatomy.model
        motors = {role: joint for joint, role in motor_roles(model, self.legs).items()}
        settings = gait_of(
            fitting,
            motors,
            float(model.body_subtreemass[0]),
            leg_m / REFERENCE_LEG_M,
        )
        lines = "".join(f"{name} = {value:.2g}\n" for name, value in settings.items())
        return f"\n[gait]                          # what does not follow from the size\n{lines}"


def toml(text: str) -> str:
    """Return a string as TOML writes it."""
    return json.dumps(text, ensure_ascii=False)


def key(name: str) -> str:
    """Return a name as TOML writes a key: bare where that is allowed, else quoted."""
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else toml(name)
