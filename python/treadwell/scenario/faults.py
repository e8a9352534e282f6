"""What can break in a sense or a motor, as it stands in a scenario file: `do = "fault"`."""

from dataclasses import dataclass
from typing import Annotated, Final, Literal, Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from treadwell.scenario.event_table import EventTable
from treadwell.scenario.types import Seconds

Part = Literal["depth", "imu", "encoders", "feet", "motors", "latency"]
"""What breaks."""
Kind = Literal[
    "nan",
    "freeze",
    "scale",
    "outliers",
    "drop",
    "bias",
    "swap",
    "zero",
    "stick",
    "dead",
    "weak",
    "motors",
    "imu",
]
"""How it breaks."""


@dataclass(frozen=True, slots=True)
class FaultKind:
    """What a kind of fault needs to be told.

    Attributes:
        keys: that it must have.
        value: least and largest `value`, None where it has none.
        optional: keys that it may have.
        is_force: whether its `value` is a force, which is greater for a heavier robot.
    """

    keys: tuple[str, ...] = ()
    value: tuple[float, float] | None = None
    optional: tuple[str, ...] = ()
    is_force: bool = False


FAULTS: Final[dict[str, dict[str, FaultKind]]] = {
    "depth": {
        "nan": FaultKind(),
        "freeze": FaultKind(),
        "scale": FaultKind(("value",), (0.01, 100.0)),
        "outliers": FaultKind(("value",), (0.0, 1.0)),
        "drop": FaultKind(("value",), (0.0, 1.0)),
    },
    "imu": {
        "bias": FaultKind(("value",), (-10.0, 10.0)),
        "swap": FaultKind(),
        "zero": FaultKind(),
    },
    "encoders": {"stick": FaultKind(("joint",))},
    "feet": {
        "stick": FaultKind(("foot", "cell", "value"), (0.0, 10000.0), is_force=True),
        "dead": FaultKind(("foot",)),
    },
    "motors": {"weak": FaultKind(("value",), (0.0, 1.0), ("joint",))},
    "latency": {
        "motors": FaultKind(("value",), (0.0, 2.0)),
        "imu": FaultKind(("value",), (0.0, 2.0)),
    },
}
"""Part -> kind -> what it needs."""


class Fault(EventTable):
    """A sense or a motor breaks; what it does wrong stands in its kind."""

    do: Literal["fault"]
    """What happens."""
    part: Part
    """What breaks; `latency`: what the inertial unit or the motors are told comes late."""
    kind: Kind
    """Depth: `nan`, `freeze`, `scale`, `outliers`, `drop`; imu: `bias`, `swap`, `zero`; encoders:
    `stick`; feet: `stick`, `dead`; motors: `weak`; latency: `motors`, `imu`."""
    value: float | None = None
    """Of `scale`: factor; `outliers`, `drop`: share; `bias`: rad/s about z; `stick` of a foot's
    cell: N; `weak`: share of the torque that is left; of a latency: seconds."""
    joint: Annotated[str, Field(min_length=1, max_length=64)] | None = None
    """Of `stick` and `weak`: the joint's name; `weak`: "all", which is the default, for all."""
    foot: Literal["left", "right"] | None = None
    """Whose force cells."""
    cell: Annotated[int, Field(ge=0, le=3)] | None = None
    """Which cell of a foot: 0 front left, 1 front right, 2 rear left, 3 rear right."""
    duration: Seconds | None = None
    """How long, simulated seconds; to the end where it is left out."""

    @model_validator(mode="after")
    def _is_one_of_its_part(self) -> Self:
        kinds = FAULTS[self.part]
        if self.kind not in kinds:
            raise PydanticCustomError(
                "fault",
                "must be one of {kinds} for the part '{part}'",
                {"key": "kind", "kinds": ", ".join(kinds), "part": self.part},
            )
        needs = kinds[self.kind]
        for key in ("value", "joint", "foot", "cell"):
            given = getattr(self, key) is not None
            if given and key not in (*needs.keys, *needs.optional):
                raise PydanticCustomError(
                    "fault", "is nothing that '{kind}' has", {"key": key, "kind": self.kind}
                )
            if not given and key in needs.keys:
                raise PydanticCustomError(
                    "fault", "missing; '{kind}' needs it", {"key": key, "kind": self.kind}
                )
        if needs.value is not None and self.value is not None:
            least, most = needs.value
            if not least <= self.value <= most:
                raise PydanticCustomError(
                    "fault",
                    "must be within {least} and {most}",
                    {"key": "value", "least": least, "most": most},
                )
        return self
