"""Clips skipped: which, why, and how one is taken up all the same."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph.model import Project
from metagraph.suggest.accept import accept
from metagraph.suggest.estimate import Belief
from metagraph.suggest.left_aside import explain_skipping, group_reasons, take_up_skipped
from metagraph.suggest.motion_guess import guess
from metagraph.suggest.propose import propose
from metagraph.suggest.review import Review
from metagraph.suggest.stances.known import discover_stances
from metagraph.suggest.words.names import NameGuess
from tests.label_zoo.catalogue import named
from tests.label_zoo.sets import MadeSet
from tests.suggest.test_traits import chain, of

SAYS_WALK = NameGuess(other=Belief("other", 0.9, "name says 'walk'"))


@pytest.fixture(scope="module")
def exercises() -> MadeSet:
    return named("one stance and exercises")


def test_a_clip_nobody_knows_anything_of_may_be_anything() -> None:
    assert explain_skipping(NameGuess(), None, None) == ""


def test_a_name_alone_leaves_aside_what_it_says_is_none_of_the_kinds() -> None:
    assert explain_skipping(SAYS_WALK, None, None) == "name says 'walk'"


def test_a_name_that_says_a_kind_is_believed_before_all_else(exercises: MadeSet) -> None:
    kind = NameGuess(kind=Belief("gesture", 0.9, ""))
    for entry in exercises.project.clips.values():
        t = of(entry.motion)  # type: ignore[arg-type]
        assert explain_skipping(kind, t, guess(t, {})) == ""
        assert explain_skipping(replace(SAYS_WALK, kind=kind.kind), t, guess(t, {})) == ""


def test_a_long_recording_of_many_movements_is_left_aside_unless_its_name_says_a_kind(toy: Any) -> None:
    stands = of(toy.clip("take", 40.0, 0.0, swing=0.05))
    arms = replace(stands.layers["arms"], bouts=14)
    take = replace(stands, layers={**stands.layers, "arms": arms})
    why = explain_skipping(NameGuess(), take, guess(take, {}))
    assert "a recording of 40 s with 14 movements" in why
    assert explain_skipping(NameGuess(kind=Belief("stance", 0.9, "")), take, guess(take, {})) == ""
    assert "recording" not in explain_skipping(NameGuess(), stands, guess(stands, {})), "an idle of 40 s"


def test_a_single_frame_is_left_aside_unless_other_clips_begin_there(toy: Any) -> None:
    pose = of(toy.clip("pose", 1.0, 0.8).trimmed(0, 1))
    alone = explain_skipping(NameGuess(), pose, guess(pose, {}))
    assert alone.startswith("is a single frame")
    others = {f"up {n}": of(toy.clip(f"up {n}", 1.5, 0.8, swing=0.3 + 0.1 * n)) for n in range(4)}
    shapes = discover_stances({**others, "pose": pose})
    assert explain_skipping(NameGuess(), pose, guess(pose, shapes), shapes=shapes) == ""
    far = of(toy.clip("far", 1.0, 2.4).trimmed(0, 1))
    assert "a pose in which no other clip begins" in explain_skipping(
        NameGuess(), far, guess(far, shapes), shapes=shapes
    )


def test_without_the_motion_a_short_clip_is_what_its_name_says(toy: Any) -> None:
    pose = of(toy.clip("pose").trimmed(0, 1))
    assert explain_skipping(NameGuess(), pose, None) == ""


@pytest.mark.parametrize("count", [1, 5])
def test_what_is_no_figure_is_judged_without_an_error(count: int) -> None:
    import numpy as np

    from metagraph.motion.clip import Clip

    skeleton = chain(count)
    clip = Clip("x", skeleton, 30, np.tile([0, 0, 0, 1.0], (40, count, 1)), np.zeros((40, 1, 3)))
    t = of(clip)
    assert "nan" not in explain_skipping(NameGuess(), t, guess(t, {}))


def test_exercises_are_left_aside_with_a_reason_and_what_a_talker_does_is_not(exercises: MadeSet) -> None:
    found = propose(exercises.project)
    entries = exercises.project.clips
    none = {c for c, e in entries.items() if exercises.truth[e.name]["kind"] is None}
    assert set(found.aside) <= none and len(found.aside) >= 0.75 * len(none)
    squats = {c for c, e in entries.items() if e.name.startswith("squat")}  # a word for a pose, too
    assert squats and squats <= set(found.aside)
    assert not set(found.aside) & set(found.proposals)
    assert set(found.aside) | set(found.proposals) == set(entries)
    assert all(why and why[0].islower() and not why.endswith(".") for why in found.aside.values())


def test_each_clip_that_is_left_aside_can_be_taken_up(exercises: MadeSet) -> None:
    found = propose(exercises.project)
    assert set(found.spare) == set(found.aside)
    for n, clip in enumerate(found.aside):
        after = take_up_skipped(found, clip)
        assert clip in after.proposals and clip not in after.aside and clip not in after.spare
        p = after.proposals[clip]
        assert p.stance is not None and after.places[p.stance.value].layer == p.layer.value
        assert set(after.proposals) == {*found.proposals, clip}
        if n < 3:
            assert clip in accept(exercises.project, after).placed
    with pytest.raises(KeyError):
        take_up_skipped(found, next(iter(found.proposals)))


def test_one_taken_up_later_belongs_to_the_stances_that_were_made_meanwhile(exercises: MadeSet) -> None:
    review = Review(propose(exercises.project))
    clip = next(iter(review.found.aside))
    project = accept(exercises.project, review.found).project
    review = review.settled(project)
    after = take_up_skipped(review.found, clip)
    p = after.proposals[clip]
    assert p.stance is not None and project.stance(p.stance.value) is not None
    review = Review(after).tell(clip, "kind", "fidget")
    placed = review.take(project, [clip])
    assert placed.placed == (clip,)
    assert len(placed.project.graphs["arms"].stances) == len(project.graphs["arms"].stances)


def test_a_stance_that_is_gone_is_made_again(exercises: MadeSet) -> None:
    found = propose(exercises.project)
    clip = next(iter(found.aside))
    after = take_up_skipped(replace(found, places={}), clip)
    p = after.proposals[clip]
    assert p.stance is not None and not after.places[p.stance.value].there


def test_a_name_that_nothing_else_is_known_of_can_be_taken_up(toy: Any) -> None:
    from metagraph.graph import edits

    project = edits.add_clips(Project("p"), [("walk.glb", 0, "", toy.clip("walk_01"))])
    found = propose(project, sources=("name",))
    clip = next(iter(project.clips))
    assert list(found.aside) == [clip] and not found.proposals
    p = take_up_skipped(found, clip).proposals[clip]
    assert p.stance is not None and p.confidence < 0.5


words = st.sampled_from(["goes {} m away", "name says 'walk'", "turns {} degrees in {} s", "{}"])
whys = st.tuples(words, st.floats(0, 99).map(lambda x: round(x, 1))).map(lambda x: x[0].format(x[1], x[1]))


@given(st.dictionaries(st.text("abc", min_size=1, max_size=3), whys))
def test_reasons_are_told_with_all_their_clips_the_most_frequent_first(aside: dict[str, str]) -> None:
    found = group_reasons(aside)
    assert sorted(c for _, clips in found for c in clips) == sorted(aside)
    assert [len(c) for _, c in found] == sorted((len(c) for _, c in found), reverse=True)
    assert all(why == aside[clips[0]] for why, clips in found if len({aside[c] for c in clips}) == 1)


def test_reasons_that_differ_in_numbers_are_one_with_the_least_and_the_greatest() -> None:
    aside = {"a": "goes 2.5 m away", "b": "goes 10.0 m away", "c": "name says 'run'", "d": "goes 3.0 m away"}
    assert group_reasons(aside) == [
        ("goes 2.5 to 10.0 m away", ["a", "b", "d"]),
        ("name says 'run'", ["c"]),
    ]
    assert group_reasons({}) == []


def test_clips_left_aside_stay_so_when_the_rest_is_placed(exercises: MadeSet) -> None:
    found = propose(exercises.project)
    assert found.aside
    placed = accept(exercises.project, found).project
    assert propose(placed).aside.keys() == found.aside.keys()
