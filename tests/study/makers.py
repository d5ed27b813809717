"""Small projects for the tests of studies."""

from __future__ import annotations

from metagraph.graph import edits
from metagraph.graph.model import Project
from tests.projects import clip

LAYER = "arms"


def small() -> Project:
    """Two stances of the arms; gestures, a fidget, a transition each way: 8 states, 31 connections."""
    names = ("sides_idle", "hips_idle", "sides_wave", "sides_shrug", "sides_scratch", "hips_point", "sides_to_hips", "hips_to_sides")
    project = edits.add_clips(Project("small"), [(f"clips/{n}.glb", 0, "", clip(n, 61)) for n in names])
    ids = {e.name: e.id for e in project.clips.values()}
    for stance in ("sides", "hips"):
        project = edits.add_stance(project, LAYER, stance, [ids[f"{stance}_idle"]])
    sides, hips = project.graphs[LAYER].stances
    project = edits.place(project, [ids["sides_wave"], ids["sides_shrug"]], LAYER, "gesture", sides)
    project = edits.place(project, [ids["sides_scratch"]], LAYER, "fidget", sides)
    project = edits.place(project, [ids["hips_point"]], LAYER, "gesture", hips)
    project = edits.place(project, [ids["sides_to_hips"]], LAYER, "transition", sides, hips)
    return edits.place(project, [ids["hips_to_sides"]], LAYER, "transition", hips, sides)
