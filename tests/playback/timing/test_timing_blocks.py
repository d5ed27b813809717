"""Phases as blocks that are dragged, handles with their numbers, and many clips moved by the same."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph import edits
from metagraph.playback.timing.handles import (
    BLOCKS,
    EDGES,
    find_blocks,
    handle_times,
    list_handles,
    move_block,
    move_handle_by,
    slip_action,
)


@pytest.fixture(scope="module")
def project(toy):
    project = toy.project()
    ident = toy.id(project, "rest wave rt")
    return edits.update_actions(
        project, [ident], timing={"start": 0.2, "end": 1.0, "ready": 0.4, "stroke_end": 0.6, "relax": 0.8}
    )


@pytest.fixture
def wave(toy, project):
    return project.action(toy.id(project, "rest wave rt"))


def edges(project, ident):
    at = handle_times(project, project.action(ident))
    return [round(at[name], 3) for name in EDGES]


def test_a_gesture_has_four_phases_end_to_end_and_nothing_else_has_any(toy, project, wave):
    found = find_blocks(project, wave)
    assert [b.name for b in found] == list(BLOCKS)
    assert [(b.first, b.last) for b in found] == [(0.2, 0.4), (0.4, 0.6), (0.6, 0.8), (0.8, 1.0)]
    assert all(find_blocks(project, a) == () for a in project.actions() if a.kind != "gesture")
    assert move_block(project, project.action(toy.id(project, "rest loop")), "hold", 0.1) == {}


@pytest.mark.parametrize(
    ("block", "by", "after"),
    [
        ("stroke", 0.1, [0.2, 0.5, 0.7, 0.8, 1.0]),
        ("stroke", -0.1, [0.2, 0.3, 0.5, 0.8, 1.0]),
        ("stroke", 9, [0.2, 0.6, 0.8, 0.8, 1.0]),
        ("stroke", -9, [0.2, 0.2, 0.4, 0.8, 1.0]),
        ("hold", 0.05, [0.2, 0.4, 0.65, 0.85, 1.0]),
        ("preparation", -9, [0.0, 0.2, 0.6, 0.8, 1.0]),
        ("retraction", 0.1, [0.2, 0.4, 0.6, 0.9, 1.1]),
        ("retraction", -0.1, [0.2, 0.4, 0.6, 0.7, 0.9]),
    ],
)
def test_a_dragged_block_keeps_its_length_and_stops_at_its_neighbours(project, wave, block, by, after):
    changed = edits.update_actions(project, [wave.id], timing=move_block(project, wave, block, by))
    assert edges(changed, wave.id) == pytest.approx(after)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(st.sampled_from(BLOCKS), st.floats(-3, 3)), max_size=4))
def test_whatever_blocks_are_dragged_the_phases_stay_in_order_within_the_clip(toy, project, drags):
    ident = toy.id(project, "rest wave rt")
    for block, by in drags:
        action = project.action(ident)
        project = edits.update_actions(project, [ident], timing=move_block(project, action, block, by))
    found = edges(project, ident)
    assert found == sorted(found)
    assert found[0] >= 0 and found[-1] <= round(project.clips[project.action(ident).clip].duration, 3)


def test_handles_say_what_is_the_timings_own_and_how_long_a_blend_is(project, wave):
    found = {h.name: h for h in list_handles(project, wave)}
    assert found["in"].words == f"blend in {wave.timing.blend_in:.2f}"
    assert found["start"].words == "start 0.20" and found["start"].own
    assert not found["stroke"].own, "nobody has said where its stroke is"
    assert found["ready"].own
    assert "exit" not in found


def test_a_loop_has_its_seam_and_ends_alone(toy, project):
    loop = project.action(toy.id(project, "rest loop"))
    assert {h.name for h in list_handles(project, loop)} == {"start", "end", "in"}


def test_another_part_of_the_clip_is_as_long_and_all_that_was_set_goes_with_it(project, wave):
    changed = edits.update_actions(project, [wave.id], timing=slip_action(project, wave, 0.1))
    assert edges(changed, wave.id) == pytest.approx([0.3, 0.5, 0.7, 0.9, 1.1])
    back = edits.update_actions(
        changed, [wave.id], timing=slip_action(changed, changed.action(wave.id), -9)
    ).action(wave.id)
    assert (back.timing.start, back.timing.end) == (0.0, pytest.approx(0.8))
    assert slip_action(project, wave, 0.0) == {}


def test_the_same_drag_moves_the_handle_of_each_within_its_own_clip(toy, project):
    idents = [toy.id(project, n) for n in ("rest short", "rest long", "rest loop")]
    changes = move_handle_by(project, [*idents, "gone"], "start", 0.3)
    assert {i: c["timing"]["start"] for i, c in changes.items()} == dict.fromkeys(idents, 0.3)
    assert set(move_handle_by(project, idents, "out", -0.1)) == set(idents[:2]), "a loop is not blended out"
