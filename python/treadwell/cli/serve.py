"""The verb `serve`: the core for a robot elsewhere, over a socket."""

import math
from pathlib import Path
from typing import Annotated, Final

import typer

from treadwell.cli.options import JsonOption
from treadwell.cli.output import (
    BAD_INPUT,
    ERROR,
    INTERRUPTED,
    PASSED,
    announce,
    write_json,
    write_message,
)
from treadwell.errors import InputError

EXAMPLE: Final = "Example: treadwell serve --robot qrio --socket core.sock --timeout 5"
_MOST_PORTS: Final = 65535


def serve(
    *,
    robot: Annotated[
        str, typer.Option("--robot", metavar="NAME", help="A robot's name or folder.")
    ],
    socket: Annotated[
        Path | None,
        typer.Option(
            "--socket", metavar="PATH", help="Where it listens; default: treadwell-NAME.sock."
        ),
    ] = None,
    tcp: Annotated[
        int | None,
        typer.Option(
            "--tcp",
            metavar="PORT",
            min=0,
            max=_MOST_PORTS,
            help="Listen on this port of 127.0.0.1 instead; 0: on any that is free.",
        ),
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="KEY=VALUE",
            help="Of navigation, whatever a client says: navigation.planner=... Repeatable.",
        ),
    ] = None,
    timeout: Annotated[
        float | None,
        typer.Option(
            "--timeout",
            metavar="SECONDS",
            help="A client whose next message takes longer is let go; default: 10.",
        ),
    ] = None,
    once: Annotated[bool, typer.Option("--once", help="End after the first client.")] = False,
    as_json: JsonOption = False,
) -> int:
    """Be the core of a robot elsewhere: observations come over a socket, joint targets go back."""
    from treadwell.plugins import examined, foreign_parts
    from treadwell.serving.connection import shown_address
    from treadwell.serving.served import ServedRobot
    from treadwell.serving.server import TIMEOUT_S, attend_all, listening

    timeout_s = TIMEOUT_S if timeout is None else timeout
    if not 0.0 < timeout_s < math.inf:
        raise InputError(f"--timeout: found {timeout_s}; must be more than 0 s, and finite")
    if socket is not None and tcp is not None:
        raise InputError("--tcp: found beside --socket; a server listens at one of them")
    served = ServedRobot(robot, settings or ())
    announce(examined(foreign_parts(served.slots()), "settings"))
    served.check()
    file = socket or Path(f"treadwell-{served.robot.name}.sock")
    try:
        with listening(file if tcp is None else tcp) as (listener, address):
            where = shown_address(address)
            write_message(f"serving:   {served.robot.name} at {where}; Ctrl-C ends it")
            attended = attend_all(listener, served, timeout_s, write_message, once=once)
    except KeyboardInterrupt:  # the only end without --once
        write_message("treadwell: interrupted")
        if as_json:
            write_json({"error": "interrupted", "status": INTERRUPTED})
        return INTERRUPTED
    if as_json:
        write_json({"robot": served.robot.name, "client": attended.document()})
    if attended.error is None:
        return PASSED
    return BAD_INPUT if isinstance(attended.error, InputError) else ERROR
