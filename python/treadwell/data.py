"""Where the folders that ship with the package (models, scenarios) are found."""

from pathlib import Path
from typing import Literal

from treadwell.errors import TreadwellError

PACKAGE = Path(__file__).resolve().parent


def scenario_names() -> list[str]:
    """Return the names of the scenarios that ship with the package, sorted."""
    return sorted(path.stem for path in data_folder("scenarios").glob("*.toml"))


def robot_names() -> list[str]:
    """Return the names of the robots that ship with the package, sorted."""
    return sorted(path.parent.name for path in data_folder("models").glob("*/robot.toml"))


def data_folder(kind: Literal["models", "scenarios"]) -> Path:
    """Return the folder that holds the robots or the scenarios.

    In a wheel it lies inside the package; in the source tree it stands at the top. The package is
    looked at first.

    Args:
        kind: which of the two.

    Raises:
        TreadwellError: the installation is incomplete, neither place has the folder.
    """
    places = (PACKAGE / kind, PACKAGE.parent.parent / kind)
    for place in places:
        if place.is_dir():
            return place
    looked = " and ".join(str(place) for place in places)
    raise TreadwellError(
        f"the folder {kind} is missing from this installation (looked at {looked})"
    )
