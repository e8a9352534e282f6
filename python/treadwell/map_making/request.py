"""What a user asks of a map: a world model, settings, and how the data is to be taken."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final, Literal

from pydantic import Discriminator, Field, Tag, ValidationError, field_validator

from treadwell.errors import InputError
from treadwell.reference.parameters import all_tables
from treadwell.scenario.messages import describe_in, nearest, shortened
from treadwell.scenario.model import Navigation
from treadwell.scenario.overrides import assign, parse_setting, split_key
from treadwell.scenario.types import Point3, Table
from treadwell.sources.landmark_log import ROBOTS
from treadwell.sources.source import POSE_WITHIN_S

Up = Literal["x", "-x", "y", "-y", "z", "-z"]
Direction = Up | tuple[float, float, float]
"""An axis, or any direction, (x, y, z)."""
PICTURES, POINTS = "fog", "elevation"
"""World models where none is named: of depth images, of clouds."""
MESH: Final = "mesh"
"""The one that keeps surfaces."""
LANDMARKS: Final = "landmarks"
"""A model for maps alone, of ranges and bearings."""
_TOP: Final = ("map", "navigation", "classification", "plan_view", LANDMARKS)
_MAP_ALONE: Final = ("lines", "topology", LANDMARKS)
"""World models for recorded data that are none of a robot's."""
_SLOTS: Final = ("world_model", "segmenter")
SLAM_TABLES: Final = ("scan_matcher", "local_maps", "loops", "pose_graph")
"""Tables of `[plan_view]` that say how scans are matched."""
LABEL_TABLES: Final = ("grouping", "shapes", "label_map", "markov_field")
"""Tables of `[classification]` that say how pictures are grouped and labels smoothed."""
TRUTH, SCAN_MATCH = "truth", "scan_match"
LOCALIZERS: Final = (TRUTH, SCAN_MATCH)
"""Poses taken as they are; scans placed by what they see."""


class MapTable(Table):
    """How recorded data is taken: `--set map.KEY=VALUE`."""

    pose_within: Annotated[float, Field(ge=0.0, le=1e6)] = POSE_WITHIN_S
    """How far off in time a frame's pose may be, s."""
    up: Annotated[
        Annotated[Up, Tag("axis")] | Annotated[Point3, Tag("direction")],
        Discriminator(lambda up: "axis" if isinstance(up, str) else "direction"),
    ] = "z"
    """Which axis of the poses' world points up, or the direction that does, (x, y, z); the map's
    z does."""
    level_within: Annotated[float, Field(ge=0.0, le=1.5)] = 0.05
    """A note tells of a floor in pictures that leans by more than this against the map, rad."""
    floor_share: Annotated[float, Field(ge=0.0, le=1.0)] = 0.05
    """It is the largest surface within 45 degrees of level, and more than this part of what the
    pictures show."""
    ground: Literal["auto", "filter", "all"] = "auto"
    """Which points of a cloud are ground: `filter` tells it from what stands on it, by
    `classification.ground_filter`; `all` takes all; `auto` filters landscapes from above."""
    baseline: Annotated[float, Field(ge=1e-3, le=10.0)] = 0.075
    """Depths are taken to be as precise as eyes so far apart see them, m."""
    robots: Annotated[int, Field(ge=0, lt=2**31)] = ROBOTS
    """Of ranges and bearings, the subjects up to this number are robots and no landmarks."""
    leave_out_moving: bool = False
    """Whether what moves, or was there and went, is left out of pictures and scans, which are
    read twice; by `navigation.moving`."""
    labels: bool = False
    """Whether pictures are grouped into planes and components, which are labelled floor, step,
    wall, furniture, clutter or door: `labels.png`, by `classification.grouping`."""
    columns: Annotated[int, Field(ge=16, le=4096)] = 160
    """Surfaces are found in pictures of so many columns at most: blocks of wider ones are one."""
    pictures: Annotated[int, Field(ge=0, le=64)] = 16
    """The world model `mesh` shows so many pictures of data in colour at most; 0: none."""

    @field_validator("up")
    @classmethod
    def _points_somewhere(cls, up: Direction) -> Direction:
        if not isinstance(up, str) and not any(up):
            raise ValueError("a direction must not be (0, 0, 0)")
        return up


