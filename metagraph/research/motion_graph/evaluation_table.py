"""An evaluation of searches as a table to read, and as values to compute with."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import astuple, fields
from statistics import fmean

from metagraph.common.csv_text import format_csv
from metagraph.research.motion_graph.search_evaluation import Evaluation, HeldOutCase


def format_cases_as_csv(cases: Sequence[HeldOutCase]) -> str:
    """Return cases as comma-separated values, a line each, under a line of names."""
    rows = (
        [round(v, 6) if isinstance(v, float) else int(v) if isinstance(v, bool) else v for v in astuple(case)]
        for case in cases
    )
    return format_csv([[f.name for f in fields(HeldOutCase)], *rows])


def format_cases_as_text(evaluation: Evaluation) -> str:
    """Return rows as a table in text."""
    return "\n".join(_lines(evaluation))


def _lines(evaluation: Evaluation) -> Iterator[str]:
    graphs = evaluation.graphs
    if graphs:
        yield (
            f"{len(graphs)} graphs, each without one take: {fmean(g.states for g in graphs):,.0f} states, "
            f"{fmean(g.kept / g.states for g in graphs):.0%} kept, "
            f"{fmean(g.transitions for g in graphs):,.0f} transitions, "
            f"built in {fmean(g.seconds for g in graphs):.2f} s (means)"
        )
    yield (
        f"{'constraints':<20}{'search':<8}{'found':>9}{'success':>9}  "
        f"{'95 %':<14}{'median':>9}{'jumps/s':>9}{'cost':>9}{'again':>7}{'rest':>7}"
    )
    for r in evaluation.rows:
        interval = f"{r.low:.0%} to {r.high:.0%}"
        yield (
            f"{r.setting:<20}{r.search:<8}{f'{r.found}/{r.cases}':>9}{r.success:>9.1%}  "
            f"{interval:<14}{1000 * r.seconds:>6.0f} ms"
            f"{r.per_second:>9.2f}{r.cost:>9.3g}{r.repeated:>7.0%}{r.rest:>5.1f} s"
        )
    yield from _beside(evaluation)
    if not evaluation.whole:
        yield "It was cancelled: these are the cases until then."


def _beside(evaluation: Evaluation) -> Iterator[str]:
    """Yield what became of a wish beside the constraints, setting by setting."""
    for r in evaluation.rows:
        parts = [
            f"{words} {value:.2f} spreads off"
            for words, value in (("loudness", r.loudness), ("rate", r.pace))
            if value is not None
        ]
        if r.words is not None:
            parts.append(f"{r.words:.0%} of words met")
        if r.off is not None and r.was is not None:
            parts.append(f"events {1000 * r.off:.0f} ms off, {1000 * r.was:.0f} before retiming")
        if parts:
            yield f"{r.setting}, {r.search}: {', '.join(parts)}"
