"""Slabs side by side: tilted within what is asked for, no higher, and true to their tops."""

import math

import mujoco
import numpy as np
import pytest
from test_course import course_of, ray_height

from treadwell.course.slabs import slab_pieces
from treadwell.scenario.ground_elements import Slabs

SIZE = (1.8, 0.9)


@pytest.mark.parametrize("seed", range(20))
def test_no_slab_is_steeper_or_higher_than_asked_or_leaves_its_share_of_the_ground(
    seed: int,
) -> None:
    slabs = Slabs(kind="slabs", position=(0.0, 0.0), size=SIZE, edge=0.3, rise=0.045, tilt=0.14)
    pieces, tops = slab_pieces(slabs, "slabs", seed)
    assert len(pieces) == len(tops) == 18
    for number, top in enumerate(tops):
        assert top.normal[2] >= math.cos(0.14) - 1e-9
        assert top.polygon[:, 2].min() >= 0.0
        assert top.polygon[:, 2].max() <= 0.045 + 1e-9
        row, column = divmod(number, 3)
        low = np.array([row, column]) * 0.3 - np.array(SIZE) / 2
        assert (top.polygon[:, :2] >= low - 1e-9).all()
        assert (top.polygon[:, :2] <= low + 0.3 + 1e-9).all()
        assert np.ptp(top.polygon[:, :2], axis=0).min() > 0.29


def test_slabs_are_drawn_from_seed_and_name_and_some_are_as_steep_as_asked() -> None:
    slabs = Slabs(kind="slabs")

    def drawn(name: str, seed: int) -> list[float]:
        return [float(top.normal[2]) for top in slab_pieces(slabs, name, seed)[1]]

    assert drawn("slabs", 1) == drawn("slabs", 1)
    assert drawn("slabs", 1) != drawn("slabs", 2)
    assert drawn("slabs", 1) != drawn("other", 1)
    steepest = max(math.acos(z) for seed in range(20) for z in drawn("slabs", seed))
    assert 0.12 < steepest <= 0.14


def test_what_is_built_is_as_high_as_the_tops_say() -> None:
    course = course_of({"kind": "slabs", "position": [2.0, 0.3], "yaw": 0.4})
    tops = course.elements[0].tops
    for top in tops:
        middle = top.polygon[:, :2].mean(axis=0)
        for place in (middle, 0.2 * middle + 0.8 * top.polygon[1, :2]):
            height = float(top.height_at(place[None])[0])
            assert ray_height(course, *place) == pytest.approx(height, abs=1e-6)


def test_level_slabs_are_level() -> None:
    course = course_of({"kind": "slabs", "position": [2.0, 0.0], "tilt": 0.0})
    heights = [top.polygon[:, 2] for top in course.elements[0].tops]
    assert all(np.ptp(each) < 1e-12 for each in heights)
    assert len({float(each[0]) for each in heights}) > 10


def test_a_sole_rests_on_a_tilted_slab() -> None:
    """A block as large as a sole comes to lie along the slab under it."""
    course = course_of({"kind": "slabs", "position": [2.0, 0.0], "size": [0.6, 0.6], "edge": 0.6})
    (top,) = course.elements[0].tops
    spec = mujoco.MjSpec()
    piece = course.elements[0].pieces[0]
    spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_BOX, pos=piece.center, quat=piece.quaternion, size=piece.size
    )
    body = spec.worldbody.add_body(pos=[2.0, 0.0, 0.08])
    body.add_freejoint()
    body.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.052, 0.037, 0.01], mass=1.0)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 1000)
    assert data.xmat[-1].reshape(3, 3)[:, 2] @ top.normal > math.cos(math.radians(0.5))
