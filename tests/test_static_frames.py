"""Claims about maps without what moved: `treadwell map --set map.leave_out_moving=true`."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from treadwell.map_making.making import make_map
from treadwell.map_making.placing import placing
from treadwell.map_making.request import read_request
from treadwell.map_making.static_frames import StaticSource
from treadwell.map_memory import OBSTACLE
from treadwell.sources.source import open_source

WIDTH, HEIGHT, FOCAL, EYE, PITCH, WALL, WALKER = 96, 72, 80.0, 0.5, 0.3, 2.6, 1.3
FRAMES = 60


def depth(walker: float) -> NDArray[np.float32]:
    """What a camera sees of a floor, a wall, and somebody at (`WALKER`, `walker`)."""
    rows, cols = np.indices((HEIGHT, WIDTH))
    down, left = (rows - 35.5) / FOCAL, -(cols - 47.5) / FOCAL
    ahead = np.cos(PITCH) - down * np.sin(PITCH)  # of a ray, for each metre along the axis
    falls = np.sin(PITCH) + down * np.cos(PITCH)
    found = np.minimum(np.where(falls > 0.01, EYE / np.maximum(falls, 0.01), np.inf), WALL / ahead)
    front = WALKER / ahead
    there = (np.abs(front * left - walker) < 0.15) & (front < found)
    seen: NDArray[np.float32] = np.where(there, front, found).astype(np.float32)
    return seen


def pictures(folder: Path) -> Path:
    """A recording of somebody who walks across; the camera stands."""
    (folder / "depth").mkdir(parents=True)
    half = np.pi / 4 + PITCH / 2
    turn = np.array([-np.sin(half), np.sin(half), -np.cos(half), np.cos(half)]) / np.sqrt(2)
    poses = []
    for frame in range(FRAMES):
        time = f"{0.1 * frame:.1f}"
        np.save(folder / "depth" / f"{time}.npy", depth(-1.1 + 0.04 * frame))
        poses.append(f"{time} 0 0 {EYE} {' '.join(map(str, turn))}\n")
    (folder / "poses.tum").write_text("".join(poses))
    camera = f"width={WIDTH}\nheight={HEIGHT}\nfx={FOCAL}\nfy={FOCAL}\ncx=47.5\ncy=35.5\n"
    (folder / "camera.toml").write_text(camera)
    return folder


def test_who_walks_through_leaves_no_obstacle_and_the_wall_stays(tmp_path: Path) -> None:
    """A map that does not unlearn has the walker in it, unless what moved is left out."""
    source = pictures(tmp_path / "pictures")
    obstacles = {}
    for name, settings in (("all", []), ("static", ["map.leave_out_moving=true"])):
        request = read_request(source, settings=settings, world_model="points")
        made = make_map(request, out=tmp_path / name, record=False)
        found = made.map
        rows, cols = np.nonzero((found.kind == OBSTACLE) | (found.height > 0.2))
        x = found.origin[0] + (cols + 0.5) * found.cell
        y = found.origin[1] + (rows + 0.5) * found.cell
        walked = (np.abs(x - WALKER) < 0.2) & (np.abs(y) < 1.4)
        obstacles[name] = int(walked.sum()), int((np.abs(x - WALL) < 0.1).sum())
        assert ("are left out" in " ".join(made.result.notes)) == (name == "static")
    assert obstacles["all"][0] > 3
    assert obstacles["static"][0] == 0
    assert obstacles["static"][1] >= 0.9 * obstacles["all"][1] > 5


def test_pixels_on_who_walks_are_left_out_and_others_are_not(tmp_path: Path) -> None:
    """By the truth: at most 1 % ghosts, at least 98 % of what is static."""
    request = read_request(pictures(tmp_path / "pictures"))
    frames = list(StaticSource(open_source(request.source), request))
    assert len(frames) == FRAMES
    assert placing("z", frames[0].world_from_sensor, 1.0).offset.tolist() == [0.0, 0.0, 0.0]
    ghosts, walker, lost, still = 0, 0, 0, 0
    for number, frame in enumerate(frames):
        assert frame.depth is not None
        here = depth(-1.1 + 0.04 * number) < depth(99.0) - 0.01
        kept = np.isfinite(frame.depth)
        ghosts, walker = ghosts + int((kept & here).sum()), walker + int(here.sum())
        lost, still = lost + int((~kept & ~here).sum()), still + int((~here).sum())
    assert walker > 10_000
    assert ghosts <= 0.01 * walker
    assert lost <= 0.02 * still
