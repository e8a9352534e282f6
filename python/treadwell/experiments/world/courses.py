"""Small courses after complaints of people who walk humanoids elsewhere, one for each complaint."""

from collections.abc import Iterable
from typing import Final

from treadwell.experiments.world.parts import (
    Part,
    between,
    box,
    cable,
    corridor,
    desk,
    flight,
    platform,
    ramp,
    scenario,
    spread,
    wall,
)

_NEAR_EDGE: Final = {
    "start.position.0": between(0.30, 0.45),
    "start.position.1": spread(0.1),
    "start.yaw": spread(0.35),
}
"""15 to 30 cm before the first riser."""
_BEHIND_EDGE: Final = {
    "start.position.0": between(1.13, 1.25),
    "start.yaw": {"normal": [3.1, 0.12]},
}
"""14 to 26 cm behind the top edge, facing it."""
_UP_THERE: Final = {"position": [1.18, 0.0], "yaw": 3.1}
_ROOM: Final = 0.54
"""Metres: less than either robot is tall."""


def table() -> Part:
    """A desk of 90 by 120 cm that leaves 54 cm stands on the straight way."""
    return scenario("table", {"position": [2.6, 0.0]}, desk((1.4, 0.0), (0.9, 1.2), _ROOM))


def ceiling_flat() -> Part:
    """Across a corridor a ceiling 1 m deep leaves 54 cm."""
    ceiling = box("ceiling", (1.6, 0.0), (1.0, 1.0, 0.05), _ROOM)
    return scenario("ceiling_flat", {"position": [2.6, 0.0]}, [*corridor(3.0), ceiling])


def head_room_on_stairs() -> Part:
    """Four steps lead up under a ceiling that leaves 54 cm on the landing."""
    ceiling = box("ceiling", (1.5, 0.0), (1.0, 1.0, 0.05), 0.12 + _ROOM)
    course = [*corridor(2.2), flight(4, 0.03, 0.12, 0.9, 1.2), ceiling]
    return scenario("head_room_on_stairs", {"position": [1.6, 0.0], "height": 0.12}, course)


def ceiling_step() -> Part:
    """One step of 45 mm under a ceiling at 60 cm: 55.5 cm are left above it."""
    floor = platform("floor", (2.0, 0.0), (2.0, 0.9, 0.045))
    course = [*corridor(3.0), floor, box("ceiling", (1.9, 0.0), (1.0, 1.0, 0.05), 0.6)]
    return scenario("ceiling_step", {"position": [2.6, 0.0], "height": 0.045}, course)


def facing_wall() -> Part:
    """The start is 30 cm before a wall and faces it; the goal is behind."""
    goal = {"position": [-1.5, 0.3]}
    before = [wall("wall", (0.325, -1.5), (0.325, 1.5), 0.6)]
    return scenario("facing_wall", goal, before, vary={"start.yaw": spread(0.1)})


def stairs_down_near() -> Part:
    """Starts 14 to 26 cm behind the top edge of four steps of 32 mm, and goes down."""
    return _down("stairs_down_near", 0.032, {})


def near_up() -> Part:
    """Starts 15 to 30 cm before four steps of 30 mm."""
    goal = {"position": [1.125, 0.0], "height": 0.12, "radius": 0.1}
    return scenario("near_up", goal, [flight(4, 0.03, 0.12, 0.33, 0.33)], vary=dict(_NEAR_EDGE))


def low_near() -> Part:
    """Starts 15 to 30 cm before two to five low steps, 15 to 20 mm, the camera crooked."""
    vary = {
        **_NEAR_EDGE,
        "course.stairs.steps": {"choice": [2, 3, 4, 5]},
        "course.stairs.rise": between(0.015, 0.020),
        "course.stairs.tread": between(0.105, 0.20),
        "course.stairs.width": between(0.33, 0.9),
        "course.stairs.texture": between(0.8, 1.0),
        "physics.mass_scale": between(0.97, 1.03),
        "sensors.latency": {"choice": [0.0, 0.0, 0.02, 0.04]},
        "sensors.camera_roll_pitch_error": between(0.0, 0.12),
    }
    goal = {"position": [1.8, 0.0], "radius": 0.2}
    return scenario("low_near", goal, [flight(3, 0.03, 0.14, 0.5, 1.7)], vary=vary)


