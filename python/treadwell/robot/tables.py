"""The table and the kinds of numbers that the models of a robot's file are made of."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, StringConstraints

Name = Annotated[str, StringConstraints(min_length=1, max_length=100)]
Positive = Annotated[FiniteFloat, Field(gt=0.0)]
NotNegative = Annotated[FiniteFloat, Field(ge=0.0)]
Share = Annotated[FiniteFloat, Field(ge=0.0, le=1.0)]
Position = tuple[FiniteFloat, FiniteFloat, FiniteFloat]


class Table(BaseModel):
    """A table of the file: unknown keys, NaN and infinity are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)
