"""Drawings of exhibits as SVG. Classes: `paper` what was published, `ours` what was made here, `s0`..`s10`
any other, coloured by the page.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite

from metagraph.common.svg import (
    WIDTH,
    draw_svg_dot,
    draw_svg_line,
    draw_svg_text,
    format_px,
    make_svg_drawing,
)
from metagraph.common.xml_text import escape
from metagraph.research.study.reports.plot_axes import RATIOS, Place, log_axis, make_plain_axis

Axis = tuple[Place, list[float]]
Bar = tuple[str, float, float | None, float | None]  # class, value, ends of its interval
Stretch = tuple[str, float, float, str]  # class, start, end, words

LEFT, RIGHT, TOP, BOTTOM = 76.0, 616.0, 14.0, 250.0
DOTTED = 40  # points of a line that are shown one by one
STEPS = tuple(m * 10.0**e for e in range(-5, 9) for m in (1, 2, 2.5, 5))


def draw_rect(css: str, x: float, y: float, wide: float, high: float, words: str = "") -> str:
    """Return a rectangle. words: shown under the pointer."""
    told = f"<title>{escape(words)}</title>" if words else ""
    size = f"width='{format_px(max(0.0, wide))}' height='{format_px(max(0.0, high))}'"
    shape = f"x='{format_px(x)}' y='{format_px(y)}' {size}"
    return f"<rect class='{css}' {shape}>{told}</rect>"


def draw_polyline(css: str, points: Sequence[tuple[float, float]]) -> str:
    """Return a line through points."""
    at = " ".join(f"{format_px(x)},{format_px(y)}" for x, y in points)
    return f"<polyline class='curve {css}' points='{at}'/>"


def draw_legend(names: Sequence[tuple[str, str]], y: float) -> list[str]:
    """Return squares with words beside them, in a line. names: class and words."""
    out, x = [], LEFT
    for css, words in names:
        out += [draw_rect(css, x, y, 12, 12), draw_svg_text(x + 18, y + 10, words, "dim", "start")]
        x += 40 + 6.6 * len(words)
    return out


def draw_series(
    series: Mapping[str, tuple[str, Sequence[tuple[float, float]]]],
    across: str,
    up: str,
    title: str,
    logs: bool = False,
) -> str:
    """Draw values over values, joined. series: words -> class and points. logs: both axes logarithmic."""
    every = [p for _, points in series.values() for p in points if all(isfinite(v) for v in p)]
    if not every:
        return draw_nothing(title)
    axis = _logs if logs else _plain
    xs, ys = [p[0] for p in every], [p[1] for p in every]
    x, x_ticks = axis(min(xs) if logs else min(0.0, *xs), max(xs), LEFT, RIGHT)
    y, y_ticks = axis(min(ys) if logs else min(0.0, *ys), max(ys), BOTTOM, TOP)
    parts = _frame(x, x_ticks, y, y_ticks, across, up)
    for css, points in series.values():
        placed = [(x(a), y(b)) for a, b in points if isfinite(a) and isfinite(b)]
        parts.append(draw_polyline(css, placed))
        if len(placed) <= DOTTED:
            parts += [f"<g class='{css}'>{draw_svg_dot(a, b, 3)}</g>" for a, b in placed]
    parts += draw_legend([(css, words) for words, (css, _) in series.items()], BOTTOM + 48)
    return make_svg_drawing(BOTTOM + 68, parts, title)


def draw_histogram(
    bars: Sequence[tuple[float, float, float]],
    curve: Sequence[tuple[float, float]],
    mark: tuple[float, str] | None,
    across: str,
    title: str,
) -> str:
    """Draw densities as bars (from, to, height), a curve over them, and a mark on the axis."""
    if not bars:
        return draw_nothing(title)
    most = max(h for _, _, h in bars)
    x, x_ticks = _plain(0.0, bars[-1][1], LEFT, RIGHT)
    y, y_ticks = _plain(0.0, most, BOTTOM, TOP)
    parts = _frame(x, x_ticks, y, y_ticks, across, "density")
    parts += [draw_rect("ours", x(a), y(h), x(b) - x(a) - 0.5, BOTTOM - y(h)) for a, b, h in bars]
    parts.append(draw_polyline("ink", [(x(a), y(min(b, most))) for a, b in curve]))
    if mark is not None:
        parts += [draw_svg_line(x(mark[0]), TOP, x(mark[0]), BOTTOM, "one")]
        parts.append(draw_svg_text(x(mark[0]) + 5, TOP + 12, mark[1], "dim", "start"))
    return make_svg_drawing(BOTTOM + 46, parts, title)


def draw_paired_bars(
    rows: Sequence[tuple[str, Sequence[Bar]]],
    names: Sequence[tuple[str, str]],
    across: str,
    title: str,
    most: float | None = None,
    one: float | None = None,
) -> str:
    """Draw bars under each other. rows: words -> class, value, and ends of an interval or None. names: class
    and words of the legend. most: end of the axis. one: where a dashed line stands.
    """
    left, high = 210.0, 16
    known = [v for _, bars in rows for _, *vs in bars for v in vs if v is not None and isfinite(v)]
    if not known:
        return draw_nothing(title)
    x, ticks = _plain(0.0, max(known) if most is None else most, left, RIGHT - 40)
    parts, at = [], TOP
    body = []
    for words, bars in rows:
        middle = at + high * len(bars) / 2
        body.append(draw_svg_text(left - 12, middle + 4, words, "label", "end"))
        for css, value, low, top in bars:
            if isfinite(value):
                body.append(draw_rect(css, left, at + 2, x(value) - left, high - 4, f"{value:.4g}"))
                if low is not None and top is not None:
                    body.append(draw_svg_line(x(low), at + high / 2, x(top), at + high / 2, "edge"))
                end = max(x(value), x(top) if top is not None else 0.0)
                body.append(draw_svg_text(end + 6, at + high / 2 + 4, f"{value:.3g}", "dim", "start"))
            at += high
        at += 10
    for t in ticks:
        parts += [
            draw_svg_line(x(t), TOP, x(t), at, "grid"),
            draw_svg_text(x(t), at + 16, f"{t:g}", "dim", "middle"),
        ]
    if one is not None:
        parts.append(draw_svg_line(x(one), TOP, x(one), at, "one"))
    parts += [
        *body,
        draw_svg_text((left + RIGHT) / 2, at + 34, across, "dim", "middle"),
        *draw_legend(names, at + 44),
    ]
    return make_svg_drawing(at + 64, parts, title)


def draw_spans(rows: Sequence[tuple[str, Sequence[Stretch]]], seconds: float, title: str) -> str:
    """Draw stretches of time under each other. rows: words -> class, start, end, words of each stretch."""
    left, high, gap = 150.0, 22, 10
    x, ticks = _plain(0.0, seconds, left, RIGHT)
    bottom = TOP + len(rows) * (high + gap)
    parts = []
    for t in ticks:
        parts += [
            draw_svg_line(x(t), TOP, x(t), bottom, "grid"),
            draw_svg_text(x(t), bottom + 16, f"{t:g} s", "dim", "middle"),
        ]
    for n, (words, stretches) in enumerate(rows):
        at = TOP + n * (high + gap)
        parts.append(draw_svg_text(left - 12, at + 15, words, "label", "end"))
        for css, a, b, told in stretches:
            parts.append(
                draw_rect(css, x(a), at, max(2.0, x(b) - x(a) - 1), high, f"{told}: {a:.2f} to {b:.2f} s")
            )
            if len(told) * 6.5 < x(b) - x(a):
                parts.append(draw_svg_text((x(a) + x(b)) / 2, at + 15, told, "inside", "middle"))
    return make_svg_drawing(bottom + 26, parts, title)


def draw_heat(
    names: Sequence[str], grids: Mapping[str, tuple[str, Sequence[Sequence[float]]]], title: str
) -> str:
    """Draw matrices of shares, 0..1, beside each other. grids: words -> class and rows."""
    wide = (WIDTH - 60) / len(grids)
    cell = min(28.0, (wide - 60) / max(1, len(names)))
    parts = []
    for k, (words, (css, rows)) in enumerate(grids.items()):
        left = 54 + k * wide
        parts.append(draw_svg_text(left + cell * len(names) / 2, 14, words, "label", "middle"))
        for i, row in enumerate(rows):
            parts.append(
                draw_svg_text(left - 6, 46 + cell * (i + 0.65), names[i].replace(" ", ""), "dim", "end")
            )
            for j, share in enumerate(row):
                told = f"{names[i]} then {names[j]}: {share:.1%}"
                box = draw_rect(css, left + cell * j, 46 + cell * i, cell - 1, cell - 1, told)
                parts.append(f"<g opacity='{0.06 + 0.94 * min(1.0, share):.2f}'>{box}</g>")
        for j, name in enumerate(names):
            parts.append(draw_svg_text(left + cell * (j + 0.5), 40, name.replace(" ", ""), "small", "middle"))
    return make_svg_drawing(60 + cell * len(names), parts, title)


def draw_nothing(title: str) -> str:
    """Return a drawing that says that there is nothing to draw."""
    return make_svg_drawing(40, [draw_svg_text(WIDTH / 2, 24, "nothing to draw", "dim", "middle")], title)


def _plain(low: float, high: float, start: float, end: float) -> Axis:
    high = high if high > low else low + 1.0
    return make_plain_axis(low, high, start, end, STEPS)


def _logs(low: float, high: float, start: float, end: float) -> Axis:
    return log_axis(low, high, start, end, RATIOS)


def _frame(
    x: Place, x_ticks: Sequence[float], y: Place, y_ticks: Sequence[float], across: str, up: str
) -> list[str]:
    parts = []
    for t in y_ticks:
        parts += [
            draw_svg_line(LEFT, y(t), RIGHT, y(t), "grid"),
            draw_svg_text(LEFT - 8, y(t) + 4, f"{t:,.6g}", "dim", "end"),
        ]
    for t in x_ticks:
        parts.append(draw_svg_text(x(t), BOTTOM + 18, f"{t:,.6g}", "dim", "middle"))
    parts.append(draw_svg_text((LEFT + RIGHT) / 2, BOTTOM + 38, across, "dim", "middle"))
    middle = (TOP + BOTTOM) / 2
    turned = f"transform='rotate(-90 14 {format_px(middle)})'"
    parts.append(
        f"<text class='dim' {turned} x='14' y='{format_px(middle)}' text-anchor='middle'>{escape(up)}</text>"
    )
    return parts
