"""Claims about the command that installs an extra: it works wherever the package came from."""

import tomllib
from importlib import metadata
from pathlib import Path

import pytest

from treadwell import extras
from treadwell.extras import install_hint

PROJECT = tomllib.loads((Path(__file__).parent.parent / "pyproject.toml").read_text())["project"]
EXTRAS = PROJECT["optional-dependencies"]


@pytest.mark.parametrize("extra", EXTRAS)
def test_the_packages_are_named_and_not_the_testbed(
    extra: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    listed = [f'{one} ; extra == "{name}"' for name, kept in EXTRAS.items() for one in kept]
    monkeypatch.setattr(extras, "requires", lambda _: [*PROJECT["dependencies"], *listed])
    wanted = " ".join(f"'{one}'" for one in EXTRAS[extra])
    assert install_hint(extra) == f"pip install {wanted}"


def test_where_the_package_is_not_installed_the_extra_is_named(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def missing(name: str) -> list[str]:
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(extras, "requires", missing)
    assert install_hint("gym") == "pip install 'treadwell[gym]'"


def test_no_message_and_no_page_asks_an_index_for_the_testbed() -> None:
    root = Path(__file__).parent.parent
    files = [*root.glob("python/treadwell/**/*.py"), *root.glob("examples/**/*.py")]
    files += [*root.glob("docs/how_to/*.md"), *root.glob("docs/tutorial/*.md")]
    said = [str(file) for file in files if "treadwell[" in file.read_text()]
    assert said == [str(root / "python" / "treadwell" / "extras.py")]
