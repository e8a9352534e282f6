"""What a course will consist of: every element with its name, geometry and part in the events."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from treadwell.course.assets import mesh_piece
from treadwell.course.outlines import Floats
from treadwell.course.pieces import Piece, Top, simple_pieces
from treadwell.course.scatter import scattered
from treadwell.course.stairs import stairs_pieces
from treadwell.errors import InputError
from treadwell.robot.load import Robot
from treadwell.scenario.elements import ElementTable, Mesh, Mjcf, Scatter, Stairs, Wall
from treadwell.scenario.events import Add, Move, Remove
from treadwell.scenario.model import Scenario
from treadwell.scenario.values import element_names

SPARE_WIDTH = 0.1
"""Metres beyond the robot's width of the path that scattered obstacles leave."""


@dataclass(frozen=True)
class PlannedElement:
    """An element before it is built.

    Attributes:
        name: unique.
        element: as in the scenario.
        pieces: its solids, world frame.
        tops: its walkable surfaces, world frame.
        origin: (3,) its reference point on the ground, world frame.
        movable: events add, remove or move it.
        present: it is there from the beginning.
        mjcf: the file of an MJCF world, whose pieces are known after building only.
        shape: vertices and faces of a mesh, world frame.
    """

    name: str
    element: ElementTable
    pieces: tuple[Piece, ...]
    tops: tuple[Top, ...]
    origin: Floats
    movable: bool = False
    present: bool = True
    mjcf: str | None = None
    shape: tuple[Floats, Any] | None = None


def all_elements(scenario: Scenario) -> list[tuple[str, ElementTable, int | None]]:
    """Return name, element and the index of the event that adds it (None: there from the start)."""
    listed: list[tuple[ElementTable, int | None]] = [(e, None) for e in scenario.course]
    listed += [(e.element, i) for i, e in enumerate(scenario.event) if isinstance(e, Add)]
    names = element_names([{"kind": getattr(e, "kind", ""), "name": e.name} for e, _ in listed])
    return [(name, e, i) for name, (e, i) in zip(names, listed, strict=True)]


def plan_elements(scenario: Scenario, robot: Robot) -> list[PlannedElement]:
    """Return every element of a scenario, scattered ones drawn.

    Raises:
        InputError: a mesh is broken, an event moves what cannot move, or no layout leaves a way.
    """
    moved = {
        e.name: f"event.{i}.name"
        for i, e in enumerate(scenario.event)
        if isinstance(e, Remove | Move)
    }
    where = str(scenario.path or scenario.name)
    plans: list[PlannedElement | tuple[str, Scatter]] = []
    for name, element, event in all_elements(scenario):
        if isinstance(element, Scatter | Mjcf) and name in moved:
            raise InputError(
                f"{where}: {moved[name]}: found {name!r}; must be an element of one "
                "body, neither scatter nor mjcf"
            )
        if isinstance(element, Scatter):
            plans.append((name, element))
            continue
        movable = event is not None or name in moved
        plans.append(_planned(scenario, name, element, movable=movable, present=event is None))
    there = [plan for plan in plans if isinstance(plan, PlannedElement) and plan.present]
    result: list[PlannedElement] = []
    for plan in plans:
        if isinstance(plan, PlannedElement):
            result.append(plan)
            continue
        name, scatter = plan
        stops = [scenario.start.position, *scenario.goal.via, scenario.goal.position]
        try:
            items = scattered(
                scatter,
                name,
                seed=scenario.seed,
                stops=[np.array(stop) for stop in stops],
                solid=[piece for p in there if not p.tops for piece in p.pieces],
                tops=[top.polygon[:, :2] for p in there for top in p.tops],
                passage=2 * robot.file.body.radius + SPARE_WIDTH,
            )
        except InputError as error:
            raise InputError(f"{where}: {error}") from None
        drawn = [
            _planned(scenario, str(item.name), item, movable=False, present=True) for item in items
        ]
        result += drawn
        there += drawn
    return result


def _planned(
    scenario: Scenario, name: str, element: ElementTable, *, movable: bool, present: bool
) -> PlannedElement:
    pieces: list[Piece] = []
    tops: list[Top] = []
    shape = mjcf = None
    if isinstance(element, Mjcf):
        mjcf = element.file
    elif isinstance(element, Mesh):
        what = f"{scenario.path or scenario.name}: course.{name}.file: {element.file}"
        piece, vertices, faces = mesh_piece(element, scenario.folder, what)
        pieces, shape = [piece], (vertices, faces)
    elif isinstance(element, Stairs):
        pieces, tops = stairs_pieces(element)
    else:
        pieces, tops = simple_pieces(element, name, scenario.seed)
    return PlannedElement(
        name, element, tuple(pieces), tuple(tops), origin_of(element), movable, present, mjcf, shape
    )


def origin_of(element: ElementTable) -> Floats:
    """Return an element's reference point on the ground, (3,): what `move` takes to a point."""
    if isinstance(element, Wall):
        middle = (np.array(element.from_) + np.array(element.to)) / 2
        return np.array([*middle, 0.0])
    position = getattr(element, "position", (0.0, 0.0))
    return np.array([position[0], position[1], 0.0])
