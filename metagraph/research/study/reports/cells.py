"""Words and cells of a report: figures with their intervals, tests, tables, sentences for a paper."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Iterable, Mapping, Sequence
from math import isfinite

from metagraph.common.xml_text import escape
from metagraph.research.study.analysis.results import TITLES, ConditionComparison
from metagraph.research.study.reports.figure_files import make_standalone_svg
from metagraph.research.study.reports.plots import format_duration
from metagraph.research.study.statistics.small_samples import Estimate, Test

Say = Callable[[float], str]


def format_ratio(ratio: Estimate) -> str:
    return f"{ratio.value:.2f} times" if ratio.value < 9.95 else f"{ratio.value:.1f} times"


def format_two_digits(value: float) -> str:
    """Return a number to two digits; what is not bounded as such."""
    return f"{value:.2f}" if isfinite(value) else "not bounded"


def format_p_value(p: float | None) -> str:
    """Return a p value as journals write it."""
    if p is None:
        return "no p"
    return "p &lt; 0.001" if p < 0.001 else f"p = {p:.3f}"


def format_test(test: Test) -> str:
    if test.p is None or test.statistic is None or test.df is None:
        return "too few for a test"
    return f"t({test.df:.4g}) = {test.statistic:.2f}, {format_p_value(test.p)}"


def format_spread(found: Estimate) -> str:
    if found.low is None or found.high is None:
        return "no interval"
    return f"95 % interval {format_two_digits(found.low)} to {format_two_digits(found.high)}"


def format_interval(found: Estimate | None, words: Say) -> str:
    """Return a cell: a value, and what it lies between."""
    if found is None:
        return ""
    if found.low is None or found.high is None:
        return f"<b>{words(found.value)}</b>"
    high = words(found.high) if isfinite(found.high) else "no bound"
    return f"<b>{words(found.value)}</b> <span class='dim'>{words(found.low)} to {high}</span>"


def describe_who(time: ConditionComparison) -> str:
    """Return the interval of the ratio of times and how many people it comes from, in words."""
    people = f"{time.ratio.n} {'person' if time.ratio.n == 1 else 'people'}"
    if time.ratio.low is None:
        return f"no interval, {people}"
    return f"95 % interval {time.ratio.low:.2f} to {time.ratio.high:.2f}, {people}" + (
        "" if time.paired else ", each doing only one"
    )


def make_figure(name: str, drawing: str, caption: str, papers: Mapping[str, bytes]) -> str:
    """Return a figure with links that save it. papers: name -> the same as PDF, where there is one."""
    kinds = {"SVG": ("svg", "image/svg+xml", make_standalone_svg(drawing).encode())}
    if name in papers:
        kinds["PDF"] = ("pdf", "application/pdf", papers[name])
    links = "".join(
        f"<a class='take' download='{name}.{end}' href='data:{sort};base64,{b64encode(content).decode()}'>"
        f"{kind}</a>"
        for kind, (end, sort, content) in kinds.items()
    )
    return f"<figure>{drawing}<figcaption>{escape(caption)}{links}</figcaption></figure>"


def format_cells(columns: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """Return a table; the cells are HTML."""
    head = "".join(f"<th>{c}</th>" for c in columns)
    body = "".join("<tr>" + "".join(f"<td>{c}</td>" for c in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


# --- for a paper


def write_apa_sentence(time: ConditionComparison) -> str:
    """Return the result as a sentence in the form of the American Psychological Association (7th edition),
    HTML.
    """
    above, below = time.pair
    a, b = time.means[above], time.means[below]
    said = (
        f"Working on the {TITLES[above]} took longer (geometric <i>M</i> = {format_duration(a.value)} "
        f"a {time.unit}{_apa_range(a, format_duration)}) than with the {TITLES[below]} "
        f"(geometric <i>M</i> = {format_duration(b.value)}{_apa_range(b, format_duration)}), "
    )
    if time.ratio.value < 1:
        said = said.replace("took longer", "took less time", 1)
    parts = []
    if time.test.p is not None and time.test.statistic is not None and time.test.df is not None:
        parts.append(
            f"<i>t</i>({time.test.df:.4g}) = {time.test.statistic:.2f}, {format_apa_chance(time.test.p)}"
        )
    parts.append(f"ratio = {time.ratio.value:.2f}{_apa_range(time.ratio, format_two_digits)}")
    if time.effect is not None:
        parts.append(
            f"<i>d</i><sub>z</sub> = {time.effect.value:.2f}{_apa_range(time.effect, format_two_digits)}"
        )
    return f"{said}{', '.join(parts)}, <i>N</i> = {time.ratio.n}."


def format_apa_chance(p: float) -> str:
    """Return a p value without the nought before the point."""
    return "<i>p</i> &lt; .001" if p < 0.001 else f"<i>p</i> = {f'{p:.3f}'.removeprefix('0')}"


def _apa_range(found: Estimate, words: Say) -> str:
    if found.low is None or found.high is None:
        return ""
    return f", 95% CI [{words(found.low)}, {words(found.high)}]"


# --- many alike


def gather_missing(missing: Sequence[str]) -> list[str]:
    """Return what is missing in few sentences: what is said of many is said once, with who they are."""
    about: dict[str, list[str]] = {}
    for words in missing:
        place, colon, rest = words.partition(": ")
        about.setdefault(rest if colon else words, []).append(place if colon else "")
    out = []
    for words, places in about.items():
        if len(places) == 1:
            out.append(f"{places[0]}: {words}" if places[0] else words)
        else:
            out.append(f"{len(places)} times: {words.removesuffix('.')} ({_places(places)}).")
    return out


def _places(places: Sequence[str]) -> str:
    """Return `P01, small (meta)` of many by person: P01 small (meta), large (meta); P02 small (meta)."""
    by: dict[str, list[str]] = {}
    for place in places:
        name, _, rest = place.partition(", ")
        by.setdefault(name, []).append(rest)
    if not any(any(rest) for rest in by.values()):
        return ", ".join(by)
    return "; ".join(f"{name} {', '.join(rest)}" for name, rest in by.items())