def low_down_near() -> Part:
    """Starts 14 to 26 cm behind the top edge of four steps of 15 to 20 mm, and goes down."""
    return _down("low_down_near", 0.017, {"course.stairs.rise": between(0.015, 0.020)})


def _down(name: str, rise: float, vary: Part) -> Part:
    course = [flight(4, rise, 0.13, 0.5, 0.5)]
    goal = {"position": [-0.1, 0.0]}
    return scenario(name, goal, course, start=dict(_UP_THERE), vary={**_BEHIND_EDGE, **vary})


def ramp_edge() -> Part:
    """A bevel, 20 mm over 10 cm, leads to a floor 20 mm high, across a corridor."""
    course = [
        *corridor(2.4),
        ramp("up", (0.9, 0.0), 0.1, 0.9, 0.02),
        platform("floor", (1.7, 0.0), (1.4, 0.9, 0.02)),
    ]
    return scenario("ramp_edge", {"position": [1.9, 0.0]}, course)


def door_sill_ramps() -> Part:
    """A door's sill: 20 mm up over 10 cm, 6 cm flat, the same down."""
    course = [
        *corridor(2.4),
        ramp("up", (0.9, 0.0), 0.1, 0.9, 0.02),
        platform("flat", (1.03, 0.0), (0.06, 0.9, 0.02)),
        ramp("down", (1.16, 0.0), 0.1, 0.9, 0.02, yaw=3.141592653589793),
    ]
    return scenario("door_sill_ramps", {"position": [1.9, 0.0]}, course)


def ramp_corridor() -> Part:
    """A cluttered corridor with a ramp up to a floor and an edge down again; a trolley crosses."""
    course = [
        *corridor(4.2, 1.65, closed=False),
        ramp("ramp", (1.0, 0.0), 0.9, 1.6, 0.04),
        platform("floor", (2.3, 0.0), (0.8, 1.6, 0.04)),
        box("chest", (0.6, 0.5), (0.2, 0.3, 0.3)),
        {
            "kind": "cylinder",
            "name": "pillar",
            "position": [3.05, 0.2],
            "radius": 0.08,
            "height": 0.7,
        },
        box("trolley", (3.4, 0.6), (0.25, 0.2, 0.4)),
    ]
    crossing = {
        "near": [2.5, 0.0],
        "within": 0.4,
        "do": "move",
        "name": "trolley",
        "to": [3.4, -0.5],
        "speed": 0.1,
    }
    vary = {
        "start.yaw": spread(0.6),
        "start.position.1": spread(0.3),
        "course.ramp.rise": between(0.02, 0.07),
        "course.floor.size.2": between(0.02, 0.07),
        "course.chest.position.1": spread(0.6),
        "course.pillar.position.1": spread(0.5),
    }
    goal = {"position": [3.6, 0.0], "radius": 0.2}
    made = scenario("ramp_corridor", goal, course, vary=vary, event=[crossing])
    return {**made, "time_limit": 240.0}


def cable_open() -> Part:
    """A cable, 15 mm high and 1 m long, on an open floor."""
    return scenario("cable_open", {"position": [1.9, 0.0]}, [cable(1.0, 1.0)])


def cable_across() -> Part:
    """A cable, 15 mm high, across a corridor."""
    return scenario("cable_across", {"position": [1.8, 0.0]}, [*corridor(2.2), cable(1.0, 0.9)])


