"""Small projects for the tests of studies."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.research.study.analysis.reading import AnalysisRow, Data
from metagraph.research.study.scores.tasks import SPENT, TaskRun
from tests.projects import clip

LAYER = "arms"


def small() -> Project:
    """Two stances of the arms; gestures, a fidget, a transition each way: 8 states, 31 connections."""
    names = (
        "sides_idle",
        "hips_idle",
        "sides_wave",
        "sides_shrug",
        "sides_scratch",
        "hips_point",
        "sides_to_hips",
        "hips_to_sides",
    )
    project = edits.add_clips(Project("small"), [(f"clips/{n}.glb", 0, "", clip(n, 61)) for n in names])
    ids = {e.name: e.id for e in project.clips.values()}
    for stance in ("sides", "hips"):
        project = edits.add_stance(project, LAYER, stance, [ids[f"{stance}_idle"]])
    sides, hips = project.graphs[LAYER].stances
    project = edits.place_clips(project, [ids["sides_wave"], ids["sides_shrug"]], LAYER, "gesture", sides)
    project = edits.place_clips(project, [ids["sides_scratch"]], LAYER, "fidget", sides)
    project = edits.place_clips(project, [ids["hips_point"]], LAYER, "gesture", hips)
    project = edits.place_clips(project, [ids["sides_to_hips"]], LAYER, "transition", sides, hips)
    return edits.place_clips(project, [ids["hips_to_sides"]], LAYER, "transition", hips, sides)


def row(who: str, condition: str, task: str, seconds: float, index: int, **more: object) -> AnalysisRow:
    """A task that was done, without operators; more: fields of the run, `score` and `sitting`."""
    score, sitting = more.pop("score", None), more.pop("sitting", 1)
    spent = dict.fromkeys(SPENT, seconds / len(SPENT))
    run = TaskRun(
        who, condition, task, index, seconds, seconds, Counter(), 0.0, 0, 0, 0, {}, spent, True, None
    )
    return AnalysisRow(replace(run, **more), sitting, 8, 0.0, score)


# Four people, two tasks: who began with what, then seconds of `a` with the meta-graph and by hand, and of
# `b`.
BY_HAND = {
    "P1": ("meta", (100.0, 200.0), (200.0, 400.0)), "P2": ("manual", (100.0, 200.0), (100.0, 800.0)),
    "P3": ("meta", (50.0, 200.0), (200.0, 800.0)), "P4": ("manual", (100.0, 800.0), (100.0, 800.0)),
}  # fmt: skip


def four() -> Data:
    """The example of the documentation, whose figures are computed by hand."""
    rows = []
    for who, (began, a, b) in BY_HAND.items():
        order = ("meta", "manual") if began == "meta" else ("manual", "meta")
        for sitting, condition in enumerate(order):
            column = 0 if condition == "meta" else 1
            rows += [
                row(who, condition, task, took[column], 2 * sitting + n, sitting=sitting + 1)
                for n, (task, took) in enumerate((("a", a), ("b", b)))
            ]
    return Data(
        "Four people", ("meta", "manual"), {"a": "Task A", "b": "Task B"}, tuple(BY_HAND), tuple(rows)
    )
