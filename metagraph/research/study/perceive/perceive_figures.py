"""Drawings of a perceptual study's report, as SVG text with the classes of `research.study.reports.plots`."""

from __future__ import annotations

from collections.abc import Sequence

from metagraph.common.svg import draw_svg_dot, draw_svg_line, draw_svg_text, make_svg_drawing
from metagraph.research.study.perceive.perceive_analysis import PerceiveResults
from metagraph.research.study.reports import plots
from metagraph.research.study.reports.plots_flow import plot_flow
from metagraph.research.study.statistics.small_samples import Estimate

MOST_ROWS = 60  # of one drawing
LETTERS = 38  # of a name beside a row


def draw_perceive_figures(results: PerceiveResults) -> dict[str, tuple[str, str]]:
    """Return name -> drawing and caption."""
    plan = results.answers.study.plan
    out = {"participants": (_flow(results), "From all codes that were made to all who count.")}
    rows = [
        (f"{plan.name(c.pair[0])} / {plan.name(c.pair[1])}", c.best)
        for c in results.pairs
        if c.best is not None
    ]
    if rows:
        out["choices"] = (
            draw_shares(rows, "share of choices for the first of the two"),
            "Shares of all people and items together, with 95 % intervals; the line is no preference.",
        )
    for n, c in enumerate(results.pairs):
        if c.by_item and len(c.by_item) > 1:
            names = " / ".join(plan.name(x) for x in c.pair)
            out[f"items-{n + 1}"] = (
                draw_shares([*c.by_item.items()][:MOST_ROWS], f"{names}, by item"),
                f"{names}: shares by item, with exact 95 % intervals.",
            )
    for question, means in (results.means or {}).items():
        asked = next(
            q for q in (plan.rating.questions if plan.rating is not None else ()) if q.id == question
        )
        assert asked.scale is not None
        points = asked.scale.points
        out[f"ratings-{question}"] = (
            plots.plot_means(
                [(shorten_condition(plan.name(c)), {"manual": e}) for c, e in means.items()],
                float(points[0]),
                float(points[-1]),
                f"{points[0]} {asked.scale.left} … {points[-1]} {asked.scale.right}",
            ),
            f"{asked.text} Means of people's means, with 95 % intervals.",
        )
    return out


def shorten_condition(name: str) -> str:
    return name if len(name) <= LETTERS else f"{name[: LETTERS - 1]}…"


def draw_shares(rows: Sequence[tuple[str, Estimate]], title: str) -> str:
    """Return shares with their intervals, one below the other, on an axis of 0 to 100 % with a line at 50."""
    row, left, right = 34 if len(rows) < 6 else 24, 270, 500
    bottom = 18 + row * len(rows)

    def x(share: float) -> float:
        return left + (right - left) * share

    parts = []
    for t in (0.0, 0.25, 0.5, 0.75, 1.0):
        parts.append(draw_svg_line(x(t), 12, x(t), bottom, "one" if t == 0.5 else "grid"))
        parts.append(draw_svg_text(x(t), bottom + 18, f"{t:.0%}", "dim", "middle"))
    parts.append(draw_svg_text((left + right) / 2, bottom + 38, title, "dim", "middle"))
    for n, (name, e) in enumerate(rows):
        at = 18 + row * (n + 0.5)
        parts.append(draw_svg_text(left - 14, at + 4, shorten_condition(name), "label", "end"))
        words = f"{e.value:.0%}"
        bar = ""
        if e.low is not None and e.high is not None:
            bar = draw_svg_line(x(e.low), at, x(e.high), at, "wide")
            words += f"  [{e.low:.0%}, {e.high:.0%}]"
        parts.append(f"<g class='manual'>{bar}{draw_svg_dot(x(e.value), at, 5)}</g>")
        parts.append(draw_svg_text(right + 12, at + 4, words, "label", "start"))
    return make_svg_drawing(bottom + 48, parts, title)


def _flow(results: PerceiveResults) -> str:
    people = results.answers.people
    begun = [p for p in people if p.standing != "not begun"]
    left: dict[str, int] = {}
    for p in begun:
        if p.why and p.why != "missed checks":
            left[p.why] = left.get(p.why, 0) + 1
    whole = [p for p in begun if p.why in ("", "missed checks")]
    missed = len(whole) - len(results.answers.counting)
    return plot_flow(
        [
            (
                "codes",
                len(people),
                {"not begun": len(people) - len(begun)} if len(people) > len(begun) else {},
            ),
            ("begun", len(begun), left),
            ("to the end", len(whole), {"missed checks": missed} if missed else {}),
            ("count", len(results.answers.counting), {}),
        ],
        [],
    )
