"""Claims about what `ulimit` leaves: nobody wants more than the shell allows, and it is said."""

import resource

import pytest

from treadwell import shell_limits


@pytest.mark.parametrize(
    ("limits", "least"),
    [((-1, -1), None), ((5, -1), 5), ((-1, 7), 7), ((3, 7), 3)],
)
def test_the_lower_of_both_limits_counts(
    limits: tuple[int, int], least: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(resource, "getrlimit", lambda _: limits)
    assert shell_limits.address_space() == least
    wanted = shell_limits.within(resource.RLIMIT_CPU, 4)
    assert wanted == (4 if least is None else min(4, least))


def test_only_too_little_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    allowed = 2_000_000_000
    monkeypatch.setattr(resource, "getrlimit", lambda _: (allowed, allowed))
    assert shell_limits.tightness(allowed) == ""
    assert "allows 2.0 GB of memory (ulimit -v), and 3.0 GB" in shell_limits.tightness(3 * 10**9)
