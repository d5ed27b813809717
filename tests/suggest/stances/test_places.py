"""Words and poses joined into stances: on shapes of one point, so that what is where can be seen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.suggest.estimate import Belief
from metagraph.suggest.motion_guess import MotionGuess
from metagraph.suggest.proposal import simplify_stance_name
from metagraph.suggest.propose import propose
from metagraph.suggest.stances.known import Shape
from metagraph.suggest.stances.places import ClipEvidence, StancePlaces
from metagraph.suggest.words.names import NameGuess
from tests.label_zoo.catalogue import named


def shape(at: float, ident: str = "", members: int = 3) -> Shape:
    """A stance of one hand that is so far to a side."""
    poses = np.array([[[at, 0.0, 0.0]]])
    return Shape(ident, f"c{at}", "arms", ("left_hand",), poses, ("x",) * members, f"c{at}", 0.0, 0.9)


def heard(
    clip: str,
    word: str | None = None,
    begins: Mapping[int, float] | None = None,
    shapes: Sequence[Shape] = (),
    kind: str = "gesture",
    end: str | None = None,
) -> ClipEvidence:
    """A clip of the arms. word: its stance by name. begins: shape -> how likely its first pose is of it;
    a transition ends in the next shape.
    """
    said = NameGuess(
        kind=Belief(kind, 0.9, ""),  # type: ignore[arg-type]
        stance=Belief(word, 0.9, "name") if word is not None else None,
        end_stance=Belief(end, 0.9, "name") if end is not None else None,
    )
    near = tuple(sorted(((p, shapes[n]) for n, p in (begins or {}).items()), key=lambda x: -x[0]))
    far = tuple((p, shapes[(shapes.index(x) + 1) % len(shapes)]) for p, x in near) if end else near
    unsure: Any = Belief("arms", 0.5, "")
    seen = Belief(near[0][1], near[0][0], f'begins in "{near[0][1].name}"') if near else None
    beside = MotionGuess(unsure, unsure, unsure, unsure, stance=seen, begins=near, ends=far) if near else None
    return ClipEvidence(clip, clip, said, None, motion=beside, beside=beside)


def key(places: StancePlaces, each: ClipEvidence) -> str:
    """The place most votes are for."""
    votes = places.vote(each, "stance", "arms")
    return max(votes, key=lambda b: b.confidence).value


def test_without_clips_and_shapes_there_are_no_places_and_one_still_chooses_of_two() -> None:
    places = StancePlaces(Project(), [], {})
    assert places.by_key == {} and places.count("arms") == 2


def test_one_clip_whose_name_says_a_stance_makes_it() -> None:
    one = heard("a", "sit")
    places = StancePlaces(Project(), [one], {})
    assert [x.name for x in places.by_key.values()] == ["sit"] and key(places, one) in places.by_key


def test_a_clip_of_which_nobody_says_anything_makes_none_and_votes_for_none() -> None:
    one = heard("a")
    places = StancePlaces(Project(), [one], {})
    assert not places.by_key and places.vote(one, "stance", "arms") == []


def test_near_poses_that_no_word_tells_apart_are_one_stance_and_far_ones_stay() -> None:
    for far, count in ((0.04, 1), (0.15, 2)):
        shapes = [shape(0.0), shape(far)]
        clips = [
            heard(f"{word} {n} {kind}", word, {n: 0.95}, shapes, kind)
            for n in (0, 1)
            for word, kind in (("face", "stance"), ("stand", "fidget"), ("stand", "gesture"))
        ]
        places = StancePlaces(Project(), clips, {"arms": shapes})
        assert len({key(places, each) for each in clips}) == count


def test_words_that_differ_in_order_and_writing_are_one() -> None:
    clips = [heard("a", "arms crossed"), heard("b", "Crossed_Arms")]
    assert len(StancePlaces(Project(), clips, {}).by_key) == 1


def test_a_pose_is_called_by_the_word_most_of_its_clips_have() -> None:
    shapes = [shape(0.0), shape(0.3)]
    clips = [heard(f"a{n}", "sit", {0: 0.9}, shapes) for n in range(5)]
    clips += [heard(f"b{n}", "stand", {1: 0.9}, shapes) for n in range(3)] + [
        heard("odd", "stand", {0: 0.9}, shapes)
    ]
    places = StancePlaces(Project(), clips, {"arms": shapes})
    assert {x.name: x.shape for x in places.by_key.values()} == {"sit": shapes[0], "stand": shapes[1]}
    odd = places.vote(clips[-1], "stance", "arms")
    assert [places.by_key[b.value].name for b in odd] == ["stand", "sit"]
    assert odd[0].confidence < 0.9  # the word is trusted less, since a clip of it lies elsewhere


def test_two_words_for_one_pose_are_one_stance() -> None:
    shapes = [shape(0.0)]
    clips = [heard(f"a{n}", "idle", {0: 0.95}, shapes) for n in range(4)]
    clips += [heard(f"b{n}", "base", {0: 0.95}, shapes) for n in range(3)]
    places = StancePlaces(Project(), clips, {"arms": shapes})
    assert [x.name for x in places.by_key.values()] == ["idle"]
    assert key(places, clips[0]) == key(places, clips[-1])


def test_poses_without_words_are_called_differently() -> None:
    shapes = [shape(0.0), shape(0.3), shape(-0.3)]
    clips = [heard(f"c{n}", None, {n: 0.9}, shapes) for n in range(3)]
    places = StancePlaces(Project(), clips, {"arms": shapes})
    names = [x.name for x in places.by_key.values()]
    assert len(names) == len(set(names)) == 3 and all(names)
    assert len({key(places, each) for each in clips}) == 3


def test_the_stances_of_a_project_keep_their_names_and_ids(toy: Any) -> None:
    project = edits.add_stance(toy.project(), "head", "ahead", [])
    mine = [s for s in project.graphs["arms"].stances.values() if s.name in ("rest", "up")]
    shapes = [shape(0.0, mine[0].id), shape(0.3, mine[1].id), shape(0.6)]
    clips = [heard(f"a{n}", "lounge", {0: 0.9}, shapes) for n in range(4)]
    clips += [heard("b", "UP", {1: 0.9}, shapes), heard("c", "new one", {2: 0.9}, shapes)]
    places = StancePlaces(project, clips, {"arms": shapes})
    for stance in mine:
        assert places.by_key[stance.id].name == stance.name and places.by_key[stance.id].there
    assert key(places, clips[0]) == mine[0].id and key(places, clips[-2]) == mine[1].id
    new = places.by_key[key(places, clips[-1])]
    assert (new.name, new.there, new.shape) == ("new one", False, shapes[2])


def test_a_stance_of_the_project_without_a_loop_takes_the_pose_its_word_means(toy: Any) -> None:
    project = edits.add_stance(Project(), "arms", "sit", [])
    (ident,) = project.graphs["arms"].stances
    shapes = [shape(0.0)]
    clips = [heard(f"a{n}", "sit", {0: 0.9}, shapes) for n in range(3)]
    places = StancePlaces(project, clips, {"arms": shapes})
    assert list(places.by_key) == [ident] and places.by_key[ident].shape is shapes[0]


def test_where_a_transition_ends_is_called_by_its_second_word() -> None:
    shapes = [shape(0.0), shape(0.3)]
    clips = [heard("sit to stand", "sit", {0: 0.9}, shapes, "transition", "stand")]
    places = StancePlaces(Project(), clips, {"arms": shapes})
    ends = places.vote(clips[0], "end_stance", "arms")
    assert [places.by_key[b.value].name for b in ends][:1] == ["stand"]


WORDS = ("sit", "stand", "lean", None)
clips_of = st.lists(
    st.tuples(st.sampled_from(WORDS), st.integers(0, 2), st.floats(0.31, 1.0), st.sampled_from(WORDS)),
    max_size=12,
)


@given(clips_of, st.randoms())
def test_every_vote_is_for_a_place_names_are_told_apart_and_order_is_nothing(drawn: Any, random: Any) -> None:
    shapes = [shape(0.3 * n) for n in range(3)]
    clips = [
        heard(f"c{n}", word, {at: chance}, shapes, "transition" if end else "gesture", end)
        for n, (word, at, chance, end) in enumerate(drawn)
    ]
    places = StancePlaces(Project(), clips, {"arms": shapes})
    for each in clips:
        for what in ("stance", "end_stance"):
            for belief in places.vote(each, what, "arms"):
                assert belief.value in places.by_key and 0 <= belief.confidence <= 1
    names = [simplify_stance_name(x.name) for x in places.by_key.values()]
    assert len(names) == len(set(names))
    assert places.count("arms") >= 2
    assert sum(x.shape is not None for x in places.by_key.values()) == len(shapes)
    mixed = list(clips)
    random.shuffle(mixed)
    again = StancePlaces(Project(), mixed, {"arms": shapes})

    def called(p: StancePlaces) -> list[tuple[str, Any]]:
        return sorted((x.name, str(x.shape and x.shape.name)) for x in p.by_key.values())

    assert called(again) == called(places)


def test_names_that_are_wrong_do_not_part_a_stance() -> None:
    made = named("many wrong names").project
    right = named("standing talker").project
    count = {len(propose(p).places) for p in (made, right)}
    assert len(count) == 1
