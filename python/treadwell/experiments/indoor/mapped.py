"""Maps that `treadwell map` makes of recorded data, with their pictures (Figs 36.6 and 36.7)."""

import shutil
from pathlib import Path
from tempfile import TemporaryDirectory

from treadwell.map_making.making import make_map
from treadwell.map_making.plan_view import TOPOLOGY
from treadwell.map_making.request import LANDMARKS, read_request
from treadwell.map_result import MapResult
from treadwell.recording.map_file import PICTURE


def draw_topology(path: Path, source: Path) -> str:
    """Draw places, ways and rooms of a laser log's map; Fig. 36.6."""
    found = _mapped(path, source, TOPOLOGY).places
    if found is None:
        return "no places"
    meets = sum(place.ways > 2 for place in found.each)
    return (
        f"{found.count} places, {meets} of them where three ways or more meet, {len(found.ways)} "
        f"ways, rooms: {found.rooms}"
    )


def draw_landmarks(path: Path, source: Path) -> str:
    """Draw landmarks and the robot's way among them by FastSLAM; Fig. 36.7."""
    result = _mapped(path, source, LANDMARKS)
    count = 0 if result.landmarks is None else len(result.landmarks)
    error = result.landmark_error
    off = "" if error is None else f", off by {1e2 * error:.0f} cm after alignment, RMS"
    return f"{count} landmarks{off}"


def _mapped(path: Path, source: Path, model: str) -> MapResult:
    with TemporaryDirectory() as place:
        request = read_request(source, world_model=model)
        made = make_map(request, out=Path(place) / "map", record=False)
        shutil.copyfile(made.folder / PICTURE, path)
        return made.result
