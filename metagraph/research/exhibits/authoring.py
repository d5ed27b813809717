"""Exhibits of the meta-graph paper about authoring: how connections grow, and what wiring all clips takes."""

from __future__ import annotations

from contextlib import suppress
from math import log
from typing import Any

from metagraph.graph.edits import remove_actions
from metagraph.graph.expand import count_machine_size
from metagraph.graph.model import Action, Kind, MetaGraph, Project, Stance
from metagraph.playback.planning.choice import uniform
from metagraph.research.exhibits import drawings
from metagraph.research.exhibits.exhibit import ExhibitDrawing, ExhibitTable, MadeExhibit
from metagraph.research.exhibits.material import ExhibitMaterial
from metagraph.research.exhibits.published import EXAMPLE_ON_EACH, EXAMPLE_STANCES, TIMES_FASTER
from metagraph.research.study.analysis.example import CLIPS, MANUAL_HOURS, META_HOURS, compute_example
from metagraph.research.study.scores.machines import Score

STEPS = (5, 10, 20, 35, 50, 75, 100, 152, 250, 400, 700, 1000, 2000, 5000)


def exhibit_growth(material: ExhibitMaterial) -> MadeExhibit:
    """Figures 1 and 2: what is dropped, and what would have to be drawn."""
    project = material.project
    whole = [a.id for a in project.actions()]
    if len(whole) < 2:
        return MadeExhibit(_of(project), missing="the project has fewer than two actions: nothing grows")
    found = []
    for count in sorted({*(n for n in STEPS if n < len(whole)), len(whole)}):
        counted = count_machine_size(make_smaller_project(project, count))
        found.append((count, counted.connections))
    slope = _slope([(n, c) for n, c in found if c])
    imagined = count_machine_size(make_figure_1())
    rows = [(f"{n}", f"{n}", f"{c:,}", f"{c / n:.1f}") for n, c in found]
    drawn = drawings.draw_series(
        {
            "dropped": ("ours", [(n, n) for n, _ in found]),
            "connections": ("paper", [(n, c) for n, c in found if c]),
        },
        "actions (logarithmic)",
        "edits (logarithmic)",
        "What is dropped, and the connections it stands for",
        logs=True,
    )
    says = [
        f"{found[-1][0]} actions are as many drops; drawn by hand they are {found[-1][1]:,} connections.",
        "The paper calls the growth exponential. Connections grow as the product of what ends in a stance "
        f"and what begins there: as a power of the number of actions, here {slope:.2f} (2 where stances are "
        "as many, 1 where each new stance brings its own actions).",
        f"Its example, {EXAMPLE_STANCES} stances with {EXAMPLE_ON_EACH} gestures and {EXAMPLE_ON_EACH} "
        f"fidgets on each and a transition from each to each (figure 1): {imagined.states} states and "
        f"{imagined.connections:,} connections, or {imagined.states} drops on 4 nodes (figure 2).",
    ]
    return MadeExhibit(
        _of(project),
        tuple(says),
        (
            ExhibitTable(
                "Connections of the first actions",
                ("actions", "drops on the meta-graph", "connections by hand", "connections an action"),
                tuple(rows),
            ),
            ExhibitDrawing(
                "The project's actions, stances' loops first, then in an order drawn by chance", drawn
            ),
        ),
        {"growth": found, "power": slope, "figure 1": [imagined.states, imagined.connections]},
    )


