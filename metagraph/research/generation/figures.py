"""Figures 6 to 8 of the paper as SVG text: how far landmarks are from the mean pose over time and altogether,
poses drawn over each other, and how fast that distance changes while oneself and while the partner speaks.

Classes: `s0`..`s4` the systems, `mark0`..`mark3` kinds of landmarks, `bones` a pose; `grid`, `dim`, `label`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.svg import WIDTH, draw_svg_line, draw_svg_text, format_px, make_svg_drawing
from metagraph.generation.landmarks import LANDMARKS
from metagraph.generation.networks import FPS
from metagraph.generation.statistics import MotionSample

Array = NDArray[Any]

LONGEST = 300.0  # seconds that are drawn
SYSTEMS = 5  # that have a colour of their own
_KIND = ("wrist", "elbow", "head nose", "sternum shoulder")  # landmarks of one colour
# What a page colours these drawings with, beside `research.study.reports.style`.
STYLE = """
.box polygon { stroke: var(--text); stroke-width: .5; }
.box .median { stroke: var(--inside); stroke-width: 1.5; }
.box .whisker { stroke: var(--dim); } .box .beyond { opacity: .5; }
polyline { fill: none; stroke-width: .8; } .bones path { fill: none; stroke-width: .6; stroke-opacity: .12; }
.mark0 { stroke: var(--s0); } .mark1 { stroke: var(--s2); }
.mark2 { stroke: var(--s3); } .mark3 { stroke: var(--s4); }
.fill0 { fill: var(--s0); } .fill1 { fill: var(--s2); }
.fill2 { fill: var(--s3); } .fill3 { fill: var(--s4); }
.line0 path { stroke: var(--s0); } .line1 path { stroke: var(--s1); } .line2 path { stroke: var(--s2); }
.line3 path { stroke: var(--s3); } .line4 path { stroke: var(--s4); }
"""
_NAMES = ("wrists", "elbows", "head, nose", "sternum, shoulders")
_BONES = ((0, 1), (0, 2), (1, 3), (3, 5), (2, 4), (4, 6), (0, 7), (7, 8))
_EVERY = 5  # frames between two points of a line
_LEFT, _RIGHT = 46, 626


def measure_landmark_distances(motion: Sequence[MotionSample], mean: Array) -> Array:
    """Return how far each landmark is from its mean `[T, 9]`, cm. mean: `[9, 3]` metres."""
    return np.concatenate([np.linalg.norm(m.landmarks - mean, axis=-1) for m in motion]) * 100


def measure_distance_changes(motion: Sequence[MotionSample], mean: Array, who: int) -> Array:
    """Return how fast those distances grow `[n, 9]`, cm/s, where somebody (`SELF`, `PARTNER`) speaks."""
    rows = []
    for m in motion:
        grown = np.diff(np.linalg.norm(m.landmarks - mean, axis=-1), axis=0) * (FPS * 100)
        rows.append(grown[m.activity[1:, who] > 0.5])
    return np.concatenate(rows)


def draw_over_time(motion: MotionSample, mean: Array, most: float | None = None) -> str:
    """Draw the distance of each landmark from its mean. most: cm, what the axis ends at."""
    far = measure_landmark_distances([motion.part(0, round(LONGEST * FPS))], mean)
    top, bottom, height = 12, 190, 236
    most = max(float(far.max()), 1.0) if most is None else most
    seconds = max(len(far) / FPS, 1.0)
    parts = _across(0.0, most, top, bottom, "cm")
    for t in _ticks(0.0, seconds):
        x = _LEFT + (_RIGHT - _LEFT) * t / seconds
        parts.append(draw_svg_text(x, bottom + 16, f"{t:g} s", "dim", "middle"))
    for n in reversed(range(len(LANDMARKS))):
        # The largest of each few frames: peaks stay, and the file is small.
        values = [far[k : k + _EVERY, n].max() for k in range(0, len(far), _EVERY)]
        points = " ".join(
            f"{format_px(_LEFT + (_RIGHT - _LEFT) * k * _EVERY / FPS / seconds)},"
            f"{format_px(_place(v, 0.0, most, top, bottom))}"
            for k, v in enumerate(values)
        )
        parts.append(f"<polyline class='mark{_kind(LANDMARKS[n])}' points='{points}'/>")
    at = float(_LEFT)
    for n, name in enumerate(_NAMES):
        parts.append(f"<rect class='fill{n}' x='{format_px(at)}' y='{height - 22}' width='12' height='12'/>")
        parts.append(draw_svg_text(at + 18, height - 12, name, "dim", "start"))
        at += 130
    return make_svg_drawing(height, parts, "Distance of landmarks from the mean pose over time")


def draw_boxes(systems: Mapping[str, Array], unit: str) -> str:
    """Draw a notched box of each system and landmark: quartiles, whiskers to the furthest value within 1.5 of
    their range, dots for what is beyond; notches 1.57 ranges over the root of the count about the median.
    systems: name -> values `[n, 9]`.
    """
    shown = {name: v for name, v in list(systems.items())[:SYSTEMS] if len(v) > 1}
    if not shown:
        return make_svg_drawing(
            40, [draw_svg_text(WIDTH / 2, 24, "nothing to draw", "dim", "middle")], "Nothing to draw"
        )
    top, bottom, height = 12, 260, 330
    low = min(0.0, *(float(v.min()) for v in shown.values()))
    high = max(1.0, *(float(v.max()) for v in shown.values()))
    parts = _across(low, high, top, bottom, unit)
    slot = (_RIGHT - _LEFT) / len(LANDMARKS)
    wide = min(14.0, slot * 0.8 / len(shown))
    for n, landmark in enumerate(LANDMARKS):
        middle = _LEFT + slot * (n + 0.5)
        side, _, part = landmark.rpartition("_")
        parts.append(draw_svg_text(middle, bottom + 16, part, "dim", "middle"))
        parts.append(draw_svg_text(middle, bottom + 30, side, "dim", "middle"))
        for k, values in enumerate(shown.values()):
            x = middle + (k - (len(shown) - 1) / 2) * wide * 1.15
            parts.append(f"<g class='box s{k}'>{_box(values[:, n], x, wide, low, high, top, bottom)}</g>")
    at = float(_LEFT)
    for k, name in enumerate(shown):
        parts.append(f"<rect class='s{k}' x='{format_px(at)}' y='{height - 18}' width='12' height='12'/>")
        parts.append(draw_svg_text(at + 18, height - 8, name[:16], "dim", "start"))
        at += 116
    return make_svg_drawing(height, parts, f"Notched boxes of each landmark, {unit}")


def compute_box_plot(values: Array) -> tuple[float, float, float, float, float, Array]:
    """Return lower whisker, first quartile, median, third quartile, upper whisker, and what lies beyond."""
    first, middle, third = (float(q) for q in np.percentile(values, (25, 50, 75)))
    reach = 1.5 * (third - first)
    inside = values[(values >= first - reach) & (values <= third + reach)]
    beyond = values[(values < first - reach) | (values > third + reach)]
    return float(inside.min()), first, middle, third, float(inside.max()), beyond


def _box(values: Array, x: float, wide: float, low: float, high: float, top: float, bottom: float) -> str:
    least, first, middle, third, most, beyond = compute_box_plot(values)
    notch = 1.57 * (third - first) / np.sqrt(len(values))

    def y(value: float) -> float:
        return _place(value, low, high, top, bottom)

    half, waist = wide / 2, wide / 4
    ends = [y(v) for v in (first, max(first, middle - notch), middle, min(third, middle + notch), third)]
    right = list(zip((half, half, waist, half, half), ends, strict=True))
    outline = [(x + w, v) for w, v in right] + [(x - w, v) for w, v in reversed(right)]
    points = " ".join(f"{format_px(a)},{format_px(b)}" for a, b in outline)
    parts = [
        f"<polygon points='{points}'/>",
        draw_svg_line(x - waist, y(middle), x + waist, y(middle), "median"),
    ]
    parts += [draw_svg_line(x, y(a), x, y(b), "whisker") for a, b in ((least, first), (third, most))]
    # What would be drawn at the same place is drawn once.
    for at in sorted({round(y(float(v))) for v in beyond}):
        parts.append(f"<circle class='beyond' cx='{format_px(x)}' cy='{at}' r='0.8'/>")
    return "".join(parts)


def draw_overlaid(motion: Mapping[str, MotionSample]) -> str:
    """Draw the poses of each system over each other, from the front, one a second."""
    some = {
        name: m.landmarks[: round(LONGEST * FPS) : round(FPS)] for name, m in list(motion.items())[:SYSTEMS]
    }
    across = np.concatenate([p[:, 1] - p[:, 2] for p in some.values()]).mean(0) * [1, 0, 1]
    across = across / max(float(np.linalg.norm(across)), 1e-9)
    shown = {name: np.stack([p @ across, p[..., 1]], -1) for name, p in some.items()}
    every = np.concatenate(list(shown.values()))
    middle = float(np.median(every[..., 0]))
    reach = max(float(np.abs(every[..., 0] - middle).max()), 0.2)
    low, high = float(every[..., 1].min()), float(every[..., 1].max())
    each = WIDTH / max(1, len(shown))
    scale = min(each * 0.46 / reach, 260 / max(high - low, 0.2))
    height = scale * (high - low) + 46
    parts = []
    for k, (name, poses) in enumerate(shown.items()):
        centre = each * (k + 0.5)
        lines = []
        for places in poses:
            at = [(centre + (p[0] - middle) * scale, 12 + (high - p[1]) * scale) for p in places]
            lines.append(
                "".join(
                    f"M{format_px(x)} {format_px(y)}L{format_px(to_x)} {format_px(to_y)}"
                    for (x, y), (to_x, to_y) in ((at[a], at[b]) for a, b in _BONES)
                )
            )
        parts.append(f"<g class='bones line{k}'>{''.join(f'<path d={d!r}/>' for d in lines)}</g>")
        parts.append(draw_svg_text(centre, height - 12, name, "label", "middle"))
    return make_svg_drawing(height, parts, "Poses drawn over each other, one a second")


def _kind(landmark: str) -> int:
    return next(n for n, words in enumerate(_KIND) if landmark.rpartition("_")[2] in words.split())


def _place(value: float, low: float, high: float, top: float, bottom: float) -> float:
    return bottom - (bottom - top) * (min(max(value, low), high) - low) / max(high - low, 1e-9)


def _ticks(low: float, high: float) -> list[float]:
    step = 10.0 ** np.floor(np.log10(max(high - low, 1e-9)))
    step = next(s for s in (step / 5, step / 2, step, step * 2) if (high - low) / s <= 7)
    return [round(k * step, 9) for k in range(int(np.ceil(low / step)), int(np.floor(high / step)) + 1)]


def _across(low: float, high: float, top: float, bottom: float, unit: str) -> list[str]:
    """Draw lines across with their values."""
    out = []
    for t in _ticks(low, high):
        y = _place(t, low, high, top, bottom)
        out += [
            draw_svg_line(_LEFT, y, _RIGHT, y, "grid"),
            draw_svg_text(_LEFT - 6, y + 4, f"{t:g}", "dim", "end"),
        ]
    return [*out, draw_svg_text(_LEFT + 4, top + 2, unit, "dim", "start")]
