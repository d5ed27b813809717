"""The report of a study: one HTML page that needs nothing beside it, its figures as files, and tables as CSV.
The same data give the same bytes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from metagraph.common.xml_text import escape
from metagraph.formats.atomic import write_together
from metagraph.research.study.analysis.reading import TOTALS
from metagraph.research.study.analysis.results import (
    ABOVE,
    BELOW,
    TITLES,
    ConditionComparison,
    Results,
    StudyMeasure,
)
from metagraph.research.study.reports import plots
from metagraph.research.study.reports.cells import (
    describe_who,
    format_cells,
    format_interval,
    format_p_value,
    format_ratio,
    format_spread,
    format_test,
    format_two_digits,
    gather_missing,
    make_figure,
    write_apa_sentence,
)
from metagraph.research.study.reports.doubts import (
    describe_alternatives,
    describe_equivalence,
    describe_gaps,
    describe_missing_data,
    describe_other_conditions,
    describe_sites,
    draw_alternatives,
    draw_flow_figure,
)
from metagraph.research.study.reports.figure_files import make_standalone_svg
from metagraph.research.study.reports.plots import format_duration
from metagraph.research.study.reports.style import METHODS, STYLE
from metagraph.research.study.reports.tables import study_tables
from metagraph.research.study.statistics.distributions import describe_software
from metagraph.research.study.statistics.small_samples import Estimate

__all__ = [
    "NAME",
    "Paper",
    "draw_study_figures",
    "format_p_value",
    "format_study_page",
    "gather_missing",
    "summarise_study",
    "write_study_report",
]

NAME = "report.html"
_NAMES: Mapping[str, str] = {"shown": "clips had their names", "hidden": "clips had numbers instead of names"}
Paper = Callable[[str], bytes]
Files = Mapping[str, bytes]


def write_study_report(results: Results, folder: Path, paper: Paper | None = None) -> list[Path]:
    """Write the page, the tables and the figures into a folder; return what was written, the page first.
    paper: makes a PDF of an SVG file's text, if that can be done. Raises FileError.
    """
    drawn = {name: make_standalone_svg(drawing) for name, (drawing, _) in draw_study_figures(results).items()}
    papers = {name: paper(text) for name, text in drawn.items()} if paper is not None else {}
    content: dict[str, bytes] = {NAME: format_study_page(results, papers).encode()}
    content |= {name: text.encode() for name, text in study_tables(results).items()}
    content |= {f"figures/{name}.svg": text.encode() for name, text in drawn.items()}
    content |= {f"figures/{name}.pdf": made for name, made in papers.items()}
    notebooks = Path(__file__).with_name("notebooks")
    content |= {f"notebooks/{n}": (notebooks / n).read_bytes() for n in ("figures.ipynb", "figures.R")}
    return write_together(folder, content)


def draw_study_figures(results: Results) -> dict[str, tuple[str, str]]:
    """Return name -> drawing (SVG, for the page's style) and caption."""
    out: dict[str, tuple[str, str]] = {}
    drawing = draw_flow_figure(results)
    if drawing is not None:
        out["participants"] = drawing, "From all who were planned to all who count."
    time = results.time
    if time is not None:
        if time.people:
            pairs = [(p.participant, p.below, p.above) for p in time.people]
            sides = (time.means[BELOW], time.means[ABOVE])
            out["times"] = (
                plots.plot_paired(pairs, sides, (TITLES[BELOW], TITLES[ABOVE]), time.unit),
                "Each line is one person. Beside them the geometric means with 95 % intervals.",
            )
        rows: list[tuple[str, Estimate]] = [("all tasks", time.ratio)]
        rows += [(results.data.tasks[t], e) for t, e in results.by_task.items() if len(results.by_task) > 1]
        rows += [(_NAMES[n], e) for n, e in results.by_names.items() if len(results.by_names) > 1]
        rows += [(TITLES[c.pair[0]], c.ratio) for c in results.others]
        out["ratios"] = (
            plots.plot_ratios(rows),
            "How many times as long it took by hand, with 95 % intervals.",
        )
    again = draw_alternatives(results)
    if again is not None:
        out["otherwise"] = again, "The ratio of all tasks, reckoned otherwise, with 95 % intervals."
    if results.curves:
        lines = {c: (curve.seconds, curve.first, curve.slope.value) for c, curve in results.curves.items()}
        out["practice"] = (
            plots.plot_learning(lines, TITLES),
            "Geometric means over those who came so far, and the power law of practice.",
        )
    if any(results.spent.values()):
        out["spent"] = plots.plot_stacked(results.spent, TITLES), "What a task went into, arithmetic means."
    known = [(m.name, m.means) for m in results.ratings if m.name in TOTALS and set(m.means) <= set(TITLES)]
    if known:
        out["ratings"] = (
            plots.plot_means(known, names=TITLES),
            "Means with 95 % intervals. SUS: more is better; NASA-TLX: less is better.",
        )
    return out


def format_study_page(results: Results, papers: Files | None = None) -> str:
    """Return the page. papers: its figures as PDF, by name."""
    data = results.data
    drawn = {
        n: make_figure(n, drawing, words, papers or {})
        for n, (drawing, words) in draw_study_figures(results).items()
    }
    parts = [
        f"<h1>{escape(data.title)}</h1>",
        "<p class='warn'>Nobody took part: these participants were simulated.</p>" if data.simulated else "",
        _headline(results),
        _time(results, drawn),
        describe_alternatives(results, drawn.get("otherwise", "")),
        _learning(results, drawn),
        _spent(results, drawn),
        _measures(
            "Mistakes",
            "Beside the task's reference, a task on average; a time is wrong when it is more than "
            f"{data.tolerance:g} s off. The difference is by hand less meta-graph.",
            results.mistakes,
        ),
        _ratings(results, drawn),
        _together(results),
        describe_missing_data(results, drawn.get("participants", "")),
        f"<h2>How it was reckoned</h2>{METHODS}<p>{describe_software()}</p>",
    ]
    head = (
        "<meta charset='utf-8'><meta name='viewport' content='width=device-width'><link rel='icon' "
        "href='data:,'>"
    )
    head += f"<title>{escape(data.title)}: report</title><style>{STYLE}</style>"
    body = "\n".join(filter(None, parts))
    return f"<!doctype html>\n<html lang='en'><head>{head}</head><body>\n{body}\n</body></html>\n"


def summarise_study(results: Results) -> list[str]:
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
    first = (
        f"Working on the {TITLES[ABOVE]} took {format_ratio(time.ratio)} as long as with the {TITLES[BELOW]}"
    )
    out = [f"{first} ({describe_who(time)})."]
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
    first, *rest = summarise_study(results)
    cautions = results.time.cautions if results.time is not None else ()
    big = f"<p class='big'>{escape(first)}</p>" + "".join(f"<p>{escape(words)}</p>" for words in rest)
    warned = "".join(f"<li>{escape(words)}</li>" for words in cautions)
    return f"<div class='card'>{big}</div>" + (
        f"<div class='card warn'><ul>{warned}</ul></div>" if warned else ""
    )


def _time(results: Results, drawn: Mapping[str, str]) -> str:
    time = results.time
    if time is None:
        return ""
    body = [
        [f"{TITLES[c]}, a {time.unit}", format_interval(time.means[c], format_duration)]
        for c in (BELOW, ABOVE)
    ]  # fmt: skip
    body.append(["ratio", format_interval(time.ratio, format_two_digits)])
    if time.effect is not None:
        body.append(["effect size, d<sub>z</sub> (Hedges)", format_interval(time.effect, format_two_digits)])
    for task, ratio in results.by_task.items() if len(results.by_task) > 1 else ():
        body.append([f"ratio, {escape(results.data.tasks[task])}", format_interval(ratio, format_two_digits)])
    for names, ratio in results.by_names.items() if len(results.by_names) > 1 else ():
        body.append([f"ratio, {_NAMES[names]}", format_interval(ratio, format_two_digits)])
    if results.names_ratio is not None:
        body.append(
            [
                "ratio with numbers over ratio with names",
                format_interval(results.names_ratio, format_two_digits),
            ]
        )
    out = "<h2>Time</h2>" + drawn.get("times", "") + drawn.get("ratios", "")
    out += format_cells(("", "value, 95 % interval"), body)
    out += f"<p class='dim'>For a paper: {write_apa_sentence(time)}</p>"
    return (
        out
        + _names(results)
        + describe_equivalence(results)
        + describe_other_conditions(results)
        + describe_sites(results)
        + _order(time)
    )


def _names(results: Results) -> str:
    """Say how the clips were called, where the study says it."""
    if len(results.by_names) == 1:
        (names,) = results.by_names
        return f"<p>In all tasks, {_NAMES[names]}.</p>"
    return (
        "<p>Each person had names in some tasks and numbers in the others, which tasks by turns. So the two "
        "ratios by names are of other tasks for each person, and of the same tasks over all.</p>"
        if results.by_names
        else ""
    )


def _order(time: ConditionComparison) -> str:
    order = time.order
    if order is None:
        return ""
    ratio, spread = format_ratio(order.second), format_spread(order.second)
    second = f"A second sitting took {ratio} as long as a first one ({spread})."
    carried = (
        f"Those who began by hand took {format_ratio(order.carried)} as long over both as those who began "
        "with the meta-graph "
        f"({format_spread(order.carried)}): "
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
            f"ratio is {order.first.value:.2f} ({format_spread(order.first)})."
        )
    return f"<h3>Order</h3><p>{second}</p><p>{carried}</p>"


def _learning(results: Results, drawn: Mapping[str, str]) -> str:
    if not results.curves:
        return ""
    said = []
    for c, curve in results.curves.items():
        twice = 2**curve.slope.value
        words = f"With each doubling of the clips done, a clip took {twice:.2f} of the time"
        slope = format_interval(curve.slope, lambda v: f"{v:.3f}")
        said.append(f"<li>{escape(TITLES[c])}: slope {slope}. {words}.</li>")
    return f"<h2>Practice</h2>{drawn.get('practice', '')}<ul>{''.join(said)}</ul>"


def _spent(results: Results, drawn: Mapping[str, str]) -> str:
    if not results.spent:
        return ""
    out = "<h2>Where the time went</h2>"
    out += drawn.get("spent", "")
    out += (
        "<p class='dim'>The seconds before each event belong to it; those with a button held are dragging. "
        "<i>Before the end</i> is what came after the last event of a task.</p>"
    )
    out += describe_gaps(results)
    if results.predicted:
        rows = [
            [
                TITLES[c],
                format_interval(p.observed, format_duration),
                format_interval(p.model, format_duration),
                format_interval(p.share, format_two_digits),
            ]
            for c, p in results.predicted.items()
        ]
        out += (
            "<h3>Beside the keystroke-level model</h3><p>What an expert who makes no mistake would need "
            "for the same operators.</p>"
        )
        out += format_cells(("a task", "observed", "predicted", "observed / predicted"), rows)
    return out


def _measures(title: str, words: str, measures: Sequence[StudyMeasure]) -> str:
    if not measures:
        return ""
    columns = [c for c in (BELOW, ABOVE) if any(c in m.means for m in measures)]
    never = [m.name for m in measures if all(e.value == 0 and e.low in (0, None) for e in m.means.values())]
    rows = [
        [
            escape(m.name),
            *(format_interval(m.means.get(c), format_two_digits) for c in columns),
            format_interval(m.difference, format_two_digits),
        ]
        for m in measures
        if m.name not in never
    ]
    if never:
        words += f" Nobody ever had: {', '.join(never)}."
    return f"<h2>{title}</h2><p>{escape(words)}</p>" + format_cells(
        ("", *(TITLES[c] for c in columns), "difference"), rows
    )


def _ratings(results: Results, drawn: Mapping[str, str]) -> str:
    told = _measures("Ratings", "The difference is by hand less meta-graph.", results.ratings)
    return told.replace("</h2>", f"</h2>{drawn.get('ratings', '')}", 1) if told else ""


def _together(results: Results) -> str:
    if not results.together:
        return ""
    rows = [[escape(name), format_test(test), format_p_value(p)] for name, test, p in results.together]
    words = (
        "What was asked of these people, by paired t tests, which agree with the intervals above; the "
        "last column "
        f"takes into account that {len(rows)} were asked (Holm). Nothing else on this page is tested."
    )
    return f"<h2>The tests</h2><p>{words}</p>" + format_cells(("", "alone", "together"), rows)
