"""Where a sensor was, by the transforms of a bag: frames that hang one below the other, by time."""

from array import array
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from treadwell.errors import InputError
from treadwell.sources.frame import Floats, UnusableError
from treadwell.sources.pose_file import nearest, pose_of

MOST_TRANSFORMS: Final = 5_000_000
"""Of one bag: thirty joints at 100 Hz for half an hour; they take 320 MB."""
MOST_FRAMES: Final = 10_000
_DEEPEST: Final = 200


@dataclass(slots=True)
class _Edge:
    """A frame's pose in its parent, by time: rows of s, x, y, z m, quaternion x, y, z, w."""

    parent: str
    numbers: "array[float]" = field(default_factory=lambda: array("d"))
    fixed: bool = False
    rows: Floats | None = None

    def close(self) -> Floats:
        """Return the rows in the order of time; a pose that never changes is fixed."""
        if self.rows is None:
            rows = np.array(self.numbers).reshape(-1, 8)
            rows = rows[np.argsort(rows[:, 0], kind="stable")]
            moves = (rows[1:, 1:] != rows[0, 1:]).any()
            self.fixed = self.fixed or (len(rows) > 1 and not moves)
            self.rows, self.numbers = rows, array("d")
        return self.rows

    def pose(self, time: float, within: float) -> Floats:
        """Return parent_from_frame, (4, 4), that is nearest in time; any time of a fixed one."""
        rows = self.close()
        number = -1 if self.fixed else nearest(rows[:, 0], time, within, "pose")
        return pose_of(rows[number, 1:])


@dataclass(slots=True)
class Transforms:
    """The transforms of a bag, and its odometry for frames that have none.

    Attributes:
        count: how many there are.
        doubted: frames that have more than one parent, of which the first counts.
    """

    count: int = 0
    doubted: set[str] = field(default_factory=set)
    _edges: dict[str, _Edge] = field(default_factory=dict)
    _odometry: dict[str, _Edge] = field(default_factory=dict)

    def add(
        self, parent: str, child: str, time: float, numbers: tuple[float, ...], *, fixed: bool
    ) -> None:
        """Take in where a frame is in another.

        Args:
            parent: the other's name.
            child: the frame's name.
            time: s.
            numbers: x, y, z m, quaternion x, y, z, w.
            fixed: whether it holds for all times.

        Raises:
            InputError: there are more than `MOST_TRANSFORMS`.
        """
        self._add(self._edges, parent, child, (time, *numbers), fixed)

    def add_odometry(
        self, parent: str, child: str, time: float, numbers: tuple[float, ...]
    ) -> None:
        """Take in odometry: as `add`, for a frame for which no transform says where it is."""
        self._add(self._odometry, parent, child, (time, *numbers), False)

    def _add(
        self,
        edges: dict[str, _Edge],
        parent: str,
        child: str,
        row: tuple[float, ...],
        fixed: bool,
    ) -> None:
        parent, child = parent.lstrip("/"), child.lstrip("/")
        if not child or child == parent:
            return
        self.count += 1
        edge = edges.get(child)
        if self.count > MOST_TRANSFORMS or len(edges) > MOST_FRAMES:
            raise InputError(
                f"more than {MOST_TRANSFORMS} transforms or {MOST_FRAMES} frames, the limit"
            )
        if edge is None:
            edge = edges[child] = _Edge(parent)
        if edge.parent != parent:
            self.doubted.add(child)
            return
        edge.fixed = edge.fixed or fixed
        edge.numbers.extend(row)

    def root(self, frame: str) -> str | None:
        """Return the frame in which a frame's poses are; None: no transform knows the frame."""
        frame = frame.lstrip("/")
        steps = self._upward(frame)
        if steps:
            return steps[-1].parent
        edges = [*self._edges.values(), *self._odometry.values()]
        return frame if any(edge.parent == frame for edge in edges) else None

    def pose(self, frame: str, time: float, within: float) -> Floats:
        """Return root_from_frame, (4, 4): of each moving frame on the way what is nearest in time.

        Args:
            frame: its name.
            time: s.
            within: s, how far off in time it may be.

        Raises:
            UnusableError: there is no such way, or none at that time.
        """
        pose = np.eye(4)
        for edge in self._upward(frame.lstrip("/")):
            pose = edge.pose(time, within) @ pose
        if not np.isfinite(pose).all():
            raise UnusableError("pose not finite")
        return pose

    def _upward(self, frame: str) -> list[_Edge]:
        steps: list[_Edge] = []
        while edge := self._edges.get(frame) or self._odometry.get(frame):
            steps.append(edge)
            frame = edge.parent
            if len(steps) > _DEEPEST:
                raise UnusableError("transforms that go in a circle")
        return steps
