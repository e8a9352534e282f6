"""The chapter's figures that are about rooms, walls, places and landmarks, each with our data."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from treadwell.experiments.experiment import Beside, Picture, Table
from treadwell.experiments.indoor.corridor import draw_corridor, draw_sonar
from treadwell.experiments.indoor.figure import ChapterFigure, DrawnFigure, FigureToDraw, drawn
from treadwell.experiments.indoor.labels import draw_groups
from treadwell.experiments.indoor.looks import draw_looks
from treadwell.experiments.indoor.mapped import draw_landmarks, draw_topology
from treadwell.experiments.indoor.people import draw_people
from treadwell.experiments.indoor.walls import draw_lines, draw_split_and_merge

_INTEL: Final = "laser2d/intel-lab.log.gz"

FIGURES: Final = (
    ChapterFigure(
        "36.1",
        "what an echo says of the cells before a sonar",
        "most on the axis near the range, less to the sides and the further off",
        draw_sonar,
    ),
    ChapterFigure(
        "36.2, 36.3",
        "a corridor by sonars: local maps, and the map that they join to",
        "18 scans of 24 beams",
        draw_corridor,
    ),
    ChapterFigure(
        "36.4",
        "split and merge",
        "split until every point is near its line",
        draw_split_and_merge,
    ),
    ChapterFigure(
        "36.5",
        "lines of a laser's points",
        "94 lines of 311,823 points",
        draw_lines,
        _INTEL,
    ),
    ChapterFigure(
        "36.6",
        "the generalized Voronoi graph of a building",
        "only the ways that the robot can go",
        draw_topology,
        _INTEL,
    ),
    ChapterFigure(
        "36.7",
        "landmarks and the robot's way",
        "rocks, by FastSLAM; no figure given",
        draw_landmarks,
        "landmarks_mrclam",
    ),
    ChapterFigure(
        "36.17",
        "looks of things, learned without naming any",
        "a compact representation by nonlinear dimension reduction; no figure given",
        draw_looks,
    ),
    ChapterFigure(
        "36.18, 36.19",
        "a room as planes and components, and what they are",
        "planes and vegetation beside the data, labels by a random field; no figure given",
        draw_groups,
    ),
    ChapterFigure(
        "36.20, 36.21",
        "people left out of what was seen",
        "points of people in the mesh before, none after; no figure given",
        draw_people,
    ),
)


def _to_draw(folder: Path) -> list[FigureToDraw]:
    names = (figure.number.replace(".", "_").replace(", ", "-") for figure in FIGURES)
    paths = (folder / f"figure_{name}.png" for name in names)
    return [FigureToDraw(figure, path) for figure, path in zip(FIGURES, paths, strict=True)]


def _told(done: DrawnFigure) -> str:
    return f"Fig. {done.figure.number}: {done.ours}"


def _tables(done: Sequence[DrawnFigure]) -> list[Table]:
    rows = [(one.figure.number, one.figure.shows, one.figure.chapter, one.ours) for one in done]
    return [Table("The chapter's figures", ("Fig.", "what", "chapter", "ours"), tuple(rows))]


def _pictures(done: Sequence[DrawnFigure]) -> list[Picture]:
    return [
        Picture(f"Fig. {one.figure.number}: {one.figure.shows}", one.path)
        for one in done
        if one.path is not None
    ]


BESIDE: Final = Beside(items=_to_draw, work=drawn, told=_told, tables=_tables, pictures=_pictures)
