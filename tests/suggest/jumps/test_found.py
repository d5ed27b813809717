"""Which actions jump, when they would not, and what is measured again."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from metagraph.graph import edits
from metagraph.graph.checks.end_gaps import find_end_gaps
from metagraph.graph.model import LAYERS, Project
from metagraph.suggest.accept import accept
from metagraph.suggest.jumps import compatibility as c
from metagraph.suggest.jumps.bridges import bridge_all
from metagraph.suggest.jumps.found import FEWEST_CLIPS, Measured, compute_stance_curves, find_jumps
from metagraph.suggest.propose import propose
from tests.label_zoo.catalogue import named


def cut(toy: Any, project: Project, name: str, **timing: Any) -> Project:
    return edits.update_actions(project, [toy.id(project, name)], timing=timing)


@pytest.fixture
def wide(toy: Any) -> Project:
    """The toy project with a wave so wide that it is far from its stance in the middle."""
    project = edits.add_clips(toy.project(), [("wide.glb", 0, "", toy.clip("wide", 2.4, swing=2.4))])
    return edits.place_clips(project, [toy.id(project, "wide")], "arms", "gesture", toy.id(project, "rest"))


def found(project: Project) -> list[Any]:
    return find_jumps(project, Measured(project, "arms"))


def test_an_empty_project_has_no_jumps_and_nothing_to_rest_on() -> None:
    for layer in LAYERS:
        measured = Measured(Project(), layer)
        assert not measured.reliable and find_jumps(Project(), measured) == []


def test_few_clips_are_not_judged(toy: Any) -> None:
    project = toy.project()
    kept = [a.id for a in project.actions()][FEWEST_CLIPS - 1 :]
    project = edits.remove_actions(project, kept)
    measured = Measured(project, "arms")
    assert (
        measured.labelled == FEWEST_CLIPS - 1
        and not measured.reliable
        and find_jumps(project, measured) == []
    )


@pytest.mark.parametrize("layer", LAYERS)
def test_the_sample_has_no_jumps(sample: Project, layer: Any) -> None:
    measured = Measured(sample, layer)
    assert measured.reliable and find_jumps(sample, measured) == []


@pytest.mark.parametrize("layer", LAYERS)
def test_no_proposed_timing_jumps(sample: Project, layer: Any) -> None:
    measured, changes = Measured(sample, layer), {}
    for action in sample.graphs[layer].actions.values():
        p = compute_stance_curves(sample, measured, action).proposed  # type: ignore[union-attr]
        timing = {"start": p.start, "end": p.end, "blend_in": p.blend_in, "blend_out": p.blend_out}
        changes[action.id] = {"timing": timing if action.kind != "stance" else {"blend_in": p.blend_in}}
    assert find_jumps(edits.update_each(sample, changes), measured) == []


def test_an_action_cut_short_jumps_at_its_end_and_is_mended_where_it_would_not(
    toy: Any, wide: Project
) -> None:
    project = cut(toy, wide, "wide", end=1.5, blend_out=0.05)
    (jump,) = found(project)
    assert (
        (jump.edge, jump.at) == ("ends", 1.5) and jump.cost > 1 and project.stance(jump.stance).name == "rest"
    )  # type: ignore[union-attr]
    assert jump.better is not None and 1.5 < jump.better <= 2.4 and jump.change == {"end": jump.better}
    assert found(edits.update_actions(project, [jump.action], timing=jump.change)) == []


def test_a_late_start_jumps_and_a_start_before_the_stroke_mends_it(toy: Any, wide: Project) -> None:
    project = cut(toy, wide, "wide", start=1.0, blend_in=0.05)
    (jump,) = found(project)
    assert jump.edge == "begins" and jump.better is not None and jump.better < 1.0
    assert found(edits.update_actions(project, [jump.action], timing=jump.change)) == []


def test_an_early_exit_behind_the_new_end_goes(toy: Any) -> None:
    project = edits.add_clips(toy.project(), [("away.glb", 0, "", toy.clip("away", 2.4, 0.0, 2.6, 0.0))])
    project = edits.place_clips(
        project, [toy.id(project, "away")], "arms", "gesture", toy.id(project, "rest")
    )
    project = cut(toy, project, "away", stroke=0.1, earliest_exit=2.0, blend_out=0.1)
    (jump,) = found(project)
    assert (
        jump.better is not None
        and jump.better < 2.0
        and jump.change == {"end": jump.better, "earliest_exit": None}
    )


def test_a_longer_blend_hides_what_no_moment_mends(toy: Any) -> None:
    project = toy.project()
    wave, up = toy.id(project, "rest wave rt"), toy.id(project, "up")
    project = edits.update_actions(project, [wave], stance=up, timing={"blend_in": 0.02, "blend_out": 0.02})
    mine = {j.edge: j for j in found(project) if j.action == wave}
    assert mine
    for jump in mine.values():
        assert jump.change or jump.fits is not None
    blended = [j for j in mine.values() if j.better is None and j.change]
    for jump in blended:
        left = found(edits.update_actions(project, [wave], timing=jump.change))
        assert jump.edge not in {j.edge for j in left if j.action == wave}


def test_a_transition_that_ends_elsewhere_says_what_it_looks_like(toy: Any) -> None:
    project = toy.project()
    way, far = toy.id(project, "rest to up"), toy.id(project, "far")
    project = edits.set_ends(project, [way], far)
    project = edits.update_actions(project, [way], timing={"blend_out": 0.0})
    jump = next(j for j in found(project) if j.action == way)
    assert jump.edge == "ends" and jump.stance == far and jump.fits == toy.id(project, "up")


def test_an_open_loop_is_mended_by_blending_its_seam(toy: Any) -> None:
    project = toy.project()
    loop = toy.clip("open", 2.0, 0.0, 0.5, 0.2)
    project = edits.add_clips(project, [("open.glb", 0, "", loop)])
    project = edits.place_clips(project, [toy.id(project, "open")], "arms", "stance", toy.id(project, "rest"))
    project = cut(toy, project, "open", blend_in=0.0)
    (jump,) = [j for j in found(project) if j.edge == "loops"]
    assert set(jump.change) == {"blend_in"}
    assert not [
        j
        for j in found(edits.update_actions(project, [jump.action], timing=jump.change))
        if j.edge == "loops"
    ]


def test_what_an_action_does_not_move_does_not_count(toy: Any, wide: Project) -> None:
    project = cut(toy, wide, "wide", end=1.5, blend_out=0.05)
    head = edits.update_actions(project, [toy.id(project, "wide")], joints=("Head",))
    assert found(project) and not found(head)


def test_only_what_changed_is_measured_again(toy: Any) -> None:
    project = toy.project()
    first = Measured(project, "arms")
    find_jumps(project, first)
    timed = cut(toy, project, "rest wave rt", end=0.6)
    again = Measured(timed, "arms", first)
    assert again.same_as(first) and all(again.frames[s] is first.frames[s] for s in first.frames)
    assert again._costs.keys() == first._costs.keys()
    loop = Measured(cut(toy, project, "up loop", end=1.0), "arms", first)
    assert loop.stats is first.stats and not loop.same_as(first)
    up = toy.id(project, "up")
    assert {s for s in loop.frames if loop.frames[s] is not first.frames[s]} == {up} and not [
        k for k in loop._costs if k[1] == up
    ]
    fewer = Measured(edits.remove_actions(project, [toy.id(project, "rest long")]), "arms", first)
    assert fewer.stats is not first.stats and not fewer._costs


def test_curves_of_a_loop_are_its_seam_and_of_a_missing_file_nothing(toy: Any, wide: Project) -> None:
    from dataclasses import replace

    project = wide
    measured = Measured(project, "arms")
    loop = project.action(next(a.id for a in project.actions() if a.name == "rest loop"))
    seen = compute_stance_curves(project, measured, loop)
    assert (
        seen is not None
        and len(seen.times) == len(seen.leave)
        and seen.leave[0] == pytest.approx(0, abs=1e-6)
    )
    wave = project.action(toy.id(project, "wide"))
    seen = compute_stance_curves(project, measured, wave)
    assert seen is not None and seen.leave.max() > 1 > seen.leave[-1] and np.isfinite(seen.enter).all()
    clips = {**project.clips, wave.clip: replace(project.clips[wave.clip], motion=None)}
    assert compute_stance_curves(replace(project, clips=clips), measured, wave) is None


def test_proposed_times_leave_the_part_that_repeats_as_it_is(toy: Any, wide: Project) -> None:
    wave = toy.id(wide, "rest wave rt")
    timing = {"start": 0.3, "end": 0.7, "blend_in": 0.3, "blend_out": 0.2, "repeat": 2.0}
    project = edits.update_actions(wide, [wave], timing=timing)
    strip = compute_stance_curves(project, Measured(project, "arms"), project.action(wave))  # type: ignore[arg-type]
    assert strip is not None and strip.proposed.good and "repeats" in strip.proposed.reason
    found = strip.proposed
    assert [found.start, found.end, found.blend_in, found.blend_out] == pytest.approx([0.3, 0.7, 0.3, 0.2])


def test_a_blend_takes_off_what_the_player_blends() -> None:
    assert c.measure_visible_difference(2.0, 0.0) == 2.0 and c.measure_visible_difference(2.0, 0.05) == 2.0
    assert c.measure_visible_difference(2.0, 0.2) == pytest.approx(1.0) and np.allclose(
        c.measure_visible_difference(np.array([1.0, 3.0]), 0.1), [1.0, 3.0]
    )


def test_a_moment_far_away_is_not_proposed_where_a_longer_blend_would_do(toy: Any) -> None:
    project = edits.add_clips(toy.project(), [("away.glb", 0, "", toy.clip("away", 2.4, 0.0, 1.5, 0.0))])
    project = edits.place_clips(
        project, [toy.id(project, "away")], "arms", "gesture", toy.id(project, "rest")
    )
    (jump,) = found(cut(toy, project, "away", stroke=0.1, blend_out=0.1))
    assert jump.better is None and set(jump.change) == {"blend_out"}


def test_a_long_slow_blend_over_a_wide_gap_is_no_jump_and_a_short_one_is() -> None:
    """Takes in which little moves from frame to frame, so that each blend from seat to seat is unusual."""
    made = named("opaque days of sitting").project
    project, bridges = bridge_all(accept(made, propose(made)).project)
    (name,) = [x.action for x in bridges]
    for blend, edges in ((0.1, ["begins"]), (0.39, ["begins"]), (0.55, [])):
        blended = edits.update_actions(project, [name], timing={"blend_in": blend})
        assert [x.edge for x in found(blended) if x.action == name] == edges, blend
    strip = compute_stance_curves(project, Measured(project, "arms"), project.action(name))  # type: ignore[arg-type]
    assert strip is not None and strip.gaps is not None
    assert strip.gaps[0][0] > 0.3 > 0.05 > strip.gaps[1][0]


@pytest.mark.nightly
@pytest.mark.parametrize("name", ["opaque takes", "sitting, leaning, standing"])
def test_proposed_times_leave_no_joint_far_from_a_stance_where_the_present_ones_do_not(name: str) -> None:
    made = named(name).project
    project, _ = bridge_all(accept(made, propose(made)).project)
    measured = {layer: Measured(project, layer) for layer in LAYERS}
    changes = {}
    for action in project.actions():
        strip = compute_stance_curves(project, measured[action.layer], action)
        if strip is not None and action.kind != "stance":
            p = strip.proposed
            times = {"start": p.start, "end": p.end, "blend_in": p.blend_in, "blend_out": p.blend_out}
            changes[action.id] = {"timing": {**times, "earliest_exit": p.earliest_exit}}
    after = edits.update_each(project, changes)
    assert len(changes) > 10
    before, now = far(project), far(after)
    assert now <= before, now - before


def far(project: Project) -> set[str]:
    graphs = project.graphs.values()
    return {
        a.id for g in graphs for a in g.actions.values() if any(x.far for x in find_end_gaps(project, g, a))
    }
