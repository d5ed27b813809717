"""The edit that plays a clip otherwise: it is kept as it was read, and all that names moments follows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from metagraph.graph import edits
from metagraph.graph.clip_source import get_clip_course, get_source_clip, with_source
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.retiming import keep_hand, set_hold, set_kept, set_retime, set_speed
from metagraph.graph.model import BasePose
from metagraph.motion.retime import Hold, Retime


@pytest.fixture(scope="module")
def project(toy):
    project = toy.project()
    ident = toy.id(project, "rest wave rt")
    return edits.update_actions(
        project, [ident], timing={"start": 0.2, "end": 1.0, "stroke_end": 0.5, "relax": 0.6}
    )


@pytest.fixture
def wave(toy, project):
    return project.action(toy.id(project, "rest wave rt"))


def test_a_slower_clip_takes_its_actions_with_it_and_comes_back_as_it_was(project, wave):
    slow = set_speed(project, wave.clip, 0.5)
    t = slow.action(wave.id).timing
    assert (t.start, t.end, t.stroke_end) == pytest.approx((0.4, 2.0, 1.0), abs=0.02)
    entry = slow.clips[wave.clip]
    assert entry.source is project.clips[wave.clip].motion and entry.frames == entry.motion.frames
    back = set_speed(slow, wave.clip, 1.0)
    assert back.clips[wave.clip].motion is project.clips[wave.clip].motion
    assert back.clips[wave.clip].source is None and back.clips == project.clips
    t = back.action(wave.id).timing
    assert (t.start, t.end, t.stroke_end) == pytest.approx((0.2, 1.0, 0.5), abs=0.005)


def test_a_hold_is_within_the_phase_in_which_it_is_put(project, wave):
    held = set_hold(project, wave.clip, 0.55, 0.4)
    t = held.action(wave.id).timing
    assert t.relax - t.stroke_end == pytest.approx(0.1 + 0.4, abs=0.03)
    assert t.end == pytest.approx(1.4, abs=0.03) and t.start == 0.2
    longer = set_hold(held, wave.clip, 0.55, 0.9)
    assert len(longer.clips[wave.clip].retime.holds) == 1
    assert set_hold(longer, wave.clip, 0.55, 0.0).clips[wave.clip].retime == Retime()


def test_actions_that_do_not_use_the_clip_and_ends_at_its_end_stay(toy, project, wave):
    slow = set_speed(project, wave.clip, 0.5)
    for action in project.actions():
        if action.clip != wave.clip:
            assert slow.action(action.id) is action
    whole = edits.update_actions(project, [wave.id], timing={"end": None})
    assert set_speed(whole, wave.clip, 2.0).action(wave.id).timing.end is None


def test_the_base_pose_keeps_its_pose(project, wave):
    based = replace(project, base=BasePose(wave.clip, 18))
    slow = set_speed(based, wave.clip, 0.5)
    before = based.clips[wave.clip].motion.rotations[18]
    after = slow.clips[wave.clip].motion.rotations[slow.base.frame]
    assert np.allclose(before, after, atol=0.05) and slow.base.frame == 36


def test_what_cannot_be_done_says_why(project, wave):
    with pytest.raises(EditError, match="no longer"):
        set_speed(project, "gone", 2.0)
    clips = {**project.clips, wave.clip: replace(project.clips[wave.clip], motion=None)}
    with pytest.raises(EditError, match="is missing"):
        set_speed(replace(project, clips=clips), wave.clip, 2.0)
    assert set_speed(project, wave.clip, 1.0) is project


def test_a_file_that_is_read_again_is_retimed_again(project, wave):
    slow = set_speed(project, wave.clip, 0.5)
    entry, source = slow.clips[wave.clip], project.clips[wave.clip].motion
    again = edits.add_clips(slow, [(entry.path, entry.take, "ab" * 32, source)])
    assert again.clips[wave.clip].frames == entry.frames
    assert again.clips[wave.clip].motion.duration == pytest.approx(2 * source.duration, abs=0.05)
    assert get_source_clip(again.clips[wave.clip]) is source


def test_the_course_of_a_clip_says_where_it_is_held(project, wave):
    held = set_retime(project, wave.clip, Retime(2.0, (Hold(0.4, 0.5),)))
    (first, last), *_ = get_clip_course(held.clips[wave.clip]).stays
    assert 0.2 <= first < last and last - first == pytest.approx(0.5, abs=0.2)
    assert with_source(held.clips[wave.clip], get_source_clip(held.clips[wave.clip])) == held.clips[wave.clip]


def kept_hand(project, clip, first=0.3, last=0.7):
    return keep_hand(project, clip, "right", first, last)


def test_a_kept_hand_is_kept_longer_or_elsewhere_and_let_go(project, wave):
    kept = kept_hand(project, wave.clip)
    (before,) = kept.clips[wave.clip].retime.contacts
    (longer,) = set_kept(kept, wave.clip, 0, before.first, 0.9).clips[wave.clip].retime.contacts
    assert longer == replace(before, last=0.9), "it stays where it is as long as it begins where it did"
    whole = set_kept(kept, wave.clip, 0, -1.0, 99.0)
    (all_of,) = whole.clips[wave.clip].retime.contacts
    assert (all_of.first, all_of.last) == (
        0.0,
        pytest.approx(get_source_clip(whole.clips[wave.clip]).duration),
    )
    for first, last in ((0.5, 0.5), (0.6, 0.2)):
        assert set_kept(kept, wave.clip, 0, first, last).clips[wave.clip].retime.plain
    with pytest.raises(EditError, match="no longer"):
        set_kept(kept, wave.clip, 1, 0.1, 0.2)
    with pytest.raises(EditError, match="no longer"):
        set_kept(kept, "gone", 0, 0.1, 0.2)


def test_a_hand_is_never_kept_twice_at_a_time(project, wave):
    two = kept_hand(kept_hand(project, wave.clip, 0.1, 0.3), wave.clip, 0.6, 0.9)
    first, second = set_kept(two, wave.clip, 0, 0.1, 0.8).clips[wave.clip].retime.contacts
    assert (first.last, second.first) == (0.6, 0.6)
    first, second = set_kept(two, wave.clip, 1, 0.0, 0.8).clips[wave.clip].retime.contacts
    assert (first.last, second.first) == (0.3, 0.3)
    other = keep_hand(two, wave.clip, "left", 0.2, 0.8)
    third = set_kept(other, wave.clip, 2, 0.0, 0.9).clips[wave.clip].retime.contacts[2]
    assert (third.first, third.last) == (0.0, 0.9), "the other hand has its own time"
