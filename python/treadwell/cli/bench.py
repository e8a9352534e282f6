"""The verb `bench`: times of the core on a fixed workload, and of an episode."""

from collections.abc import Mapping, Sequence
from typing import Any, Final

from treadwell.cli.output import write_message, write_table
from treadwell.errors import InputError
from treadwell.timing.benches import BENCHES
from treadwell.timing.episode import episode
from treadwell.timing.room import workloads

_COUNT: Final = 40
_EPISODE: Final = "episode"


def bench(names: Sequence[str], frames: str | None) -> dict[str, Any]:
    """Run benches and return what they found, as plain data.

    Args:
        names: which; all where there is none.
        frames: a file of depth frames, or how many to make of the room.

    Raises:
        InputError: there is no such bench or file.
    """
    known = (*BENCHES, _EPISODE)
    for name in names:
        if name not in known:
            raise InputError(f"there is no bench {name!r}; there are {', '.join(known)}")
    chosen = [name for name in BENCHES if not names or name in names]
    rows = []
    for workload in workloads(str(_COUNT) if frames is None else frames) if chosen else []:
        for name in chosen:
            write_message(f"{name}: {workload.name} {workload.shape}")
            rows.append(BENCHES[name](workload))
    document: dict[str, Any] = {"schema": "treadwell.bench/1", "unit": "ms", "benches": rows}
    if not names or _EPISODE in names:
        write_message(_EPISODE)
        document[_EPISODE] = episode()
    return document


def show(document: Mapping[str, Any]) -> None:
    """Write what `bench` returned as tables."""
    if _EPISODE in document:
        _show_episode(document[_EPISODE])
    if not document["benches"]:
        return
    rows = []
    for row in document["benches"]:
        for mode, found in row["modes"].items():
            agrees = ", ".join(
                f"{value} {key}" if isinstance(value, int) else f"{key} {100 * value:.1f} %"
                for key, value in found["agreement"].items()
            )
            rows.append(
                (
                    row["bench"],
                    row["frames"],
                    mode,
                    f"{found['p50']:.3f}",
                    f"{found['p95']:.3f}",
                    f"{found['worst']:.3f}",
                    f"{100 * found['bindings_share']:.1f} %",
                    f"{found['ratio']:.1f}",
                    agrees,
                )
            )
    header = ("bench", "frames", "mode", "p50", "p95", "worst", "bindings", "faster", "agreement")
    write_table("the core, milliseconds a frame", header, rows)


def _show_episode(row: Mapping[str, Any]) -> None:
    header = ("episode", "a simulated second", "of the frozen physics", "ratio", "real time")
    cells = (
        f"{row['scenario']} {row['seed']}",
        f"{row['ms_a_simulated_second']:.1f} ms",
        f"{row['frozen_ms']:.1f} ms",
        f"{row['ratio']:.2f}",
        f"{row['times_real_time']:.1f} times",
    )
    title = "ten seconds of an episode, the processor's time without recording"
    write_table(title, header, [cells])