@dataclass(frozen=True, slots=True)
class MapRequest:
    """What is to be made of which data.

    Attributes:
        source: a file or folder.
        world_model: its name; None: what suits the data.
        robot: a robot's name or folder, whose height counts; None without.
        camera: a `camera.toml` that takes the place of the source's own.
        topics: of a bag, those to read.
        seed: of all that is random.
        segmenter: what finds surfaces in pictures.
        parameters: table -> key -> value, as in a scenario's `[navigation]`.
        data: how the data is taken.
        ground_filter: key -> value, how a cloud's ground is told from what stands on it.
        labels: table -> key -> value, how pictures are grouped and labels smoothed.
        plan_view: `lines`, `alignment` and `topology` -> key -> value, how lines are found among a
            laser's points, how its scans are laid onto them, and what is a place, a way, a room;
            and `SLAM_TABLES`, how scans are matched.
        landmarks: table -> key -> value, how landmarks are found, of `[landmarks]`.
        localizer: one of `LOCALIZERS`.
    """

    source: Path
    world_model: str | None
    robot: str | None
    camera: Path | None
    topics: tuple[str, ...]
    seed: int
    segmenter: str
    parameters: dict[str, dict[str, Any]]
    data: MapTable
    ground_filter: dict[str, Any]
    labels: dict[str, dict[str, Any]]
    plan_view: dict[str, dict[str, Any]]
    landmarks: dict[str, Any]
    localizer: str = TRUTH


def read_request(
    source: Path,
    *,
    world_model: str | None = None,
    localizer: str | None = None,
    robot: str | None = None,
    camera: Path | None = None,
    topics: Sequence[str] = (),
    seed: int = 0,
    settings: Sequence[str] = (),
) -> MapRequest:
    """Return a request that is checked.

    Args:
        source: a file or folder.
        world_model: a name; None: what suits the data.
        localizer: one of `LOCALIZERS`; None: the first.
        robot: a robot's name or folder.
        camera: a `camera.toml`.
        topics: of a bag.
        seed: of all that is random.
        settings: `KEY=VALUE`: `elevation.cell=0.1`, `navigation.elevation.cell=0.1`,
            `map.up=-y`.

    Raises:
        InputError: with one message that names everything that is wrong.
    """
    if localizer not in (None, *LOCALIZERS):
        raise InputError(
            f"--localizer: found {shortened(localizer)}; must be {TRUTH}, by which poses are taken "
            f"as they are, or {SCAN_MATCH}, by which a laser's scans are placed by what they see"
        )
    raw: dict[str, Any] = {}
    for setting in settings:
        key, value = parse_setting(setting)
        words = split_key(key)
        if words[0] not in _TOP:
            _is_a_table(words[0])
            key = f"navigation.{key}"
        assign(raw, key, value)
    tables = dict(raw.get("navigation", {}))
    named = tables.pop("world_model", None) if world_model is None else world_model
    if named is not None and named not in _MAP_ALONE:
        tables["world_model"] = named
    try:
        navigation = Navigation.model_validate(tables)
        data = MapTable.model_validate(raw.get("map", {}))
    except ValidationError as error:
        found, name, model = (
            (dict(tables), "navigation", Navigation)
            if error.title == Navigation.__name__
            else (raw.get("map", {}), "map", MapTable)
        )
        details = error.errors(include_url=False)
        lines = [f"--set {describe_in(name, model, detail, found)}" for detail in details]
        raise InputError("\n".join(dict.fromkeys(lines))) from None
    classes = _tables(raw, "classification", "ground_filter", *LABEL_TABLES)
    return MapRequest(
        source=source,
        world_model=named,
        robot=robot,
        camera=camera,
        topics=tuple(topics),
        seed=seed,
        segmenter=navigation.segmenter,
        parameters=navigation.parameters(),
        data=data,
        ground_filter=classes["ground_filter"],
        labels={name: classes[name] for name in LABEL_TABLES},
        plan_view=_tables(raw, "plan_view", "lines", "alignment", "topology", *SLAM_TABLES),
        landmarks=_tables(raw, LANDMARKS, "readings", "fast_slam"),
        localizer=localizer or TRUTH,
    )


def _tables(raw: dict[str, Any], top: str, *names: str) -> dict[str, dict[str, Any]]:
    """Return the tables of another part of the core that are set; it checks what is in them."""
    tables = raw.get(top, {})
    if not isinstance(tables, dict) or set(tables) - set(names):
        keys = " and ".join(f"{top}.{name}.KEY" for name in names)
        raise InputError(f"--set {top}: only {keys} can be set")
    for name in names:
        if not isinstance(tables.get(name, {}), dict):
            raise InputError(f"--set {top}.{name}: must be followed by a key")
    return {name: tables.get(name, {}) for name in names}


def _is_a_table(word: str) -> None:
    names = sorted({table.key.split(".")[1] for table in all_tables() if "." in table.key})
    if word not in (*names, *_SLOTS):
        allowed = (
            f"{', '.join(_TOP)}, or a table of navigation{nearest(word, ['map', *_SLOTS, *names])}"
        )
        raise InputError(f"--set {shortened(word)}: unknown; must begin with {allowed}")
