"""The verb `robot check`: what a robot's folder holds, what it lacks, and what its gait can do."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from treadwell.cli.output import BAD_INPUT, FAILED, PASSED, write_json, write_message, write_table
from treadwell.errors import InputError


def check(
    folder: Path, *, walk: bool, template: bool, as_json: bool, model: str | None = None
) -> int:
    """Report on a folder, and return the exit status.

    Args:
        folder: the robot's; the name of one that ships with the package, where there is no such
            folder.
        walk: let it walk a metre, and then walk, turn, stop, be pushed and climb.
        template: write a draft of a `robot.toml` where there is none.
        as_json: write JSON instead of tables.
        model: the file of the folder of which the draft is to be; None: the one that is found.

    Raises:
        InputError: there is no such folder, no MJCF in it, or a `robot.toml` already.
    """
    if model is not None and not template:
        raise InputError(
            "--model: goes with --write-template; of a folder with a robot.toml, [robot] model = "
            "in it says which file is the robot"
        )
    from treadwell.data import data_folder, robot_names
    from treadwell.robot.report import report_on

    if not folder.is_dir() and str(folder) in robot_names():
        folder = data_folder("models") / folder
    if template:
        _draft(folder, model)
    document = report_on(folder)
    if document["fits"]:
        from treadwell.robot_trial import refused

        document["problems"] += refused(folder)
        document["fits"] = not document["problems"]
    if walk and document["fits"]:
        from treadwell.robot_trial import walk_a_metre
        from treadwell.trials.table import table

        write_message("walking a metre, with all senses ...")
        document["walk"] = walk_a_metre(folder)
        document["trials"] = table(folder, write_message)
    if as_json:
        write_json(document)
    else:
        _show(document)
    if document["problems"]:
        return BAD_INPUT
    return PASSED if document.get("walk", {"passed": True})["passed"] else FAILED


def _draft(folder: Path, model: str | None) -> None:
    """Write a draft, and say which models there are where nobody said of which it is to be."""
    from treadwell.robot.model_file import find_model, models_in
    from treadwell.robot.template import write_template

    there = models_in(folder) if model is None else []
    try:
        wrote = write_template(folder, model)
    except InputError as error:
        if len(there) < 2 or (folder / "robot.toml").exists():
            raise
        told = f"the folder has {', '.join(there)}; --model FILE says which of them to take"
        raise InputError(f"{error}\n{told}") from None
    write_message(f"wrote {wrote}: read it through, guesses are said as such")
    if len(there) > 1:
        taken = find_model(folder).name
        others = ", ".join(name for name in there if name != taken)
        write_message(f"note:     of {taken}; --model takes another: {others}")


def _show(document: Mapping[str, Any]) -> None:
    _show_body(document)
    _show_legs(document)
    if "motors" in document:
        _show_senses(document)
    if "gait" in document:
        _show_gait(document["gait"])
    if "walk" in document:
        walk = document["walk"]
        rows = [(key, _number(value)) for key, value in walk.items() if value is not None]
        write_table("a metre ahead", ("", ""), rows)
    if "trials" in document:
        _show_trials(document["trials"])
    for title, lines in (("notes", document["notes"]), ("problems", document["problems"])):
        if lines:
            write_table(title, ("",), [(line,) for line in lines])


def _show_body(document: Mapping[str, Any]) -> None:
    mass = document["mass"]
    heaviest = sorted(mass["links"], key=lambda link: -link["mass"])
    rows: list[Sequence[object]] = [
        ("model", document["model"]),
        ("mass", f"{mass['total']:.3f} kg in {len(heaviest)} links"),
        ("links", ", ".join(f"{link['name']} {link['mass']:.3f}" for link in heaviest)),
        ("cameras", ", ".join(document["cameras"]) or "none"),
        ("sites", ", ".join(document["sites"]) or "none"),
        ("keyframes", ", ".join(document["keyframes"]) or "none"),
    ]
    if document["without_range"]:
        rows.append(("without range", ", ".join(document["without_range"])))
    actuators = [f"{a['name']} ({a['kind']})" for a in document["actuators"]]
    rows.append(("actuators", f"{len(actuators)}: {', '.join(actuators)}"))
    verdict = "fits" if document["fits"] else "does not fit yet"
    write_table(f"{document['name']}: {verdict}", ("", ""), rows)


def _show_legs(document: Mapping[str, Any]) -> None:
    motors = {motor["joint"]: motor for motor in document.get("motors", [])}
    rows = []
    for side, leg in document["legs"].items():
        for joint in leg["joints"]:
            motor = motors.get(joint["name"])
            bounds = joint["range"]
            rows.append(
                (
                    joint["name"],
                    joint["role"],
                    side,
                    " ".join(f"{value:g}" for value in joint["axis"]),
                    "none" if bounds is None else f"{bounds[0]:.2f} to {bounds[1]:.2f} rad",
                    f"{motor['peak_torque']:g} N m, {motor['no_load_speed']:g} rad/s"
                    if motor
                    else "",
                )
            )
    write_table("legs, from the hip down", ("joint", "does", "leg", "axis", "range", "motor"), rows)
    soles = [
        (
            side,
            f"{1e3 * sole['length']:.0f} x {1e3 * sole['width']:.0f} mm",
            ", ".join(f"{1e3 * value:.1f}" for value in sole["position"]) + " mm",
            document["legs"][side]["foot"],
        )
        for side, sole in document["soles"].items()
    ]
    write_table("soles", ("", "size", "centre in the link", "link"), soles)
    for title, key in (
        ("no two legs to walk on", "leg_faults"),
        ("the legs are no mirror images", "unlike"),
    ):
        if document[key]:
            write_table(title, ("",), [(line,) for line in document[key]])


def _show_senses(document: Mapping[str, Any]) -> None:
    camera, imu, stand = document["camera"], document["imu"], document["stand"]
    across, along = camera["fields_of_view"]
    rows = [
        (
            "camera",
            f"{camera['name']} on {camera['link']}: {camera['sensor']}, "
            f"{camera['size'][0]} x {camera['size'][1]}, {across:.2f} x {along:.2f} rad, "
            f"every {camera['period']:g} s",
        ),
        (
            "its place",
            f"{1e3 * camera['height']:.0f} mm high, {1e3 * camera['ahead']:.0f} mm ahead, "
            f"{camera['down']:.2f} rad down in the stance",
        ),
        ("inertial unit", f"{imu['site']} on {imu['link']}"),
        (
            "stance",
            f"centre of mass {1e3 * stand['height_of_mass']:.0f} mm high, "
            f"{1e3 * stand['mass_ahead_of_soles']:.1f} mm ahead of the soles' middle",
        ),
    ]
    write_table("senses and stance", ("", ""), rows)


def _show_gait(gait: Mapping[str, Any]) -> None:
    lengths = ", ".join(
        f"{word} {1e3 * gait[key]:.0f} mm"
        for word, key in (
            ("thigh", "thigh"),
            ("shank", "shank"),
            ("ankle over sole", "ankle_height"),
            ("hips apart", "hips_apart"),
            ("hips high", "hip_height"),
        )
    )
    open_turn = gait["left_open"]
    solved = gait["solved_by"] + (
        f"; five joints leave the sole's {open_turn} free" if open_turn else ""
    )
    rows: list[Sequence[object]] = [
        ("legs", lengths, f"{gait['scale']:g} times as long as qrio's"),
        ("inverse kinematics", solved, ""),
    ]
    for word, key, unit in (
        ("longest step", "step", "mm"),
        ("widest side step", "sideways", "mm"),
        ("largest turn", "turn", "rad"),
    ):
        asked, reached = gait[key]["asked"], gait[key]["reached"]
        if unit == "mm":
            asked, reached = f"{1e3 * asked:.0f} mm", f"{1e3 * reached:.0f} mm"
        else:
            asked, reached = f"{asked:.2f} rad", f"{reached:.2f} rad"
        rows.append((word, f"{asked} by [gait]", f"{reached} by the legs"))
    for word, key in (("highest step up", "up"), ("highest step down", "down")):
        found = gait[key]
        ends = found["ends"]
        can = f"none by statics: {ends}; `--walk` tries what it can in motion"
        if found["steps"]:
            last = found["steps"][-1]
            can = (
                f"{1e3 * found['highest']:.0f} mm by legs and motors: "
                f"knee {last['knee_torque']:.1f} N m, {last['joint']} at "
                f"{100 * last['share']:.0f} % of its peak"
            ) + (f"; beyond, {ends}" if ends else "")
        rows.append(
            (
                word,
                f"{1e3 * found['asked']:.0f} mm by [gait]",
                can,
            )
        )
    rows.append(("speed", f"{gait['speed']:.2f} m/s", ""))
    write_table(
        f"what the gait can do (statics on treads of {1e3 * gait['tread']:.0f} mm: "
        "nothing moves or touches)",
        ("", "", ""),
        rows,
    )


def _show_trials(rows: Sequence[Mapping[str, Any]]) -> None:
    shown = [(row["task"], row["result"], row["why"] or "") for row in rows]
    title = "what it does, by its walker alone: no camera, no map"
    write_table(title, ("", "", "why no more"), shown)


def _number(value: object) -> str:
    return f"{value:.3f}" if isinstance(value, float) else str(value)
