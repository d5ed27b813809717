"""Hands that stay where they are on the body, while both move."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.graph import anatomy, edits
from metagraph.graph.clip_source import get_source_clip
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.retiming import keep_hand
from metagraph.motion.contact_hold import Contact, hold_hands


@pytest.fixture(scope="module")
def project(toy):
    return edits.add_clips(toy.project(), [("wide.glb", 0, "", toy.clip("wide", 2.4, swing=1.2))])


def beside(clip, hand, to):
    """Where a joint is, seen from another `[F, 3]`."""
    from metagraph.motion import rotation

    turns, places = clip.skeleton.globals(clip.poses())
    return rotation.rotate_vectors(rotation.conjugate(turns[:, to]), places[:, hand] - places[:, to])


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_hand_stays_where_it_is_and_goes_on_afterwards(toy, project, side):
    clip = toy.id(project, "wide")
    kept = keep_hand(project, clip, side, 0.6, 1.2)
    before, after = get_source_clip(project.clips[clip]), kept.clips[clip].motion
    (contact,) = kept.clips[clip].retime.contacts
    names = before.skeleton.names
    hand, to = names.index(contact.hand), names.index(contact.to)
    place = beside(after, hand, to)
    inside = slice(round(0.6 * after.fps), round(1.2 * after.fps) + 1)
    assert np.ptp(place[inside], axis=0).max() < 5e-3, "it does not slide"
    untouched = slice(round(1.95 * after.fps), None)
    assert np.allclose(after.rotations[untouched], before.rotations[untouched], atol=1e-6)
    speed = np.linalg.norm(np.diff(place, axis=0), axis=-1) * after.fps
    fastest = np.linalg.norm(np.diff(beside(before, hand, to), axis=0), axis=-1).max() * after.fps
    assert speed.max() < 3 * max(fastest, 0.2), "it neither comes nor goes with a jump"


def test_bones_keep_their_lengths_and_nothing_else_moves(toy, project):
    clip = toy.id(project, "wide")
    kept = keep_hand(project, clip, "right", 0.6, 1.2).clips[clip].motion
    before = get_source_clip(project.clips[clip])
    roles = anatomy.project_roles(project)
    arm = {roles[f"right_{part}"] for part in ("upper_arm", "lower_arm", "hand")}
    others = [j for j in range(len(before.skeleton)) if j not in arm]
    assert np.array_equal(kept.rotations[:, others], before.rotations[:, others])
    assert np.array_equal(kept.translations, before.translations)


def test_what_is_no_limb_is_left_out(toy, project):
    clip = get_source_clip(project.clips[toy.id(project, "wide")])
    names = clip.skeleton.names
    assert hold_hands(clip, [Contact("no", "such", "joint", names[0], 0, 1)]) is clip
    assert hold_hands(clip, [Contact(names[0], names[0], names[0], names[0], 0, 1)]) is clip


def test_an_arm_that_is_not_known_is_said(toy, project):
    with pytest.raises(EditError, match="find its file"):
        keep_hand(project, "gone", "left", 0, 1)
    with pytest.raises(EditError, match="could stay at"):
        keep_hand(project, toy.id(project, "wide"), "left", 1.0, 1.0)


def test_another_contact_of_the_same_hand_takes_the_place_of_the_one_it_meets(toy, project):
    clip = toy.id(project, "wide")
    kept = keep_hand(keep_hand(project, clip, "left", 0.2, 0.6), clip, "left", 0.5, 0.9)
    assert [c.first for c in kept.clips[clip].retime.contacts] == [0.5]
    both = keep_hand(kept, clip, "right", 0.5, 0.9)
    assert len(both.clips[clip].retime.contacts) == 2


@pytest.mark.parametrize("name", ["Idle01_YouLf01", "Idle01_NegativeBt01", "Idle02_MeRt01"])
def test_hands_of_a_figure_nobody_here_made_stay_too(shared_data, name):
    from metagraph.formats.clips import read_clips
    from metagraph.graph.model import Project

    path = shared_data / "smartbody-brad" / f"ChrBrad@{name}.bvh"
    project = edits.add_clips(Project(), [(path.as_posix(), 0, "", read_clips(path)[0])])
    (clip,) = project.clips
    length = project.clips[clip].duration
    for side in ("left", "right"):
        after = keep_hand(project, clip, side, 0.4 * length, 0.6 * length).clips[clip]
        contact, motion = after.retime.contacts[0], after.motion
        hand, to = (motion.skeleton.index(n) for n in (contact.hand, contact.to))
        inside = slice(int(0.4 * length * motion.fps) + 1, int(0.6 * length * motion.fps))
        slid = np.ptp(beside(motion, hand, to)[inside], axis=0).max()
        was = np.ptp(beside(after.source, hand, to)[inside], axis=0).max()
        assert slid < max(0.005, 0.1 * was), f"{side}: {slid:.3f} of {was:.3f} m"
