"""`result.json` of a map (schema `treadwell.map/1`)."""

from typing import Any, Final

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from treadwell.map_memory import FLOOR, OBSTACLE, UNKNOWN, RememberedMap

SCHEMA: Final = "treadwell.map/1"


class Strict(BaseModel):
    """A table that allows nothing but its keys."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)


class MappedSource(Strict):
    """What was mapped."""

    kind: str
    """Which form of recording it is."""
    path: str
    """Where it lies."""


class MappedCells(Strict):
    """How many cells the map has of each kind."""

    floor: int
    """Ground, or the top of what is higher than what lies beside it by no more than a step."""
    obstacle: int
    """What stands out."""
    unknown: int
    """Within the map's bounds, and never seen."""


class MappedLine(Strict):
    """A wall, or what else is straight."""

    normal: float
    """Direction of the line's normal in the map, counter-clockwise from x, rad."""
    distance: float
    """Distance of the line from the origin along the normal, m."""
    share: float
    """Share of all points that belong to it."""
    stretches: list[tuple[float, float, float, float]]
    """Where its points are: x and y of both ends of each part without a large gap, m."""


class MappedLines(Strict):
    """The lines that the points lie on, those with most points first."""

    count: int
    """How many there are."""
    held: float
    """Share of the points that lie on one, within two standard deviations."""
    each: list[MappedLine]
    """The lines."""


class MappedPlace(Strict):
    """A place where ways meet or end."""

    position: tuple[float, float]
    """Where it is, m."""
    clearance: float
    """From there to the nearest cell that is not free, m."""
    ways: int
    """How many ways begin there."""


class MappedWay(Strict):
    """A way between two places, in the middle between what is nearest on both sides."""

    places: tuple[int, int]
    """Numbers of the places that it joins, from 0 on."""
    length: float
    """Its length, m."""
    clearance: float
    """Distance to the nearest cell that is not free where it is narrowest, m."""


class MappedDoorway(Strict):
    """A narrow place between two rooms."""

    position: tuple[float, float]
    """Its middle, m."""
    width: float
    """From one side to the other, m."""
    rooms: tuple[int, int]
    """Numbers of the rooms that it joins, from 1 on."""


class MappedPlaces(Strict):
    """The map as a graph: places, ways between them, and rooms."""

    count: int
    """How many places there are."""
    each: list[MappedPlace]
    """The places."""
    ways: list[MappedWay]
    """Ways between them."""
    rooms: int
    """How many rooms there are."""
    doorways: list[MappedDoorway]
    """Doorways between two different rooms."""


class MappedLandmark(Strict):
    """A landmark on the plane."""

    x: float
    """m."""
    y: float
    """m."""
    covariance: tuple[float, float, float]
    """Of x and y: xx, xy, yy, m²."""
    name: int | None
    """What the source calls it; none where names were withheld."""
    probability: float
    """That it is there."""
    readings: int
    """How many readings of it were taken in."""


class MappedMatching(Strict):
    """How a laser's scans were placed by what they see."""

    local_maps: int
    """Stretches of the way, each with a map of its own."""
    loops_closed: int
    """Scans that were matched to an older local map as well."""
    unmatched: int
    """Scans that fit nowhere near, for which odometry was believed."""
    moved: float
    """Mean distance by which the scans were moved, m."""


class Times(Strict):
    """Milliseconds of the clock a frame."""

    median: float
    """Half took no longer."""
    p99: float
    """All but one in a hundred."""
    max: float
    """The longest."""
    count: int
    """Of how many frames."""


class MapResult(Strict):
    """What came of a map."""

    schema_: str = Field(SCHEMA, alias="schema")
    """`treadwell.map/1`."""
    version: str
    """Of treadwell."""
    source: MappedSource
    """What was mapped."""
    world_model: str
    """What kept the map."""
    localizer: str = "truth"
    """`truth`: poses were taken as they are; `scan_match`: scans were placed by what they see."""
    robot: str | None
    """Whose height counted; none where nobody's did."""
    seed: int
    """Of all that is random."""
    frames: int
    """Frames that the source has, as far as it was read."""
    frames_used: int
    """Frames in the map."""
    unused: dict[str, int]
    """Reason -> frames that were left out."""
    interrupted: bool
    """Whether it was ended before the source was."""
    cells: MappedCells
    """Cells of the map by kind."""
    lines: MappedLines | None = None
    """Lines, of the world model `lines`; none of others."""
    places: MappedPlaces | None = None
    """Places and the ways between them, of the world model `topology`; none of others."""
    matching: MappedMatching | None = None
    """Of the localizer `scan_match`; none of others."""
    landmarks: list[MappedLandmark] | None = None
    """In a map of landmarks: their places, in the frame in which the robot starts at 0, 0, 0."""
    landmark_error: float | None = None
    """Root mean square distance of the landmarks from where they were surveyed after the best turn
    and shift, m; none where nobody surveyed them, or they have no names."""
    cell: float
    """Side of a cell, m; 0 of a map that has none."""
    origin: tuple[float, float]
    """Lower-left corner of the map, m, in the source's world, turned so that z is up."""
    settings: dict[str, Any]
    """Table -> key -> value, of the core: the user's, and those that follow from the data."""
    assumed: dict[str, Any]
    """Key -> value, of the settings that follow from the data."""
    notes: list[str]
    """What was found in the data that its user should know."""
    timing_ms: dict[str, Times]
    """Stage -> times: `map` is one frame from the sensor's data to the map's view."""


def counted(found: RememberedMap) -> MappedCells:
    """Return how many cells a map has of each kind."""
    return MappedCells(
        floor=int((found.kind == FLOOR).sum()),
        obstacle=int((found.kind == OBSTACLE).sum()),
        unknown=int((found.kind == UNKNOWN).sum()),
    )


def times(seconds: list[float]) -> Times:
    """Return the times of frames, of seconds of the clock."""
    if not seconds:
        return Times(median=0.0, p99=0.0, max=0.0, count=0)
    each = 1e3 * np.array(seconds)
    return Times(
        median=round(float(np.median(each)), 4),
        p99=round(float(np.percentile(each, 99)), 4),
        max=round(float(each.max()), 4),
        count=len(seconds),
    )
