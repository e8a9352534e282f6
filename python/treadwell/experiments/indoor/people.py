"""What a robot saw in a house with people, with them and without (Figs 36.20 and 36.21)."""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from treadwell._core import MovingFilter
from treadwell.episode import Episode
from treadwell.experiments.drawn import write_scenario
from treadwell.experiments.indoor.figure import panels, save
from treadwell.map_making.placing import placing
from treadwell.map_making.static_frames import insert, valid
from treadwell.runner import run_episode
from treadwell.sources.frame import Floats, RangeFrame
from treadwell.sources.run import open_run

_LOW_M: Final = 0.02
"""What is no higher is floor."""
_COLUMNS: Final = 160
_SEED: Final = 4


def _walker(name: str, x: float, speed: float) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return somebody who walks to and fro across the house, and the event that starts it."""
    body = {"kind": "cylinder", "name": name, "position": [x, -0.9], "radius": 0.15, "height": 0.6}
    way = {
        "at": 0.0,
        "do": "move",
        "name": name,
        "path": [[x, 0.9], [x, -0.9]],
        "loop": True,
        "speed": speed,
        "gives_way": True,
    }
    return body, way


def draw_people(path: Path, _source: Path) -> str:
    """Draw a run's points from above: all, and those that what moves left in."""
    people = [_walker("somebody", 2.0, 0.2), _walker("another", 3.6, 0.3)]
    house = {"kind": "house", "name": "house", "rooms": 2, "things": ["shelf"]}
    table = {
        "schema": 1,
        "name": "people",
        "seed": _SEED,
        "time_limit": 60.0,
        "start": {"position": [0.0, 0.0]},
        "goal": {"position": [4.2, 0.0]},
        "course": [house, *(body for body, _ in people)],
        "event": [way for _, way in people],
    }
    with TemporaryDirectory() as place:
        episode = Episode(write_scenario(Path(place) / "people.toml", table))
        run_episode(episode, out=Path(place) / "run")
        frames = list(open_run(Path(place) / "run"))
    found = MovingFilter()
    lies = placing("z", frames[0].world_from_sensor, 1.0)
    for frame in frames:
        insert(found, frame, lies, _COLUMNS)
    seen = [valid(frame) for frame in frames]
    points = np.concatenate([_in_map(*pair) for pair in zip(frames, seen, strict=True)])
    pairs = zip(found.are_static(), seen, strict=True)
    kept = np.concatenate([static[some] for static, some in pairs])
    high = points[:, 2] > _LOW_M
    figure, axes = panels(2, (4.4, 3.4))
    for place_of, shown, title in (
        (axes[0], high, "as it was seen"),
        (axes[1], high & kept, "without what moved"),
    ):
        place_of.plot(points[shown, 0], points[shown, 1], ",", color="#17181c", alpha=0.3)
        place_of.set_title(title, fontsize=9, loc="left")
        place_of.set_xlim(-1.0, 5.0)
        place_of.set_ylim(-2.0, 2.0)
    save(figure, path)
    return (
        f"{(high & ~kept).sum() / max(high.sum(), 1):.1%} of {high.sum()} points above the floor "
        "moved, or went, and are left out"
    )


def _in_map(frame: RangeFrame, some: NDArray[np.bool_]) -> Floats:
    """Return points (n, 3) m in the map of those pixels of a picture."""
    camera, depth = frame.camera, frame.depth
    assert camera is not None
    assert depth is not None
    rows, cols = np.nonzero(some)
    ahead = depth[some].astype(np.float64)
    local = np.stack(
        [(cols - camera.cx) / camera.fx * ahead, (rows - camera.cy) / camera.fy * ahead, ahead],
        axis=1,
    )
    pose = frame.world_from_sensor
    return np.asarray(local @ pose[:3, :3].T + pose[:3, 3])
