"""How much room above the ground a world model is to ask for."""

from collections.abc import Mapping
from typing import Any, Final

NEEDS_A_ROBOT: Final = {
    "extended_elevation": "extended_elevation",
    "multi_level": "multi_level",
    "points": "points",
    "mesh": "mesh",
    "occupancy_2d": "depth_slice",
}
"""World model -> the table that says, or the robot does, how much room there must be."""
_HEADROOM: Final = {"depth_slice": "high"}
"""Table -> its key for that, where it is not `headroom`."""
ROBOT: Final = "qrio"
"""Whose height counts where a world model needs one and no robot is named."""


def headroom_of(
    world_model: str, parameters: Mapping[str, Mapping[str, Any]], robot: str | None
) -> tuple[str | None, float | None]:
    """Return whose height counts, and that height, m; None where no model asks and none is named.

    Args:
        world_model: its name.
        parameters: table -> key -> value; one may say how much room there must be.
        robot: a robot's name or folder; None: a model that needs one takes `ROBOT`.

    Raises:
        InputError: there is no such robot.
    """
    table = NEEDS_A_ROBOT.get(world_model)
    needed = table and _HEADROOM.get(table, "headroom") not in parameters.get(table, {})
    if robot is None and not needed:
        return None, None
    # Late: a map without a robot needs no MuJoCo.
    from treadwell.robot.load import load_robot

    whose = robot or ROBOT
    return whose, float(load_robot(whose).description()["body"]["height"])
