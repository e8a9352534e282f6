"""Plays a recorded run through a server, and compares each of its answers with the recorded one.

    treadwell run open_floor --out run
    treadwell serve --robot qrio --socket core.sock &
    python examples/serve_replay.py run core.sock

The second argument is the server's socket file, or its port (`--tcp`). The answers are the same
bit for bit, if the server has the parts and parameters of the run and runs on the same processor.
"""

import json
import sys
from pathlib import Path

from treadwell.errors import InputError
from treadwell.recording.log_file import read_front
from treadwell.recording.messages import encode_command, encode_estimate
from treadwell.recording.observation_log import header_of, read_answers, read_observations
from treadwell.replaying.difference import between_answers
from treadwell.serving.client import Client


def play(run: Path, server: str) -> str:
    """Return what the comparison says."""
    log = run / "observations.mcap"
    front = read_front(log)
    header = header_of(front, log)
    told = json.loads(front.attachments["core.json"])["settings"]
    *via, goal = told["goals"]
    with Client(
        int(server) if server.isdigit() else Path(server),
        robot=header["robot"],
        goal={**goal, "via": [each["position"] for each in via]},
        start=told["start"] or {"known": False},
        navigation=told["navigation"],
        static_map=front.attachments.get("static_map.ot"),
    ) as core:
        ticks = 0
        for observation, recorded in zip(read_observations(log), read_answers(log), strict=False):
            now, a = observation.time_ns, core.tick(observation)
            answer = (
                encode_command(now, a.position, a.velocity, a.torque),
                encode_estimate(now, a.estimate, a.odometry, a.state, a.outcome, a.reason),
            )
            what = between_answers(answer, recorded, core.robot["joints"])
            if what is not None:
                raise SystemExit(f"first difference at tick {ticks} ({1e-9 * now:.2f} s): {what}")
            ticks += 1
    return f"the same in all {ticks} ticks, bit for bit"


if __name__ == "__main__":
    try:
        print(play(Path(sys.argv[1]), sys.argv[2]))
    except (InputError, IndexError) as error:
        raise SystemExit(f"error: {error}") from None
