"""What is kept of the frames of a map of one's own: its picture and its recording."""

from pathlib import Path

import numpy as np
import pytest
from boxes_seen import CAMERA, flight, looking, seen
from episode_builders import entities, shown_as

from treadwell import mapping
from treadwell.errors import InputError, RecordingError
from treadwell.map_making.mapper import Mapper
from treadwell.map_making.request import read_request
from treadwell.map_memory import FLOOR
from treadwell.mapping.kept_frames import KeptFrames
from treadwell.sources.frame import RangeFrame

BOXES = flight(rise=0.03, tread=0.2, steps=3)
FRAMES = [(seen(BOXES, pose), pose) for pose in (looking(0.4 * k, 0.0, 0.5) for k in range(12))]


def world_of(model: str = "elevation") -> mapping.Map:
    world = mapping.Map(model, CAMERA)
    for depth, pose in FRAMES:
        world.insert(depth, pose)
    return world


def test_a_map_has_its_picture_and_its_recording_by_a_call_each(tmp_path: Path) -> None:
    world = world_of()
    assert world.save_picture(tmp_path / "map.png", "stairs") == tmp_path / "map.png"
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")
    assert world.save_recording(str(tmp_path / "map.rrd"), "stairs") == tmp_path / "map.rrd"
    assert shown_as(tmp_path / "map.rrd") == ("treadwell_map", "stairs")
    found = entities(tmp_path / "map.rrd")
    assert {"/world/camera", "/world/points", "/world/map/floor"} <= found


def test_a_recording_shows_the_surface_of_a_model_that_keeps_one(tmp_path: Path) -> None:
    world_of("mesh").save_recording(tmp_path / "map.rrd")
    assert "/world/map/surface" in entities(tmp_path / "map.rrd")


def test_the_map_that_is_shown_is_that_of_the_command(tmp_path: Path) -> None:
    world = world_of()
    request = read_request(tmp_path, world_model="elevation")
    frames = [
        RangeFrame(k, pose, CAMERA, depth.astype(np.float32), None, "picture")
        for k, (depth, pose) in enumerate(FRAMES)
    ]
    mapper = Mapper(request, frames[0])
    for frame in frames:
        mapper.insert(frame)
    wanted, found = mapper.map(), world._kept.map(world.offset)
    assert (found.kind == FLOOR).sum() > 1000
    for key in ("kind", "height", "sightings"):
        np.testing.assert_array_equal(getattr(found, key), getattr(wanted, key))
    # The window has moved on: it does not hold all of it.
    assert (world.view().kind == FLOOR).sum() < (found.kind == FLOOR).sum()


def test_of_many_frames_evenly_many_are_kept() -> None:
    kept, view = KeptFrames(), mapping.floor_view([[0.0]], cell=0.1)
    for k in range(2100):
        kept.insert(float(k), np.eye(4), np.zeros((1, 3), np.float32), view)
    times = [time for time, *_ in kept._frames]
    assert 250 <= len(times) <= 500
    assert set(np.diff(times)) == {8.0}
    assert len(kept.poses) == 2100


def test_without_frames_and_where_nothing_can_be_written_it_is_said(tmp_path: Path) -> None:
    world = mapping.Map("elevation", CAMERA)
    with pytest.raises(InputError, match=r"Map\.save_picture: no frame was taken in yet"):
        world.save_picture(tmp_path / "map.png")
    world.insert(np.zeros((120, 160)), np.eye(4))
    for save in (world.save_picture, world.save_recording):
        with pytest.raises(InputError, match="none of 1 frames was used"):
            save(tmp_path / "map")
    world = world_of()
    for save, ending in ((world.save_picture, "png"), (world.save_recording, "rrd")):
        with pytest.raises(RecordingError, match="missing"):
            save(tmp_path / "missing" / f"map.{ending}")
        for name in ("map", "map.xyz"):
            with pytest.raises(InputError, match=rf"Map\.save_.*{name}; must end with \.{ending}"):
                save(tmp_path / name)
        assert not any(tmp_path.iterdir())
