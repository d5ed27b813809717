"""Who took part, as a diagram: from all that were planned to all that count, and where the others went."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from metagraph.common.svg import WIDTH, draw_svg_line, format_px, make_svg_drawing
from metagraph.common.xml_text import escape

WIDE, HIGH, GAP = 250, 44, 26


def plot_flow(
    steps: Sequence[tuple[str, int, Mapping[str, int]]], arms: Sequence[tuple[str, Sequence[tuple[str, int]]]]
) -> str:
    """Draw boxes from above to below, then side by side. steps: (words, people, why people left here -> how
    many);
    arms: (title, its boxes from above to below).
    """
    parts: list[str] = []
    y, centre = 10.0, WIDTH / 2 if not any(out for _, _, out in steps) else 200.0
    last: float | None = None
    for words, count, left in steps:
        lines = [f"{why}: {n}" for why, n in left.items()]
        parts += _box(centre, y, WIDE, [f"{words}: {count}"])
        if last is not None:
            parts.append(draw_svg_line(centre, last, centre, y, "edge"))
        last = y + HIGH
        if lines:
            high = 14 + 17 * len(lines)
            middle = last + GAP / 2 + high / 2 - 6
            parts += _box(WIDTH - 140, middle - high / 2, WIDE, lines, high)
            parts.append(draw_svg_line(centre, middle, WIDTH - 140 - WIDE / 2, middle, "edge"))
            y = middle + high / 2 + GAP / 2
        else:
            y = last + GAP
    wide = min(WIDE, (WIDTH - 20) / max(1, len(arms)) - 12)
    bottom = y
    if arms and last is not None:
        spots = [WIDTH * (n + 0.5) / len(arms) for n in range(len(arms))]
        parts.append(draw_svg_line(centre, last, centre, y - GAP / 4, "edge"))
        parts.append(
            draw_svg_line(min(*spots, centre), y - GAP / 4, max(*spots, centre), y - GAP / 4, "edge")
        )
        for x, (title, boxes) in zip(spots, arms, strict=True):
            at = y
            for n, (words, count) in enumerate(boxes):
                lines = [title, f"{words}: {count}"] if n == 0 else [f"{words}: {count}"]
                parts.append(draw_svg_line(x, at - (GAP / 4 if n == 0 else GAP), x, at, "edge"))
                high = 14 + 17 * len(lines)
                parts += _box(x, at, wide, lines, high)
                at += high + GAP
            bottom = max(bottom, at - GAP + 10)
    return make_svg_drawing(bottom + 4, parts, "Who took part")


def _box(x: float, y: float, wide: float, lines: Sequence[str], high: float = HIGH) -> list[str]:
    out = [
        f"<rect class='box' x='{format_px(x - wide / 2)}' y='{format_px(y)}' width='{format_px(wide)}' "
        f"height='{format_px(high)}' rx='4'/>"
    ]
    top = y + high / 2 - 17 * (len(lines) - 1) / 2 + 4
    for n, words in enumerate(lines):
        out.append(
            f"<text class='label' x='{format_px(x)}' y='{format_px(top + 17 * n)}' "
            f"text-anchor='middle'>{escape(words)}</text>"
        )
    return out
