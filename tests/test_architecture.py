"""The house rules that one would else have to trust: order of floors, file length, tests."""

import re
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

import doc_comments
import module_circles
import numbers_outside_settings as numbers
import pytest
import rust_source
from import_graph import ROOT as DOOR
from import_graph import between_floors, circle, floor_of, imports, modules

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "python" / "treadwell"
LONGEST_FILE = 400
SIMULATOR = {"simulated_body", "mujoco_step"}
# Tested through what uses them, by the test named.
TESTED_BY = {
    "map_making.headroom": "test_map.py",
    "judging.entries": "test_result.py",
    "mapping.camera": "test_mapping.py",
    "mapping.checks": "test_mapping.py",
    "mapping.stairs": "test_mapping.py",
    "mapping.view": "test_mapping.py",
    "mapping.ways": "test_mapping.py",
    "__main__": "test_start.py",
    "recording.sole_outlines": "test_map_picture.py",
    "recording.stair_outlines": "test_map_picture.py",
    "recording.step_shapes": "test_recording.py",
    "cli.verify": "test_difference.py",
    "progress": "test_cli.py",
    "scores": "test_runner.py",
    "recording.core_products": "test_recording.py",
    "replaying.findings": "test_replay.py",
    "replaying.folder": "test_cut_off.py",
    "protocols": "test_components.py",
    "version": "test_bindings.py",
    "cli.compare": "test_comparison.py",
    "dependencies": "test_class_hash.py",
    "quiet_definitions": "test_class_hash.py",
    "comparing.tables": "test_comparison.py",
    "cli.list_verbs": "test_reference.py",
    "cli.options": "test_cli.py",
    "cli.run_verbs": "test_cli.py",
    "cli.sweep": "test_sweeps.py",
    "cli.sweep_verbs": "test_sweeps.py",
    "cli.export": "test_exports.py",
    "cli.report": "test_reporting.py",
    "gymnasium_hook": "test_environment.py",
    "course.check": "test_course.py",
    "course.levels": "test_course.py",
    "course.pieces": "test_course.py",
    "course.terrain": "test_ground_elements.py",
    "course.vegetation": "test_ground_elements.py",
    "recording.recorded_camera": "test_sources_foxglove.py",
    "recording.products": "test_recording.py",
    "exports.gltf": "test_mesh_export.py",
    "recording.mesh_file": "test_mesh_export.py",
    "recording.stair_shapes": "test_recording.py",
    "measuring.true_levels": "test_score.py",
    "experiments.side_by_side": "test_experiments.py",
    "experiments.models.experiment": "test_models_experiment.py",
    "experiments.models.recorded": "test_models_experiment.py",
    "experiments.models.suite": "test_models_experiment.py",
    "experiments.models.tables": "test_models_experiment.py",
    "map_result": "test_map.py",
    "map_making.landmark_picture": "test_landmark_map.py",
    "map_making.landmarks": "test_landmark_map.py",
    "map_making.leaning": "test_map.py",
    "map_making.mapper": "test_map.py",
    "map_making.picture": "test_map.py",
    "map_making.plan_picture": "test_map_plan.py",
    "map_making.plan_view": "test_map_plan.py",
    "map_making.points_map": "test_map_plan.py",
    "map_making.scan_matched": "test_map_scan_match.py",
    "map_making.sizing": "test_map.py",
    "map_making.standing_out": "test_map.py",
    "map_making.recording": "test_map.py",
    "cli.map": "test_map.py",
    "reporting.data_uri": "test_reporting.py",
    "sources.camera_file": "test_sources_depth.py",
    "sources.depth_folder": "test_sources_depth.py",
    "sources.depth_image": "test_sources_depth.py",
    "sources.folders": "test_sources_depth.py",
    "sources.height_image": "test_sources.py",
    "sources.bag": "test_sources_bag.py",
    "sources.foxglove_messages": "test_sources_foxglove.py",
    "sources.laser_log": "test_sources_laser.py",
    "sources.packed": "test_sources_clouds.py",
    "sources.clouds": "test_sources_clouds.py",
    "sources.pcd": "test_sources_clouds.py",
    "sources.ply": "test_sources_clouds.py",
    "sources.pose_file": "test_sources_depth.py",
    "sources.run": "test_sources.py",
    "sweeps.asked": "test_sweeps.py",
    "sweeps.table": "test_sweeps.py",
    "sweeps.agreement": "test_sweep_folder.py",
    "sweeps.folder": "test_sweeps.py",
    "sweeps.job": "test_sweeps.py",
    "sweeps.summary": "test_sweeps.py",
    "solving.climb_line": "test_solvable.py",
    "solving.true_solids": "test_solvable.py",
    "robot.camera_file": "test_robot_file.py",
    "robot.tables": "test_robot_file.py",
    "robot.stance": "test_robot_template.py",
    "robot.draft": "test_robot_template.py",
    "robot.draft_motors": "test_robot_template.py",
    "robot.keyframes": "test_robot_template.py",
    "robot.joint_roles": "test_anatomy.py",
    "robot.surfaces": "test_soles.py",
    "robot.model_gaps": "test_robot_additions.py",
    "robot.camera_added": "test_robot_additions.py",
    "robot.turned_links": "test_robot_additions.py",
    "robot.model_file": "test_robot_report.py",
    "robot.leg_faults": "test_robot_faults.py",
    "robot.bearing": "test_robot_faults.py",
    "robot.leg_loads": "test_robot_faults.py",
    "trials.world": "test_trials.py",
    "trials.stairs": "test_trials.py",
    "trials.table": "test_trials.py",
    "robot.check_motors": "test_robot_check.py",
    "scenario.drawn_elements": "test_scenario.py",
    "scenario.element_table": "test_scenario.py",
    "scenario.messages": "test_scenario.py",
    "scenario.types": "test_scenario.py",
    "workers.log": "test_pool.py",
}


