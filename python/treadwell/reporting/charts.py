"""Plots and the lane of states as SVG within the page: its style sheet gives the colours."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from markupsafe import Markup, escape
from numpy.typing import NDArray

Floats = NDArray[np.float64]
WIDTH, HEIGHT = 720, 170
_LEFT, _RIGHT, _TOP, _BOTTOM = 52, 12, 10, 24
_LANE: Final = 26
"""Height of the lane of states, pixels."""
_MOST_POINTS: Final = 500
"""Of a line; a longer one keeps the highest and the lowest of each stretch."""
_STATE_COLOURS: Final = 8
"""Classes `s0` to `s7` of the style sheet."""
_HUGE: Final = 1e9


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """A line of a plot: name, times (n,) s and values (n,)."""

    name: str
    times: Floats
    values: Floats


def plot(title: str, unit: str, lines: Sequence[Line], end_s: float, least: float = 1e-6) -> Markup:
    """Return a plot over time.

    Args:
        title: what is plotted.
        unit: of the values.
        lines: those that have no value that can be drawn are left out.
        end_s: s, where the time axis ends.
        least: what the value axis reaches at least, so that noise is not blown up.
    """
    drawn = [_finite(line) for line in lines]
    drawn = [line for line in drawn if len(line.times)]
    values = np.concatenate([line.values for line in drawn]) if drawn else np.zeros(1)
    low, high = min(0.0, float(values.min())), max(least, float(values.max()))
    marks = ticks(low, high, 4)
    low, high = min(low, marks[0]), max(high, marks[-1])
    parts = [_time_axis(end_s, HEIGHT - _BOTTOM)]
    for mark in marks:
        y = _y(mark, low, high)
        parts.append(
            f'<line class="grid" x1="{_LEFT}" x2="{WIDTH - _RIGHT}" y1="{y:.1f}" y2="{y:.1f}"/>'
            f'<text class="tick" x="{_LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{mark:g}</text>'
        )
    for number, line in enumerate(drawn):
        places = " ".join(
            f"{_x(t, end_s):.1f},{_y(v, low, high):.1f}"
            for t, v in zip(*_thinned(line.times, line.values), strict=True)
        )
        parts.append(f'<polyline class="line l{number % 4}" points="{places}"/>')
    keys = "".join(
        f'<span class="key k{number % 4}">{escape(line.name)}</span>'
        for number, line in enumerate(drawn)
    )
    caption = f"<figcaption>{escape(title)} ({escape(unit)}) {keys}</figcaption>"
    return Markup(f'<figure class="plot">{caption}{_svg(HEIGHT, parts, title)}</figure>')


def state_lane(states: Sequence[tuple[float, str]], end_s: float) -> Markup:
    """Return a lane that shows which state lasted from when to when.

    Args:
        states: (s, name) at each change.
        end_s: s, where the time axis ends.
    """
    names = list(dict.fromkeys(name for _, name in states))
    parts = [_time_axis(end_s, _TOP + _LANE)]
    for (begin, name), (end, _) in zip(states, [*states[1:], (end_s, "")], strict=True):
        left, right = _x(begin, end_s), _x(end, end_s)
        if not right > left:
            continue
        kind = names.index(name) % _STATE_COLOURS
        parts.append(
            f'<rect class="s{kind}" x="{left:.1f}" width="{right - left:.1f}" y="{_TOP}" '
            f'height="{_LANE}"><title>{escape(name)}: {begin:.2f} s to {end:.2f} s</title></rect>'
        )
        if right - left > 7.0 * len(name) + 6:
            parts.append(
                f'<text class="state" x="{(left + right) / 2:.1f}" y="{_TOP + _LANE / 2 + 4}" '
                f'text-anchor="middle">{escape(name)}</text>'
            )
    keys = "".join(
        f'<span class="key b{number % _STATE_COLOURS}">{escape(name)}</span>'
        for number, name in enumerate(names)
    )
    caption = f"<figcaption>Behaviour {keys}</figcaption>"
    svg = _svg(_TOP + _LANE + _BOTTOM, parts, "behaviour")
    return Markup(f'<figure class="plot">{caption}{svg}</figure>')


def ticks(low: float, high: float, about: int) -> list[float]:
    """Return round numbers from `low` to `high`, some `about` of them, at least one."""
    span = high - low
    if not (span > 0.0 and math.isfinite(span)):
        return [low]
    rough = span / about
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(power * k for k in (1.0, 2.0, 2.5, 5.0, 10.0) if power * k >= rough * 0.999)
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [round(k * step, 12) + 0.0 for k in range(first, last + 1)] or [low]


def _svg(height: float, parts: Sequence[str], label: str) -> str:
    return (
        f'<svg viewBox="0 0 {WIDTH} {height:g}" role="img" aria-label="{escape(label)}">'
        f"{''.join(parts)}</svg>"
    )


def _time_axis(end_s: float, y: float) -> str:
    parts = [f'<line class="axis" x1="{_LEFT}" x2="{WIDTH - _RIGHT}" y1="{y}" y2="{y}"/>']
    for mark in ticks(0.0, max(end_s, 1e-6), 8):
        x = _x(mark, end_s)
        parts.append(
            f'<text class="tick" x="{x:.1f}" y="{y + 16}" text-anchor="middle">{mark:g} s</text>'
        )
    return "".join(parts)


def _finite(line: Line) -> Line:
    good = (np.abs(line.times) < _HUGE) & (np.abs(line.values) < _HUGE)  # NaN is not less
    return Line(line.name, line.times[good], line.values[good])


def _thinned(times: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Return the same line with fewer points, in which no peak is lost."""
    if len(times) <= _MOST_POINTS:
        return times, values
    kept: list[int] = []
    for part in np.array_split(np.arange(len(times)), _MOST_POINTS // 2):
        kept += sorted({int(part[values[part].argmin()]), int(part[values[part].argmax()])})
    return times[kept], values[kept]


def _x(time_s: float, end_s: float) -> float:
    share = min(max(time_s / max(end_s, 1e-6), 0.0), 1.0)
    return _LEFT + share * (WIDTH - _LEFT - _RIGHT)


def _y(value: float, low: float, high: float) -> float:
    return HEIGHT - _BOTTOM - (value - low) / (high - low) * (HEIGHT - _TOP - _BOTTOM)
