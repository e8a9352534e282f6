"""When something happens on the way: what all events have in common."""

from typing import Self

from pydantic import model_validator
from pydantic_core import PydanticCustomError

from treadwell.scenario.types import Length, Point2, Seconds, Table


class EventTable(Table):
    """When it happens: `at` a time, or when the robot comes `near` a point."""

    at: Seconds | None = None
    """Time at which it happens, simulated seconds."""
    near: Point2 | None = None
    """World x, y, m: it happens once, when the robot comes as near to it as `within` says."""
    within: Length | None = None
    """Distance from `near`, m."""

    @model_validator(mode="after")
    def _has_one_trigger(self) -> Self:
        if (self.at is None) == (self.near is None):
            raise PydanticCustomError(
                "trigger", "must have either 'at' or 'near' with 'within'", {"key": None}
            )
        if (self.near is None) != (self.within is None):
            raise PydanticCustomError(
                "trigger", "'near' and 'within' belong together", {"key": "within"}
            )
        return self
