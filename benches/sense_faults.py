"""Faults of senses and motors x scenarios x seeds: false successes, falls, what was named.

python benches/sense_faults.py --scenarios slalom stairs_up --seeds 0-1 --workers 2
"""

import argparse
import json
from concurrent.futures import ProcessPoolExecutor

from episodes import seeds

from treadwell.episode import Episode
from treadwell.errors import TreadwellError

FROM_START, ON_THE_WAY = 0.0, 10.0

FAULTS: dict[str, tuple[float, str]] = {
    "none": (ON_THE_WAY, ""),
    "depth nan for 5 s": (ON_THE_WAY, 'part="depth", kind="nan", duration=5.0'),
    "depth frozen for 5 s": (ON_THE_WAY, 'part="depth", kind="freeze", duration=5.0'),
    "depth frozen": (ON_THE_WAY, 'part="depth", kind="freeze"'),
    "depth nan": (ON_THE_WAY, 'part="depth", kind="nan"'),
    "30 % outliers": (ON_THE_WAY, 'part="depth", kind="outliers", value=0.3'),
    "depth x 1.05": (ON_THE_WAY, 'part="depth", kind="scale", value=1.05'),
    "half of the frames lost": (ON_THE_WAY, 'part="depth", kind="drop", value=0.5'),
    "camera 3 degrees down": (FROM_START, "pitch=0.0524"),
    "cell dead": (ON_THE_WAY, 'part="feet", kind="stick", foot="left", cell=0, value=0.0'),
    "cell at 60 N": (ON_THE_WAY, 'part="feet", kind="stick", foot="left", cell=0, value=60.0'),
    "cell at 60 N, start": (
        FROM_START,
        'part="feet", kind="stick", foot="left", cell=0, value=60.0',
    ),
    "left foot dead": (ON_THE_WAY, 'part="feet", kind="dead", foot="left"'),
    "left foot dead, start": (FROM_START, 'part="feet", kind="dead", foot="left"'),
    "gyro + 2 degrees/s": (ON_THE_WAY, 'part="imu", kind="bias", value=0.0349'),
    "gyro + 2 degrees/s, start": (FROM_START, 'part="imu", kind="bias", value=0.0349'),
    "imu axes swapped": (ON_THE_WAY, 'part="imu", kind="swap"'),
    "imu axes swapped, start": (FROM_START, 'part="imu", kind="swap"'),
    "imu zero": (ON_THE_WAY, 'part="imu", kind="zero"'),
    "imu zero, start": (FROM_START, 'part="imu", kind="zero"'),
    "encoder of a knee stuck": (
        ON_THE_WAY,
        'part="encoders", kind="stick", joint="left_knee_pitch"',
    ),
    "torque 60 %, start": (FROM_START, 'part="motors", kind="weak", value=0.6'),
    "knee 40 %, start": (
        FROM_START,
        'part="motors", kind="weak", value=0.4, joint="left_knee_pitch"',
    ),
    "motors 20 ms late": (ON_THE_WAY, 'part="latency", kind="motors", value=0.02'),
    "imu 50 ms late": (ON_THE_WAY, 'part="latency", kind="imu", value=0.05'),
}
"""Name -> from when on, seconds, and the rest of the event."""


def event(name: str) -> str:
    """Return the override that brings a fault about."""
    at, rest = FAULTS[name]
    do = "knock" if name.startswith("camera") else "fault"
    return f'event=[{{at={at}, do="{do}", {rest}}}]' if rest else "event=[]"


def play(job: tuple[str, str, int]) -> dict[str, object]:
    """Run one episode, and say how it went."""
    name, scenario, seed = job
    episode = Episode(scenario, seed=seed, overrides=(event(name),))
    stood, step = None, None
    try:
        while episode.verdict is None:
            step = episode.tick()
            if step.state == "refuse" and stood is None:
                stood = 1e-9 * step.time_ns
        outcome, reason = episode.verdict.outcome, episode.verdict.reason
    except TreadwellError as error:
        outcome, reason = "error", str(error)
    true, goal = episode.judge.frame, episode.scenario.goal
    away = ((true.x - goal.position[0]) ** 2 + (true.y - goal.position[1]) ** 2) ** 0.5
    declared = step.outcome if step else None
    return {
        "fault": name,
        "scenario": scenario,
        "seed": seed,
        "outcome": outcome,
        "reason": reason,
        "falls": episode.judge.falls,
        "gave_up_at": stood,
        "over_at": 1e-9 * episode.simulation.time_ns,
        "false_success": outcome != "goal_reached" and declared == "goal_reached",
        "away": round(away, 2),
    }


def main() -> None:
    """Print a line of JSON an episode, and the sums."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenarios", nargs="+", default=["slalom", "stairs_up"])
    parser.add_argument("--seeds", type=seeds, default=[0, 1])
    parser.add_argument("--faults", nargs="+", choices=FAULTS, default=list(FAULTS))
    parser.add_argument("--workers", type=int, default=1)
    options = parser.parse_args()
    jobs = [
        (fault, scenario, seed)
        for fault in options.faults
        for scenario in options.scenarios
        for seed in options.seeds
    ]
    rows = []
    with ProcessPoolExecutor(options.workers) as pool:
        for row in pool.map(play, jobs):
            rows.append(row)
            print(json.dumps(row), flush=True)
    named = sum(str(row["reason"]).startswith("sensor:") for row in rows)
    print(
        f"{len(rows)} episodes: {sum(bool(row['false_success']) for row in rows)} false successes, "
        f"{sum(bool(row['falls']) for row in rows)} with a fall, {named} refused with the sense"
    )


if __name__ == "__main__":
    main()