def exhibit_hours(material: ExhibitMaterial) -> MadeExhibit:
    """Section 7.1: 8 hours against 63, which were timed, and ours, which are counted."""
    from metagraph.research.study.machines.by_hand import Way
    from metagraph.research.study.machines.counted_drops import label_by_drops
    from metagraph.research.study.machines.counted_fields import label_by_fields
    from metagraph.research.study.machines.counted_hand import search_ways, try_way

    published, project = compute_example(), keep_first_uses(material.project)
    again = len(list(material.project.actions())) - len(list(project.actions()))
    about = _of(project) + (f", {again} further uses of the same clips left out" if again else "")
    if len(list(project.actions())) < 2:
        return MadeExhibit(about, missing="the project has fewer than two actions: there is nothing to wire")
    meta: Any = label_by_drops(project)
    with suppress(ValueError):  # names that do not tell clips apart
        meta = min(meta, label_by_fields(project), key=lambda way: way.seconds)
    tried = [
        try_way(Way("many at once", "from aliases", "words", "many at once", True), project),
        try_way(Way("one by one", "one by one", "clicks", "each", True), project),
    ]
    if material.full:
        tried = [search_ways(project)[0], tried[-1]]
    best, each = min(tried, key=lambda t: t.seconds), tried[-1]
    clips = len(list(project.actions()))

    def row(words: str, kind: str, seconds: float, mistakes: str, count: int) -> tuple[str, ...]:
        return words, kind, _time(seconds), f"{seconds / 60 / count:.2f}", mistakes

    rows = [
        row("there: meta-graph", "timed, one animator", META_HOURS * 3600, "fewer", CLIPS),
        row(
            "there: Unreal's state machine",
            "timed, the same animator",
            MANUAL_HOURS * 3600,
            "many more",
            CLIPS,
        ),
        row("here: meta-graph, many at once", "counted", meta.seconds, _left(meta.score), clips),
        row(f"here: by hand, {best.way}", "counted", best.seconds, _left(best.score), clips),
        row("here: by hand, link by link", "counted", each.seconds, _left(each.score), clips),
    ]
    ratio, every = best.seconds / meta.seconds, each.seconds / meta.seconds
    says = [
        f"There: {MANUAL_HOURS:g} / {META_HOURS:g} = {published.ratio.value:.2f} times as long, told as "
        f"{TIMES_FASTER} times. One person, one order, no interval; with the week of tutorial "
        f"{published.with_tutorial:.1f} times.",
        "Here nobody was timed. Operators of the keystroke-level model were counted while the real edits "
        "were made by somebody who makes no mistake and never looks, so hours and minutes are different in "
        "kind and only ratios may be laid beside each other.",
        f"By hand takes {every:.1f} times as long link by link, and {ratio:.2f} times in the "
        + ("quickest way a search could find" if material.full else "quickest way known")
        + ", with aliases that the paper's editor did not have: "
        + f"{'slower' if ratio > 1 else 'faster'} than dropping clips where names tell what they are and "
        "nothing is proposed. docs/researchers/experts-paths.md has the race with proposals, in the real "
        "window.",
    ]
    bars = [
        ("there (timed)", [("paper", MANUAL_HOURS / META_HOURS, None, None)]),
        ("here, link by link", [("ours", every, None, None)]),
        ("here, best way", [("ours", ratio, None, None)]),
    ]
    drawn = drawings.draw_paired_bars(
        bars,
        (("paper", "timed"), ("ours", "counted")),
        "times as long by hand",
        "By hand over meta-graph",
        one=1.0,
    )
    head = ("", "", "time", "minutes a clip", "mistakes")
    table = ExhibitTable(f"{CLIPS} clips there, {clips} here", head, tuple(rows))
    return MadeExhibit(
        about,
        tuple(says),
        (table, ExhibitDrawing("Ratios; the dashed line is no difference", drawn)),
        {
            "published": published.ratio.value,
            "link by link": every,
            "best way": ratio,
            "seconds": {"meta": meta.seconds, "best": best.seconds, "each": each.seconds},
        },
    )


def keep_first_uses(project: Project) -> Project:
    """Return a project with the first use of each clip: who wires clips by hand makes a state of each."""
    first = {a.clip: a.id for a in reversed(list(project.actions()))}
    return remove_actions(project, [a.id for a in project.actions() if first[a.clip] != a.id])


def _left(score: Score) -> str:
    """Say what is not as in the reference: connections, and what neither a drop nor a link sets."""
    settings = sum(m.what in ("mask", "timing") for m in score.mistakes)
    wrong = len(score.mistakes) - settings
    return f"{wrong} wrong" + (f"; {settings} masks and times not set" if settings else "")


def make_smaller_project(project: Project, count: int) -> Project:
    """Return a project with so many of its actions: loops of stances first, then others in an order drawn by
    chance, the same each time.
    """
    order = sorted(project.actions(), key=lambda a: (a.kind != "stance", uniform(1, a.id)))
    return remove_actions(project, [a.id for a in order[count:]])


def make_figure_1() -> Project:
    """Return the graph that figure 1 imagines: a gesture and a fidget so many times on each stance, and a
    transition from each stance to each other.
    """
    names = [f"stance {n}" for n in range(EXAMPLE_STANCES)]
    actions: list[Action] = []

    def add(kind: Kind, stance: str, end: str | None = None) -> None:
        ident = f"{kind} {len(actions)}"
        actions.append(Action(ident, ident, kind, "arms", stance, ident, end))

    for name in names:
        add("stance", name)
        for _ in range(EXAMPLE_ON_EACH):
            add("gesture", name)
            add("fidget", name)
        for other in names:
            if other != name:
                add("transition", name, other)
    stances = {n: Stance(n, "arms", n) for n in names}
    graph = MetaGraph("arms", stances, {a.id: a for a in actions}, names[0])
    return Project(name="figure 1", graphs={**Project(name="").graphs, "arms": graph})


def _slope(points: list[tuple[int, int]]) -> float:
    """Return the power by which the second grows with the first, by least squares on logs."""
    xs, ys = [log(a) for a, _ in points], [log(b) for _, b in points]
    if len(set(xs)) < 2:
        return 1.0
    x, y = sum(xs) / len(xs), sum(ys) / len(ys)
    return sum((a - x) * (b - y) for a, b in zip(xs, ys, strict=True)) / sum((a - x) ** 2 for a in xs)


def _time(seconds: float) -> str:
    return f"{seconds / 3600:.1f} h" if seconds >= 5400 else f"{seconds / 60:.1f} min"


def _of(project: Project) -> str:
    return f"the project '{project.name}': {len(list(project.actions()))} actions"
