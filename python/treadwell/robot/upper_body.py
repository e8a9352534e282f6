"""What an MJCF shows of a robot above its legs: torso, trunk, arms, head, and a camera."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.robot.anatomy import FORWARD, Anatomy
from treadwell.robot.surfaces import cloud_of

Floats = NDArray[np.float64]

MIDDLE_SHARE = 0.05
"""Of the robot's height: what is this near to its middle plane is no arm."""
OF_HEAD = 0.2
"""Share of what turns with it that a head's last link has at least: a rod in a neck has less."""
AHEAD = 0.5
"""A camera whose view has less of forward in it does not look ahead."""
TURNS = 0.8
"""A joint pans or tilts where so much of its axis is upright, or across."""
ARM_ANGLES = 13
"""Angles of a joint of an arm that are tried, over its range."""
NODS_RAD = 1.04
"""How far down a camera can be turned at least: `nao`'s, which sees the ground before its feet."""
HEAD_NAMES = ("head", "neck", "skull", "face")
UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, slots=True)
class FoundHead:
    """What carries the camera, and what turns it.

    Attributes:
        link: number of the link.
        camera: name of the model's camera there; None where it has none that looks ahead.
        lens: (3,) m in the link's frame, where a camera could be: in front, near the top.
        pan: joint that turns it left and right, None where there is none.
        tilt: joint that nods, None where there is none.
        how: how it was found, and how sure that is.
        down: how far a camera that is added looks down, rad: what the head cannot nod.
    """

    link: int
    camera: str | None
    lens: Floats
    pan: str | None
    tilt: str | None
    how: str
    down: float = 0.0

    @property
    def turns(self) -> bool:
        """Whether it both pans and tilts."""
        return self.pan is not None and self.tilt is not None