def members() -> list[str]:
    workspace = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]
    return [Path(member).name for member in workspace["members"]]


@cache
def harness() -> dict[str, set[str]]:
    return imports(PACKAGE)


def floors() -> list[list[str]]:
    """The rows of ARCHITECTURE.md's table of the harness, from the ground up."""
    page = (ROOT / "ARCHITECTURE.md").read_text()
    _, _, section = page.partition("## The harness: `python/treadwell/`\n")
    table = section.partition("\n## ")[0]
    rows = [line.split("|")[1] for line in table.splitlines() if line.startswith("| `")]
    return [re.findall(r"`([^`]+)`", row) for row in rows]


def manifest(crate: str) -> dict[str, Any]:
    return tomllib.loads((ROOT / "rust" / crate / "Cargo.toml").read_text())


def sources(pattern: str, *folders: str) -> list[Path]:
    found = [path for folder in folders for path in sorted((ROOT / folder).rglob(pattern))]
    return [path for path in found if "__pycache__" not in path.parts]


@pytest.mark.parametrize("crate", members())
def test_a_crate_uses_only_the_crates_above_it(crate: str) -> None:
    order = members()
    manifest = tomllib.loads((ROOT / "rust" / crate / "Cargo.toml").read_text())
    used = [name for name in manifest.get("dependencies", {}) if name in order]
    below = [name for name in used if order.index(name) >= order.index(crate)]
    assert not below, f"{crate} uses {below}, which stand below it in Cargo.toml"


FOR_FEATURES = {"either", "indexmap"}
"""Declared with the features that tests switch on, so that nothing is built twice."""


@pytest.mark.parametrize("crate", members())
def test_a_crate_is_named_like_its_folder_and_declares_only_what_it_uses(crate: str) -> None:
    folder = ROOT / "rust" / crate
    manifest = tomllib.loads((folder / "Cargo.toml").read_text())
    assert manifest["package"]["name"] == crate
    text = "\n".join(path.read_text() for path in folder.rglob("*.rs"))
    unused = [
        name
        for name in manifest.get("dependencies", {})
        if name not in FOR_FEATURES and not re.search(rf"\b{name.replace('-', '_')}\b", text)
    ]
    assert not unused, f"{crate} declares {unused} and does not use them"


