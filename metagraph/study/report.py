"""The report of a study: one HTML page that needs nothing beside it, and tables as CSV. The same data give
the same bytes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from html import escape
from pathlib import Path

from metagraph.formats.atomic import write_atomically
from metagraph.study import plots
from metagraph.study.analysis import ABOVE, BELOW, TITLES, Comparison, Measure, Results
from metagraph.study.analysis_read import TOTALS
from metagraph.study.plots import seconds
from metagraph.study.report_style import METHODS, STYLE
from metagraph.study.report_tables import tables
from metagraph.study.stats import Estimate, Test

NAME = "report.html"


def write_report(results: Results, folder: Path) -> list[Path]:
    """Write the page and the tables into a folder; return what was written. Raises FileError."""
    content = {NAME: page(results), **tables(results)}
    for name, text in content.items():
        write_atomically(folder / name, text.encode())
    return [folder / name for name in content]


def page(results: Results) -> str:
    """Return the page."""
    data = results.data
    parts = [
        f"<h1>{escape(data.title)}</h1>",
        "<p class='warn'>Nobody took part: these participants were simulated.</p>" if data.simulated else "",
        _headline(results),
        _time(results),
        _learning(results),
        _spent(results),
        _measures(
            "Mistakes",
            "Beside the task's reference, a task on average; a time is wrong when it is more than "
            f"{data.tolerance:g} s off. The difference is by hand less meta-graph.",
            results.mistakes,
        ),
        _ratings(results),
        _together(results),
        _missing(results),
        f"<h2>How it was reckoned</h2>{METHODS}",
    ]
    head = (
        "<meta charset='utf-8'><meta name='viewport' content='width=device-width'><link rel='icon' "
        "href='data:,'>"
    )
    head += f"<title>{escape(data.title)}: report</title><style>{STYLE}</style>"
    body = "\n".join(filter(None, parts))
    return f"<!doctype html>\n<html lang='en'><head>{head}</head><body>\n{body}\n</body></html>\n"


def summary(results: Results) -> list[str]:
    """Return the findings as sentences, the most important first."""
    data, time = results.data, results.time
    done = [r for r in data.rows if r.done]
    if not data.rows:
        return ["Nobody has begun a task yet."]
    if time is None:
        found = sorted({TITLES[r.run.condition] for r in done})
        return [
            f"There is nothing to compare yet: {f'only {found[0]} was' if found else 'no task was'} brought "
            "to an end."
        ]
    first = f"Working on the {TITLES[ABOVE]} took {times(time.ratio)} as long as with the {TITLES[BELOW]}"
    out = [f"{first} ({_who(time)})."]
    f1 = next((m for m in results.mistakes if m.name.startswith("F1")), None)
    if f1 is not None and ABOVE in f1.means and BELOW in f1.means:
        below, above = (f1.means[c].value for c in (BELOW, ABOVE))
        out.append(
            f"Connections were right to {below:.1f} % (F1) with the meta-graph, to {above:.1f} % by hand."
        )
    for name, better in (("SUS", "higher"), ("NASA-TLX, raw", "lower")):
        found_rating = next(
            (m for m in results.ratings if m.name == name and ABOVE in m.means and BELOW in m.means), None
        )
        if found_rating is not None:
            means = found_rating.means
            out.append(
                f"{name} ({better} is better): {means[BELOW].value:.1f} with the meta-graph, "
                f"{means[ABOVE].value:.1f} by hand."
            )
    return out


# --- parts


def _headline(results: Results) -> str:
    first, *rest = summary(results)
    cautions = results.time.cautions if results.time is not None else ()
    big = f"<p class='big'>{escape(first)}</p>" + "".join(f"<p>{escape(words)}</p>" for words in rest)
    warned = "".join(f"<li>{escape(words)}</li>" for words in cautions)
    return f"<div class='card'>{big}</div>" + (
        f"<div class='card warn'><ul>{warned}</ul></div>" if warned else ""
    )


def _time(results: Results) -> str:
    time = results.time
    if time is None:
        return ""
    unit = f"a {time.unit}"
    rows: list[tuple[str, Estimate]] = [("all tasks", time.ratio)]
    if time.order is not None:
        rows.append(("both orders alike", time.order.adjusted))
    rows += [
        (results.data.tasks[task], ratio)
        for task, (ratio, _, _) in results.by_task.items()
        if len(results.by_task) > 1
    ]
    body = [
        [f"{TITLES[c]}, {unit}", _interval(time.means[c], seconds), ""] for c in (BELOW, ABOVE)
    ]  # fmt: skip
    body.append(["ratio", _interval(time.ratio, lambda v: f"{v:.2f}"), tested(time.test)])
    if time.ranked is not None:
        body.append(["ranks of the ratios", "", tested(time.ranked)])
    if time.effect is not None:
        body.append(["effect size, d<sub>z</sub> (Hedges)", _interval(time.effect, lambda v: f"{v:.2f}"), ""])
    if time.biserial is not None:
        body.append(["matched-pairs rank biserial", f"{time.biserial:.2f}", ""])
    for task, (ratio, test, p) in results.by_task.items() if len(results.by_task) > 1 else ():
        words = f"{tested(test)}; Holm: {chance(p)}" if p is not None else tested(test)
        body.append(
            [f"ratio, {escape(results.data.tasks[task])}", _interval(ratio, lambda v: f"{v:.2f}"), words]
        )
    out = "<h2>Time</h2>"
    if time.people:
        pairs = [(p.participant, p.below, p.above) for p in time.people]
        out += _figure(
            plots.paired(pairs, (time.means[BELOW], time.means[ABOVE]), (TITLES[BELOW], TITLES[ABOVE])),
            f"Each line is one person: seconds {unit}, on a logarithmic axis. Beside them the geometric "
            "means with 95 % intervals.",
        )
    out += _figure(plots.ratios(rows), "How many times as long it took by hand, with 95 % intervals.")
    return out + _table(("", "value, 95 % interval", "test"), body) + _order(time)


def _order(time: Comparison) -> str:
    order = time.order
    if order is None:
        return ""
    second = (
        f"A second sitting took {times(order.second)} as long as a first one ({_range(order.second)}, "
        f"{tested(order.second_test)})."
    )
    carried = (
        f"Those who began by hand took {times(order.carried)} as long over both as those who began with the "
        "meta-graph "
        f"({_range(order.carried)}, {tested(order.carried_test)}): "
    )
    if order.carried.holds(1.0):
        carried += (
            "no sign that anything carried over from one to the other, though such a check finds "
            "only "
            "large effects."
        )
    else:
        carried += (
            "something carried over, or the two groups were unlike. By first sittings alone, which nothing "
            "can have carried over to, the "
            f"ratio is {order.first.value:.2f} ({_range(order.first)})."
        )
    return f"<h3>Order</h3><p>{second}</p><p>{carried}</p>"


def _learning(results: Results) -> str:
    if not results.curves:
        return ""
    lines = {c: (curve.seconds, curve.first, curve.slope.value) for c, curve in results.curves.items()}
    said = []
    for c, curve in results.curves.items():
        twice = 2**curve.slope.value
        words = f"With each doubling of the clips done, a clip took {twice:.2f} of the time"
        said.append(
            f"<li>{escape(TITLES[c])}: slope {_interval(curve.slope, lambda v: f'{v:.3f}')}. {words}.</li>"
        )
    caption = (
        "Geometric means over those who came so far, and the power law of practice; both axes are "
        "logarithmic."
    )
    return f"<h2>Practice</h2>{_figure(plots.curves(lines, TITLES), caption)}<ul>{''.join(said)}</ul>"


def _spent(results: Results) -> str:
    if not results.spent:
        return ""
    out = "<h2>Where the time went</h2>"
    out += _figure(
        plots.stacked(
            {c: {str(k): v for k, v in parts.items()} for c, parts in results.spent.items()}, TITLES
        ),
        "What a task went into, arithmetic means.",
    )
    if results.predicted:
        rows = [
            [
                TITLES[c],
                _interval(p.observed, seconds),
                _interval(p.model, seconds),
                _interval(p.share, lambda v: f"{v:.2f}"),
            ]
            for c, p in results.predicted.items()
        ]
        out += (
            "<h3>Beside the keystroke-level model</h3><p>What an expert who makes no mistake would need "
            "for the same operators.</p>"
        )
        out += _table(("a task", "observed", "predicted", "observed / predicted"), rows)
    return out


def _measures(title: str, words: str, measures: Sequence[Measure]) -> str:
    if not measures:
        return ""
    columns = [c for c in (BELOW, ABOVE) if any(c in m.means for m in measures)]
    never = [m.name for m in measures if all(e.value == 0 and e.low in (0, None) for e in m.means.values())]
    rows = [
        [
            escape(m.name),
            *(_interval(m.means.get(c), lambda v: f"{v:.2f}") for c in columns),
            _interval(m.difference, lambda v: f"{v:.2f}"),
            tested(m.test)
            if m.test is not None and (m.difference is None or m.difference.value != 0)
            else "",
        ]
        for m in measures
        if m.name not in never
    ]
    if never:
        words += f" Nobody ever had: {', '.join(never)}."
    return f"<h2>{title}</h2><p>{escape(words)}</p>" + _table(
        ("", *(TITLES[c] for c in columns), "difference", "test"), rows
    )


def _ratings(results: Results) -> str:
    known = [(m.name, m.means) for m in results.ratings if m.name in TOTALS and set(m.means) <= set(TITLES)]
    plot = (
        _figure(
            plots.means(known), "Means with 95 % intervals. SUS: more is better; NASA-TLX: less is better."
        )
        if known
        else ""
    )
    table = _measures("Ratings", "The difference is by hand less meta-graph.", results.ratings)
    return table.replace("</h2>", f"</h2>{plot}", 1) if table else ""


def _together(results: Results) -> str:
    if len(results.together) < 2:
        return ""
    rows = [[escape(name), tested(test), chance(p)] for name, test, p in results.together]
    words = "Several questions were asked of the same people; the last column takes that into account (Holm)."
    return f"<h2>The tests together</h2><p>{words}</p>" + _table(("", "alone", "together"), rows)


def _missing(results: Results) -> str:
    data = results.data
    begun = len({r.run.participant for r in data.rows})
    done = sum(1 for r in data.rows if r.done)
    words = (
        f"{begun} of {len(data.participants)} people have begun; {done} of {len(data.rows)} tasks they "
        "began were brought to an end."
    )
    items = "".join(f"<li>{escape(text)}</li>" for text in data.missing)
    return f"<h2>What is there, and what is not</h2><p>{words}</p>" + (
        f"<ul class='warn'>{items}</ul>" if items else "<p>Nothing is missing.</p>"
    )


# --- words and cells


def times(ratio: Estimate) -> str:
    return f"{ratio.value:.2f} times" if ratio.value < 9.95 else f"{ratio.value:.1f} times"


def chance(p: float | None) -> str:
    """Return a p value as journals write it."""
    if p is None:
        return "no p"
    return "p &lt; 0.001" if p < 0.001 else f"p = {p:.3f}"


def tested(test: Test) -> str:
    if test.p is None or test.statistic is None:
        return "too few for a test"
    if test.df is None:
        return f"W<sub>+</sub> = {test.statistic:g}, {chance(test.p)}"
    return f"t({test.df:.4g}) = {test.statistic:.2f}, {chance(test.p)}"


def _who(time: Comparison) -> str:
    people = f"{time.ratio.n} {'person' if time.ratio.n == 1 else 'people'}"
    if time.ratio.low is None:
        return f"no interval, {people}"
    return f"95 % interval {time.ratio.low:.2f} to {time.ratio.high:.2f}, {people}" + (
        "" if time.paired else ", each doing only one"
    )


def _range(found: Estimate) -> str:
    return "no interval" if found.low is None else f"95 % interval {found.low:.2f} to {found.high:.2f}"


def _interval(found: Estimate | None, words: Callable[[float], str]) -> str:
    if found is None:
        return ""
    if found.low is None or found.high is None:
        return f"<b>{words(found.value)}</b>"
    return f"<b>{words(found.value)}</b> <span class='dim'>{words(found.low)} to {words(found.high)}</span>"


def _figure(svg: str, caption: str) -> str:
    return f"<figure>{svg}<figcaption>{escape(caption)}</figcaption></figure>"


def _table(columns: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """Return a table; the cells are HTML."""
    head = "".join(f"<th>{c}</th>" for c in columns)
    body = "".join("<tr>" + "".join(f"<td>{c}</td>" for c in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
