"""Visible jumps are judged for every connection, by what is usual in the reference's clips."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

from metagraph.formats.store import open_project, read_project
from metagraph.graph import edits
from metagraph.graph.manual import edits as manual_edits
from metagraph.graph.model import Project
from metagraph.research.study.machines.normal_machine import normalize_machines
from metagraph.research.study.scores.jumps import with_jumps
from metagraph.research.study.scores.machines import Score
from metagraph.research.study.simulation.work import draw_every_connection
from metagraph.suggest.jumps.found import Measured, find_jumps
from tests.research.study.makers import small

SAMPLE = Path(__file__).resolve().parents[4] / "sample_clips" / "sample.metagraph.yaml"


@cache
def sample() -> Project:
    return open_project(SAMPLE).project


def judged(attempt: Project, reference: Project | None = None) -> Score:
    return with_jumps(Score(), normalize_machines(attempt), reference or sample())


def named(project: Project, layer: str, name: str) -> str:
    return next(a.id for a in project.graphs[layer].actions.values() if a.name == name)


def test_nothing_is_judged_without_clips_or_with_too_few() -> None:
    assert judged(small(), read_project(SAMPLE)).jumps is None
    few = edits.remove_actions(small(), [a.id for a in small().actions()][3:])
    assert judged(few, few).jumps is None
    assert judged(Project()).jumps is None


def test_clips_that_the_reference_has_not_are_left_out() -> None:
    assert judged(small()).jumps == 0


@pytest.mark.nightly
def test_a_good_machine_does_not_jump_in_either_condition() -> None:
    assert judged(sample()).jumps == judged(draw_every_connection(sample())).jumps == 0
    assert not any(find_jumps(sample(), Measured(sample(), layer)) for layer in sample().graphs)


def test_a_clip_on_the_wrong_stance_jumps_to_and_from_what_it_does_not_fit() -> None:
    project = sample()
    graph = project.graphs["arms"]
    gesture = next(
        a
        for a in graph.actions.values()
        if a.kind == "gesture" and graph.stances[a.stance].name == "arms crossed"
    )
    hips = next(s.id for s in graph.stances.values() if s.name == "on hips")
    found = judged(edits.move_actions(project, [gesture.id], "gesture", hips))
    assert found.jumps is not None and found.jumps > 2
    key = normalize_machines(project)["arms"].states
    clip = next(k for k, s in key.items() if project.clips[gesture.clip].path.endswith(s.clip))
    assert any(m.clip == clip and m.words.startswith(f"{clip} jumps to ") for m in found.mistakes)
    assert found.count("jump") == found.jumps


def test_a_link_by_hand_between_stances_jumps_unless_it_is_blended_for_long() -> None:
    project = draw_every_connection(sample())
    machine = project.manual["arms"]
    loops = {s.name: s.id for s in machine.states.values() if s.loop}
    crossed, sides = (
        next(i for name, i in loops.items() if name.startswith(n)) for n in ("arms crossed", "hands at sides")
    )
    project = manual_edits.add_link(project, "arms", crossed, sides)
    ident = [*project.manual["arms"].links][-1]
    assert judged(manual_edits.update_links(project, [ident], blend=0.1)).jumps == 1
    assert judged(manual_edits.update_links(project, [ident], blend=8.0)).jumps == 0


def test_what_can_be_left_at_any_time_is_judged_at_no_moment_in_particular() -> None:
    project = draw_every_connection(sample())
    machine = project.manual["arms"]
    gesture = max((s for s in machine.states.values() if not s.loop), key=lambda s: (s.end or 0) - s.start)
    rest = next(x for x in machine.links.values() if x.source == gesture.id and machine.states[x.target].loop)
    links = {
        **machine.links,
        rest.id: replace(
            rest, exit_time=None, blend=0.0, condition=replace(rest.condition, when="request", trigger="x")
        ),
    }
    assert judged(project.with_manual(replace(machine, links=links))).jumps == 1


@pytest.mark.nightly
def test_a_mask_leaves_out_what_is_not_moved() -> None:
    project = sample()
    graph = project.graphs["arms"]
    gesture = next(
        a
        for a in graph.actions.values()
        if a.kind == "gesture" and graph.stances[a.stance].name == "arms crossed"
    )
    hips = next(s.id for s in graph.stances.values() if s.name == "on hips")
    moved = edits.move_actions(project, [gesture.id], "gesture", hips)
    still = edits.update_actions(moved, [gesture.id], joints=(project.skeleton.names[0],))
    assert (judged(still).jumps or 0) < (judged(moved).jumps or 0)
    faint = edits.update_actions(
        moved, [gesture.id], joint_weights=tuple((name, 0.05) for name in project.skeleton.names)
    )
    assert (judged(faint).jumps or 0) < (judged(moved).jumps or 0)
