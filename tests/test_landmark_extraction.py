"""Rocks and trunks found in depth images of the simulator, with the errors of nao's camera."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell._core import standing_things
from treadwell.random_streams import stream
from treadwell.senses.depth import DepthCamera, Pinhole
from treadwell.senses.structured_light import StructuredLightConfig, StructuredLightModel

PINHOLE = Pinhole(320, 240, 288.7)
EYE_M, PITCH = 0.6, 0.3
REACH = (0.9, 3.2)
VIEW, EDGE = 0.48, 0.02
SETTINGS = f'{{"view": {VIEW}, "edge": {EDGE}}}'
VIEWS = ((0.0, 0.0, 0.0), (-0.2, 0.5, -0.2))
Thing = tuple[float, float, float, float, bool]
"""x, y, radius, height, m, and whether it is a trunk."""


@dataclass
class Look:
    """What one look should find of the things, and where it found them."""

    should: list[bool]
    found: list[tuple[float, float] | None]
    made_up: int


def field(random: np.random.Generator) -> list[Thing]:
    things: list[Thing] = []
    while len(things) < 7:
        trunk = len(things) >= 4
        x, y = random.uniform(0.9, 3.2), random.uniform(-1.3, 1.3)
        radius = random.uniform(0.04, 0.08) if trunk else random.uniform(0.09, 0.2)
        height = random.uniform(0.8, 1.3) if trunk else radius * random.uniform(0.9, 1.3)
        if all(np.hypot(x - a, y - b) > radius + r + 0.25 for a, b, r, *_ in things):
            things.append((x, y, radius, height, trunk))
    return things


def world(things: list[Thing], robot: tuple[float, float, float]) -> mujoco.MjModel:
    geoms = ['<geom type="plane" size="9 9 1"/>']
    geoms.append('<geom type="box" pos="3.8 0 1" size="0.05 3 1"/>')
    for x, y, radius, height, trunk in things:
        if trunk:
            size = f"{radius} {height / 2}"
            geoms.append(f'<geom type="cylinder" pos="{x} {y} {height / 2}" size="{size}"/>')
        else:
            size = f"{radius} {radius} {height}"
            geoms.append(f'<geom type="ellipsoid" pos="{x} {y} 0" size="{size}"/>')
    x, y, yaw = robot
    right = f"{np.sin(yaw)} {-np.cos(yaw)} 0"
    up = f"{np.sin(PITCH) * np.cos(yaw)} {np.sin(PITCH) * np.sin(yaw)} {np.cos(PITCH)}"
    eye = f'<body pos="{x} {y} {EYE_M}"><camera name="eye" xyaxes="{right} {up}"/></body>'
    return mujoco.MjModel.from_xml_string(
        f"<mujoco><worldbody>{''.join(geoms)}{eye}</worldbody></mujoco>"
    )


def points(model: mujoco.MjModel, seed: int) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Points (n, 3) m in the robot's frame, and what each pixel shows."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    cast = DepthCamera(model, "eye", PINHOLE).cast(data)
    noisy = StructuredLightModel(
        StructuredLightConfig(baseline=0.075), PINHOLE, stream(seed, "noise")
    )
    depth = noisy.see(cast).astype(np.float64).ravel()
    right, down, ahead = (PINHOLE.directions() * depth[:, None]).T
    x = np.cos(PITCH) * ahead - np.sin(PITCH) * down
    z = EYE_M - np.sin(PITCH) * ahead - np.cos(PITCH) * down
    return np.column_stack([x, -right, z])[np.isfinite(depth)], cast.geom


def look(things: list[Thing], robot: tuple[float, float, float], seed: int) -> Look:
    seen, geom = points(world(things, robot), seed)
    cos, sin = np.cos(robot[2]), np.sin(robot[2])
    should: list[bool] = []
    for index, (x, y, radius, *_) in enumerate(things):
        east, north = x - robot[0], y - robot[1]
        along, across = cos * east + sin * north, cos * north - sin * east
        away, half = np.hypot(along, across), np.arcsin(radius / np.hypot(along, across))
        shown = int((geom == index + 2).sum())
        alone, _ = points_alone(things[index], robot)
        in_view = abs(np.arctan2(across, along)) + half < VIEW - 1.5 * EDGE
        should.append(REACH[0] < away < REACH[1] and in_view and shown >= max(60, alone))
    found: list[tuple[float, float] | None] = [None] * len(things)
    made_up = 0
    for (ahead, left, *_), pole in standing_things(seen, EYE_M, SETTINGS):
        place = (robot[0] + cos * ahead - sin * left, robot[1] + sin * ahead + cos * left)
        near = [
            index
            for index, (x, y, *_, trunk) in enumerate(things)
            if np.hypot(place[0] - x, place[1] - y) < 0.1 and trunk == pole
        ]
        if near:
            found[near[0]] = place
        else:
            made_up += 1
    return Look(should, found, made_up)


def points_alone(thing: Thing, robot: tuple[float, float, float]) -> tuple[int, int]:
    """How many pixels show a thing that nothing hides."""
    model = world([thing], robot)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    geom = DepthCamera(model, "eye", PINHOLE).cast(data).geom
    return int((geom == 2).sum()), geom.size


def test_rocks_and_trunks_are_found_and_two_views_find_the_same() -> None:
    wanted = hits = right = every = both = same = 0
    for seed in range(10):
        things = field(np.random.default_rng(seed))
        looks = [look(things, robot, 2 * seed + i) for i, robot in enumerate(VIEWS)]
        for one in looks:
            wanted += sum(one.should)
            hits += sum(a and b is not None for a, b in zip(one.should, one.found, strict=True))
            right += sum(place is not None for place in one.found)
            every += sum(place is not None for place in one.found) + one.made_up
        for index in range(len(things)):
            if all(one.should[index] for one in looks):
                both += 1
                first, second = (one.found[index] for one in looks)
                if first is not None and second is not None:
                    same += float(np.hypot(*np.subtract(first, second))) < 0.08
    assert wanted > 40
    assert both > 12
    told = f"recall {hits} of {wanted}, precision {right} of {every}, both {same} of {both}"

    assert min(hits / wanted, right / every, same / both) >= 0.9, told
