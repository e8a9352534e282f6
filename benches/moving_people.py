"""Houses with people who walk: what is left of them in a static map, and what is lost of the rest.

    python benches/moving_people.py
    python benches/moving_people.py --robot nao --pictures FOLDER --results indoor_changing

The robot walks through a house in which people go about and doors are opened, every noise on, and
where it believes to be is what is used. Points are filtered as by `treadwell map RUN --set
map.leave_out_moving=true`, and labelled by the simulator's truth: each pixel by what its ray truly
meets. A point moves if that thing is not where it is at the end of the run, and is static if it is,
and was there all the time or for as long as looks are kept (`navigation.moving.views.memory`);
between the two it does not count. Measurements that are further off than the filter's own margin
are errors of the sensor, of nothing, and counted apart. Told are the share of the points on what
moves that are left in (ghosts) and of the points on all else that are taken out (lost): of what is
higher above the floor than 2 cm, and of all. `--pictures` draws a run's points before and after, as
the handbook's Figs 36.20 and 36.21.
"""

import argparse
import json
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
from into_results import add_options, write
from numpy.typing import NDArray

from treadwell import _core
from treadwell.episode import Episode
from treadwell.map_making.placing import placing
from treadwell.map_making.static_frames import insert, valid
from treadwell.runner import run_episode
from treadwell.sources.frame import Floats, RangeFrame
from treadwell.sources.run import open_run

LOW = 0.02
"""Metres: what is no higher is floor to the filter."""
COLUMNS = 160
SAME = 0.01
"""Metres, and of a quaternion: what is nearer is the same place."""
STATIC, MOVING, BETWEEN, WRONG = range(4)
HOUSE = """
schema = 1
name = "moving_people"
robot = "{robot}"
seed = {seed}
time_limit = {seconds}
[start]
position = [0.0, 0.0]
[goal]
position = [4.2, 0.0]
[[course]]
kind = "house"
name = "house"
rooms = 2
things = ["door", "shelf"]
closed = 0.0
"""


@dataclass(frozen=True)
class Someone:
    """Somebody who walks to and fro.

    Attributes:
        round: whether it is an upright cylinder or a box of 0.3 x 0.2 m.
        height: m.
        begin: where it stands at first.
        path: what it goes along.
        at: when it starts, s.
        speed: m/s.
    """

    round: bool
    height: float
    begin: tuple[float, float]
    path: tuple[tuple[float, float], ...]
    at: float = 0.0
    speed: float = 0.25

    def toml(self, name: str) -> str:
        """Return its `[[course]]` and `[[event]]`."""
        kind = "cylinder" if self.round else "box"
        size = f"radius = 0.15\nheight = {self.height}" if self.round else ""
        size = size or f"size = [0.2, 0.3, {self.height}]"
        points = [list(point) for point in self.path]
        return (
            f'[[course]]\nkind = "{kind}"\nname = "{name}"\nposition = {list(self.begin)}\n{size}\n'
            f'[[event]]\nat = {self.at}\ndo = "move"\nname = "{name}"\npath = {points}\n'
            f"loop = true\nspeed = {self.speed}\ngives_way = true\n"
        )


SCENES: dict[str, tuple[int, tuple[Someone, ...]]] = {
    "two who walk to and fro, one in each room": (
        2,
        (
            Someone(True, 1.2, (1.0, -0.9), ((1.0, 0.9), (1.0, -0.9)), speed=0.2),
            Someone(False, 0.58, (3.4, -0.9), ((3.4, 0.9), (3.4, -0.9)), speed=0.3),
        ),
    ),
    "one who stood for 12 s and walks off, one who goes around": (
        3,
        (
            Someone(False, 0.58, (2.2, -0.7), ((3.9, -0.9), (3.9, -0.2)), at=12.0, speed=0.25),
            Someone(True, 1.2, (2.4, 0.9), ((3.3, 0.9), (3.3, 0.0), (2.4, 0.9)), speed=0.25),
        ),
    ),
    "three, of whom two cross": (
        4,
        (
            Someone(True, 1.2, (2.0, -0.9), ((2.0, 0.9), (2.0, -0.9)), speed=0.2),
            Someone(True, 0.6, (2.7, 0.9), ((2.7, -0.9), (2.7, 0.9)), speed=0.3),
            Someone(False, 0.58, (3.9, -0.9), ((3.9, 0.9), (3.9, -0.9)), at=3.0, speed=0.2),
        ),
    ),
}
"""What it shows -> seed of the house, people."""


