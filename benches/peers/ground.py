"""Ground filters on airborne laser clouds with the true ground: the core's and the cloth's.

    TREADWELL_DATA=FOLDER python benches/peers/ground.py [--samples samp11 ...]

The core's is run with its defaults. The cloth (Zhang et al. 2016; `pip install
cloth-simulation-filter`) is run with its own defaults and with those that its authors give for
flat ground. Published of SMRF with parameters tuned for each of the 15 samples: 2.97 % of total
error in the mean (Pingel, Clarke and McBride 2013).
"""

import argparse
import os
import sys
from pathlib import Path
from time import process_time

import CSF
import numpy as np
from numpy.typing import NDArray

sys.path.append(str(Path(__file__).resolve().parents[1]))
from isprs_clouds import errors, sample, samples

from treadwell._core import ground_points

CLOTHS: dict[str, dict[str, float]] = {
    "cloth, its defaults": {},
    "cloth, 0.5 m, rigid 2": {"rigidness": 2, "cloth_resolution": 0.5, "bSloopSmooth": 1},
}


def by_cloth(points: NDArray[np.float64], settings: dict[str, float]) -> NDArray[np.bool_]:
    """Return which points the cloth simulation takes for ground."""
    filter_ = CSF.CSF()
    for name, value in settings.items():
        kind = type(getattr(filter_.params, name))
        setattr(filter_.params, name, kind(value))
    filter_.setPointCloud(points - points.mean(axis=0))
    ground, rest = CSF.VecInt(), CSF.VecInt()
    filter_.do_filtering(ground, rest, False)
    found = np.zeros(len(points), bool)
    found[np.array(ground, dtype=np.int64)] = True
    return found


def main() -> None:
    """Print a line for each sample and filter."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--samples", nargs="*", help="names; all that are there")
    chosen = parser.parse_args().samples
    data = Path(os.environ["TREADWELL_DATA"])
    for name in chosen or samples(data):
        points, truth = sample(data, name)
        filters = {"core, its defaults": ground_points}
        filters |= {
            cloth: lambda points, settings=settings: by_cloth(points, settings)
            for cloth, settings in CLOTHS.items()
        }
        for filter_name, apply in filters.items():
            started = process_time()
            found = apply(points)
            seconds = process_time() - started
            wrong = errors(truth, found)
            line = ", ".join(f"{what} {value:.2f} %" for what, value in wrong.items())
            print(f"{name} {filter_name}: {line}; {seconds:.2f} s")


if __name__ == "__main__":
    main()
