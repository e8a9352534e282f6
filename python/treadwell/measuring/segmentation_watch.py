"""How well the segmenter tells the level surfaces of each frame apart, by the simulator's truth."""

import numpy as np
from numpy.typing import NDArray

from treadwell.episode import Episode
from treadwell.measuring.regions import RegionCounts, compare_regions
from treadwell.senses.depth import Cast
from treadwell.trace import Trace

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

LEAST_PIXELS = 100
"""Pixels of the smallest surface that counts: Gutmann's experiments have 88 x 72."""
_NOT_COUNTED = -1
_SAME_LEVEL = 1e-6


class SegmentationWatch:
    """Compares the labels of each frame with the surfaces that its rays truly met.

    True regions are the level surfaces, connected in the image; walls, risers and pixels without a
    measurement do not count.
    """

    def __init__(self, episode: Episode) -> None:
        """Watch this episode."""
        self._episode = episode
        self._counts = RegionCounts()

    def frame(self, trace: Trace) -> None:
        """Take in a camera frame."""
        if trace.depth is None or trace.labels is None:
            return
        cast = self._episode.sensors.camera.cast(self._episode.simulation.data)
        truth = connected(self._levels(cast))
        truth[~np.isfinite(trace.depth)] = _NOT_COUNTED
        found = trace.labels.reshape(truth.shape).astype(np.int64)
        self._counts += compare_regions(
            truth, found, least_true=LEAST_PIXELS, least_found=LEAST_PIXELS
        )

    def findings(self) -> RegionCounts:
        """Return the sums over all frames."""
        return self._counts

    def _levels(self, cast: Cast) -> Ids:
        """Return for each pixel, (h, w), which level it shows, 1 for the ground; or not counted."""
        pinhole = self._episode.sensors.camera.pinhole
        rays = pinhole.directions() @ cast.rotation.T
        points = cast.position + rays * cast.depth.reshape(-1, 1)
        geoms = cast.geom.reshape(-1)
        ids = np.full(len(points), _NOT_COUNTED, dtype=np.int64)
        course, events = self._episode.course, self._episode.events
        elements = course.geom_element[np.maximum(geoms, 0)]
        ids[(geoms >= 0) & (elements < 0) & (np.abs(points[:, 2]) < _SAME_LEVEL)] = 1
        number = 1
        for index, element in enumerate(course.elements):
            offset = events.place(element, self._episode.simulation.data)
            for top in element.tops:
                number += 1
                if abs(top.normal[2]) < 1.0 - _SAME_LEVEL:
                    continue
                there = points - offset
                on_it = (geoms >= 0) & (elements == index) & top.contains(there[:, :2])
                ids[on_it & (np.abs(there[:, 2] - top.height) < _SAME_LEVEL)] = number
        return ids.reshape(cast.geom.shape)


def connected(ids: Ids) -> Ids:
    """Number the connected areas (4 neighbours) of equal positive ids from 1 on; others stay.

    Args:
        ids: (h, w).
    """
    # The smallest index that is joined to a pixel spreads until nothing changes.
    labels = np.arange(ids.size, dtype=np.int64).reshape(ids.shape)
    down, right = ids[1:] == ids[:-1], ids[:, 1:] == ids[:, :-1]
    while True:
        before = labels.copy()
        for joined, a, b in (
            (down, np.s_[1:], np.s_[:-1]),
            (right, np.s_[:, 1:], np.s_[:, :-1]),
        ):
            least = np.minimum(labels[a], labels[b])
            labels[a] = np.where(joined, least, labels[a])
            labels[b] = np.where(joined, np.minimum(labels[b], least), labels[b])
        if np.array_equal(labels, before):
            break
    areas = np.unique(labels[ids > 0], return_inverse=True)[1]
    numbered = ids.copy()
    numbered[ids > 0] = areas.ravel() + 1
    return numbered