class UpperBody:
    """What is above the legs of a model."""

    def __init__(self, anatomy: Anatomy) -> None:
        """Find arms and torso.

        Args:
            anatomy: with two feet.
        """
        self._anatomy, self._model, self._data = anatomy, anatomy.model, anatomy.data
        of_legs = {body for foot in anatomy.feet for body in anatomy.links(foot)}
        self._legs = of_legs - set(anatomy.links(anatomy.pelvis))
        self._span_m = float(np.ptp(self._data.xpos[1:, 2])) if self._model.nbody > 2 else 0.0
        self.arms = self._arms()
        self.torso = self._torso()

    @property
    def trunk(self) -> list[str]:
        """The joints between pelvis and torso, from below."""
        up = self._anatomy.links(self._anatomy.pelvis)
        down = self._anatomy.links(self.torso)
        shared = len([None for one, other in zip(up, down, strict=False) if one == other])
        way = [*reversed(up[shared:]), *down[shared:]]
        joints = [joint for body in way for joint in self._hinges(body)]
        return [self._model.joint(joint).name for joint in joints]

    def head(self) -> FoundHead:
        """Return the link that carries the camera, or could."""
        model = self._model
        for camera in range(model.ncam):
            if self._looks_ahead(camera):
                link = int(model.cam_bodyid[camera])
                how = f"the model's camera {model.camera(camera).name!r}"
                return self._head_at(link, model.camera(camera).name, np.zeros(3), how)
        link, how = self._head_link()
        return self._head_at(link, None, self._lens(link), how)

    def _head_at(self, link: int, camera: str | None, lens: Floats, how: str) -> FoundHead:
        pan = tilt = None
        down = 0.0
        across = np.cross(UP, FORWARD)
        above = self._anatomy.chain(self.torso)
        for joint in self._anatomy.chain(link):
            if joint in above:
                continue
            axis = self._data.xaxis[joint]
            if abs(float(axis @ UP)) > TURNS:
                pan = self._model.joint(joint).name
            elif abs(float(axis @ across)) > TURNS:
                tilt = self._model.joint(joint).name
                bounds = self._model.jnt_range[joint] * np.sign(float(axis @ across))
                limited = bool(self._model.jnt_limited[joint])
                down = max(0.0, NODS_RAD - float(bounds.max())) if limited else 0.0
        # One that does not both pan and tilt gets a unit that does.
        return FoundHead(link, camera, lens, pan, tilt, how, down if pan and tilt else 0.0)

    def _looks_ahead(self, camera: int) -> bool:
        """Whether a camera is fixed to the robot, within its height, and looks ahead."""
        model, data = self._model, self._data
        fixed = model.cam_mode[camera] == mujoco.mjtCamLight.mjCAMLIGHT_FIXED
        link = int(model.cam_bodyid[camera])
        if not fixed or link == 0 or not model.camera(camera).name or link in self._legs:
            return False
        view = -data.cam_xmat[camera].reshape(3, 3)[:, 2]
        apart = float(np.linalg.norm(data.cam_xpos[camera] - data.xpos[link]))
        near = apart < max(0.3 * self._span_m, 0.05)
        return bool(near and float(view @ FORWARD) > AHEAD)

    def _head_link(self) -> tuple[int, str]:
        """Return the link of the head, and how it was found."""
        model = self._model
        arms = {body for arm in self.arms for body in self._below(arm)}
        free = [
            body
            for body in range(1, model.nbody)
            if body not in self._legs and body not in arms and self._turns_above(body)
        ]
        named = [b for b in free if any(word in model.body(b).name.lower() for word in HEAD_NAMES)]
        # Rods and gears are light.
        whole = sum(float(model.body_mass[body]) for body in free)
        heavy = [body for body in free if model.body_mass[body] >= OF_HEAD * whole]
        last = [b for b in heavy if not any(c != b and c in self._below(b) for c in heavy)]
        if last:
            link = max(last, key=lambda body: float(self._data.xipos[body][2]))
            sure = "its name says so, too" if link in named else "by its place alone: look at it"
            return link, f"{model.body(link).name!r} is the head: above the torso ({sure})"
        return self.torso, f"no head: {model.body(self.torso).name!r} is the highest link"

    def _turns_above(self, body: int) -> bool:
        """Whether a body hangs on the torso by a joint, and is above it."""
        chain = self._anatomy.links(body)
        if self.torso not in chain or body == self.torso:
            return False
        own = chain[chain.index(self.torso) + 1 :]
        higher = float(self._data.xipos[body][2]) > float(self._data.xipos[self.torso][2])
        return higher and any(self._hinges(link) for link in own)

    def _lens(self, link: int) -> Floats:
        """Return a place in front of a link and near its top, in its frame."""
        model, data = self._model, self._data
        fixed = model.body_weldid == model.body_weldid[link]
        cloud = cloud_of(model, data, np.flatnonzero(fixed[model.geom_bodyid]))
        if not len(cloud.centres):
            return np.zeros(3)
        high = float((cloud.centres[:, 2] + cloud.radii).max())
        low = float((cloud.centres[:, 2] - cloud.radii).min())
        level = max(low, high - max(0.3 * (high - low), 0.02))
        # Of a whole trunk, only what is about as high counts for its front.
        near = cloud.centres[:, 2] + cloud.radii >= low + 0.4 * (high - low)
        ahead = float((cloud.centres[near, 0] + cloud.radii[near]).max())
        middle = float(data.xpos[link][1]) if link == self.torso else float(data.xipos[link][1])
        place = np.array([ahead + 0.005, middle, level])
        lens: Floats = data.xmat[link].reshape(3, 3).T @ (place - data.xpos[link])
        return lens

    def _hinges(self, body: int) -> list[int]:
        model = self._model
        first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
        kind = mujoco.mjtJoint.mjJNT_HINGE
        return [j for j in range(first, first + count) if model.jnt_type[j] == kind]

    def _below(self, body: int) -> list[int]:
        model, found = self._model, {body}
        for child in range(body + 1, model.nbody):
            if int(model.body_parentid[child]) in found:
                found.add(child)
        return sorted(found)

    def _arms(self) -> list[int]:
        """Return the first links of what hangs at the sides: pairs, one on each side."""
        model, data = self._model, self._data
        away = MIDDLE_SHARE * self._span_m
        sides: dict[bool, list[int]] = {True: [], False: []}
        for body in range(2, model.nbody):
            if body in self._legs or not self._hinges(body):
                continue
            below = self._below(body)
            if self._legs & set(below):
                continue
            inner = any(body in self._below(arm) for arms in sides.values() for arm in arms)
            y = float(data.subtree_com[body][1])
            if not inner and abs(y) > away:
                sides[y > 0.0].append(body)
        if not sides[True] or not sides[False]:
            return []
        return [
            max(arms, key=lambda body: float(model.body_subtreemass[body]))
            for arms in sides.values()
        ]

    def _torso(self) -> int:
        """Return the link that the arms hang on, or else the one above all other joints."""
        anatomy, model = self._anatomy, self._model
        if self.arms:
            chains = [anatomy.links(int(model.body_parentid[arm])) for arm in self.arms]
            shared = [a for a, b in zip(*chains, strict=False) if a == b]
            return int(shared[-1])
        return anatomy.links(anatomy.pelvis)[0]

    def resting_arms(self, angles: dict[str, float]) -> dict[str, float]:
        """Return the arms' angles with which they hang lowest and touch nothing.

        Args:
            angles: of the other joints.
        """
        model, data = self._model, mujoco.MjData(self._model)
        data.qpos[:] = self._data.qpos
        for name, angle in angles.items():
            data.qpos[model.joint(name).qposadr[0]] = angle
        found = {}
        for arm in self.arms:
            joints = [joint for body in self._below(arm) for joint in self._hinges(body)][:3]
            touching = self._touching(data)
            for joint in joints:
                at = int(model.jnt_qposadr[joint])
                best, lowest = float(data.qpos[at]), self._height(data, arm)
                low, high = model.jnt_range[joint] if model.jnt_limited[joint] else (-1.5, 1.5)
                for angle in np.linspace(low, high, ARM_ANGLES):
                    data.qpos[at] = angle
                    height = self._height(data, arm)
                    if height < lowest - 1e-3 and self._touching(data) <= touching:
                        best, lowest = float(angle), height
                data.qpos[at] = best
                found[model.joint(joint).name] = best
        return {name: angle for name, angle in found.items() if abs(angle) > 1e-9}

    def _height(self, data: mujoco.MjData, arm: int) -> float:
        mujoco.mj_kinematics(self._model, data)
        mujoco.mj_comPos(self._model, data)
        return float(data.subtree_com[arm][2])

    def _touching(self, data: mujoco.MjData) -> int:
        mujoco.mj_kinematics(self._model, data)
        mujoco.mj_collision(self._model, data)
        return int(data.ncon)
