"""Monte Carlo localization in maps that our octree built of a made room: errors and biases."""

import argparse
import json
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from made_rooms import (
    CENTRE,
    FOCAL,
    HEIGHT,
    WIDTH,
    Floats,
    Frame,
    carried,
    measured_map,
    odometry,
    sequence,
)
from numpy.typing import NDArray
from plain_field import PlainField

from treadwell.exports.octomap import filled
from treadwell.mapping import Camera, MonteCarlo

CAMERA = Camera(width=WIDTH, height=HEIGHT, fx=FOCAL, fy=FOCAL, cx=CENTRE[0], cy=CENTRE[1])
Step = Callable[[NDArray[np.float32], Floats], Floats]


def errors(frames: Sequence[Frame], steps: Sequence[Floats], update: Step) -> NDArray[np.float64]:
    """Return (n, 3): how far each pose is off, how far ahead along the view, m, and turned, rad."""
    rows = []
    for frame, step in zip(frames, steps, strict=True):
        pose = update(frame.depth, step)
        off = pose[:3, 3] - frame.pose[:3, 3]
        cosine = 0.5 * (np.trace(pose[:3, :3].T @ frame.pose[:3, :3]) - 1.0)
        ahead = off @ frame.pose[:3, 2]
        rows.append([np.linalg.norm(off), ahead, np.arccos(np.clip(cosine, -1.0, 1.0))])
    return np.array(rows)


def of_core(map_file: Path, start: Floats, seed: int, **overrides: object) -> Step:
    """Return the localizer's step."""
    where = MonteCarlo(map_file, CAMERA, start=start, seed=seed, overrides=overrides)
    return lambda depth, step: where.update(depth, step)[0]


def main() -> None:
    """Print one line of JSON for each way and size of voxels."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--frames", type=int, default=300)
    parser.add_argument("--resolution", type=float, nargs="+", default=[0.04, 0.02, 0.08])
    parser.add_argument("--turned", type=float, default=0.0, help="of the room in the map, rad")
    parser.add_argument("--ways", nargs="+", default=["ray_cast", "likelihood_field", "plain"])
    parser.add_argument("--surfaces", default="auto")
    chosen = parser.parse_args()
    data = []
    seeds = range(chosen.first_seed, chosen.first_seed + chosen.seeds)
    for seed in seeds:
        poses = carried(chosen.frames, seed, chosen.turned)
        data.append((sequence(chosen.frames, seed, chosen.turned), odometry(poses, seed)))
    for resolution in chosen.resolution:
        tree = measured_map(resolution, turned=chosen.turned)
        centres = filled(np.column_stack(tree.occupied()), resolution)
        with tempfile.TemporaryDirectory() as folder:
            map_file = Path(folder) / "room.bt"
            tree.write(str(map_file))
            for way in chosen.ways:
                found = []
                for seed, (frames, steps) in zip(seeds, data, strict=True):
                    start = frames[0].pose
                    if way == "plain":
                        update: Step = PlainField(centres, resolution, start, seed).update
                    else:
                        told = {"surfaces": chosen.surfaces}
                        update = of_core(map_file, start, seed, range_model=way, static_map=told)
                    found.append(errors(frames, steps, update))
                each = np.array([rows.mean(axis=0) for rows in found])
                print(
                    json.dumps(
                        {
                            "way": way,
                            "voxel_m": resolution,
                            "error_cm": round(100.0 * float(each[:, 0].mean()), 2),
                            "worst_seed_cm": round(100.0 * float(each[:, 0].max()), 2),
                            "ahead_cm": round(100.0 * float(each[:, 1].mean()), 2),
                            "turned_mrad": round(1000.0 * float(each[:, 2].mean()), 1),
                        }
                    ),
                    flush=True,
                )


if __name__ == "__main__":
    main()