@dataclass(frozen=True)
class Exposure:
    """What a picture truly shows.

    Attributes:
        element: (h, w) index of what each pixel shows, -1 for the ground and the robot.
        depth: (h, w) m, without an error.
        places: (elements, 7) where each is: its offset, m, and how it is turned.
    """

    element: NDArray[np.intp]
    depth: Floats
    places: Floats


@dataclass(frozen=True)
class Seen:
    """A run's points.

    Attributes:
        points: (n, 3) m, where the robot believes them to be.
        label: (n,) `STATIC`, `MOVING`, `BETWEEN` or `WRONG`.
        kept: (n,) whether the filter leaves it in.
    """

    points: Floats
    label: NDArray[np.int8]
    kept: NDArray[np.bool_]

    def shares(self, low: float) -> tuple[float, float]:
        """Return ghosts and what is lost, as shares, of the points above a height, m."""
        high = self.points[:, 2] > low
        moving, static = high & (self.label == MOVING), high & (self.label == STATIC)
        return float(self.kept[moving].mean()), float((~self.kept[static]).mean())


def exposures(episode: Episode) -> dict[int, Exposure]:
    """Have an episode note what each exposure truly shows, by its time in ns."""
    camera, see, course = episode.sensors.camera, episode.sensors.camera.see, episode.course
    found: dict[int, Exposure] = {}

    def noted(data: mujoco.MjData, errors: _core.DepthErrors) -> NDArray[np.float32]:
        cast = camera.cast(data)
        element = np.where(cast.geom < 0, -1, course.geom_element[np.maximum(cast.geom, 0)])
        places = np.zeros((len(course.elements), 7))
        for index, one in enumerate(course.elements):
            if one.mocap_id is not None:
                places[index, :3] = data.mocap_pos[one.mocap_id]
                places[index, 3:] = data.mocap_quat[one.mocap_id]
        found[episode.simulation.time_ns] = Exposure(element, cast.depth, places)
        return see(data, errors)

    camera.see = noted  # type: ignore[method-assign]
    return found


def labelled(frames: Sequence[RangeFrame], truth: dict[int, Exposure]) -> list[NDArray[np.int8]]:
    """Return for each picture what its pixels are, (h, w)."""
    views = json.loads(_core.parameters())
    tables = next(one for one in views if one["key"] == "navigation.moving")["parameters"]
    settings = {one["key"].removeprefix("navigation.moving."): one["default"] for one in tables}
    shown = [truth[round(1e9 * frame.time)] for frame in frames]
    there = np.array([np.abs(one.places - shown[-1].places).max(axis=1) < SAME for one in shown])
    since = np.full(there.shape[1], -np.inf)
    labels = []
    for number, (frame, one) in enumerate(zip(frames, shown, strict=True)):
        if number:
            since = np.where(there[number] & ~there[number - 1], frame.time, since)
        stays = there[number] & (frame.time - since > settings["views.memory"])
        of_element = np.where(stays, STATIC, np.where(there[number], BETWEEN, MOVING))
        label = np.where(one.element < 0, STATIC, of_element[np.maximum(one.element, 0)])
        assert frame.depth is not None
        off, far = np.abs(frame.depth - one.depth), np.abs(1 / frame.depth - 1 / one.depth)
        wrong = (off > settings["views.margin"]) & (far > settings["views.inverse_margin"])
        labels.append(np.where(wrong | np.isnan(one.depth), WRONG, label).astype(np.int8))
    return labels


