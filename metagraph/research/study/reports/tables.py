"""A study's data as CSV tables: a row a participant, a task, a clip, a mistake, an answer. Times in
seconds.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import isfinite
from typing import Any

from metagraph.common.csv_text import format_csv
from metagraph.research.study.analysis.reading import Data
from metagraph.research.study.analysis.results import Results
from metagraph.research.study.scores.machines import WORDS, Score
from metagraph.research.study.scores.tasks import OPERATORS, SPENT
from metagraph.research.study.statistics.small_samples import Estimate

MISSING = "n/a"  # as BIDS writes it


def study_tables(results: Results) -> dict[str, str]:
    """Return file name -> content."""
    data = results.data
    return {
        "participants.csv": format_rows(*tabulate_people(results)),
        "tasks.csv": format_rows(*tabulate_tasks(data)),
        "clips.csv": format_rows(*tabulate_clips(data)),
        "mistakes.csv": format_rows(*tabulate_mistakes(data)),
        "questionnaires.csv": format_rows(*tabulate_questionnaires(data)),
        "estimates.csv": format_rows(*tabulate_estimates(results)),
        "spent.csv": format_rows(*tabulate_spent(data)),
    }


def format_rows(columns: Sequence[str], rows: Iterable[Sequence[Any]], separator: str = ",") -> str:
    """Return rows as text; None is written as MISSING, numbers to six digits at most."""
    return format_csv([columns, *([format_cell(v) for v in row] for row in rows)], separator)


def format_cell(value: Any) -> str:
    """Return a value as text: MISSING for None and for what is not finite, yes or no, numbers to six
    digits.
    """
    if value is None:
        return MISSING
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        if not isfinite(value):
            return MISSING
        return f"{value:.6f}".rstrip("0").rstrip(".")
    return str(value)


Table = tuple[tuple[str, ...], list[tuple[Any, ...]]]


def tabulate_people(results: Results) -> Table:
    """Return a row for each participant: how far they came, their order, and their times."""
    data = results.data
    time = {p.participant: p for p in results.time.people} if results.time is not None else {}
    out: list[tuple[Any, ...]] = []
    for who in data.participants:
        mine = [r for r in data.rows if r.run.participant == who]
        person = time.get(who)
        order = "-".join(dict.fromkeys(r.run.condition for r in mine)) or None
        ratings = [
            next(
                (r.value for r in data.ratings if (r.participant, r.measure, r.condition) == (who, m, c)),
                None,
            )
            for m in ("SUS", "NASA-TLX, raw")
            for c in data.conditions
        ]
        taken = data.people.get(who)
        out.append(
            (
                who,
                taken.standing if taken is not None else None,
                (taken.first or None) if taken is not None else None,
                order,
                len(mine),
                sum(1 for r in mine if r.done),
                person and person.below,
                person and person.above,
                person and person.ratio,
                *ratings,
            )
        )
    rated = tuple(f"{m}_{c}" for m in ("sus", "tlx") for c in data.conditions)
    unit = results.time.unit if results.time is not None else data.unit
    end = "_a_clip" if unit == "clip" else ""  # another unit has another name
    where = ("site",) if data.sites else ()
    if where:
        out = [(*row[:1], data.sites.get(row[0]), *row[1:]) for row in out]
    return (
        "participant",
        *where,
        "standing",
        "first",
        "order",
        "tasks_begun",
        "tasks_done",
        f"meta_seconds{end}",
        f"manual_seconds{end}",
        "ratio",
        *rated,
    ), out


SCORES = (
    "precision",
    "recall",
    "f1",
    "right",
    "missing",
    "extra",
    "wrong",
    "essential",
    "essential_right",
    "states",
    "placed",
    "jumps",
)


def tabulate_tasks(data: Data) -> Table:
    """Return a row for each task that a participant did."""
    columns = (
        "participant",
        "condition",
        "task",
        "sitting",
        "index",
        "begun",
        "finished",
        "timed_out",
        "names",
        "seconds",
        "wall",
        "paused",
        "away",
        "longest_gap_seconds",
        "clips",
        "predicted_seconds",
        "edits",
        "undos",
        "errors",
        *OPERATORS,
        "drag_seconds",
        *(f"{s}_seconds" for s in SPENT),
        *SCORES,
        "correct",
    )
    rows: list[tuple[Any, ...]] = []
    for r in data.rows:
        t = r.run
        rows.append(
            (
                t.participant,
                t.condition,
                t.task,
                r.sitting,
                t.index,
                t.begun,
                t.finished,
                t.timed_out,
                t.names or None,
                t.seconds,
                t.wall,
                t.paused,
                t.away,
                max((g.seconds for g in r.gaps), default=0.0),
                r.clips,
                r.predicted,
                t.edits,
                t.undos,
                t.errors,
                *(t.operators[o] for o in OPERATORS),
                t.drag_s,
                *(t.spent[s] for s in SPENT),
                *_scores(r.score),
                None if r.score is None else r.correct,
            )
        )
    return columns, rows


def _scores(score: Score | None) -> tuple[Any, ...]:
    return tuple(None if score is None else getattr(score, name) for name in SCORES)


def tabulate_clips(data: Data) -> Table:
    """Return a row for each clip of each task, with the seconds it took."""
    rows: list[tuple[Any, ...]] = [
        (r.run.participant, r.run.condition, r.run.task, n, clip, seconds)
        for r in data.rows
        for n, (clip, seconds) in enumerate(r.run.per_clip.items(), 1)
    ]
    return ("participant", "condition", "task", "number", "clip", "seconds"), rows


def tabulate_mistakes(data: Data) -> Table:
    """Return a row for each kind of mistake in each task."""
    rows: list[tuple[Any, ...]] = [
        (r.run.participant, r.run.condition, r.run.task, WORDS[m.what], m.layer, m.clip, m.count, m.words)
        for r in data.rows
        for m in (r.score.mistakes if r.score is not None else ())
    ]
    return ("participant", "condition", "task", "mistake", "layer", "clip", "count", "words"), rows


def tabulate_questionnaires(data: Data) -> Table:
    """Return a row for each answer, and below them one for each score of a questionnaire."""
    rows: list[tuple[Any, ...]] = [
        (a.participant, a.condition, a.task, a.questionnaire, a.item, a.value) for a in data.answers
    ]
    totals: Mapping[str, str] = {"SUS": "sus", "NASA-TLX, raw": "tlx", "NASA-TLX, weighted": "tlx_weighted"}
    rows += [
        (r.participant, r.condition, None, totals[r.measure], "score", r.value)
        for r in data.ratings
        if r.measure in totals
    ]
    return ("participant", "condition", "task", "questionnaire", "item", "value"), rows


def tabulate_estimates(results: Results) -> Table:
    """Return the ratio as it is reported, by task, and computed otherwise."""
    rows: list[tuple[Any, ...]] = []

    def add(sort: str, name: str, e: Estimate, title: str | None = None) -> None:
        rows.append((sort, name, e.value, e.low, e.high, e.n, title))

    if results.time is not None:
        add("reported", "all tasks", results.time.ratio)
        for c, e in results.time.means.items():
            add("mean seconds", c, e)
    for task, e in results.by_task.items():
        add("task", task, e, results.data.tasks[task])
    for site, e in results.by_site.items():
        add("site", site, e)
    for names, e in results.by_names.items():
        add("names", names, e)
    if results.names_ratio is not None:
        add("names", "hidden over shown", results.names_ratio)
    for other in results.others:
        add("condition", other.pair[0], other.ratio)
    for way in results.sensitivity.ways if results.sensitivity is not None else ():
        add("otherwise", way.name, way.ratio)
    for c, curve in results.curves.items():
        add("practice, slope", c, curve.slope)
    for m in (*results.mistakes, *results.ratings):
        for c, e in m.means.items():
            add(m.name, c, e)
        if m.difference is not None:
            add(m.name, "difference", m.difference)
    return ("sort", "name", "value", "low", "high", "n", "title"), rows


def tabulate_spent(data: Data) -> Table:
    """What the time of each task went into."""
    rows: list[tuple[Any, ...]] = [
        (r.run.participant, r.run.condition, r.run.task, use, seconds)
        for r in data.rows
        for use, seconds in r.uses.items()
    ]
    return ("participant", "condition", "task", "use", "seconds"), rows
