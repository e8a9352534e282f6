"""Planes and components in rooms, labelled, against what was drawn (Figs 36.18 and 36.19)."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.patches import Patch
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.experiments.indoor.figure import panels, save
from treadwell.experiments.indoor.rooms import DrawnRooms, RoomLook
from treadwell.map_making.room_labels import COLOURS, NAMES, RGB, RoomLabels, pool_of
from treadwell.measuring.regions import RegionCounts, compare_regions
from treadwell.measuring.segmentation_watch import connected

COLUMNS: Final = 160
LEAST_SHARE: Final = 100 / (88 * 72)
"""Of a picture: surfaces that are smaller do not count, as in Gutmann's experiments."""
_MATCHES: Final = 0.8
"""Groups of fewer pixels than this share of the least surface match none that counts."""
_SHOWN: Final = range(2, 12)
_SCORED: Final = range(6)
_LOOKS: Final = 6
_PURE: Final = 0.7
_FEATURES: Final = 17
"""Of a group."""
_CUBE_M: Final = 0.05
"""Side of a cube that has a label: the core's own, `classification.label_map.cube`."""
_HALF: Final = 1 << 12
"""Cubes to each side of the origin, at most."""


@dataclass(frozen=True, slots=True, eq=False)
class LabelScore:
    """How labels fit what was drawn.

    Attributes:
        regions: groups against true surfaces, after Hoover et al. 1996.
        confusion: (6, 6) pixels: true label, label by the group alone.
        points: (6, 6) cubes of the maps: true label, smoothed label.
        alone: the same before neighbours smoothed them.
        isolated: cubes with a wrong label unlike that of most around them; before, and after.
    """

    regions: RegionCounts
    confusion: NDArray[np.int64]
    points: NDArray[np.int64]
    alone: NDArray[np.int64]
    isolated: tuple[int, int]


