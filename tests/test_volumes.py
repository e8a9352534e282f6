"""Claims about the maps and the guesses in a recording."""

from pathlib import Path

import numpy as np
from episode_builders import entities

from treadwell.episode import Episode
from treadwell.recording.recorder import NAME, Recorder
from treadwell.recording.tracing import trace_of


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
