"""Learns what labels of groups are told by, of drawn houses, and writes what the crate has of it.

    python benches/learn_labels.py rust/classification/src/scene/learned.txt

The houses are of other seeds than those of tests and results (`experiments/indoor/labels.py`).
"""

import argparse
from pathlib import Path
from typing import Final

import numpy as np

from treadwell.experiments.indoor.labels import COLUMNS, examples
from treadwell.map_making.room_labels import NAMES, RoomLabels

ROBOTS: Final = ("nao", "qrio")
FIRST: Final = 100
"""Seed of the first house."""
LOOKS: Final = 8
"""Into each house, by each robot's camera."""


def main() -> None:
    """Learn, and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("path", type=Path, help="the file to write")
    parser.add_argument("--houses", type=int, default=120, help="how many, from seed 100 on")
    given = parser.parse_args()
    path: Path = given.path
    features, labels = [], []
    for robot in ROBOTS:
        rows, kinds = examples(range(FIRST, FIRST + given.houses), robot, LOOKS)
        features += rows
        labels += kinds
    counts = np.bincount(labels, minlength=len(NAMES)).tolist()
    print(", ".join(f"{name}: {count}" for name, count in zip(NAMES, counts, strict=True)))
    path.write_text(RoomLabels(COLUMNS, examples=(np.array(features), labels)).core.learned)


if __name__ == "__main__":
    main()
