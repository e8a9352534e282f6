"""Labels of a frame against the level surfaces that its rays truly met."""

from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
from episode_builders import qrio, trace, world
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from treadwell.measuring.regions import RegionCounts
from treadwell.measuring.segmentation_watch import SegmentationWatch, connected
from treadwell.random_streams import RandomStreams
from treadwell.scenario.model import Sensors as Senses
from treadwell.senses.sensors import Sensors

STEP = """
[[course]]
kind = "platform"
name = "step"
position = [0.55, 0.0]
size = [0.5, 2.0, 0.04]
[[event]]
at = 5.0
do = "remove"
name = "step"
"""
SHAPE = (72, 88)


class Scene:
    """A robot before a step, as only the watch sees it; the head looks straight ahead and down."""

    def __init__(self) -> None:
        self.world = world(STEP)
        data, model = self.world.simulation.data, self.world.model
        data.joint("neck_tilt").qpos[:] = 0.8
        ideal = Senses(depth="ideal", encoders="ideal", imu="ideal", feet="ideal")
        sensors = Sensors(model, qrio(), ideal, RandomStreams(0))
        place = np.zeros(3)
        episode: Any = SimpleNamespace(
            course=self.world.course,
            simulation=self.world.simulation,
            sensors=sensors,
            events=SimpleNamespace(present={"step"}, place=lambda *_: place),
        )
        mujoco.mj_kinematics(model, data)
        mujoco.mj_camlight(model, data)
        self.watch = SegmentationWatch(episode)
        self.cast = sensors.camera.cast(data)

    def see(self, labels: np.ndarray) -> RegionCounts:
        depth = self.cast.depth.astype(np.float32)
        labels = labels.astype(np.uint16).ravel()
        self.watch.frame(trace(self.world, 0, depth=depth, labels=labels))
        counts: RegionCounts = self.watch.findings()
        return counts


def test_a_surface_by_its_height_is_what_the_watch_takes_for_true() -> None:
    scene = Scene()
    rays = scene.watch._episode.sensors.camera.pinhole.directions() @ scene.cast.rotation.T
    height = (scene.cast.position + rays * scene.cast.depth.reshape(-1, 1))[:, 2].reshape(SHAPE)
    level = np.abs(height[..., None] - np.array([0.0, 0.04])) < 1e-5
    labels = connected((level @ np.array([1, 2])).astype(np.int64))
    counts = scene.see(labels)
    assert counts.true >= 2
    assert counts == RegionCounts(true=counts.true, correct=counts.true)


def test_one_region_for_all_is_under_segmented() -> None:
    counts = Scene().see(np.ones(SHAPE))
    assert (counts.correct, counts.under, counts.merged) == (0, 1, counts.true)


def test_frames_are_summed_and_those_without_a_picture_left_out() -> None:
    scene = Scene()
    once = scene.see(np.zeros(SHAPE))
    assert once.missed == once.true
    scene.watch.frame(trace(scene.world, 0, depth=None))
    assert scene.watch.findings() == once
    assert scene.see(np.zeros(SHAPE)).true == 2 * once.true


@given(arrays(np.int64, (5, 7), elements=st.integers(-1, 2)))
def test_connected_areas_have_a_number_each(ids: np.ndarray) -> None:
    numbered = connected(ids)
    assert np.array_equal(numbered[ids <= 0], ids[ids <= 0])
    for axis in (0, 1):
        a, b = np.moveaxis(ids, axis, 0), np.moveaxis(numbered, axis, 0)
        both = (a[1:] > 0) & (a[1:] == a[:-1])
        assert np.array_equal(b[1:][both], b[:-1][both])
    for number in np.unique(numbered[ids > 0]):
        area = numbered == number
        assert len(np.unique(ids[area])) == 1
        assert flooded(area) == int(area.sum())


def flooded(area: np.ndarray) -> int:
    """How many pixels are reached from the area's first one."""
    todo, seen = [tuple(np.argwhere(area)[0])], set()
    while todo:
        row, col = todo.pop()
        inside = 0 <= row < area.shape[0] and 0 <= col < area.shape[1]
        if (row, col) in seen or not inside or not area[row, col]:
            continue
        seen.add((row, col))
        todo += [(row + 1, col), (row - 1, col), (row, col + 1), (row, col - 1)]
    return len(seen)
