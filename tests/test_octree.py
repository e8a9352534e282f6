"""The octree from Python: points in, leaves and rays out, files as OctoMap's."""

import json
from pathlib import Path

import numpy as np
import pytest

from treadwell._core import OccupancyGrid, Octree
from treadwell.errors import InputError

EYE = (0.01, 0.02, 0.53)


def wall() -> np.ndarray:
    """Return points of a wall 1.03 m ahead, 0.4 m wide and high."""
    across, up = np.meshgrid(0.02 * np.arange(-9.5, 10), 0.02 * np.arange(16.5, 36))
    return np.stack([np.full(across.size, 1.03), across.ravel(), up.ravel()], axis=1)


def seen(*, each_point: bool = False) -> Octree:
    tree = Octree(0.04)
    tree.insert(wall(), EYE, each_point=each_point)
    return tree


def test_a_wall_is_occupied_and_the_way_to_it_free() -> None:
    tree = seen()
    centres, sides = tree.occupied()
    assert np.allclose(centres[:, 0], 1.02)
    assert np.all(sides == 0.04)
    assert len(centres) == 100
    free, _ = tree.free()
    assert free[:, 0].max() < 1.0
    values = tree.log_odds(np.array([[1.03, 0.01, 0.5], [0.5, 0.02, 0.53], [1.2, 0.0, 0.5]]))
    assert values[:2] == pytest.approx([0.8473, -0.4055], abs=1e-4)
    assert np.isnan(values[2])


def test_per_point_counts_every_beam() -> None:
    point = np.array([[1.03, 0.01, 0.5]])
    assert seen(each_point=True).log_odds(point)[0] > 3.0 > seen().log_odds(point)[0]


def test_what_is_too_far_clears_the_way() -> None:
    tree = Octree(0.04)
    tree.insert(np.array([[5.0, 0.02, 0.53], [np.nan, 0.0, 0.0]]), EYE, max_range=2.0)
    assert len(tree.occupied()[0]) == 0
    values = tree.log_odds(np.array([[1.9, 0.02, 0.53], [2.2, 0.02, 0.53]]))
    assert values[0] < 0.0
    assert np.isnan(values[1])


def test_rays_end_at_the_wall() -> None:
    origins = np.array([EYE, EYE, EYE])
    directions = np.array([[2.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    ends, ranges = seen().cast_rays(origins, directions)
    assert ends[0] == pytest.approx([1.02, 0.02, 0.54])
    assert ranges[0] == pytest.approx(np.linalg.norm(ends[0] - EYE))
    assert np.isnan(ends[1]).all()
    assert np.isnan(ranges[1])
    assert np.isnan(seen().cast_rays(origins, directions, 0.5)[1]).all()
    beside = np.array([[0.5, 1.0, 0.5]])
    through = np.array([[1.03 - 0.5, -1.0, 0.0]])
    assert np.isfinite(seen().cast_rays(beside, through)[1]).all()
    assert np.isnan(seen().cast_rays(beside, through, through_unknown=False)[1]).all()


@pytest.mark.parametrize("name", ["map.ot", "map.bt"])
def test_a_map_is_written_and_read(tmp_path: Path, name: str) -> None:
    tree, path = seen(), tmp_path / name
    tree.write(str(path))
    again = Octree.read(str(path))
    assert again.resolution == 0.04
    assert np.array_equal(again.occupied()[0], tree.occupied()[0])
    again.write(str(tmp_path / f"again_{name}"))
    assert (tmp_path / f"again_{name}").read_bytes() == path.read_bytes()


def test_bad_files_and_settings_are_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "broken.bt"
    path.write_bytes(b"# Octomap OcTree binary file\nid OcTree\nsize 9\nres 0.1\ndata\n\x01")
    with pytest.raises(InputError, match=r"broken\.bt: byte 59: the file ends within the tree"):
        Octree.read(str(path))
    with pytest.raises(InputError, match="missing"):
        Octree.read(str(tmp_path / "missing.bt"))
    with pytest.raises(InputError, match=r"\.bt or \.ot"):
        seen().write(str(tmp_path / "map.txt"))
    with pytest.raises(InputError, match=r"octree\.resolution must be > 0, got 0"):
        Octree(0.0)
    with pytest.raises(InputError, match=r"octree\.p_hit must be > 0\.5"):
        Octree(settings=json.dumps({"p_hit": 0.2}))
    with pytest.raises(InputError, match=r"points must be numbers \(n, 3\)"):
        Octree().insert(np.zeros((3, 2)), EYE)
    with pytest.raises(InputError, match="the eye must be finite"):
        Octree().insert(np.zeros((3, 3)), (np.nan, 0.0, 0.0))


FAR = np.array([500_000.0, 5_000_000.0, 100.0])


def test_what_lies_beyond_the_voxels_is_counted_and_refused_where_all_does() -> None:
    said = r"point 0 at \(50000\d.*, 4999999.81, .*\) m lies beyond .* from -1310.72 to 1310.72 m"
    tree = Octree(0.04)
    with pytest.raises(InputError, match=said):
        tree.insert(wall() + FAR, tuple(EYE + FAR))
    with pytest.raises(InputError, match=said):
        tree.occupy(wall() + FAR)
    assert tree.nodes == 0
    both = np.concatenate([wall(), wall()[:3] + FAR, [[np.nan, 0.0, 0.0]]])
    assert tree.insert(both, EYE) == 3
    assert tree.occupy(both) == 3
    assert tree.insert(wall(), EYE) == 0
    with pytest.raises(InputError, match=r"to 32768 m"):
        Octree(1.0).occupy(np.array([[1e5, 0.0, 0.0]]))


def test_a_grid_that_a_frame_misses_says_so_and_one_far_away_works() -> None:
    grid = OccupancyGrid((60, 60, 20), (-1.0, -1.0, 0.0))
    with pytest.raises(InputError, match=r"lies outside the grid, as all others and the eye"):
        grid.insert(wall() + FAR, tuple(EYE + FAR))
    assert grid.insert(np.concatenate([wall(), wall()[:2] + FAR]), EYE) == 2
    there = OccupancyGrid((60, 60, 20), tuple(FAR + np.array([-1.0, -1.0, 0.0])))
    assert there.insert(wall() + FAR, tuple(EYE + FAR)) == 0
    assert (there.probability() > 0.5).sum() > 10
