"""How well treads are seen: shares and errors of a place, as rows of a table."""

from dataclasses import dataclass, field

import numpy as np


@dataclass
class Share:
    """Treads within a range.

    Attributes:
        visible, hit, over: those with over 100 pixels, found, cut in parts.
        under: regions that hold a good part of two.
        errors: m, of the regions' heights.
    """

    visible: int = 0
    hit: int = 0
    over: int = 0
    under: int = 0
    errors: list[float] = field(default_factory=list)

    def row(self) -> str:
        """Return its part of a row."""
        share = 100 * self.hit / max(1, self.visible)
        return f"{self.visible:5d}{share:4.0f}%{self.over:5d}{self.under:5d} {spread(self.errors)}"


@dataclass
class Seen:
    """What a place showed.

    Attributes:
        near, far: treads up to 0.6 m, and from there to 1 m away.
        frames, reliable: depth frames, and those whose heights are trusted.
        lost, false_floor: sums over frames of the shares of treads without a height, and of walls
            with one.
        tilts: rad, of the corrected camera.
        cells: m, errors of the map's floor cells inside treads.
        inside, blocked, wrong: cells inside treads, those that are no floor, and those on another
            level.
    """

    near: Share = field(default_factory=Share)
    far: Share = field(default_factory=Share)
    frames: int = 0
    reliable: int = 0
    lost: float = 0.0
    false_floor: float = 0.0
    tilts: list[float] = field(default_factory=list)
    cells: list[float] = field(default_factory=list)
    inside: int = 0
    blocked: int = 0
    wrong: int = 0

    def row(self, name: str) -> str:
        """Return the place's row."""
        tilts, frames, inside = np.degrees(self.tilts), self.frames, max(1, self.inside)
        return (
            f"{name:<12}{100 * self.reliable / frames:5.0f}% |{self.near.row()} |{self.far.row()} |"
            f"{np.median(tilts):5.2f}{np.percentile(tilts, 95):5.2f} |"
            f"{100 * self.lost / frames:5.1f}{100 * self.false_floor / frames:6.1f} |"
            f"{spread(self.cells)}{100 * self.blocked / inside:5.1f}"
            f"{100 * self.wrong / inside:6.1f}\n"
        )


HEAD = (
    "            trust | <0.6: n  hit over under  bias   p95 <3mm |"
    "  <1: n  hit over under  bias   p95 <3mm | tilt  p95 | lost false | map: bias p95 <3mm"
    " obst wrong\n"
)


def spread(errors: list[float]) -> str:
    """Return bias and 95th percentile in millimetres, and the share within 3 mm."""
    if not errors:
        return f"{'-':>17}"
    mm = 1e3 * np.array(errors)
    within = 100 * np.mean(np.abs(mm) <= 3.0)
    return f"{np.mean(mm):+6.1f}{np.percentile(np.abs(mm), 95):6.1f}{within:4.0f}%"


def join(one: object, other: object) -> None:
    """Add another seed's counts and lists."""
    for name, value in vars(other).items():
        if isinstance(value, Share):
            join(getattr(one, name), value)
        else:
            setattr(one, name, getattr(one, name) + value)