def seen(text: str, folder: Path) -> Seen:
    """Run a scenario, and filter what it saw."""
    folder.mkdir(parents=True)
    scenario = folder / "moving_people.toml"
    scenario.write_text(text)
    episode = Episode(scenario)
    truth = exposures(episode)
    run_episode(episode, out=folder / "run")
    frames = list(open_run(folder / "run"))
    found = _core.MovingFilter()
    place = placing("z", frames[0].world_from_sensor, 1.0)
    for frame in frames:
        insert(found, frame, place, COLUMNS)
    points, label, kept = [], [], []
    each = zip(frames, labelled(frames, truth), found.are_static(), strict=True)
    for frame, labels, static in each:
        some = valid(frame)
        points.append(in_map(frame)[some])
        label.append(labels[some])
        kept.append(static[some])
    return Seen(np.concatenate(points), np.concatenate(label), np.concatenate(kept))


def in_map(frame: RangeFrame) -> Floats:
    """Return a picture's points (h, w, 3) m in the map."""
    camera, depth = frame.camera, frame.depth
    assert camera is not None
    assert depth is not None
    rows, cols = np.indices(depth.shape)
    rays = np.stack([(cols - camera.cx) / camera.fx, (rows - camera.cy) / camera.fy], axis=-1)
    local = np.concatenate([rays * depth[..., None], depth[..., None]], axis=-1)
    pose = frame.world_from_sensor
    found: Floats = local @ pose[:3, :3].T + pose[:3, 3]
    return found


def draw(title: str, found: Seen, path: Path) -> None:
    """Draw the points before and after, from above and from the side."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    high = (found.points[:, 2] > LOW) & (found.points[:, 2] < 1.4)
    fig, axes = plt.subplots(2, 2, figsize=(11, 8), sharex=True)
    for column, kept in enumerate((np.ones_like(found.kept), found.kept)):
        shown = high & kept
        points, person = found.points[shown], found.label[shown] == MOVING
        name = "as it was seen" if column == 0 else "without what moved"
        for row, axis in enumerate((1, 2)):
            ax = axes[row, column]
            for of, colour in ((~person, "0.35"), (person, "tab:red")):
                ax.plot(points[of, 0], points[of, axis], ",", color=colour, alpha=0.5)
            ax.set_aspect("equal")
            ax.set_ylabel(f"{'xyz'[axis]}, m")
        axes[0, column].set_title(name)
        axes[1, column].set_xlabel("x, m")
    fig.suptitle(f"{title} (red: on what moves, by the simulator's truth)")
    fig.tight_layout()
    fig.savefig(path, dpi=110)
    plt.close(fig)


def main(words: Sequence[str] | None = None) -> None:
    """Run what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--robot", default="qrio")
    parser.add_argument("--scenes", type=int, default=len(SCENES))
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--pictures", type=Path, metavar="FOLDER")
    add_options(parser)
    options = parser.parse_args(words)
    rows = []
    for number, (name, (seed, people)) in enumerate(list(SCENES.items())[: options.scenes], 1):
        text = HOUSE.format(robot=options.robot, seed=seed, seconds=options.seconds)
        text += "".join(one.toml(f"somebody {index}") for index, one in enumerate(people))
        with tempfile.TemporaryDirectory() as folder:
            found = seen(text, Path(folder) / "scene")
        ghosts, lost = found.shares(LOW)
        all_ghosts, all_lost = found.shares(-np.inf)
        moving, static, wrong = (int((found.label == of).sum()) for of in (MOVING, STATIC, WRONG))
        measured = (
            f"{ghosts:.2%} / {lost:.2%}; with the floor {all_ghosts:.2%} / {all_lost:.2%} of "
            f"{moving} / {static} points ({wrong} errors of the sensor apart)"
        )
        print(f"{options.robot}, {name}: {measured}", flush=True)
        rows.append(
            {
                "what": f"`{options.robot}`, {name}: ghosts left / static points lost",
                "measured": measured,
                "wanted": "1 % / 2 %",
            }
        )
        if options.pictures is not None:
            options.pictures.mkdir(parents=True, exist_ok=True)
            draw(name, found, options.pictures / f"people_{options.robot}_{number}.png")
    write(options, "People in houses, left out of static maps", None, rows)


if __name__ == "__main__":
    main()