def recall_precision(confusion: NDArray[np.int64]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return recall and precision of each label, NaN of one that there is none of."""
    with np.errstate(invalid="ignore"):
        right = np.diag(confusion)
        return right / confusion.sum(axis=1), right / confusion.sum(axis=0)


def drawn_houses(seeds: Iterable[int], robot: str) -> Iterable[tuple[int, DrawnRooms]]:
    """Yield the houses of those seeds that have one."""
    for seed in seeds:
        try:
            yield seed, DrawnRooms(seed, robot)
        except InputError:
            continue


def examples(
    seeds: Iterable[int], robot: str, looks: int
) -> tuple[list[NDArray[np.float64]], list[int]]:
    """Return features of groups, and which label most of their pixels have, where most agree."""
    features: list[NDArray[np.float64]] = []
    labels: list[int] = []
    begin = (np.random.default_rng(0).normal(size=(12 * len(NAMES), _FEATURES)), [*range(6)] * 12)
    seer = RoomLabels(COLUMNS, examples=begin)
    for _, rooms in drawn_houses(seeds, robot):
        for look in rooms.looks(looks):
            if not seer.insert(look.depth, rooms.camera, look.world_from_camera, keep=False):
                continue
            groups, kinds = seer.core.groups, _sampled(look.kind, look)
            for number, row in enumerate(seer.core.features, start=1):
                seen = kinds[(groups == number) & (kinds >= 0)]
                counts = np.bincount(seen, minlength=len(NAMES))
                if counts.max() > _PURE * max(len(seen), 1):
                    features.append(row)
                    labels.append(int(counts.argmax()))
    return features, labels


def score(seeds: Iterable[int], robot: str, looks: int) -> LabelScore:
    """Return how groups and labels fit in houses that nothing was learned of.

    Args:
        seeds: of the houses.
        robot: whose camera looks.
        looks: into each house.
    """
    size = len(NAMES)
    regions = RegionCounts()
    confusion, points, alone = (np.zeros((size, size), np.int64) for _ in range(3))
    isolated = np.zeros(2, np.int64)
    for _, rooms in drawn_houses(seeds, robot):
        seer = RoomLabels(COLUMNS)
        seen: list[RoomLook] = []
        for look in rooms.looks(looks, surfaces=True):
            if not seer.insert(look.depth, rooms.camera, look.world_from_camera):
                continue
            seen.append(look)
            kinds, labels = _sampled(look.kind, look), seer.core.labels
            surfaces = connected(_sampled(look.surface, look))
            surfaces[kinds < 0] = -1
            regions += _hoover(surfaces, seer.core.groups.astype(np.int64))
            known = (kinds >= 0) & (labels < size)
            np.add.at(confusion, (kinds[known], labels[known]), 1)
        places, smoothed, before = seer.core.points()
        truth = _truth_of_points(rooms, seen, places)
        known = truth >= 0
        np.add.at(points, (truth[known], smoothed[known]), 1)
        np.add.at(alone, (truth[known], before[known]), 1)
        isolated += [_isolated(places, labels, truth) for labels in (before, smoothed)]
    return LabelScore(regions, confusion, points, alone, (int(isolated[0]), int(isolated[1])))


def draw_groups(path: Path, _source: Path) -> str:
    """Draw a look into a room, its planes and components, and what they are labelled."""
    _, rooms = next(iter(drawn_houses(_SHOWN, "nao")))
    seer = RoomLabels(COLUMNS)
    look = max(rooms.looks(_LOOKS), key=lambda one: len(np.unique(one.kind)))
    seer.insert(look.depth, rooms.camera, look.world_from_camera)
    groups, labels = seer.core.groups, seer.core.labels
    figure, axes = panels(3, (4.0, 3.4))
    shown = np.append(RGB, [[255, 255, 255]], axis=0)[np.minimum(labels, len(NAMES))]
    mixed = np.where(groups > 0, 1 + groups.astype(np.int64) * 7 % 19, 0)
    axes[0].imshow(1.0 / look.depth, cmap="viridis")
    axes[1].imshow(mixed, cmap="tab20", interpolation="nearest")
    axes[2].imshow(shown, interpolation="nearest")
    titles = ("inverse depth", f"{groups.max()} planes and components", "what they are")
    for place, title in zip(axes, titles, strict=True):
        place.set_title(title, fontsize=9, loc="left")
        place.set_axis_off()
    marks = [Patch(color=colour, label=name) for name, colour in zip(NAMES, COLOURS, strict=True)]
    axes[2].legend(handles=marks, fontsize=7, ncols=2, loc="lower left")
    save(figure, path)
    found = score(_SCORED, "nao", _LOOKS)
    right = np.trace(found.confusion) / found.confusion.sum()
    before, after = found.isolated
    return (
        f"of {found.regions.true} surfaces {found.regions.correct} are groups at 80 % overlap "
        f"(Hoover et al.), {right:.1%} of the pixels have the right label, neighbours take "
        f"{before - after} of {before} errors away that stand alone"
    )


def _hoover(truth: NDArray[np.int64], groups: NDArray[np.int64]) -> RegionCounts:
    """Return how a picture's groups fit its true surfaces; what is small counts on neither side."""
    least = round(LEAST_SHARE * truth.size)
    groups[np.bincount(groups.ravel())[groups] < _MATCHES * least] = 0
    return compare_regions(truth, groups, least_true=least, least_found=least)


def _truth_of_points(
    rooms: DrawnRooms, seen: Sequence[RoomLook], places: NDArray[np.float64]
) -> NDArray[np.int64]:
    """Return what the cube of each place (n, 3) truly shows: what most pixels in it do."""
    camera = rooms.camera
    rows, cols = np.mgrid[: camera.height, : camera.width]
    x, y = (cols - camera.cx) / camera.fx, (rows - camera.cy) / camera.fy
    rays = np.stack([x, y, np.ones_like(x)], axis=-1)
    own = _cubes(places)
    counts = np.zeros((len(own), len(NAMES)), np.int64)
    order = np.argsort(own)
    for look in seen:
        there = look.kind >= 0
        pose = look.world_from_camera
        ends = (rays[there] * look.depth[there, None]) @ pose[:3, :3].T + pose[:3, 3]
        cubes = _cubes(ends)
        at = np.searchsorted(own, cubes, sorter=order).clip(max=max(len(own) - 1, 0))
        same = own[order[at]] == cubes if len(own) else np.zeros(0, bool)
        np.add.at(counts, (order[at[same]], look.kind[there][same]), 1)
    return np.where(counts.any(axis=1), counts.argmax(axis=1), -1)


def _cubes(places: NDArray[np.float64], step: tuple[int, ...] = (0, 0, 0)) -> NDArray[Any]:
    """Return the number of the cube that each place (n, 3) lies in, or of one so many cubes on."""
    cells = np.floor(places / _CUBE_M).astype(np.int64) + np.array(step) + _HALF
    return np.asarray((cells[:, 0] * 2 * _HALF + cells[:, 1]) * 2 * _HALF + cells[:, 2])


def _isolated(
    places: NDArray[np.float64], labels: NDArray[np.uint8], truth: NDArray[np.int64]
) -> int:
    """Return how many places have a wrong label that most of those in touching cubes do not."""
    own = _cubes(places)
    order = np.argsort(own)
    like, near = np.zeros(len(own), np.int64), np.zeros(len(own), np.int64)
    for step in product((-1, 0, 1), repeat=3):
        if not any(step) or not len(own):
            continue
        beside = _cubes(places, step)
        at = order[np.searchsorted(own, beside, sorter=order).clip(max=len(own) - 1)]
        there = own[at] == beside
        near += there
        like += there & (labels[at] == labels)
    return int(((2 * like < near) & (labels != truth) & (truth >= 0)).sum())


def _sampled(values: NDArray[np.int64], look: RoomLook) -> NDArray[np.int64]:
    """Return the value of each block of pixels that is one: that of its first pixel."""
    pool = pool_of(look.depth.shape[1], COLUMNS)
    rows, cols = (size // pool * pool for size in look.depth.shape)
    return values[:rows:pool, :cols:pool]
