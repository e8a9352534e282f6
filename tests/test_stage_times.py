"""Claims about the times of stages: none is lost, and one that did not run has none."""

import math

from treadwell.stage_times import StageTimes


def test_a_stage_has_a_time_for_each_tick_at_which_it_ran() -> None:
    times = StageTimes(("physics",), ("walk", "map"))
    for tick in range(5000):
        times.add("physics", 0.5)
        times.add_row([float(tick), 0.25 if tick % 8 == 0 else math.nan])
    found = times.seconds()
    assert list(found) == ["physics", "walk", "map"]
    assert list(found["physics"]) == [0.5] * 5000
    assert list(found["walk"]) == [float(tick) for tick in range(5000)]
    assert list(found["map"]) == [0.25] * 625


def test_times_are_told_amid_a_run_and_go_on() -> None:
    times = StageTimes((), ("walk",))
    times.add_row([1.0])
    assert list(times.seconds()["walk"]) == [1.0]
    times.add_row([2.0])
    assert list(times.seconds()["walk"]) == [1.0, 2.0]
