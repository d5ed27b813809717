"""Plots of a study as SVG text, drawn by us so that a report needs nothing beside it. Colours come from the
page's style, light or dark.

Classes: `meta`, `manual` the conditions; `axis`, `grid`, `label`, `dim`; `s0`..`s10` the parts of a
stacked bar.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite

from metagraph.common.svg import draw_svg_dot, draw_svg_line, draw_svg_text, format_px, make_svg_drawing
from metagraph.common.xml_text import escape
from metagraph.research.study.reports.plot_axes import (
    COUNTS,
    PLAIN_TIMES,
    RATIOS,
    TIMES,
    Place,
    list_finite,
    log_axis,
    make_plain_axis,
)
from metagraph.research.study.statistics.small_samples import Estimate


def format_duration(value: float) -> str:
    """Return a time as people read it: 42 s, 8 min, 1.5 min, 2.1 h."""
    if value < 90:
        return f"{value:.3g} s" if value < 9.95 else f"{value:.0f} s"
    return f"{value / 60:.3g} min" if value < 5400 else f"{value / 3600:.3g} h"


def plot_paired(
    people: Sequence[tuple[str, float, float]],
    means: Sequence[Estimate],
    names: tuple[str, str],
    unit: str = "task",
    css: tuple[str, str] = ("meta", "manual"),
) -> str:
    """Each person's two times as a line on a logarithmic axis, with geometric means and their intervals.
    people: (name, left, right). unit: what
    the times are of. css: classes of the two.
    """
    height, top, bottom, xs = 380, 24, 340, (210.0, 430.0)
    every = [v for _, a, b in people for v in (a, b)] + [
        v for m in means for v in (m.low, m.high) if v is not None
    ]
    y, ticks = log_axis(min(every), max(every), bottom, top, TIMES)
    parts = [_grid(x1=88, x2=560, y=y(t), words=format_duration(t)) for t in ticks]
    parts.append(_title_up((top + bottom) / 2, f"time a {unit} (logarithmic)"))
    for name, a, b in people:
        words = escape(f"{name}: {format_duration(a)} and {format_duration(b)}, {b / a:.2f} times")
        parts.append(
            f"<g class='person'><title>{words}</title>{draw_svg_line(xs[0], y(a), xs[1], y(b))}"
            f"{draw_svg_dot(xs[0], y(a), 3)}{draw_svg_dot(xs[1], y(b), 3)}</g>"
        )
    for x, mean, kind, name, side in zip((xs[0] - 26, xs[1] + 26), means, css, names, (-1, 1), strict=True):
        parts.append(f"<g class='{kind}'>{_vertical(x, mean, y)}</g>")
        anchor = "end" if side < 0 else "start"
        parts.append(
            draw_svg_text(
                x + 12 * side, y(mean.value) + 4, format_duration(mean.value), f"label {kind}", anchor
            )
        )
        parts.append(draw_svg_text(x - 13 * side, bottom + 26, name, f"label {kind}", "middle"))
    return make_svg_drawing(height, parts, f"Times of {len(people)} people in both conditions")


def plot_ratios(
    rows: Sequence[tuple[str, Estimate]], title: str = "ratio of times, by hand / meta-graph (logarithmic)"
) -> str:
    """Draw ratios with their intervals, one below the other, on a logarithmic axis with a line at 1. Where an
    end is not known an arrow goes on. title: of the axis.
    """
    row, left, right = 34 if len(rows) < 6 else 24, 190, 500
    bottom = 18 + row * len(rows)
    every = list_finite([v for _, e in rows for v in (e.value, e.low, e.high)])
    x, ticks = log_axis(min(1.0, *every), max(1.0, *every), left, right, RATIOS)
    parts = []
    for t in ticks:
        one = "one" if t == 1 else "grid"
        parts.append(draw_svg_line(x(t), 12, x(t), bottom, one))
        parts.append(draw_svg_text(x(t), bottom + 18, f"{t:g}", "dim", "middle"))
    if 1.0 not in ticks:
        parts.append(draw_svg_line(x(1), 12, x(1), bottom, "one"))
    parts.append(draw_svg_text((left + right) / 2, bottom + 38, title, "dim", "middle"))
    for n, (name, e) in enumerate(rows):
        at = 18 + row * (n + 0.5)
        parts.append(draw_svg_text(left - 14, at + 4, name, "label", "end"))
        words = f"{e.value:.2f}"
        if e.low is not None and e.high is not None:
            low = x(e.low) if e.low > 0 else left
            high = x(e.high) if isfinite(e.high) else right
            parts.append(f"<g class='manual'>{draw_svg_line(low, at, high, at, 'wide')}")
            if not isfinite(e.high):
                parts.append(
                    draw_svg_line(right - 6, at - 5, right, at, "wide")
                    + draw_svg_line(right - 6, at + 5, right, at, "wide")
                )
            parts.append("</g>")
            words += f"  [{e.low:.2f}, {e.high:.2f}]" if isfinite(e.high) else f"  [{e.low:.2f}, …"
        parts.append(f"<g class='manual'>{draw_svg_dot(x(e.value), at, 6 if n == 0 else 4)}</g>")
        parts.append(draw_svg_text(right + 12, at + 4, words, "label", "start"))
    return make_svg_drawing(bottom + 48, parts, "Ratios of times with their intervals")


def plot_learning(found: Mapping[str, tuple[Sequence[float], float, float]], names: Mapping[str, str]) -> str:
    """Seconds of the first, second ... clip, both axes logarithmic. found: condition -> (seconds, first and
    slope of the line).
    """
    height, top, bottom, left, right = 330, 20, 280, 88, 470
    every = [
        s for values, first, slope in found.values() for s in (*values, first, first * len(values) ** slope)
    ]
    longest = max(len(values) for values, _, _ in found.values())
    y, ticks = log_axis(min(every), max(every), bottom, top, TIMES)
    x, across = log_axis(1, max(2, longest), left, right, COUNTS)
    parts = [_grid(x1=left, x2=right, y=y(t), words=format_duration(t)) for t in ticks]
    parts += [draw_svg_text(x(t), bottom + 18, f"{t:g}", "dim", "middle") for t in across]
    parts.append(
        draw_svg_text(
            (left + right) / 2,
            bottom + 40,
            "the how-many-eth clip (logarithmic)",
            "dim",
            "middle",
        )
    )
    parts.append(_title_up((top + bottom) / 2, "time a clip (logarithmic)"))
    for condition, (values, first, slope) in found.items():
        dots = "".join(draw_svg_dot(x(n), y(s), 3.5) for n, s in enumerate(values, 1))
        end = first * len(values) ** slope
        line = draw_svg_line(x(1), y(first), x(len(values)), y(end), "wide")
        parts.append(f"<g class='{condition}'>{line}{dots}</g>")
        parts.append(
            draw_svg_text(x(len(values)) + 10, y(end) + 4, names[condition], f"label {condition}", "start")
        )
    return make_svg_drawing(height, parts, "Seconds a clip, from the first clip to the last")


COLUMNS = 4  # of a legend


def plot_stacked(rows: Mapping[str, Mapping[str, float]], names: Mapping[str, str]) -> str:
    """What the time went into, as one bar a condition, to scale; rows: condition -> part -> seconds."""
    row, left, right = 58, 20, 620
    most = max(sum(parts.values()) for parts in rows.values()) or 1.0
    kinds = list(dict.fromkeys(name for parts in rows.values() for name in parts))
    axis = 16 + row * len(rows)
    place, ticks = make_plain_axis(0, most, left, right, PLAIN_TIMES)
    out = []
    for t in ticks:
        out.append(draw_svg_line(place(t), 12, place(t), axis, "grid"))
        out.append(
            draw_svg_text(
                place(t), axis + 16, format_duration(t) if t else "0", "dim", "middle" if t < most else "end"
            )
        )
    for n, (condition, parts) in enumerate(rows.items()):
        at, total = 16 + row * n, sum(parts.values())
        out.append(
            draw_svg_text(
                left,
                at + 10,
                f"{names[condition]}: {format_duration(total)} a task",
                f"label {condition}",
                "start",
            )
        )
        edge = float(left)
        for name, value in parts.items():
            wide = place(value) - left
            words = escape(f"{name}: {format_duration(value)}, {value / total if total else 0:.0%}")
            out.append(
                f"<rect class='s{kinds.index(name)}' x='{format_px(edge)}' y='{at + 18}' "
                f"width='{format_px(wide)}' height='22'><title>{words}</title></rect>"
            )
            if wide > 34:
                out.append(
                    draw_svg_text(edge + wide / 2, at + 33, f"{value / total:.0%}", "inside", "middle")
                )
            edge += wide
    legend = axis + 34
    for k, name in enumerate(kinds):
        x, y = left + 150 * (k % COLUMNS), legend + 20 * (k // COLUMNS)
        out.append(f"<rect class='s{k}' x='{format_px(x)}' y='{format_px(y)}' width='12' height='12'/>")
        out.append(draw_svg_text(x + 18, y + 10, name, "dim", "start"))
    return make_svg_drawing(
        legend + 20 * ((len(kinds) - 1) // COLUMNS + 1) + 4, out, "What the time went into"
    )


def plot_means(
    rows: Sequence[tuple[str, Mapping[str, Estimate]]],
    low: float = 0.0,
    high: float = 100.0,
    title: str = "score, points of 100",
    names: Mapping[str, str] = {},
) -> str:
    """Means with their intervals on a plain axis, the conditions below each other. rows: (name, condition ->
    mean). title: of the axis. names: of the conditions, as a legend.
    """
    row, left, right = 46, 190, 560
    height, bottom = 24 + row * len(rows) + 44, 16 + row * len(rows)
    whole = (1.0, 2.0) if high - low <= 12 else ()  # points of a scale
    x, ticks = make_plain_axis(low, high, left, right, (*whole, *((high - low) / k for k in (5, 4, 2))))
    parts = [draw_svg_text((left + right) / 2, bottom + 38, title, "dim", "middle")]
    for k, condition in enumerate(dict.fromkeys(c for _, found in rows for c in found) if names else ()):
        parts.append(
            draw_svg_text(left - 14, bottom + 20 + 15 * k, names[condition], f"label {condition}", "end")
        )
    for t in ticks:
        parts.append(
            f"<line class='grid' x1='{format_px(x(t))}' x2='{format_px(x(t))}' y1='12' y2='{bottom}'/>"
        )
        parts.append(draw_svg_text(x(t), bottom + 18, f"{t:g}", "dim", "middle"))
    for n, (name, found) in enumerate(rows):
        at = 16 + row * (n + 0.5)
        parts.append(draw_svg_text(left - 14, at + 4, name, "label", "end"))
        for k, (condition, e) in enumerate(found.items()):
            y = at + (k - (len(found) - 1) / 2) * 14
            bar = (
                draw_svg_line(x(e.low), y, x(e.high), y, "wide")
                if e.low is not None and e.high is not None
                else ""
            )
            parts.append(f"<g class='{condition}'>{bar}{draw_svg_dot(x(e.value), y, 4.5)}</g>")
            parts.append(draw_svg_text(right + 14, y + 4, f"{e.value:.1f}", f"label {condition}", "start"))
    return make_svg_drawing(height, parts, "Means with their intervals")


# --- marks


def _grid(x1: float, x2: float, y: float, words: str) -> str:
    return f"{draw_svg_line(x1, y, x2, y, 'grid')}{draw_svg_text(x1 - 8, y + 4, words, 'dim', 'end')}"


def _title_up(y: float, words: str) -> str:
    """Return what a vertical axis shows, along it."""
    turned = f"transform='rotate(-90 14 {format_px(y)})'"
    return f"<text class='dim' {turned} x='14' y='{format_px(y)}' text-anchor='middle'>{escape(words)}</text>"


def _vertical(x: float, mean: Estimate, y: Place) -> str:
    bar = (
        draw_svg_line(x, y(mean.low), x, y(mean.high), "wide")
        if mean.low is not None and mean.high is not None
        else ""
    )
    return f"{bar}{draw_svg_dot(x, y(mean.value), 6)}"
