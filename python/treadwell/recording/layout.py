"""How the recording opens: the views, where they are, and the colours of what they show."""

from typing import Final

import numpy as np
import rerun.blueprint as rrb
from numpy.typing import NDArray

UNSEEN: Final = (150, 150, 150)
"""Grey: points without a plane, cells never seen."""
OBSTACLE: Final = (30, 30, 34)
TRUTH: Final = (40, 160, 90)
ESTIMATE: Final = (70, 130, 240)
ODOMETRY: Final = (240, 150, 40)
PATH: Final = (255, 70, 160)
CLIMB: Final = (125, 60, 215)
"""Legs of the path that are climbed."""
STAIR: Final = (20, 110, 120)
FRONT_EDGE: Final = (255, 190, 0)
FITTED_EDGE: Final = (230, 50, 40)
PLANNED_SOLE: Final = (70, 130, 240)
LANDED_SOLES: Final = ((250, 250, 250), (165, 170, 180))
"""Where the left and the right foot came down."""
WALKED_SOLE: Final = (90, 200, 250)
"""Steps of a plan that are walked."""
CAREFUL_SOLE: Final = (255, 140, 0)
EXIT: Final = (255, 70, 160)
"""Where a plan leads on over ground that was not seen."""
GOAL: Final = (60, 200, 90, 110)
GROUND_PLANE: Final = (95, 185, 120)
_NOT_AT_THE_FEET: Final = ("points", "trajectory", "walls", "obstacles", "believed", "path", "maps")
STATE_COLOURS: Final = (
    0x4C8BF5FF,
    0xF5A623FF,
    0x9B59B6FF,
    0x2ECC71FF,
    0xE74C3CFF,
    0x1ABC9CFF,
    0xF1C40FFF,
    0x95A5A6FF,
    0xE67E22FF,
    0x34495EFF,
    0xFF5FA2FF,
    0x7F8C1FFF,
)

_VIRIDIS: Final = np.array(
    [
        (68, 1, 84), (72, 40, 120), (62, 74, 137), (49, 104, 142), (38, 130, 142),
        (31, 158, 137), (53, 183, 121), (110, 206, 88), (181, 222, 43), (253, 231, 37),
    ],
    dtype=np.float64,
)  # fmt: skip
_PLANES: Final = np.array(
    [
        (31, 119, 180), (255, 127, 14), (214, 39, 40), (148, 103, 189), (140, 86, 75),
        (227, 119, 194), (188, 189, 34), (23, 190, 207), (255, 187, 120), (197, 176, 213),
    ],
    dtype=np.uint8,
)  # fmt: skip


def height_colours(height: NDArray[np.float32], low: float, high: float) -> NDArray[np.uint8]:
    """Return colours (n, 3) of heights (n,) m, dark at `low` and bright at `high`."""
    share = np.clip((height - low) / (high - low), 0.0, 1.0) * (len(_VIRIDIS) - 1)
    index = np.minimum(share.astype(np.intp), len(_VIRIDIS) - 2)
    rest = (share - index)[:, None]
    mixed = (1.0 - rest) * _VIRIDIS[index] + rest * _VIRIDIS[index + 1]
    return np.asarray(mixed, dtype=np.uint8)


def plane_colours(labels: NDArray[np.uint16], ground: int) -> NDArray[np.uint8]:
    """Return colours (n, 3) of points by their plane; grey without one, green on the ground."""
    table = np.empty((int(labels.max(initial=0)) + 1, 3), dtype=np.uint8)
    table[:] = _PLANES[(np.arange(len(table)) - 1) % len(_PLANES)]
    table[0] = UNSEEN
    if 0 < ground < len(table):
        table[ground] = GROUND_PLANE
    return table.take(labels, axis=0)


