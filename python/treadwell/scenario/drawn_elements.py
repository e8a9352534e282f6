"""Elements that draw themselves from the seed: many things in an area of the course."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from treadwell.scenario.element_table import ElementTable
from treadwell.scenario.types import Point2, Size2

Area = Annotated[tuple[Point2, Point2], Field(strict=False)]
"""Its lower and its upper corner: world x, y, m."""


def check_area(area: tuple[tuple[float, float], tuple[float, float]]) -> None:
    """Refuse an area whose first corner is not the lower one.

    Raises:
        PydanticCustomError: for the key `area`.
    """
    (x0, y0), (x1, y1) = area
    if x0 >= x1 or y0 >= y1:
        raise PydanticCustomError(
            "order", "must be the lower and then the upper corner", {"key": "area"}
        )


class Scatter(ElementTable):
    """Random boxes and cylinders, 0.08 m or higher, that leave a way from start to goal."""

    kind: Literal["scatter"]
    """Which kind of element it is."""
    area: Area = ((0.5, -0.8), (2.5, 0.8))
    """Two opposite corners of the area in which their centres lie: world x, y, m."""
    count: Annotated[int, Field(ge=1, le=200)] = 6
    """How many there are."""
    size: Size2 = (0.05, 0.25)
    """Smallest and largest edge, m."""

    @model_validator(mode="after")
    def _is_ordered(self) -> Self:
        check_area(self.area)
        if self.size[0] > self.size[1]:
            raise PydanticCustomError(
                "order", "must be the smallest and then the largest edge", {"key": "size"}
            )
        return self
