"""Claims about the maps and the guesses in a recording."""

from pathlib import Path

import numpy as np
from episode_builders import entities
from hypothesis import given
from hypothesis import strategies as st

from treadwell.episode import Episode
from treadwell.recording.file import NAME
from treadwell.recording.recorder import Recorder
from treadwell.recording.tracing import trace_of
from treadwell.recording.volumes import bars


def test_both_maps_and_the_guesses_of_a_robot_in_a_known_house_are_recorded(tmp_path: Path) -> None:
    episode = Episode("two_levels", seed=0, overrides=("navigation.world_model=octree",))
    assert episode.static_map is not None
    writer = Recorder(
        tmp_path / NAME,
        episode.course.model,
        episode.course,
        episode.scenario,
        episode.robot,
        episode.static_map,
    )
    guesses = 0
    for step in episode:
        made = trace_of(episode, step)
        assert np.isfinite(made.guesses).all()
        assert np.isfinite(made.occupied).all()
        guesses = len(made.guesses)
        writer.frame(made)
        if len(made.occupied):
            break
    writer.close()
    assert guesses == 500
    # What was seen is where something stands: not far above the walls, not below the floor.
    assert len(made.occupied)
    assert -0.2 < made.occupied[:, 2].min() <= made.occupied[:, 2].max() < 0.8
    maps = {f"/world/maps/{name}" for name in ("static", "local", "guesses")}
    assert maps <= entities(tmp_path / NAME)


@given(st.sets(st.tuples(*[st.integers(-6, 6)] * 3), max_size=60))
def test_bars_fill_the_space_of_their_voxels_and_no_other(
    voxels: set[tuple[int, int, int]],
) -> None:
    side = 0.04
    centres = (np.array(sorted(voxels)).reshape(-1, 3) + 0.5) * side
    middles, halves = bars(centres, np.full(len(centres), side))
    assert len(middles) <= len(centres)
    counts = np.rint(2 * halves / side).astype(int)
    lowest = np.rint((middles - halves) / side).astype(int)
    filled = [
        tuple(low + step)
        for low, count in zip(lowest, counts, strict=True)
        for step in np.ndindex(*count)
    ]
    assert len(filled) == len(set(filled))
    assert set(filled) == voxels


def test_a_wall_a_voxel_thick_is_a_bar_in_each_layer() -> None:
    row = np.array([[0.02 + 0.04 * i, 0.02, 0.02 + 0.04 * k] for i in range(50) for k in range(3)])
    assert len(bars(row, np.full(150, 0.04))[0]) == 3
    # Across the other axis, too; and what is of another size stays apart.
    middles, _ = bars(row[:, [1, 0, 2]], np.r_[np.full(149, 0.04), 0.08])
    assert len(middles) == 4