def test_what_stands_in_the_harness_stands_in_its_table_once() -> None:
    listed = sorted(name for row in floors() for name in row)
    there = {floor_of(name) for name in modules(PACKAGE)}
    assert listed == sorted(f"{name}/" if (PACKAGE / name).is_dir() else name for name in there)


@pytest.mark.parametrize("row", range(len(floors())))
def test_a_floor_imports_only_from_itself_and_the_floors_above_it_in_the_table(row: int) -> None:
    order = [[name.removesuffix("/") for name in names] for names in floors()]
    allowed = {name for names in order[: row + 1] for name in names}
    graph = harness()
    wrong = [
        f"{name} imports {found}"
        for name in graph
        if floor_of(name) in order[row]
        for found in sorted(graph[name])
        if floor_of(found) not in allowed
    ]
    assert not wrong, f"on a higher floor stands what is imported: {wrong}"


def test_no_import_goes_in_a_circle() -> None:
    graph = harness()
    assert not circle(between_floors(graph))
    assert not circle(graph)


def test_imports_are_found_wherever_they_stand(tmp_path: Path) -> None:
    (tmp_path / "inner").mkdir()
    for name in ("__init__", "low", "inner/__init__", "inner/deep", "typed", "late"):
        (tmp_path / f"{name}.py").write_text("")
    (tmp_path / "high.py").write_text(
        "import os\nfrom treadwell import low\nfrom treadwell._core import Pilot\n"
        "if TYPE_CHECKING:\n    from treadwell.typed import Thing\n"
        "def f():\n    import treadwell\n    import_module('treadwell.late:main')\n"
        "    from treadwell.inner.deep import X\n"
    )
    graph = imports(tmp_path)
    assert graph["high"] == {DOOR, "low", "typed", "late", "inner.deep"}
    assert between_floors(graph)["high"] == {DOOR, "low", "typed", "late", "inner"}
    assert not circle(graph)
    (tmp_path / "inner" / "deep.py").write_text("def g():\n    import treadwell.high\n")
    assert set(circle(imports(tmp_path))) == {"high", "inner.deep"}


def test_no_source_file_is_longer_than_the_limit() -> None:
    files = sources("*.rs", "rust") + sources("*.py", "python", "tests", "benches")
    lengths = {path.relative_to(ROOT): len(path.read_text().splitlines()) for path in files}
    too_long = {str(path): n for path, n in lengths.items() if n > LONGEST_FILE}
    assert not too_long


def test_every_source_file_says_what_it_is_for() -> None:
    rust = [path for path in sources("*.rs", "rust") if not path.read_text().startswith("//!")]
    python = [path for path in sources("*.py", "python") if not path.read_text().startswith('"""')]
    assert not [str(path.relative_to(ROOT)) for path in rust + python]


def test_every_python_module_has_a_test() -> None:
    tests = {path.name for path in (ROOT / "tests").glob("test_*.py")}
    texts = "\n".join(path.read_text() for path in (ROOT / "tests").glob("test_*.py"))
    assert set(TESTED_BY.values()) <= tests
    untested = []
    for path in sorted(PACKAGE.rglob("*.py")):
        if path.stem == "__init__" or "__pycache__" in path.parts:
            continue
        name = ".".join(path.relative_to(PACKAGE).with_suffix("").parts)
        parent, _, leaf = name.rpartition(".")
        imported = re.search(
            rf"treadwell\.{re.escape(name)}\b|from treadwell\.?{parent} import .*\b{leaf}\b", texts
        )
        own = {f"test_{leaf}.py", f"test_{parent}_{leaf}.py", TESTED_BY.get(name)}
        if not imported and not own & tests:
            untested.append(name)
    assert not untested


def test_every_rust_crate_has_tests_beside_its_code() -> None:
    for crate in members():
        if crate in ("bindings", "testkit"):  # tested from Python; by the tests that it is for
            continue
        text = "\n".join(path.read_text() for path in (ROOT / "rust" / crate).rglob("*.rs"))
        assert "#[test]" in text, crate


