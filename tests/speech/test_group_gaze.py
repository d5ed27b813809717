"""Who looks at whom, and how much of that comes out."""

from __future__ import annotations

from itertools import pairwise

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph.anatomy import get_base_pose
from metagraph.graph.conversation.model import EVERYBODY, Conversation
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.speech.duet import plan_duet
from metagraph.speech.gaze_shares import GazeShare, join_shares, measure_gaze_shares
from metagraph.speech.group_gaze import AT_ADDRESSEE, AT_SPEAKER, LEAST, list_looks
from tests.posing import pose_at
from tests.speech.group import group, made_up, said
from tests.thorough import many


@given(st.integers(3, 8), st.integers(0, 99))
def test_looks_begin_at_once_last_and_never_go_to_oneself(count: int, seed: int) -> None:
    talk = made_up(count, seed, 40.0)
    for side in range(count):
        looks = list_looks(talk, side)
        assert looks[0].at == 0 and all(0 <= k.side < count and k.side != side for k in looks)
        assert all(b.at - a.at >= LEAST - 0.01 and a.side != b.side for a, b in pairwise(looks))


def test_of_two_each_looks_at_the_other() -> None:
    assert [(k.at, k.side) for k in list_looks(made_up(2, 1), 1)] == [(0.0, 0)]


def test_where_nobody_speaks_one_looks_from_one_to_another_and_nobody_twice() -> None:
    looks = list_looks(group(3, length=60.0), 0)
    assert {k.side for k in looks} == {1, 2} and 10 < len(looks) < 30


def seen(talk: Conversation, side: int, at: float) -> int:
    looks = list_looks(talk, side)
    return [k.side for k in looks if k.at <= at][-1]


def test_at_the_end_of_a_turn_its_speaker_looks_at_who_is_next() -> None:
    """Though it is said to another."""
    for seed in range(20):
        talk = group(4, said(0, 1, 6, to=2), said(3, 6.3, 9, to=EVERYBODY), length=12.0, seed=seed)
        assert seen(talk, 0, 5.9) == 3


def test_listeners_look_at_who_begins_to_speak_and_sooner_where_that_was_to_be_seen() -> None:
    foreseen, sudden = [], []
    for seed in range(1, 60):
        for to, found in ((2, foreseen), (1, sudden)):
            talk = group(4, said(0, 1, 6, to=to), said(2, 6.2, 20, to=0), length=21.0, seed=seed)
            late = [k.at - 6.2 for k in list_looks(talk, 3) if k.side == 2 and k.at > 5.5]
            found += late[:1]
    assert np.median(foreseen) < 0.15 < np.median(sudden) < 0.6
    assert np.mean(np.array(foreseen) < 0) > 0.15, "some look there before"


def test_an_edit_of_one_turn_leaves_looks_of_others_as_they_were() -> None:
    talk = made_up(3, 5)
    last = max(range(3), key=lambda n: talk.sides[n].segments[-1].end)
    side = talk.sides[last]
    longer = msgspec.structs.replace(side.segments[-1], end=side.segments[-1].end + 1.0, text="other words")
    sides = list(talk.sides)
    sides[last] = msgspec.structs.replace(side, segments=(*side.segments[:-1], longer))
    after, start = msgspec.structs.replace(talk, sides=tuple(sides)), side.segments[0].start
    begun = max(t for t in (s.start for s in side.segments) if t < side.segments[-1].start - 5)
    for n in range(3):
        was, now = ([k for k in list_looks(c, n) if k.at < begun] for c in (talk, after))
        assert was == now and start <= begun


def test_another_seed_looks_elsewhere() -> None:
    talk = made_up(3, 5)
    assert list_looks(talk, 0) != list_looks(msgspec.structs.replace(talk, seed=99), 0)


@pytest.fixture(scope="module")
def shares(sample: Project) -> dict[str, GazeShare]:
    found = []
    for seed in range(many(4, 20)):
        talk = made_up(3, seed, 120.0)
        made = plan_duet(talk, "v1", (sample,) * 3, (None,) * 3)
        found += [share for part in made.parts for share in part.looks]
    return {str(share.doing): share for share in join_shares(found)}


@pytest.mark.nightly
def test_of_looks_at_faces_as_many_as_were_observed_are_at_the_speaker_and_the_one_addressed(
    shares: dict[str, GazeShare],
) -> None:
    """Delivered, with life's looks away: 88 % and 77 % (Vertegaal et al. 2001)."""
    at = {doing: share.of_faces for doing, share in shares.items()}
    assert at["addressed"] == pytest.approx(AT_SPEAKER, abs=0.05)
    assert at["aside"] == pytest.approx(AT_SPEAKER, abs=0.05)
    assert at["speaking"] == pytest.approx(AT_ADDRESSEE, abs=0.06)


def test_who_speaks_looks_away_more_than_who_listens(shares: dict[str, GazeShare]) -> None:
    away = {n: 1 - s.main - s.others for n, s in shares.items()}
    assert away["speaking"] > 1.3 * away["addressed"] > 0.1


def test_who_speaks_to_all_looks_at_each(sample: Project) -> None:
    talk = group(4, *(said(0, 1.0 + 5 * n, 5.9 + 5 * n, f"w{n}", to=EVERYBODY) for n in range(10)), length=52)
    made = plan_duet(talk, "v1", (sample,) * 4, (None,) * 4)
    (share,) = made.parts[0].looks
    assert share.doing == "speaking to all" and share.main > 0.6 and share.others == 0
    looks = list_looks(talk, 0)
    spent = dict.fromkeys((1, 2, 3), 0.0)
    for a, b in pairwise(looks):
        spent[a.side] += b.at - a.at
    assert min(spent.values()) > 0.2 * sum(spent.values())
    assert "speaking to all, looks at one of them" in share.words()


def test_two_are_not_asked_where_else_they_look(sample: Project) -> None:
    made = plan_duet(group(2, said(0, 1, 2)), "v1", (sample,) * 2, (None,) * 2)
    assert all(part.looks == () for part in made.parts)
    assert measure_gaze_shares(group(2, said(0, 1, 2)), 0, sample, made.parts[0].plan) == ()


@pytest.mark.nightly
def test_eyes_are_on_the_eyes_of_whom_they_look_at(sample: Project) -> None:
    """In the poses as they are shown, where each stands."""
    talk = made_up(3, 2, 40.0)
    made = plan_duet(talk, "v1", (sample,) * 3, (None,) * 3)
    assert sample.skeleton is not None
    eye = list(sample.skeleton.names).index("LeftEye")
    rest = sample.skeleton.globals(get_base_pose(sample))[0][eye]
    ahead = rotation.rotate_vectors(rotation.conjugate(rest), np.array([0.0, 0.0, 1.0]))
    times = np.arange(1.0, 39.0, 0.2)
    placed = [p.stand.placed(*sample.skeleton.globals(pose_at(p.plan, sample, times))) for p in made.parts]
    off = []
    for n, (turned, at) in enumerate(placed):
        for k, time in enumerate(times):
            to = placed[seen(talk, n, time - 0.4)][1][k, eye] - at[k, eye]
            way = rotation.rotate_vectors(turned[k, eye], ahead)
            off.append(np.degrees(np.arccos(np.clip(way @ to / np.linalg.norm(to), -1, 1))))
    assert np.median(off) < 5.0
