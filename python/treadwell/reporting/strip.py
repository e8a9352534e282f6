"""Draws a run's pictures for `images.strip`, in a process of its own: JSON on standard output."""

import json
import sys
from pathlib import Path
from typing import Final

from PIL import Image

from treadwell.errors import InputError
from treadwell.film.film import scene_of, state_at
from treadwell.film.poses import TICK_S
from treadwell.reporting.data_uri import jpeg_uri

SIZE: Final = (320, 256)
"""Pixels of a picture."""
MOMENTS: Final = (0.0, 0.33, 0.67, 1.0)
"""Of the run, of which there are pictures."""


def shots(folder: Path) -> list[tuple[str, str]]:
    """Return data URI and caption of each picture.

    Raises:
        InputError: result or audit are missing or broken.
    """
    scene = scene_of(folder, SIZE)
    made = []
    for share in MOMENTS:
        row = round(share * (scene.poses.count - 1))
        time_s = (row + 1) * TICK_S
        caption = f"{time_s:.1f} s {state_at(scene.behaviour, time_s)}".rstrip()
        made.append((jpeg_uri(Image.fromarray(scene.picture(row))), caption))
    return made


def main() -> None:
    """Draw the run whose folder is the only argument."""
    try:
        document: dict[str, object] = {"shots": shots(Path(sys.argv[1]))}
    except InputError as error:
        document = {"error": str(error)}
    sys.stdout.write(json.dumps(document))


if __name__ == "__main__":
    main()