def test_the_senses_and_the_core_cannot_read_the_truth() -> None:
    """What runs before the core's tick imports no judge, and the core knows no simulator."""
    before = [PACKAGE / "observation.py", PACKAGE / "protocols.py"]
    before += sorted((PACKAGE / "senses").glob("*.py")) + sorted((PACKAGE / "physics").glob("*.py"))
    assert len(before) > 6
    truth = r"treadwell\.(judging|measuring|solving|recording|trace)\b"
    for path in before:
        assert not re.search(truth, path.read_text()), path.name
    core = [name for name in members() if name not in (*SIMULATOR, "bindings")]
    text = "\n".join(path.read_text() for path in sources("*.rs", *(f"rust/{n}" for n in core)))
    assert "mujoco" not in text.lower().replace("mujoco's quaternions", "")


@pytest.mark.parametrize("crate", members())
def test_only_the_bindings_use_what_the_simulator_knows(crate: str) -> None:
    used = SIMULATOR & manifest(crate).get("dependencies", {}).keys()
    assert not used or crate in {"bindings", *SIMULATOR}
    assert set(members()) >= SIMULATOR


@pytest.mark.parametrize("crate", members())
def test_unsafe_code_stands_in_one_crate_alone(crate: str) -> None:
    inherits = manifest(crate)["lints"].get("workspace", False)
    assert inherits == (crate != "mujoco_step")
    text = "\n".join(path.read_text() for path in sources("*.rs", f"rust/{crate}"))
    assert inherits or text.count("// SAFETY: ") == len(re.findall(r"\bunsafe (?:\{|impl)", text))


# Float literals that are true by nature (`python tools/numbers.py --list`). The count only falls.
MOST_NUMBERS = 56
MOST_NAMES_WITH_TWO_MEANINGS = 10
# A circle between modules of a crate, and why it is one.
CIRCLES = {
    "geometry: area, lattice": "an area is of cells, and a lattice tells which cells an area holds",
}


def test_few_numbers_of_the_core_are_no_settings() -> None:
    found = [one for source in rust_source.sources() for one in numbers.literals(source)]
    assert len(found) <= MOST_NUMBERS, [one.place for one in found]


def test_few_type_names_stand_for_two_things() -> None:
    assert len(numbers.type_names()) <= MOST_NAMES_WITH_TWO_MEANINGS, numbers.type_names()


def test_no_two_modules_of_a_crate_use_each_other_but_for_a_reason() -> None:
    found = module_circles.all_circles()
    assert found.keys() <= CIRCLES.keys(), found
    assert len(CIRCLES) <= 3


def test_every_doc_comment_of_the_core_is_a_sentence_of_its_own() -> None:
    assert not doc_comments.faults()


def test_no_crate_but_for_its_tests_uses_the_testkit() -> None:
    for crate in members():
        manifest = tomllib.loads((ROOT / "rust" / crate / "Cargo.toml").read_text())
        assert "testkit" not in manifest.get("dependencies", {}), crate


def test_no_crate_but_the_bindings_knows_the_simulators_true_scene() -> None:
    for crate in members():
        manifest = tomllib.loads((ROOT / "rust" / crate / "Cargo.toml").read_text())
        used = [*manifest.get("dependencies", {}), *manifest.get("dev-dependencies", {})]
        assert crate == "bindings" or "simulated_senses" not in used, crate


def test_the_tools_count_what_they_say() -> None:
    text = rust_source.blank(
        'const A: f64 = 0.3; // 0.4\nlet b = 1.5 * x + 0.5 + 1e-6 + 10.0;\nlet t = "0.7";\n'
        "settings! { x: f64 = 0.9; }\nimpl Default for X { fn d() { 0.8 } }\nlet c = 3_f64;"
    )
    source = rust_source.Source(ROOT / "x.rs", "x", (), text)
    found = [(one.text, one.constant) for one in numbers.literals(source)]
    assert found == [("0.3", True), ("1.5", False), ("3_f64", False)]
    tested = "fn a() {}\n#[cfg(test)]\nmod tests { fn b() { 0.3 } }\nfn c() {}"
    left = rust_source.without_tests(tested)
    assert "fn a" in left
    assert "fn c" in left
    assert "0.3" not in left
    assert module_circles.split_use("a::{b, c::{d, e}}") == ["a::b", "a::c::d", "a::c::e"]