def start_by_wall() -> Part:
    """The start is 15 cm from a wall that leads along."""
    along = [wall("wall", (-0.5, 0.19), (1.5, 0.19), 0.6)]
    return scenario(
        "start_by_wall", {"position": [1.8, 0.0]}, along, vary={"start.yaw": spread(0.1)}
    )


def handrails() -> Part:
    """Stairs 60 cm wide with thin posts and a rail at each side."""
    course = [flight(4, 0.03, 0.12, 0.6, 0.6)]
    for name, y in (("left", 0.285), ("right", -0.285)):
        course += [
            box(f"{name} post {i}", (x, y), (0.02, 0.02, 0.5))
            for i, x in enumerate((0.62, 0.98, 1.5))
        ]
        course.append(box(f"{name} rail", (1.06, y), (0.9, 0.025, 0.025), 0.42))
    return scenario("handrails", {"position": [1.3, 0.0], "height": 0.12}, course)


def narrow_corridor() -> Part:
    """A corridor 72 cm wide, straight on."""
    return scenario("narrow_corridor", {"position": [2.2, 0.0]}, corridor(2.8, 0.72, closed=False))


def dead_end() -> Part:
    """A dead end straight ahead, 2.4 m deep; the way is a side door behind the start."""
    lines = {
        "north": ((-1.5, 0.45), (2.4, 0.45)),
        "south": ((-0.9, -0.45), (2.4, -0.45)),
        "jamb": ((-1.5, -0.45), (-1.45, -0.45)),
        "east": ((2.4, -0.45), (2.4, 0.45)),
        "west": ((-1.5, -1.4), (-1.5, 0.45)),
    }
    walls = [wall(name, *line, 0.6) for name, line in lines.items()]
    return {**scenario("dead_end", {"position": [2.0, -1.0]}, walls), "time_limit": 300.0}


def grating() -> Part:
    """A floor of bars, 30 mm wide and high, 15 mm apart, across a corridor."""
    bars = [{**cable(0.785 + 0.045 * i, 0.9, 0.03), "name": f"bar {i}"} for i in range(14)]
    return scenario("grating", {"position": [1.95, 0.0]}, [*corridor(2.4), *bars])


def nosing() -> Part:
    """Treads whose noses stand out 20 mm over the risers."""
    return _boards("nosing")


def open_risers() -> Part:
    """Treads of 12 mm boards without risers."""
    return _boards("open_risers")


def _boards(name: str) -> Part:
    built = {"kind": "mjcf", "name": "boards", "file": f"{name}.xml"}
    goal = {"position": [1.35, 0.0], "height": 0.12}
    return scenario(name, goal, [*corridor(1.6), built])


def _mjcf_of(slabs: Iterable[tuple[float, float, float, float]]) -> str:
    """Return an MJCF world of slabs 90 cm wide: from x to x and from z to z, m."""
    geoms = "".join(
        f'<geom name="slab {i}" type="box" pos="{(x0 + x1) / 2:.4f} 0 {(z0 + z1) / 2:.4f}" '
        f'size="{(x1 - x0) / 2:.4f} 0.45 {(z1 - z0) / 2:.4f}"/>'
        for i, (x0, x1, z0, z1) in enumerate(slabs)
    )
    return f"<mujoco><worldbody>{geoms}</worldbody></mujoco>\n"


_STEPS: Final = tuple(
    (0.6 + 0.12 * i, 1.6 if i == 3 else 0.72 + 0.12 * i, 0.03 * (i + 1)) for i in range(4)
)
"""Front edge, back edge and height of four steps, m."""

BOARDS: Final = {
    "nosing.xml": _mjcf_of(
        slab
        for front, back, top in _STEPS
        for slab in ((front - 0.02, back, top - 0.01, top), (front, back, 0.0, top - 0.01))
    ),
    "open_risers.xml": _mjcf_of((front, back, top - 0.012, top) for front, back, top in _STEPS),
}
"""Name of a file -> its text: what `nosing` and `open_risers` name."""
