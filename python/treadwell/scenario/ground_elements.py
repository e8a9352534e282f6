"""Elements that are ground of another kind: slippery patches, vegetation, terrain, slabs."""

from typing import Annotated, Final, Literal, Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from treadwell.scenario.element_table import ElementTable
from treadwell.scenario.types import (
    LARGEST_M,
    Angle,
    FileName,
    Fraction,
    Friction,
    Length,
    Point2,
    Rise,
    Size2,
)

MOST_STEMS: Final = 20_000
"""Stems of one element: each is six triangles that rays are held against."""
WAVELENGTH_M: Final = 0.8
"""Of a terrain that is drawn, where nothing is said."""
SHORTEST_WAVE_M: Final = 0.05
MOST_SLABS: Final = 1000
"""Slabs of one element: each is a piece of the course."""
STEEPEST_SLAB: Final = 0.5
"""Radians: no slab is tilted by more."""
WAVES: Final = 100.0
"""Wavelengths along a side of a terrain that is drawn, at most."""


class Patch(ElementTable):
    """A plate on the ground, 1 mm thick, with a friction of its own. Position: its centre."""

    kind: Literal["patch"]
    """Which kind of element it is."""
    position: Point2 = (1.2, 0.0)
    """Its centre: world x, y, m."""
    yaw: Angle = 0.0
    """Heading of its length, rad."""
    size: Size2 = (0.4, 0.6)
    """Length and width, m."""
    friction: Friction = 0.1
    """Sliding friction on it, whatever the soles' is, and whatever an event makes of that."""
    shade: Fraction = 0.5
    """How light it is, 0 (black) to 1 (white): what a camera that sees light could tell."""


class Vegetation(ElementTable):
    """Stems that are seen and give way; the ground below them is firm. Position: its centre."""

    kind: Literal["vegetation"]
    """Which kind of element it is."""
    position: Point2 = (1.2, 0.0)
    """Its centre: world x, y, m."""
    yaw: Angle = 0.0
    """Heading of its length, rad."""
    size: Size2 = (0.6, 0.6)
    """Length and width, m."""
    height: Rise = 0.12
    """Height of the tallest stem, m; the shortest is half as high."""
    density: Annotated[float, Field(gt=0.0, le=MOST_STEMS)] = 150.0
    """Stems a square metre; each is 4 mm thick, its place drawn from the seed."""

    @model_validator(mode="after")
    def _can_be_drawn(self) -> Self:
        if self.stems() > MOST_STEMS:
            raise PydanticCustomError(
                "density",
                "must make at most {most} stems of this size, not {stems}",
                {"key": "density", "most": MOST_STEMS, "stems": self.stems()},
            )
        return self

    def stems(self) -> int:
        """Return how many stems there are, one at least."""
        return max(1, round(self.density * self.size[0] * self.size[1]))


class Terrain(ElementTable):
    """A height field that is walked on. Position: its centre.

    Its lowest place is the ground's. One that is drawn is level with the ground at its edges.
    """

    kind: Literal["terrain"]
    """Which kind of element it is."""
    position: Point2 = (1.5, 0.0)
    """Its centre: world x, y, m."""
    yaw: Angle = 0.0
    """Heading of its length, rad."""
    size: Annotated[tuple[Length, Length, Rise], Field(strict=False)] = (2.0, 1.6, 0.03)
    """Length, width, and the height of white, or of the highest place of one that is drawn, m."""
    file: FileName | None = None
    """Its heights: a grey PNG of 16 bits beside the scenario file, black 0 and white the height;
    the picture's right is along its length, its upper edge to the left. Either this or
    `wavelength`."""
    wavelength: Annotated[float, Field(ge=SHORTEST_WAVE_M, le=LARGEST_M)] | None = None
    """Of the shortest of the waves that it is drawn with from the seed, m; 0.8 where neither this
    nor `file` is there."""

    @model_validator(mode="after")
    def _is_read_or_drawn(self) -> Self:
        if self.file is not None and self.wavelength is not None:
            raise PydanticCustomError(
                "either", "must not be there together with file", {"key": "wavelength"}
            )
        least = max(self.size[:2]) / WAVES
        if self.file is None and self.drawn_wavelength() < least:
            raise PydanticCustomError(
                "wavelength",
                "must be at least a hundredth of the longer side: {least}",
                {"key": "wavelength", "least": round(least, 6)},
            )
        return self

    def drawn_wavelength(self) -> float:
        """Return the wavelength that it is drawn with, m."""
        return WAVELENGTH_M if self.wavelength is None else self.wavelength


class Slabs(ElementTable):
    """Slabs side by side, each tilted its own way, that are walked on. Position: their centre.

    Heights and tilts are drawn from the seed and the name.
    """

    kind: Literal["slabs"]
    """Which kind of element it is."""
    position: Point2 = (1.5, 0.0)
    """Their centre: world x, y, m."""
    yaw: Angle = 0.0
    """Heading of their length, rad."""
    size: Size2 = (1.8, 0.9)
    """Length and width of the ground that they cover, m."""
    edge: Length = 0.3
    """Length and width of one slab, m; as near to it as fits in."""
    rise: Rise = 0.045
    """No place of a slab is higher above the ground, m."""
    tilt: Annotated[float, Field(ge=0.0, le=STEEPEST_SLAB)] = 0.14
    """No slab is tilted by more, rad; less where it would leave the ground or be too high."""

    @model_validator(mode="after")
    def _can_be_laid(self) -> Self:
        rows, columns = self.counts()
        if rows * columns > MOST_SLABS:
            raise PydanticCustomError(
                "edge",
                "must make at most {most} slabs of this size, not {slabs}",
                {"key": "edge", "most": MOST_SLABS, "slabs": rows * columns},
            )
        return self

    def counts(self) -> tuple[int, int]:
        """Return how many slabs lie along its length and across, one at least."""
        length, width = (max(1, round(extent / self.edge)) for extent in self.size)
        return length, width
