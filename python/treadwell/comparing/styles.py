"""How a figure tells sides apart, in grey as well: a letter, a marker and a style of line each."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

from matplotlib.lines import Line2D

from treadwell.comparing.comparison import letter

MOST_STYLES: Final = 8
"""Sides that markers and lines tell apart."""
_MARKERS: Final = ("o", "s", "^", "D", "v", "P", "X", "p")
_DASHES: Final = (
    "-", (0, (5, 1.5)), (0, (1, 1)), (0, (5, 1.5, 1, 1.5)), (0, (9, 2)),
    (0, (3, 1, 1, 1, 1, 1)), (0, (2, 2)), (0, (9, 2, 2, 2)),
)  # fmt: skip
_COLOURS: Final = (
    "#000000", "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#56b4e9", "#7a5c00", "#777777",
)  # fmt: skip
"""Those of Okabe and Ito that are dark enough on white, and two more."""
_KEY: Final = re.compile(r"(?:^|(?<= ))(?:[\w-]+\.)*([\w-]+)=")
"""A key of a variant, with the tables that it stands in."""
_LONGEST: Final = 34
"""Characters of a name in the legend; longer ones lose their middle."""


@dataclass(frozen=True, slots=True)
class Style:
    """How a side is drawn.

    Attributes:
        letter: that stands for it.
        name: in the legend.
        marker: of its points, as Matplotlib has it.
        dashes: of its lines, as Matplotlib has it.
        colour: of both.
    """

    letter: str
    name: str
    marker: str
    dashes: Any
    colour: str

    @property
    def label(self) -> str:
        """Letter and name."""
        return f"{self.letter}  {self.name}"

    def handle(self) -> Line2D:
        """Return what a legend shows of it."""
        return Line2D(
            [0], [0], color=self.colour, linestyle=self.dashes, linewidth=1.1, marker=self.marker,
            markersize=3.5, label=self.label,
        )  # fmt: skip


def styles(names: Sequence[str]) -> tuple[Style, ...]:
    """Return the style of each side, in the order of their names; from the ninth on they repeat."""
    return tuple(
        Style(
            letter=letter(number),
            name=name,
            marker=_MARKERS[number % MOST_STYLES],
            dashes=_DASHES[number % MOST_STYLES],
            colour=_COLOURS[number % MOST_STYLES],
        )
        for number, name in enumerate(short_names(names))
    )


def short_names(names: Sequence[str]) -> list[str]:
    """Return names for a legend: keys of variants without the tables that they stand in.

    `navigation.world_model=fog` becomes `world_model=fog`. Names that would then be the same are
    left as they are; what is longer than a legend has room for loses its middle.
    """
    short = [_KEY.sub(r"\1=", name) for name in names]
    if len(set(short)) < len(short):
        short = list(names)
    cut = [_without_middle(name) for name in short]
    return cut if len(set(cut)) == len(cut) else short


def _without_middle(name: str) -> str:
    half = _LONGEST // 2
    return name if len(name) <= _LONGEST else f"{name[:half]}…{name[-half + 1 :]}"
