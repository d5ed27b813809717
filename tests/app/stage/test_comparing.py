"""Two versions of a project: what differs, and what it looks like in each."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.stage.comparing import compare_projects, count_fates, film_difference
from metagraph.graph import edits


def changed(toy):
    """The toy, and what became of it: a gesture gone, one new, one that begins later."""
    before = toy.project()
    after = edits.remove_actions(before, [toy.id(before, "rest cough")])
    clip = next(e.id for e in after.clips.values() if e.name == "rest cough")
    after = edits.place_clips(after, [clip], "arms", "gesture", toy.id(after, "up"))
    later = toy.id(after, "rest long")
    return before, edits.update_actions(after, [later], timing=replace(after.action(later).timing, start=0.8))


def test_what_is_new_gone_and_changed_is_counted_and_shown_in_both(toy):
    before, after = changed(toy)
    found = compare_projects(before, after, None)
    assert count_fates(found.differences) == (1, 1, 1)
    films = {
        one.fate: [film_difference(found, one, side) for side in ("before", "after")]
        for one in found.differences
    }
    assert [film is not None for film in films["added"]] == [False, True]
    assert [film is not None for film in films["removed"]] == [True, False]
    then, now = films["changed"]
    assert then.frames > now.frames, "less of the clip is played"
    assert not np.allclose(then.rotations[: now.frames], now.rotations)


def test_clips_that_are_the_same_are_not_read_again(toy):
    before, after = changed(toy)
    bare = {i: replace(e, motion=None) for i, e in before.clips.items()}
    found = compare_projects(replace(before, clips=bare), after, None)
    assert all(e.motion is after.clips[i].motion for i, e in found.before.clips.items())


def test_settings_that_changed_are_shown_by_what_the_project_improvises(toy):
    project = toy.project()
    found = compare_projects(project, edits.set_settings(project, seed=9), None)
    assert [one.part for one in found.differences] == ["settings"]
    assert film_difference(found, found.differences[0], "before") is not None
