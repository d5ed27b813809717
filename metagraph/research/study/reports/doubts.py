"""What a reviewer asks of a report: who is in it, what hangs on a choice, what was not counted."""

from __future__ import annotations

from metagraph.common.xml_text import escape
from metagraph.research.study.analysis.results import TITLES, Results
from metagraph.research.study.reports import plots
from metagraph.research.study.reports.cells import (
    format_cells,
    format_interval,
    format_two_digits,
    gather_missing,
)
from metagraph.research.study.reports.plots import format_duration
from metagraph.research.study.reports.plots_flow import plot_flow
from metagraph.research.study.statistics.sensitivity import BY_HAND, PRACTICE, SECOND

LEFT = {
    "not begun": "did not begin",
    "declined": "declined",
    "withdrawn": "withdrew",
    "deleted": "withdrew, data deleted",
}


def draw_flow_figure(results: Results) -> str | None:
    """Return who took part as a drawing; None if the data do not tell."""
    data = results.data
    if not data.people:
        return None
    left = {
        words: n
        for kind, words in LEFT.items()
        if (n := sum(1 for t in data.people.values() if t.standing == kind))
    }
    began = {who: t for who, t in data.people.items() if t.standing not in LEFT}
    time = results.time
    used = {p.participant for p in time.people} if time is not None and time.paired else set()
    if time is not None and not time.paired:
        used = {r.run.participant for r in data.rows if r.done and r.run.condition in time.pair} - set(
            time.left_out
        )
    arms = []
    for first in dict.fromkeys(t.first for t in data.people.values()):
        mine = [who for who, t in began.items() if t.first == first]
        done = sum(1 for who in mine if began[who].standing == "done")
        arms.append(
            (
                f"{TITLES.get(first, first)} first",
                [("began", len(mine)), ("came to the end", done), ("in the ratio", len(used & set(mine)))],
            )
        )
    return plot_flow([("Planned", len(data.people), left), ("Took part", len(began), {})], arms)


def draw_alternatives(results: Results) -> str | None:
    """Return the ratio by every way as a drawing."""
    found, time = results.sensitivity, results.time
    if found is None or time is None or not found.ways:
        return None
    return plots.plot_ratios([("as reported", time.ratio), *((w.name, w.ratio) for w in found.ways)])


def describe_alternatives(results: Results, drawing: str) -> str:
    """Return what the ratio hangs on. drawing: the figure, whole."""
    found, time = results.sensitivity, results.time
    if found is None or time is None:
        return ""
    out = "<h2>Reckoned otherwise</h2>"
    out += "<p>The same data by other choices: what the figures above, whose analysis is fixed, hang on.</p>"
    if found.odd:
        out += "<ul class='warn'>" + "".join(f"<li>{escape(words)}</li>" for words in found.odd) + "</ul>"
    else:
        out += (
            "<p>No task, and nobody's ratio, is far from the others', and none is longer than its limit.</p>"
        )
    out += drawing
    rows = [[escape(w.name), format_interval(w.ratio, format_two_digits), escape(w.how)] for w in found.ways]
    out += format_cells(("", "ratio, 95 % interval", "how"), rows)
    if found.correct:
        said = [
            f"{TITLES[c]} {right} of {n}" for c, (right, n) in sorted(found.correct.items(), reverse=True)
        ]
        out += f"<p>Machines without any mistake: {escape('; '.join(said))}.</p>"
    model = found.mixed
    if model is not None:
        names = {
            BY_HAND: "by hand beside meta-graph",
            SECOND: "second sitting beside first",
            PRACTICE: "practice, slope of log seconds over log clips",
        }
        body = [
            [
                names[k],
                format_interval(e if k == PRACTICE else e.exp(), format_two_digits),
                f"{model.df[k]:.1f}",
            ]
            for k, e in model.effects.items()
            if k in names
        ]
        out += "<h3>The mixed model</h3>" + format_cells(
            ("", "estimate, 95 % interval", "degrees of freedom"), body
        )
        spreads = ", ".join(f"{escape(k)} {v:.2f}" for k, v in model.deviations.items())
        out += f"<p>Standard deviations of logs: {spreads}; {model.n} tasks."
        out += (
            f" The data cannot tell {escape(', '.join(model.left_out))} from the rest."
            if model.left_out
            else ""
        )
        out += "</p>"
    return out


def describe_gaps(results: Results) -> str:
    """Return how much time no figure counts."""
    if not results.vanished:
        return ""
    rows = [
        [
            TITLES[c],
            str(v.count),
            format_duration(v.seconds) if v.count else "none",
            f"{v.share:.0%}",
            format_duration(v.longest) if v.count else "",
            f"{v.playing:.0%}" if v.count else "",
        ]
        for c, v in results.vanished.items()
    ]
    words = (
        "Gaps of more than a minute without anything done are taken to be absence, and left out of all "
        "times. "
        "Somebody may have watched motion, or thought; how the ratio would be with other limits is told "
        "above."
    )
    head = ("", "gaps", "a task, mean", "of all time", "longest", "of it while the preview played")
    return f"<h3>Time that is not counted</h3><p>{words}</p>{format_cells(head, rows)}"


def describe_missing_data(results: Results, drawing: str) -> str:
    """Return what is there, and what is not."""
    data = results.data
    begun = len({r.run.participant for r in data.rows})
    done = sum(1 for r in data.rows if r.done)
    words = (
        f"{begun} of {len(data.participants)} people have begun; {done} of {len(data.rows)} tasks they "
        "began were brought to an end."
    )
    items = "".join(f"<li>{escape(text)}</li>" for text in gather_missing(data.missing))
    return f"<h2>Who took part, and what is missing</h2><p>{words}</p>{drawing}" + (
        f"<ul class='warn'>{items}</ul>" if items else "<p>Nothing is missing.</p>"
    )


def describe_other_conditions(results: Results) -> str:
    """Return further conditions beside the meta-graph."""
    if not results.others:
        return ""
    rows = [
        [
            escape(TITLES[c.pair[0]]),
            format_interval(c.means[c.pair[0]], format_duration),
            format_interval(c.ratio, format_two_digits),
            str(c.ratio.n),
        ]
        for c in results.others
    ]
    return "<h3>Other conditions</h3>" + format_cells(
        ("beside the meta-graph", "time", "ratio, 95 % interval", "people"), rows
    )


def describe_sites(results: Results) -> str:
    """Return the ratio at each site, where there are several."""
    if len(results.by_site) < 2:
        return ""
    rows = [[escape(s), format_interval(e, format_two_digits), str(e.n)] for s, e in results.by_site.items()]
    return "<h3>Sites</h3>" + format_cells(("", "ratio, 95 % interval", "people"), rows)


VERDICTS = {
    "larger": "the ratio is larger than that: the difference matters",
    "smaller": "the ratio is smaller than 1 by more than that",
    "equivalent": "the two are equivalent by that measure",
    "not told": "these people show neither that the difference matters nor that it does not",
}


def describe_equivalence(results: Results) -> str:
    """Return what the smallest ratio that matters says of the ratio."""
    found = results.equivalence
    if found is None or found.interval.low is None or found.interval.high is None:
        return ""
    low, high = format_two_digits(found.interval.low), format_two_digits(found.interval.high)
    return (
        f"<p>The smallest ratio that matters was set to {found.smallest:g}. With a 90 % interval of "
        f"{low} to {high}, {VERDICTS[found.verdict]}.</p>"
    )
