"""What a course will consist of: every element with its name, geometry and part in the events."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from treadwell.course.assets import mesh_piece
from treadwell.course.course import Hinge
from treadwell.course.doors import LEAF, frame_pieces, hinge_of, leaf_piece
from treadwell.course.outlines import Floats
from treadwell.course.pieces import Piece, Top, simple_pieces
from treadwell.course.scatter import scattered
from treadwell.course.slabs import slab_pieces
from treadwell.course.stairs import stairs_pieces
from treadwell.course.terrain import terrain_pieces
from treadwell.course.vegetation import stems
from treadwell.course.worlds.drawing import Drawn
from treadwell.course.worlds.flights import drawn_flights
from treadwell.course.worlds.house import drawn_house
from treadwell.course.worlds.yard import drawn_yard
from treadwell.errors import InputError
from treadwell.robot.load import Robot
from treadwell.scenario.drawn_elements import Flights, House, Scatter, Yard
from treadwell.scenario.element_table import ElementTable
from treadwell.scenario.elements import ELEMENTS, MOVABLE, Door, Mesh, Mjcf, Stairs, Wall
from treadwell.scenario.events import Add, Event, Move, Remove, SetDoor
from treadwell.scenario.ground_elements import Slabs, Terrain, Vegetation
from treadwell.scenario.messages import nearest
from treadwell.scenario.model import Scenario
from treadwell.scenario.scaling import scaled_event
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
        hinge: what it turns about where it is the leaf of a door.
        stems: vertices and faces, world frame, of what is seen of it and gives way.
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
    hinge: Hinge | None = None
    stems: tuple[Floats, Any] | None = None

    def multiplied(self, factor: float) -> "PlannedElement":
        """Return the same element with all lengths multiplied; an MJCF world's when it is read."""
        if factor == 1.0:
            return self
        shape, stems = (
            None if mesh is None else (factor * mesh[0], mesh[1])
            for mesh in (self.shape, self.stems)
        )
        return replace(
            self,
            pieces=tuple(piece.multiplied(factor) for piece in self.pieces),
            tops=tuple(top.multiplied(factor) for top in self.tops),
            origin=factor * self.origin,
            shape=shape,
            stems=stems,
        )


@dataclass(frozen=True)
class Plan:
    """A course before it is built.

    Attributes:
        elements: in the order of the file, drawn ones in place, those of events last.
        events: the scenario's, then what drawn elements bring.
    """

    elements: list[PlannedElement]
    events: list[Event]


def all_elements(scenario: Scenario) -> list[tuple[str, ElementTable, int | None]]:
    """Return name, element and the index of the event that adds it (None: there from the start)."""
    listed: list[tuple[ElementTable, int | None]] = [(e, None) for e in scenario.course]
    listed += [(e.element, i) for i, e in enumerate(scenario.event) if isinstance(e, Add)]
    names = element_names([{"kind": getattr(e, "kind", ""), "name": e.name} for e, _ in listed])
    return [(name, e, i) for name, (e, i) in zip(names, listed, strict=True)]


def plan_course(scenario: Scenario, robot: Robot) -> Plan:
    """Return every element of a scenario, those that draw themselves drawn, and all events.

    All is drawn and laid out in the lengths in which the scenario is written, so that one seed
    draws the same for robots of all sizes, and is multiplied then where it was fitted to one.

    Raises:
        InputError: a mesh is broken, an event names what it cannot move, or no layout leaves a way.
    """
    fitted, scenario = scenario, scenario.written
    scale = fitted.scale
    elements = all_elements(scenario)
    check_names(scenario, elements)
    moved = _moved(scenario.event)
    fixed = [
        None
        if isinstance(element, Scatter | House | Yard | Flights)
        else _planned(scenario, name, element, moved, present=event is None)
        for name, element, event in elements
    ]
    there = [plan for plans in fixed if plans is not None for plan in plans if plan.present]
    result: list[PlannedElement] = []
    events: list[Event] = list(fitted.event)
    width = 2 * robot.file.body.radius / scale.length
    for (name, element, _), plans in zip(elements, fixed, strict=True):
        if plans is not None:
            result += plans
            continue
        drawn = _drawn(scenario, width, name, element, there)
        moved = _moved(drawn.events)
        made = [
            plan
            for item in drawn.elements
            for plan in _planned(scenario, str(item.name), item, moved, present=True)
        ]
        result += made
        there += made
        events += [scaled_event(event, scale) for event in drawn.events]
    return Plan([plan.multiplied(scale.length) for plan in result], events)


