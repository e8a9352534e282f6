"""What entries of a result are made of, and those of footsteps."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

Count = Annotated[int, Field(ge=0)]
Instant = Annotated[FiniteFloat, Field(ge=0.0, le=1e6)]
"""Simulated seconds since the start: a scenario's time limit is below it."""


class Table(BaseModel):
    """A part of the result: no further keys, no NaN, no infinity."""

    model_config = ConfigDict(
        extra="forbid", allow_inf_nan=False, populate_by_name=True, use_attribute_docstrings=True
    )


class FootstepPlanEntry(Table):
    """A plan of footsteps by which the feet began to step: what it costs, and for what."""

    time: Instant
    """When they began, simulated seconds."""
    steps: Count = 0
    """How many steps it has."""
    careful_steps: Count = 0
    """How many of them are careful ones."""
    walked: float = 0.0
    """The time of its walked steps, s."""
    careful: float = 0.0
    """The time of its careful steps, s."""
    partial: float = 0.0
    """What it costs that soles bear in part, s."""
    margin: float = 0.0
    """What it costs that ground beside the feet is not known or out of reach, s."""
    turns: float = 0.0
    """What it costs that feet turn, s."""
    unseen: float = 0.0
    """What the way costs on from there over ground that was not seen, s."""
    expanded: Count = 0
    """Places of a foot that were looked on from."""
