"""The verb `check`: what a scenario would build, without running it."""

from collections.abc import Mapping, Sequence
from typing import Any

from treadwell.cli.output import write_notes, write_table
from treadwell.course.build import build_course
from treadwell.course.course import Course
from treadwell.plugins import ForeignPart, examined, foreign_parts, stand_in
from treadwell.robot.load import load_robot
from treadwell.scenario.event_table import EventTable
from treadwell.scenario.loading import load_scenario
from treadwell.scenario.model import Scenario
from treadwell.scenario.scaling import to_robot
from treadwell.scenario.unread import unread, unread_tables


def checked(
    name_or_path: str, *, robot: str | None, seed: int | None, settings: Sequence[str]
) -> dict[str, Any]:
    """Return what a scenario would build, as plain data.

    Args:
        name_or_path: a file or a name.
        robot: instead of the file's.
        seed: instead of the file's.
        settings: `KEY=VALUE` each.

    Raises:
        InputError: something about it is bad.
    """
    scenario = load_scenario(name_or_path, robot=robot, seed=seed, overrides=settings)
    body = load_robot(scenario.robot)
    scenario = to_robot(scenario, body)
    course = build_course(scenario, body)
    parts = foreign_parts(scenario.navigation.slots())
    files = examined(parts, str(scenario.path))
    _check_components(scenario, parts)
    return {
        "scenario": scenario.name,
        "description": scenario.description,
        "file": str(scenario.path),
        "robot": body.name,
        "seed": scenario.seed,
        "start": {
            "position": list(course.start.position),
            "height": course.start.height,
            "yaw": course.start.yaw,
        },
        "goal": {
            "position": list(scenario.goal.position),
            "height": course.goal_height,
            "radius": scenario.goal.radius,
        },
        "elements": _elements(course),
        "events": [_event(event) for event in course.events],
        "navigation": scenario.navigation.slots(),
        "unread": [*unread(scenario).values(), *unread_tables(scenario)],
        "python": [
            {"slot": p.slot, "name": p.name, "class": p.target, "file": str(file or "")}
            for p, file in files.items()
        ],
        "expect": scenario.expect.model_dump(mode="json"),
        "configuration": scenario.configuration(),
    }


def show(document: Mapping[str, Any]) -> None:
    """Write what `checked` returned as tables."""
    start, goal = document["start"], document["goal"]
    rows = [
        ("file", document["file"]),
        ("robot", document["robot"]),
        ("seed", document["seed"]),
        (
            "start",
            f"{_point(start['position'])}, height {start['height']:.3f} m, "
            f"yaw {start['yaw']:.3f} rad",
        ),
        (
            "goal",
            f"{_point(goal['position'])}, height {goal['height']:.3f} m, "
            f"radius {goal['radius']:.2f} m",
        ),
        (
            "navigation",
            ", ".join(f"{slot} {name}" for slot, name in document["navigation"].items()),
        ),
        *(
            ("python", f"{entry['slot']} {entry['class']} {entry['file']}: named, not loaded")
            for entry in document["python"]
        ),
        (
            "expects",
            ", ".join(
                f"{key} {value}" for key, value in document["expect"].items() if value is not None
            ),
        ),
    ]
    title = f"{document['scenario']}: {document['description']}".rstrip(": ")
    write_table(title, ("", ""), rows)
    write_notes(document["unread"])
    if document["elements"]:
        lines = [
            (
                e["name"],
                e["kind"],
                _point(e["position"]),
                ", ".join(f"{t['part']} {1e3 * t['height']:.0f} mm" for t in e["tops"])
                or ("gives way" if e["kind"] == "vegetation" else "obstacle"),
                "" if e["present"] else "not there at first",
            )
            for e in document["elements"]
        ]
        write_table("course", ("name", "kind", "at", "tops", ""), lines)
    if document["events"]:
        write_table(
            "events", ("when", "what"), [(e["when"], e["what"]) for e in document["events"]]
        )


def _check_components(scenario: Scenario, parts: Sequence[ForeignPart]) -> None:
    """Let the core read the components' parameters: what they may be, only it knows.

    In the place of parts in Python stands something that does nothing: none of them is loaded.

    Raises:
        InputError: with the file and the key that the core refuses.
    """
    from treadwell.episode import Episode

    given: dict[str, Any] = {part.slot: stand_in(part.slot) for part in parts}
    Episode(scenario, user_code=False, **given)


def _elements(course: Course) -> list[dict[str, Any]]:
    return [
        {
            "name": element.name,
            "kind": element.kind,
            "position": element.origin[:2].tolist(),
            "pieces": len(element.pieces),
            "tops": [{"part": top.part, "height": round(top.height, 6)} for top in element.tops],
            "movable": element.mocap_id is not None,
            "present": element.present,
        }
        for element in course.elements
    ]


def _event(event: EventTable) -> dict[str, Any]:
    table = event.model_dump(mode="json", by_alias=True, exclude_none=True)
    do = table.pop("do")
    if event.near is None:
        when = f"at {table.pop('at')} s"
    else:
        when = f"within {table.pop('within')} m of {_point(table.pop('near'))}"
    if "element" in table:
        element = table["element"]
        what = f"{do} {element['kind']} {element.get('name', '')}".rstrip()
    else:
        what = f"{do} " + ", ".join(f"{key} {value}" for key, value in table.items())
    return {"when": when, "what": what, "do": do, **table}


def _point(position: Sequence[float]) -> str:
    return "[" + ", ".join(f"{value:.2f}" for value in position) + "]"