def blueprint(
    centre: tuple[float, float, float],
    extent: float,
    feet: tuple[float, float, float] | None = None,
    *,
    maps: bool = False,
    footsteps: bool = False,
) -> rrb.Blueprint:
    """Return the views: the world large, map and camera beside it, states and plots below.

    Args:
        centre: m, world: what the first view looks at.
        extent: m, size of the course.
        feet: m, world: where the robot starts, for a view that goes with its feet; None for none.
        maps: whether the robot was told a map, for a view of it.
        footsteps: whether footsteps are planned, for a view of the ground and a plot of the cost.
    """
    x, y, z = centre
    away = max(1.3, 0.8 * extent)  # then all of it is in view
    world = rrb.Spatial3DView(
        origin="/world",
        contents=["+ $origin/**", "- $origin/maps/static/**", "- $origin/maps/local/**"],
        name="World",
        background=rrb.Background(color=(236, 239, 243, 255)),
        line_grid=rrb.LineGrid3D(visible=True, spacing=0.2, color=(120, 125, 135, 60)),
        eye_controls=rrb.EyeControls3D(
            position=(x - 0.75 * away, y - 0.6 * away, z + 0.75 * away),
            look_target=(x, y, z),
            eye_up=(0.0, 0.0, 1.0),
        ),
    )
    pictures = rrb.Vertical(
        rrb.Spatial2DView(origin="/camera/depth", name="Depth"),
        rrb.Spatial2DView(origin="/map/floor", name="Floor and obstacle grid"),
        rrb.Spatial2DView(origin="/map/clearance", name="Distance to obstacles"),
        *([rrb.Spatial2DView(origin="/map/ground", name="Planned footsteps")] if footsteps else []),
    )
    plots = rrb.Horizontal(
        rrb.TimeSeriesView(origin="/error", name="Error against truth (m, rad)"),
        rrb.TimeSeriesView(origin="/timing", name="Time a stage takes (ms)"),
        *([rrb.TimeSeriesView(origin="/footsteps", name="Cost of the way")] if footsteps else []),
    )
    beside = [] if feet is None else [_feet(feet)]
    if maps:
        beside.insert(0, _maps(centre, away))
    views = (
        rrb.Horizontal(world, rrb.Vertical(*beside), pictures, column_shares=[5, 4, 2])
        if beside
        else rrb.Horizontal(world, pictures, column_shares=[3, 1])
    )
    return rrb.Blueprint(
        rrb.Vertical(
            views,
            rrb.StateTimelineView(origin="/behaviour", name="Behaviour"),
            plots,
            row_shares=[6, 1, 2],
        ),
        rrb.TimePanel(state="collapsed", timeline="time"),
        rrb.SelectionPanel(state="collapsed"),
        rrb.BlueprintPanel(state="collapsed"),
    )


def _maps(centre: tuple[float, float, float], away: float) -> rrb.Spatial3DView:
    """Return the view of what is known of the space, and of where the robot may be in it."""
    x, y, z = centre
    return rrb.Spatial3DView(
        origin="/world",
        contents=[f"+ $origin/{name}/**" for name in ("maps", "path", "believed", "robot", "goal")],
        name="Static map, local map and guesses",
        background=rrb.Background(color=(236, 239, 243, 255)),
        eye_controls=rrb.EyeControls3D(
            position=(x - 0.3 * away, y - 0.6 * away, z + 1.1 * away),
            look_target=(x, y, z),
            eye_up=(0.0, 0.0, 1.0),
        ),
    )


def _feet(start: tuple[float, float, float]) -> rrb.Spatial3DView:
    """Return the view of feet and edges from the side, which goes with the robot."""
    x, y, z = start
    return rrb.Spatial3DView(
        origin="/world",
        contents=["+ $origin/**", *(f"- $origin/{name}/**" for name in _NOT_AT_THE_FEET)],
        name="Feet and edges",
        background=rrb.Background(color=(236, 239, 243, 255)),
        eye_controls=rrb.EyeControls3D(
            position=(x, y - 0.75, z + 0.35),
            look_target=(x, y, z),
            eye_up=(0.0, 0.0, 1.0),
            tracking_entity="/world/ahead",
        ),
    )
