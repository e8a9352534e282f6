"""What hangs over the course: the ceiling map against the truth (Gutmann 2005, section VI)."""

from dataclasses import dataclass

import numpy as np

from treadwell.course.course import CourseElement
from treadwell.episode import Episode
from treadwell.map_memory import FLOOR
from treadwell.measuring.cells import covered_by, lattice
from treadwell.trace import Trace


@dataclass(frozen=True, slots=True)
class CeilingErrors:
    """How far the map has what hangs from where it hangs.

    Attributes:
        cells: that something hangs over, floor below it; of those that the map ever had in view.
        errors: m, map minus truth, an entry for each of them for which the map had a ceiling: the
            last one that it had.
        free: how many of those were floor to the map then, with room to pass under.
    """

    cells: int
    errors: tuple[float, ...]
    free: int


class CeilingWatch:
    """Watches the cells that lie under what hangs above the ground."""

    def __init__(self, episode: Episode) -> None:
        """Watch this episode."""
        self._pilot = episode.pilot
        self._hanging = [one for one in episode.course.elements if _underside(one) > 0.0]
        self._errors: dict[tuple[int, int], float] = {}
        self._free: set[tuple[int, int]] = set()

    def frame(self, trace: Trace) -> None:
        """Take in a camera frame."""
        ceilings = self._pilot.ceilings()
        if ceilings is None:
            return
        centres, cells = lattice(trace)
        found, kind = ceilings.ravel().astype(np.float64), trace.view_kind.ravel()
        for element in self._hanging:
            for index in np.flatnonzero(covered_by(element, centres)):
                cell, error = cells[index], found[index] - _underside(element)
                self._errors.setdefault(cell, np.nan)
                if np.isfinite(error):
                    self._errors[cell] = error
                    (self._free.add if kind[index] == FLOOR else self._free.discard)(cell)

    def findings(self) -> CeilingErrors:
        """Return what the map had last."""
        known = tuple(float(error) for error in self._errors.values() if np.isfinite(error))
        return CeilingErrors(len(self._errors), known, len(self._free))


def _underside(element: CourseElement) -> float:
    """Return the height of its lowest point where the course puts it, m."""
    return min(float(piece.vertices[:, 2].min()) for piece in element.pieces)
