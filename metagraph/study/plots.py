"""Plots of a study as SVG text, drawn by us so that a report needs nothing beside it. Colours come from the
page's style, light or dark.

Classes: `meta`, `manual` the conditions; `axis`, `grid`, `label`, `dim`; `s0`..`s4` the parts of a stacked
bar.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from html import escape
from math import ceil, floor, isfinite, log10

from metagraph.study.stats import Estimate
from metagraph.svg import dot, line, number, svg, text

Place = Callable[[float], float]


def seconds(value: float) -> str:
    """Return a time as people read it: 42 s, 8 min, 1.5 min, 2.1 h."""
    if value < 90:
        return f"{value:.3g} s" if value < 9.95 else f"{value:.0f} s"
    return f"{value / 60:.3g} min" if value < 5400 else f"{value / 3600:.3g} h"


def paired(
    people: Sequence[tuple[str, float, float]], means: Sequence[Estimate], names: tuple[str, str]
) -> str:
    """Each person's two times as a line on a logarithmic axis, with geometric means and their intervals.
    people: (name, left, right).
    """
    height, top, bottom, xs = 380, 24, 340, (210.0, 430.0)
    every = [v for _, a, b in people for v in (a, b)] + [
        v for m in means for v in (m.low, m.high) if v is not None
    ]
    y, ticks = _log_axis(min(every), max(every), bottom, top, _TIMES)
    parts = [_grid(x1=80, x2=560, y=y(t), words=seconds(t)) for t in ticks]
    for name, a, b in people:
        words = escape(f"{name}: {seconds(a)} and {seconds(b)}, {b / a:.2f} times")
        parts.append(
            f"<g class='person'><title>{words}</title>{line(xs[0], y(a), xs[1], y(b))}"
            f"{dot(xs[0], y(a), 3)}{dot(xs[1], y(b), 3)}</g>"
        )
    for x, mean, css, name, side in zip(
        (xs[0] - 26, xs[1] + 26), means, ("meta", "manual"), names, (-1, 1), strict=True
    ):
        parts.append(f"<g class='{css}'>{_vertical(x, mean, y)}</g>")
        anchor = "end" if side < 0 else "start"
        parts.append(text(x + 12 * side, y(mean.value) + 4, seconds(mean.value), f"label {css}", anchor))
        parts.append(text(x - 13 * side, bottom + 26, name, f"label {css}", "middle"))
    return svg(height, parts, f"Times of {len(people)} people in both conditions")


def ratios(rows: Sequence[tuple[str, Estimate]]) -> str:
    """Ratios with their intervals, one below the other, on a logarithmic axis with a line at 1."""
    row, left, right = 34, 190, 540
    height = 24 + row * len(rows) + 34
    every = [v for _, e in rows for v in (e.value, e.low, e.high) if v is not None and isfinite(v) and v > 0]
    x, ticks = _log_axis(min(1.0, *every), max(1.0, *every), left, right, _RATIOS)
    bottom = 18 + row * len(rows)
    parts = []
    for t in ticks:
        parts.append(
            f"<line class='{'one' if t == 1 else 'grid'}' x1='{number(x(t))}' x2='{number(x(t))}' y1='12' "
            f"y2='{bottom}'/>"
        )
        parts.append(text(x(t), bottom + 18, f"{t:g}", "dim", "middle"))
    for n, (name, e) in enumerate(rows):
        at = 18 + row * (n + 0.5)
        parts.append(text(left - 14, at + 4, name, "label", "end"))
        if e.low is not None and e.high is not None:
            parts.append(f"<g class='manual'>{line(x(e.low), at, x(e.high), at, 'wide')}</g>")
        parts.append(f"<g class='manual'>{dot(x(e.value), at, 6 if n == 0 else 4)}</g>")
        parts.append(text(right + 14, at + 4, f"{e.value:.2f}", "label", "start"))
    return svg(height, parts, "Ratios of times with their intervals")


def curves(found: Mapping[str, tuple[Sequence[float], float, float]], names: Mapping[str, str]) -> str:
    """Seconds of the first, second ... clip, both axes logarithmic. found: condition -> (seconds, first and
    slope of the line).
    """
    height, top, bottom, left, right = 330, 20, 280, 70, 470
    every = [
        s for values, first, slope in found.values() for s in (*values, first, first * len(values) ** slope)
    ]
    longest = max(len(values) for values, _, _ in found.values())
    y, ticks = _log_axis(min(every), max(every), bottom, top, _TIMES)
    x, across = _log_axis(1, max(2, longest), left, right, _COUNTS)
    parts = [_grid(x1=left, x2=right, y=y(t), words=seconds(t)) for t in ticks]
    parts += [text(x(t), bottom + 18, f"{t:g}", "dim", "middle") for t in across]
    parts.append(
        text(
            (left + right) / 2,
            bottom + 40,
            "how many clips were done before and with this one",
            "dim",
            "middle",
        )
    )
    for condition, (values, first, slope) in found.items():
        dots = "".join(dot(x(n), y(s), 3.5) for n, s in enumerate(values, 1))
        end = first * len(values) ** slope
        parts.append(
            f"<g class='{condition}'>{line(x(1), y(first), x(len(values)), y(end), 'wide')}{dots}</g>"
        )
        parts.append(text(x(len(values)) + 10, y(end) + 4, names[condition], f"label {condition}", "start"))
    return svg(height, parts, "Seconds a clip, from the first clip to the last")


def stacked(rows: Mapping[str, Mapping[str, float]], names: Mapping[str, str]) -> str:
    """What the time went into, as one bar a condition; rows: condition -> part -> seconds."""
    row, left, right = 58, 20, 620
    most = max(sum(parts.values()) for parts in rows.values()) or 1.0
    height = 20 + row * len(rows) + 30
    out = []
    for n, (condition, parts) in enumerate(rows.items()):
        at, total = 16 + row * n, sum(parts.values())
        out.append(
            text(left, at + 10, f"{names[condition]}: {seconds(total)} a task", f"label {condition}", "start")
        )
        edge = float(left)
        for k, (name, value) in enumerate(parts.items()):
            wide = (right - left) * value / most
            words = escape(f"{name}: {seconds(value)}, {value / total if total else 0:.0%}")
            out.append(
                f"<rect class='s{k}' x='{number(edge)}' y='{at + 18}' width='{number(wide)}' "
                f"height='22'><title>{words}</title></rect>"
            )
            if wide > 34:
                out.append(text(edge + wide / 2, at + 33, f"{value / total:.0%}", "inside", "middle"))
            edge += wide
    edge = float(left)
    for k, name in enumerate(next(iter(rows.values()), {})):
        out.append(f"<rect class='s{k}' x='{number(edge)}' y='{height - 22}' width='12' height='12'/>")
        out.append(text(edge + 18, height - 12, name, "dim", "start"))
        edge += 110
    return svg(height, out, "What the time went into")


def means(rows: Sequence[tuple[str, Mapping[str, Estimate]]], low: float = 0.0, high: float = 100.0) -> str:
    """Means with their intervals on a plain axis, the conditions below each other. rows: (name, condition ->
    mean).
    """
    row, left, right = 46, 190, 560
    height, bottom = 24 + row * len(rows) + 30, 16 + row * len(rows)

    def x(value: float) -> float:
        return left + (right - left) * (min(max(value, low), high) - low) / (high - low)

    parts = []
    for k in range(5):
        t = low + (high - low) * k / 4
        parts.append(f"<line class='grid' x1='{number(x(t))}' x2='{number(x(t))}' y1='12' y2='{bottom}'/>")
        parts.append(text(x(t), bottom + 18, f"{t:g}", "dim", "middle"))
    for n, (name, found) in enumerate(rows):
        at = 16 + row * (n + 0.5)
        parts.append(text(left - 14, at + 4, name, "label", "end"))
        for k, (condition, e) in enumerate(found.items()):
            y = at + (k - (len(found) - 1) / 2) * 14
            bar = line(x(e.low), y, x(e.high), y, "wide") if e.low is not None and e.high is not None else ""
            parts.append(f"<g class='{condition}'>{bar}{dot(x(e.value), y, 4.5)}</g>")
            parts.append(text(right + 14, y + 4, f"{e.value:.1f}", f"label {condition}", "start"))
    return svg(height, parts, "Means with their intervals")


# --- axes and marks

_TIMES = (
    *(m * b for b in (0.01, 0.1, 1) for m in (1, 2, 5)),
    10,
    20,
    30,
    60,
    120,
    300,
    600,
    1200,
    1800,
    3600,
    7200,
    18000,
    36000,
    72000,
    180000,
    360000,
    720000,
)
_RATIOS = tuple(m * 10.0**b for b in range(-6, 7) for m in (1, 2, 5))
_COUNTS = (1, 2, 3, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000)


def _log_axis(
    low: float, high: float, start: float, end: float, nice: Sequence[float]
) -> tuple[Place, list[float]]:
    """Return where a value lies between start and end, and the values to mark."""
    a, b = log10(low) - 0.06, log10(high) + 0.06
    if b - a < 0.3:
        a, b = a - 0.15, b + 0.15

    def place(value: float) -> float:
        return start + (end - start) * (log10(value) - a) / (b - a)

    ticks = [t for t in nice if a <= log10(t) <= b]
    if len(ticks) < 2:
        ticks = [10.0**k for k in range(floor(a), ceil(b) + 1) if a <= k <= b] or ticks
    return place, [float(t) for t in ticks]


def _grid(x1: float, x2: float, y: float, words: str) -> str:
    return f"{line(x1, y, x2, y, 'grid')}{text(x1 - 8, y + 4, words, 'dim', 'end')}"


def _vertical(x: float, mean: Estimate, y: Place) -> str:
    bar = (
        line(x, y(mean.low), x, y(mean.high), "wide")
        if mean.low is not None and mean.high is not None
        else ""
    )
    return f"{bar}{dot(x, y(mean.value), 6)}"
