"""What a foot met is known: the way goes around it, or is refused with what and where."""

import re
from pathlib import Path

import pytest

from treadwell.runner import run

CABLE = """
schema = 1
name = "cable_unseen"
robot = "qrio"
time_limit = 150.0
[start]
position = [0.0, 0.03]
yaw = 0.1
[goal]
position = [1.9, 0.0]
radius = 0.15
"""

SILL = """
[[course]]
kind = "sill"
name = "cable"
position = [1.0, 0.0]
yaw = 0.0
rise = 0.015
depth = 0.015
width = {width}
"""

WALL = """
[[course]]
kind = "wall"
from = [{a[0]}, {a[1]}]
to = [{b[0]}, {b[1]}]
height = 0.6
"""


def outcome(folder: Path, text: str) -> tuple[str, str | None, object]:
    """Runs a scenario: the outcome, the reason and the falls."""
    path = folder / "cable.toml"
    path.write_text(text)
    result = run(str(path), seed=0, record=False, out=folder / "run").result
    return result.outcome, result.reason, result.falls


@pytest.mark.scenario
def test_a_cable_on_an_open_floor_is_walked_around_after_a_foot_met_it(tmp_path: Path) -> None:
    assert outcome(tmp_path, CABLE + SILL.format(width=1.0)) == ("goal_reached", None, 0)


@pytest.mark.scenario
def test_a_cable_across_a_corridor_is_refused_with_where_a_foot_met_it(tmp_path: Path) -> None:
    corners = [(-0.6, 0.475), (2.2, 0.475), (2.2, -0.475), (-0.6, -0.475)]
    pairs = zip(corners, corners[1:] + corners[:1], strict=True)
    walls = "".join(WALL.format(a=a, b=b) for a, b in pairs)
    told, reason, falls = outcome(tmp_path, CABLE + SILL.format(width=0.95) + walls)
    assert (told, falls) == ("refused", 0)
    met = re.match(r"blocked: a foot met something at \(([\d.]+), (-?[\d.]+)\)", reason or "")
    assert met is not None, reason
    assert abs(float(met[1]) - 1.0) < 0.05, reason
