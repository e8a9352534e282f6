"""How well planes, components and labels fit drawn houses that nothing was learned of.

    python benches/room_labels.py --robot nao

The figures of docs/results/indoor_planning.md. Labels were learned by `learn_labels.py` of others.
"""

import argparse

import numpy as np

from treadwell.experiments.indoor.labels import recall_precision, score
from treadwell.map_making.room_labels import NAMES


def main() -> None:
    """Look, and tell."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--robot", default="nao", help="whose camera looks")
    parser.add_argument("--houses", type=int, default=20, help="how many, from seed 0 on")
    parser.add_argument("--looks", type=int, default=8, help="into each house")
    given = parser.parse_args()
    found = score(range(given.houses), given.robot, given.looks)
    regions = found.regions
    share = regions.correct / max(regions.true, 1)
    print(f"surfaces: {regions.correct} of {regions.true} found ({share:.1%}), {regions}")
    for what, confusion in (
        ("pixels", found.confusion),
        ("cubes, pictures alone", found.alone),
        ("cubes, smoothed", found.points),
    ):
        right = np.trace(confusion) / max(confusion.sum(), 1)
        print(f"{what}: {right:.2%} of {confusion.sum()} right")
        for name, recall, precision in zip(NAMES, *recall_precision(confusion), strict=True):
            print(f"    {name:10} recall {recall:.3f}, precision {precision:.3f}")
    before, after = found.isolated
    print(f"errors that stand alone: {before}, with neighbours {after}")


if __name__ == "__main__":
    main()
