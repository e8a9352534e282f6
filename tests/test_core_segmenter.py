"""Claims about a segmenter alone, for depth images that come from elsewhere."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import settings as budget
from hypothesis import strategies as st

from treadwell._core import Planes, Segmenter
from treadwell.components import COMPONENTS
from treadwell.errors import InputError
from treadwell.senses.depth import Pinhole

EYE = Pinhole(88, 72, 101.2)
BASELINE = 0.06
HEIGHT, DOWN = 0.5, 0.75


def made(name: str = "scan_line", **tables: dict[str, float]) -> Segmenter:
    return Segmenter(
        name,
        width=EYE.width,
        height=EYE.height,
        focal=EYE.focal,
        baseline=BASELINE,
        settings=json.dumps(tables),
    )


def looking_down() -> np.ndarray:
    """A camera above the robot's frame that looks ahead and down."""
    sin, cos = np.sin(DOWN), np.cos(DOWN)
    pose = np.eye(4)
    pose[:3, :3] = [[0.0, -sin, cos], [-1.0, 0.0, 0.0], [0.0, -cos, -sin]]
    pose[2, 3] = HEIGHT
    return pose


def floor_depth() -> np.ndarray:
    """What it sees of a floor, with a box of 0.1 m from 0.6 m on."""
    rays = EYE.directions() @ looking_down()[:3, :3].T
    with np.errstate(divide="ignore"):
        depth = np.where(rays[:, 2] < -0.05, -HEIGHT / rays[:, 2], np.nan)
        face = np.where(rays[:, 0] > 0.05, 0.6 / rays[:, 0], np.inf)
    on_face = (face < depth) & (HEIGHT + face * rays[:, 2] < 0.1)
    over = HEIGHT + face * rays[:, 2] >= 0.1
    depth = np.where(on_face, face, depth)
    depth = np.where(over & (rays[:, 2] < -0.05), -(HEIGHT - 0.1) / rays[:, 2], depth)
    return depth.reshape(EYE.height, EYE.width).astype(np.float32)


@pytest.mark.parametrize("name", list(COMPONENTS["segmenter"]))
def test_every_segmenter_of_the_list_finds_floor_and_box(name: str) -> None:
    planes = made(name).segment(floor_depth(), looking_down())
    assert isinstance(planes, Planes)
    assert planes.ground is not None
    heights = [height for *_, height in planes.regions if height is not None]
    assert any(abs(height - 0.1) < 0.005 for height in heights), heights
    assert np.nanmax(np.abs(planes.robot_from_camera - looking_down())) < 0.01


def test_it_is_the_same_segmenter_frame_by_frame() -> None:
    segmenter = made()
    reliable = [segmenter.segment(floor_depth(), looking_down()).reliable for _ in range(12)]
    assert not reliable[0]
    assert reliable[-1]


def test_the_layout_of_the_image_in_memory_does_not_matter() -> None:
    depth = floor_depth()
    rows_last = np.asfortranarray(depth)
    mirrored_twice = depth[:, ::-1].copy()[:, ::-1]
    first = made().segment(depth, looking_down())
    for other in (rows_last, mirrored_twice):
        again = made().segment(other, looking_down())
        np.testing.assert_array_equal(first.labels, again.labels)
        np.testing.assert_array_equal(first.points_in_robot, again.points_in_robot)


def test_settings_reach_it() -> None:
    def levels(**tables: dict[str, float]) -> list[float]:
        planes = made(**tables).segment(floor_depth(), looking_down())
        return [round(height, 3) for *_, height in planes.regions if height is not None]

    assert sorted(levels()) == [0.0, 0.1]
    assert levels(ground={"min_region": 3000}) == [0.0]


@pytest.mark.parametrize(
    ("name", "tables", "message"),
    [
        ("scan_lines", {}, "navigation.segmenter must be one of scan_line, .*, got scan_lines"),
        ("scan_line", {"ground": {"no": 1}}, r"navigation\.ground\.no: unknown field `no`"),
        ("ransac", {"ransac": {"samples": 0}}, r"navigation\.ransac\.samples must be"),
        ("scan_line_adaptive", {"scan_line_adaptive": {"strip": 1}}, r"strip must be from 2 to 32"),
    ],
)
def test_what_cannot_be_used_is_refused_by_its_key(
    name: str, tables: dict[str, dict[str, float]], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        made(name, **tables)


@pytest.mark.parametrize("key", ["width", "height", "focal", "baseline"])
def test_a_camera_that_is_none_is_refused(key: str) -> None:
    camera = {"width": 88, "height": 72, "focal": 101.2, "baseline": 0.06, key: 0}
    with pytest.raises(InputError, match="must be > 0"):
        Segmenter("scan_line", **camera)  # type: ignore[arg-type]


def test_an_image_of_another_size_and_a_pose_that_is_none_are_refused() -> None:
    segmenter = made()
    with pytest.raises(ValueError, match=r"depth must be \(72, 88\), got \(88, 72\)"):
        segmenter.segment(floor_depth().T, looking_down())
    with pytest.raises(ValueError, match=r"finite \(4, 4\) matrix"):
        segmenter.segment(floor_depth(), np.full((4, 4), np.nan))


@given(st.sampled_from(list(COMPONENTS["segmenter"])), st.integers(0, 99))
@budget(max_examples=20, deadline=None)
def test_any_image_gives_labels_of_its_regions(name: str, seed: int) -> None:
    random = np.random.default_rng(seed)
    depth = random.choice([np.nan, np.inf, 0.0, -1.0, 1e-3, 0.5, 0.7, 1e6], (72, 88))
    depth[20:50, 30:70] = random.uniform(0.3, 2.0)
    planes = made(name).segment(depth.astype(np.float32), looking_down())
    assert planes.labels.max() <= len(planes.regions)
    assert len(planes.labels) == depth.size