def _drawn(
    scenario: Scenario,
    width: float,
    name: str,
    element: ElementTable,
    there: Sequence[PlannedElement],
) -> Drawn:
    """Return what an element that draws itself consists of, for a robot of this width, m."""
    goal = scenario.goal
    stops = [np.array(stop) for stop in (scenario.start.position, *goal.via, goal.position)]
    try:
        if isinstance(element, House):
            return drawn_house(element, name, seed=scenario.seed, stops=stops, width=width)
        if isinstance(element, Yard):
            return drawn_yard(element, name, seed=scenario.seed, stops=stops, width=width)
        if isinstance(element, Flights):
            return drawn_flights(element, name, seed=scenario.seed, stops=stops)
        assert isinstance(element, Scatter)
        items = scattered(
            element,
            name,
            seed=scenario.seed,
            stops=stops,
            solid=[piece for p in there if not p.tops for piece in p.pieces],
            tops=[top.polygon[:, :2] for p in there for top in p.tops],
            passage=width + SPARE_WIDTH,
        )
    except InputError as error:
        raise InputError(f"{scenario.path or scenario.name}: {error}") from None
    return Drawn(list(items), [])


def _moved(events: Sequence[Event]) -> set[str]:
    """Return the names of the elements that events move, remove, open or shut."""
    return {e.name for e in events if isinstance(e, Remove | Move | SetDoor)}


def _planned(
    scenario: Scenario, name: str, element: ElementTable, moved: set[str], *, present: bool
) -> list[PlannedElement]:
    """Return an element with its geometry; of a door the frame, and the leaf behind it."""
    pieces: list[Piece] = []
    tops: list[Top] = []
    shape = mjcf = None
    movable = not present or name in moved
    origin = origin_of(element)
    if isinstance(element, Door):
        leaf = (leaf_piece(element),)
        hinge, at = Hinge(name, element.open), hinge_of(element)
        return [
            PlannedElement(name, element, tuple(frame_pieces(element)), (), origin),
            PlannedElement(name + LEAF, element, leaf, (), at, movable, hinge=hinge),
        ]
    if isinstance(element, Vegetation):
        seen = stems(element, name, scenario.seed)
        return [PlannedElement(name, element, (), (), origin, stems=seen)]
    if isinstance(element, Mjcf):
        mjcf = element.file
    elif isinstance(element, Mesh):
        what = f"{scenario.path or scenario.name}: course.{name}.file: {element.file}"
        piece, vertices, faces = mesh_piece(element, scenario.folder, what)
        pieces, shape = [piece], (vertices, faces)
    elif isinstance(element, Terrain):
        pieces, tops = terrain_pieces(element, name, scenario.seed, scenario.folder)
    elif isinstance(element, Slabs):
        pieces, tops = slab_pieces(element, name, scenario.seed)
    elif isinstance(element, Stairs):
        pieces, tops = stairs_pieces(element)
    else:
        pieces, tops = simple_pieces(element, name, scenario.seed)
    return [
        PlannedElement(
            name, element, tuple(pieces), tuple(tops), origin, movable, present, mjcf, shape
        )
    ]


def check_names(scenario: Scenario, elements: Sequence[tuple[str, ElementTable, Any]]) -> None:
    """Refuse events that name what they cannot move, or no door.

    Raises:
        InputError: with the event's key.
    """
    kinds = {name: str(getattr(element, "kind", "")) for name, element, _ in elements}
    doors = [name for name, kind in kinds.items() if kind == "door"]
    for i, event in enumerate(scenario.event):
        where = f"{scenario.path or scenario.name}: event.{i}.name: found"
        if isinstance(event, SetDoor) and event.name not in doors:
            listed = ", ".join(doors) or "there is none"
            raise InputError(
                f"{where} {event.name!r}; must be a door of the course: {listed}"
                f"{nearest(event.name, doors)}"
            )
        if isinstance(event, Remove | Move) and kinds.get(event.name, "box") not in MOVABLE:
            *others, last = (kind for kind in ELEMENTS if kind not in MOVABLE)
            raise InputError(
                f"{where} {event.name!r}; must be an element of one body, neither "
                f"{', '.join(others)} nor {last}"
            )


def origin_of(element: ElementTable) -> Floats:
    """Return an element's reference point on the ground, (3,): what `move` takes to a point."""
    if isinstance(element, Wall):
        middle = (np.array(element.from_) + np.array(element.to)) / 2
        return np.array([*middle, 0.0])
    position = getattr(element, "position", (0.0, 0.0))
    return np.array([position[0], position[1], 0.0])
