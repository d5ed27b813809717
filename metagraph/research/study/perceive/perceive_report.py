"""The report of a perceptual study: one HTML page that needs nothing beside it, tables as CSV, figures as
files. The same answers give the same bytes.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from metagraph.common.xml_text import escape
from metagraph.formats.atomic import write_together
from metagraph.research.study.perceive.perceive_analysis import ComparedPair, PerceiveResults
from metagraph.research.study.perceive.perceive_figures import draw_perceive_figures
from metagraph.research.study.reports.cells import (
    format_cells,
    format_interval,
    format_p_value,
    format_two_digits,
    make_figure,
)
from metagraph.research.study.reports.figure_files import make_standalone_svg
from metagraph.research.study.reports.style import STYLE
from metagraph.research.study.reports.tables import Table
from metagraph.research.study.reports.tables import format_rows as csv_of
from metagraph.research.study.statistics.distributions import describe_software
from metagraph.research.study.statistics.small_samples import Estimate

NAME = "report.html"

METHODS = """<dl>
<dt>Exact binomial</dt><dd>All answers to a pair against a half; two-sided, by what is at most as likely;
intervals by Clopper and Pearson (1934). It takes answers for independent. Those of one person, and about one
item, are not: where people or items differ it claims too much.</dd>
<dt>People</dt><dd>Each counts once, for what they chose more often; who chose both as often is left out
(sign test).</dd>
<dt>Mixed model</dt><dd>Log odds of a choice by a preference and by the side, with deviations of people and
items that cross; likelihood by Laplace's approximation, intervals from its curvature, degrees of freedom by
Satterthwaite's formula. Its share is that of all people and items together. This is what is judged by, where
there is a model.</dd>
<dt>Ratings</dt><dd>Differences of the same person's ratings of the same item in two conditions, by a linear
mixed model with deviations of people and items that cross (restricted maximum likelihood); without one, by
people's means.</dd>
<dt>Tests</dt><dd>One for each pair, of choices and of each question; Holm's correction over all of them.</dd>
<dt>Systems beside each other</dt><dd>If the study asks which sound belongs to a motion: of each two
systems, the difference of the log odds of choosing the own sound in their mixed models, with Welch's degrees
of freedom; Holm's correction over these differences.</dd>
<dt>Order</dt><dd>Shares in the first and in the second half of each person's session, compared by Fisher's
exact test. Sides: all choices of the left one against a half.</dd>
<dt>Who counts</dt><dd>Who came to the end and missed no more checks than the plan allows. What would come of
it with nobody excluded, but without those who withdrew, is told beside.</dd></dl>"""


def write_perceive_report(results: PerceiveResults, folder: Path) -> list[Path]:
    """Write the page, the tables and the figures into a folder; return what was written, the page first.
    Raises FileError.
    """
    drawn = draw_perceive_figures(results)
    content = {NAME: format_perceive_page(results).encode()}
    content |= {name: csv_of(*rows).encode() for name, rows in perceive_tables(results).items()}
    content |= {f"figures/{name}.svg": make_standalone_svg(d).encode() for name, (d, _) in drawn.items()}
    return write_together(folder, content)


def summarise_perceive(results: PerceiveResults) -> list[str]:
    """Return the findings as sentences."""
    plan, out = results.answers.study.plan, []
    for c in results.pairs:
        out.append(_said(c, plan.name(c.pair[0]), plan.name(c.pair[1]), plan.smallest))
    for r in results.rated:
        a, b = (plan.name(x) for x in r.pair)
        higher = "higher" if r.difference.value > 0 else "lower"
        sure = r.together is not None and r.together < 0.05
        tail = f"{_points(r.difference)}, {_plain(r.together)} together"
        out.append(
            f"{r.question}: {a} was rated {abs(r.difference.value):.2f} points {higher} than {b} ({tail})"
            + ("." if sure else "; these answers do not show that it is so in general.")
        )
    for s in results.systems:
        a, b = s.systems if s.better != s.systems[1] else s.systems[::-1]
        tail = f"{_plain(s.together)} together"
        out.append(
            f"{a}'s motion goes with its sound more visibly than {b}'s ({tail})."
            if s.better
            else f"{a} and {b}: these answers do not show whose motion goes better with its sound ({tail})."
        )
    return out or ["Nobody has answered yet."]


def _said(c: ComparedPair, a: str, b: str, smallest: float | None) -> str:
    best = c.best
    if best is None:
        return f"{a} and {b}: no answers count."
    told = f"{a} was chosen over {b} in {best.value:.0%} ({_between(best)}, {_plain(c.together)} together)"
    if c.verdict in ("preferred", "not preferred"):
        return f"{told}: {a if c.verdict == 'preferred' else b} is preferred."
    if c.verdict == "no difference that matters":
        return f"{told}: no difference that matters, which is {smallest:.0%} and more."
    return f"{told}: these answers do not show which is preferred, nor that neither is."


def _plain(p: float | None) -> str:
    return format_p_value(p).replace("&lt;", "<")


def _between(e: Estimate) -> str:
    return "no interval" if e.low is None or e.high is None else f"95 % interval {e.low:.0%} to {e.high:.0%}"


def _points(e: Estimate) -> str:
    return "no interval" if e.low is None or e.high is None else f"95 % interval {e.low:.2f} to {e.high:.2f}"


# --- the page


def format_perceive_page(results: PerceiveResults) -> str:
    """Return the page."""
    plan = results.answers.study.plan
    drawn = {n: make_figure(n, d, words, {}) for n, (d, words) in draw_perceive_figures(results).items()}
    parts = [
        f"<h1>{escape(plan.title)}</h1>",
        "<p class='warn'>Nobody took part: these answers were simulated.</p>"
        if results.answers.simulated
        else "",
        "<div class='card'>"
        + "".join(
            f"<p class='{'big' if n == 0 else ''}'>{escape(w)}</p>"
            for n, w in enumerate(summarise_perceive(results))
        )
        + "</div>",
        _list(results.cautions, "card warn"),
        _choices(results, drawn),
        _systems(results),
        _ratings(results, drawn),
        _sides(results),
        _people(results, drawn),
        _claims(results),
        f"<h2>How it was reckoned</h2>{METHODS}<p>{describe_software()}</p>",
    ]
    head = (
        "<meta charset='utf-8'><meta name='viewport' content='width=device-width'>"
        "<link rel='icon' href='data:,'>"
        f"<title>{escape(plan.title)}: report</title><style>{STYLE}</style>"
    )
    body = "\n".join(filter(None, parts))
    return f"<!doctype html>\n<html lang='en'><head>{head}</head><body>\n{body}\n</body></html>\n"


def _list(words: tuple[str, ...], css: str = "") -> str:
    if not words:
        return ""
    return f"<div class='{css}'><ul>{''.join(f'<li>{escape(w)}</li>' for w in words)}</ul></div>"


def _percent(value: float) -> str:
    return f"{value:.1%}"


def _choices(results: PerceiveResults, drawn: Mapping[str, str]) -> str:
    if not results.pairs:
        return ""
    plan = results.answers.study.plan
    rows, people, models, items = [], [], [], []
    for n, c in enumerate(results.pairs):
        names = escape(f"{plan.name(c.pair[0])} / {plan.name(c.pair[1])}")
        count = "" if c.share is None else f"{round(c.share.value * c.share.n)} of {c.share.n}"
        rows.append(
            [
                names,
                format_interval(c.model.share if c.model else None, _percent),
                format_p_value(c.alone),
                format_p_value(c.together),
                f"{count} {format_interval(c.share, _percent)}",
                f"{format_p_value(c.p)}; {format_p_value(c.exact)} together",
            ]
        )
        spread = "no model"
        if c.model is not None:
            d = c.model.deviations
            spread = f"people {d['participants']:.2f}, items {d['items']:.2f}"
        side = c.model.effects.get("side") if c.model else None
        people.append(
            [
                names,
                format_interval(c.people, _percent)
                + (f" of {c.people.n}, {format_p_value(c.people_p)}" if c.people else ""),
                f"{c.halves[0].value:.0%}, {c.halves[1].value:.0%}; {format_p_value(c.halves_p)}"
                if c.halves
                else "",
                format_interval(c.unfiltered, _percent),
            ]
        )
        models.append(
            [
                names,
                format_interval(c.model.effects["preference"] if c.model else None, format_two_digits),
                spread,
                format_interval(side, format_two_digits),
            ]
        )
        items.append(drawn.get(f"items-{n + 1}", ""))
    out = "<h2>Choices</h2>" + drawn.get("choices", "")
    out += format_cells(
        (
            "first / second",
            "mixed model: share of the first",
            "alone",
            "together",
            "answers",
            "exact binomial",
        ),
        rows,
    )
    out += format_cells(
        ("", "people who chose the first more often", "first, second half", "nobody excluded"), people
    )
    out += format_cells(("mixed model", "log odds", "deviations", "gain of the left side"), models)
    return out + "<h3>By item</h3>" + "".join(items)


def _systems(results: PerceiveResults) -> str:
    if not results.systems:
        return ""
    rows = [
        [
            escape(f"{s.systems[0]} less {s.systems[1]}"),
            format_interval(s.difference, format_two_digits),
            format_p_value(s.p),
            format_p_value(s.together),
            escape(s.better or "not shown"),
        ]
        for s in results.systems
    ]
    words = "<p>How much better the own sound is recognised with one system's motion than with another's.</p>"
    columns = ("systems", "difference, log odds", "alone", "together", "goes better with its sound")
    return f"<h2>Systems beside each other</h2>{words}{format_cells(columns, rows)}"


def _ratings(results: PerceiveResults, drawn: Mapping[str, str]) -> str:
    if not results.means:
        return ""
    plan = results.answers.study.plan
    out = "<h2>Ratings</h2>" + "".join(d for n, d in drawn.items() if n.startswith("ratings-"))
    rows = [
        [
            escape(r.question),
            escape(" less ".join(plan.name(x) for x in r.pair)),
            format_interval(r.difference, lambda v: f"{v:.2f}"),
            format_p_value(r.p),
            format_p_value(r.together),
            r.by,
        ]
        for r in results.rated
    ]
    return out + format_cells(("question", "pair", "difference, points", "alone", "together", "by"), rows)


def _sides(results: PerceiveResults) -> str:
    rows = []
    for name, found in (("all choices", results.left), ("pairs of the same video", results.same)):
        if found is not None:
            e, p = found
            rows.append(
                [name, format_interval(e, _percent), f"{round(e.value * e.n)} of {e.n}", format_p_value(p)]
            )
    return "<h2>Sides</h2>" + format_cells(("", "left", "answers", "against a half"), rows) if rows else ""


def _people(results: PerceiveResults, drawn: Mapping[str, str]) -> str:
    answers = results.answers
    rows = [
        [
            escape(p.participant),
            p.standing,
            str(p.answered),
            f"{p.missed} of {p.told}",
            str(p.replays),
            "" if p.seconds is None else f"{p.seconds:.1f} s",
            escape(p.why) or "counts",
        ]
        for p in answers.people
        if p.standing != "not begun"
    ]
    columns = ("code", "", "answers", "checks missed", "replays", "median decision", "")
    odd = f"<h3>What is not as it should be</h3>{_list(answers.odd)}" if answers.odd else ""
    return f"<h2>Who took part</h2>{drawn['participants']}{format_cells(columns, rows) if rows else ''}{odd}"


def _claims(results: PerceiveResults) -> str:
    plan = results.answers.study.plan
    can = [
        f"Which of two conditions people of this kind prefer, in {len(plan.items)} stretches of motion "
        "like these, shown like this, when asked this question: with the intervals above."
    ]
    cannot = [
        "That there is no difference, where none was shown: an interval with a half in it has others, too."
        + ("" if plan.smallest else " 'smallest' in the plan lets the report say it where it can be said."),
        "Why one is preferred: conditions may differ in more than what they are called after.",
        "Anything about other characters, cameras, voices, lengths or questions.",
        "That what is preferred is natural: a choice is between these two.",
    ]
    if not any(c.model is not None for c in results.pairs) and not results.rated:
        can = []
    return "<h2>What can be claimed</h2>" + _list(tuple(can)) + "<h3>What cannot</h3>" + _list(tuple(cannot))


# --- tables


def perceive_tables(results: PerceiveResults) -> dict[str, Table]:
    """Return file name -> columns and rows."""
    answers = results.answers
    choices = [
        (
            c.participant,
            *c.pair,
            c.item,
            c.first,
            "left" if c.left else "right",
            c.place,
            c.seconds,
            c.replays,
        )
        for c in answers.choices
    ]
    ratings = [
        (r.participant, r.question, r.condition, r.item, r.value, r.place, r.seconds, r.replays)
        for r in answers.ratings
    ]
    pairs = [
        (
            *c.pair,
            c.share.n if c.share else 0,
            *_three(c.share),
            c.p,
            c.exact,
            *_three(c.model.share if c.model else None),
            c.model.effects["preference"].value if c.model else None,
            c.model.errors["preference"] if c.model else None,
            c.model.deviations["participants"] if c.model else None,
            c.model.deviations["items"] if c.model else None,
            c.alone,
            c.together,
            c.verdict,
        )
        for c in results.pairs
    ]
    items = [(*c.pair, item, e.n, *_three(e)) for c in results.pairs for item, e in (c.by_item or {}).items()]
    people = [
        (p.participant, p.standing, p.answered, p.told, p.missed, p.replays, p.seconds, p.why)
        for p in answers.people
    ]
    rated = [(r.question, *r.pair, *_three(r.difference), r.p, r.together, r.by) for r in results.rated]
    both = ("first", "second")
    share = ("share", "low", "high")
    end = ("seconds", "replays")
    return {
        "choices.csv": (("participant", *both, "item", "chose_first", "first_was", "place", *end), choices),
        "ratings.csv": (("participant", "question", "condition", "item", "value", "place", *end), ratings),
        "pairs.csv": (
            (
                *both,
                "answers",
                *share,
                "p_exact",
                "p_exact_holm",
                "model_share",
                "model_low",
                "model_high",
                "log_odds",
                "error",
                "sd_participants",
                "sd_items",
                "p",
                "p_holm",
                "verdict",
            ),
            pairs,
        ),
        "items.csv": ((*both, "item", "answers", *share), items),
        "participants.csv": (
            ("participant", "standing", "answers", "told", "missed", "replays", "seconds", "why"),
            people,
        ),
        "systems.csv": (
            ("first", "second", "difference", "low", "high", "p", "p_holm", "better"),
            [(*s.systems, *_three(s.difference), s.p, s.together, s.better or "") for s in results.systems],
        ),
        "rated.csv": (("question", *both, "difference", "low", "high", "p", "p_holm", "by"), rated),
    }


def _three(e: Estimate | None) -> tuple[float | None, float | None, float | None]:
    return (None, None, None) if e is None else (e.value, e.low, e.high)
