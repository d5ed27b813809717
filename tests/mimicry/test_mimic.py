"""One person mimicked: stances told once they are certain, and nothing else."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from metagraph.graph.model import LAYERS, Project
from metagraph.graph.requests import Go, Look, read_request
from metagraph.mimicry.keypoint_layouts import LAYOUTS, PLACE, POINTS, swap
from metagraph.mimicry.mimic import Mimic
from metagraph.mimicry.pose_measures import turn_about_y
from metagraph.mimicry.tuning import JUDGING, Tuning
from sample_clips.make import sample_keypoints
from sample_clips.make.sample_keypoints import SECONDS, View, played, seen, truth
from tests.mimicry import people
from tests.thorough import some

# Degrees the camera is turned by, and whether what it sees is mirrored.
VIEWS = some([(-40.0, True), (-40.0, False), (0.0, True), (0.0, False), (40.0, False), (40.0, True)], 2)

FPS = 25.0
Talk = tuple[Project, Any]
_SOMEBODY: list[Project] = []


@pytest.fixture(autouse=True, scope="module")
def somebody(toy: Any) -> Project:
    _SOMEBODY[:] = [people.somebody(toy.skeleton)]
    return _SOMEBODY[0]


@pytest.fixture(scope="module")
def talk(sample: Project) -> Talk:
    return played(sample)


def feed(
    mimic: Mimic, points: Any, seconds: float, start: float = 0.0, sure: Any = None, goals: Any = None
) -> list[Any]:
    """Show the same points for a while; return what is requested."""
    out = []
    for n in range(round(seconds * FPS)):
        out += mimic.feed(start + n / FPS, points, sure, goals)
    return out


def named(project: Project, asks: list[Any]) -> list[tuple[str, str]]:
    return [(ask.layer, project.stance(ask.stance).name) for ask in asks]  # type: ignore[union-attr]


# --- what cannot be mimicked


def test_without_a_character_or_stances_nothing_can_be_mimicked(somebody: Project) -> None:
    with pytest.raises(ValueError, match="no clips"):
        Mimic(Project())
    with pytest.raises(ValueError, match="no stance"):
        Mimic(somebody, layers=["body"])


@pytest.mark.parametrize(
    ("points", "sure", "words"),
    [
        (np.zeros(34), None, "are .K, 2. or .K, 3."),
        (np.zeros((17, 4)), None, "are .K, 2. or .K, 3."),
        (np.zeros((17, 3)), np.ones(16), "have 17 confidences"),
        (np.zeros((20, 3)), None, "20 points are none of the layouts"),
    ],
)
def test_shapes_that_do_not_fit_are_refused(somebody: Project, points: Any, sure: Any, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        Mimic(somebody).feed(0.0, points, sure)


@pytest.mark.nightly
@settings(max_examples=40)
@given(
    hnp.arrays(
        float,
        st.tuples(st.sampled_from([17, 18, 25, 33]), st.sampled_from([2, 3])),
        elements=st.floats(allow_nan=True, width=64),
    ),
    st.floats(allow_nan=True),
    st.lists(st.floats(allow_nan=True), min_size=1, max_size=4),
)
def test_whatever_a_camera_says_nothing_breaks_nor_is_believed_for_ever(
    points: Any, sure: float, times: list[float]
) -> None:
    somebody = _SOMEBODY[0]
    mimic = Mimic(somebody, mirror=False, gaze=True)
    for time in times:
        mimic.feed(time, points, np.full(len(points), sure))
    begin = (mimic._time or 0.0) + 2.0
    if abs(begin) < 1e6:
        feed(mimic, people.standing(somebody, "raised"), 2.0, begin)
        assert mimic.seen["arms"] == people.stance(somebody, "arms", "raised")


# --- what is seen


def test_the_stance_one_begins_in_is_asked_for_once_and_to_be_kept(somebody: Project) -> None:
    asks = feed(Mimic(somebody, mirror=False), people.standing(somebody, "down"), 5.0)
    assert sorted(named(somebody, asks)) == [("arms", "down"), ("head", "straight")]
    for ask in asks:
        assert isinstance(ask, Go) and ask.stay and ask.at is None and ask.priority == 1
        assert 0.3 <= ask.told < 0.8  # type: ignore[operator]
    assert len({ask.id for ask in asks}) == 2


@pytest.mark.parametrize("dims", [2, 3])
@pytest.mark.parametrize("kind", list(people.ARMS))
def test_every_stance_is_known_in_space_and_in_a_picture(somebody: Project, kind: str, dims: int) -> None:
    mimic = Mimic(somebody, mirror=False)
    feed(mimic, people.standing(somebody, kind)[:, :dims] * 300, 1.5)
    assert mimic.seen["arms"] == people.stance(somebody, "arms", kind)
    assert mimic.distances("arms")[mimic.seen["arms"]] < 0.1


def test_a_change_is_told_when_it_has_lasted_and_only_then(somebody: Project) -> None:
    mimic = Mimic(somebody, mirror=False)
    feed(mimic, people.standing(somebody, "down"), 2.0)
    asks = feed(mimic, people.standing(somebody, "raised"), 3.0, 2.0)
    assert named(somebody, asks) == [("arms", "raised")]
    how = JUDGING["arms"]
    assert how.dwell < asks[0].told - 2.0 < how.dwell + 4 * how.smooth  # type: ignore[operator]
    assert named(somebody, feed(mimic, people.standing(somebody, "raised"), 10.0, 5.0)) == []


def test_what_lasts_less_than_the_dwell_is_not_told(somebody: Project) -> None:
    mimic = Mimic(somebody, mirror=False)
    feed(mimic, people.standing(somebody, "down"), 2.0)
    asks = feed(mimic, people.standing(somebody, "raised"), JUDGING["arms"].dwell, 2.0)
    assert asks + feed(mimic, people.standing(somebody, "down"), 2.0, 2.0 + JUDGING["arms"].dwell) == []


def test_hands_in_motion_are_in_no_stance(somebody: Project) -> None:
    """Waving through a stance, and hands that circle at one."""
    mimic = Mimic(somebody, mirror=False)
    feed(mimic, people.standing(somebody, "down"), 2.0)
    raised, asks, moving = people.standing(somebody, "raised"), [], 0
    for n in range(150):
        moved = raised.copy()
        moved[[PLACE["left_wrist"], PLACE["right_wrist"]]] += 0.1 * np.array(
            [np.sin(n * 0.5), np.cos(n * 0.5), 0]
        )
        asks += mimic.feed(2.0 + n / FPS, moved)
        moving += mimic.judges["arms"].moving
    assert asks == [] and moving > 140
    assert len(feed(mimic, raised, 1.5, 8.0)) == 1


def test_a_pose_far_from_every_stance_changes_nothing(somebody: Project) -> None:
    mimic = Mimic(somebody, mirror=False)
    feed(mimic, people.standing(somebody, "down"), 2.0)
    away = people.standing(somebody, "down")
    away[[PLACE["left_wrist"], PLACE["right_wrist"]]] += [0.0, 1.6, 0]
    away[[PLACE["left_elbow"], PLACE["right_elbow"]]] += [0.0, 0.9, 0]
    assert feed(mimic, away, 3.0, 2.0) == []
    assert min(mimic.distances("arms").values()) > JUDGING["arms"].near


def test_two_stances_that_are_about_as_near_do_not_flicker(somebody: Project) -> None:
    mimic = Mimic(somebody, mirror=False)
    a, b = people.standing(somebody, "down"), people.standing(somebody, "hips")
    feed(mimic, a, 2.0)
    asks = []
    for n in range(20):  # now a little nearer to one, now to the other
        asks += feed(mimic, a + (b - a) * (0.47 + 0.06 * (n % 2)), 1.0, 2.0 + n)
    assert asks == []


# --- left and right


def test_in_a_mirror_the_other_side_is_meant(somebody: Project) -> None:
    tilted = people.standing(somebody, "down", tilt=-14.0)
    for mirror, name in ((False, "left"), (True, "right")):
        mimic = Mimic(somebody, mirror=mirror)
        feed(mimic, tilted, 2.0)
        assert mimic.seen["head"] == people.stance(somebody, "head", name)


def test_arms_are_known_whichever_hand_does_what(sample: Project) -> None:
    body = Mimic(sample).judges["arms"]
    chin = next(
        n
        for n, s in enumerate(body.signature.stances)
        if sample.graphs["arms"].stances[s].name == "hand to chin"
    )
    assert list(body.signature.of).count(chin) == 2


# --- what is not there


def test_what_cannot_be_seen_is_not_judged_and_the_rest_is(somebody: Project) -> None:
    sure = np.ones(17)
    sure[[PLACE["left_wrist"], PLACE["right_wrist"], PLACE["left_elbow"]]] = 0.05
    mimic = Mimic(somebody, mirror=False)
    asks = feed(mimic, people.standing(somebody, "raised", tilt=14.0), 2.0, sure=sure)
    assert named(somebody, asks) == [("head", "right")]
    assert mimic.distances("arms") == {} and mimic.distances("head") != {}


def test_points_that_drop_out_now_and_then_do_no_harm(somebody: Project) -> None:
    mimic, rng = Mimic(somebody, mirror=False), np.random.default_rng(5)
    points, asks = people.standing(somebody, "raised"), []
    for n in range(100):
        gone = rng.uniform(size=17) < 0.3
        asks += mimic.feed(n / FPS, np.where(gone[:, None], 0.0, points), np.where(gone, 0.0, 0.9))
    assert sorted(named(somebody, asks)) == [("arms", "raised"), ("head", "straight")]


def test_whoever_is_gone_for_long_leaves_the_stances_to_the_models(somebody: Project) -> None:
    mimic, tuning = Mimic(somebody, mirror=False), Tuning()
    feed(mimic, people.standing(somebody, "raised"), 2.0)
    points, nobody = people.standing(somebody, "raised"), np.zeros(17)
    assert feed(mimic, points, tuning.lost, 2.0, nobody) == []
    assert mimic.seen["arms"] == people.stance(somebody, "arms", "raised")
    asks = feed(mimic, points, 3.0, 2.0 + tuning.lost, nobody)
    assert [(ask.layer, ask.stay) for ask in asks] == [("arms", False), ("head", False)]
    assert mimic.seen == {}
    assert len(feed(mimic, points, 2.0, 12.0)) == 2  # back again


def test_somebody_who_turns_the_back_is_not_judged(somebody: Project) -> None:
    mimic = Mimic(somebody, mirror=False)
    points = people.standing(somebody, "raised")
    assert feed(mimic, (turn_about_y(points, np.pi) * [1, 1, 0])[:, :2], 2.0) == []


def test_frames_out_of_order_are_passed_over_and_gaps_begin_anew(somebody: Project) -> None:
    mimic = Mimic(somebody, mirror=False)
    down, raised = people.standing(somebody, "down"), people.standing(somebody, "raised")
    feed(mimic, down, 2.0)
    for time in (1.0, 1.96, float("nan")):
        assert mimic.feed(time, raised) == []
    assert mimic.judges["arms"].mean.points() == pytest.approx(down, abs=1e-3)
    mimic.feed(9.0, raised)
    assert mimic.judges["arms"].mean.points() == pytest.approx(raised, abs=1e-9)


# --- what the character does


@pytest.mark.nightly
def test_a_stance_the_character_is_not_in_is_asked_for_again_and_less_and_less_often(
    somebody: Project,
) -> None:
    mimic = Mimic(somebody, mirror=False, layers=["arms"])
    raised, down = people.stance(somebody, "arms", "raised"), people.stance(somebody, "arms", "down")
    asks = feed(mimic, people.standing(somebody, "raised"), 20.0, goals={"arms": down})
    told = [ask.told for ask in asks]
    assert {ask.stance for ask in asks} == {raised}
    assert np.allclose(np.diff(told), [2.0, 4.0, 8.0], atol=0.05)
    assert [s.again for s in mimic.sightings] == [False, True, True, True]
    assert feed(mimic, people.standing(somebody, "raised"), 20.0, 20.0, goals={"arms": raised}) == []


def test_asks_can_be_sent_as_they_are(somebody: Project) -> None:
    import msgspec

    for ask in feed(
        Mimic(somebody, priority=4, prefix="cam", gaze=True), people.standing(somebody, "down"), 2.0
    ):
        assert read_request(msgspec.json.encode(ask)) == ask
        assert ask.id.startswith("cam") and ask.priority == 4


def test_with_the_gaze_the_character_looks_where_the_head_is_turned(somebody: Project) -> None:
    mimic = Mimic(somebody, mirror=False, gaze=True)
    ahead, aside = people.standing(somebody, "down"), people.standing(somebody, "down")
    head = [n for n, name in enumerate(POINTS) if name == "nose" or "eye" in name or "ear" in name]
    middle = aside[head].mean(0)
    aside[head] = turn_about_y(aside[head] - middle, 0.6) + middle
    looks = [a for a in feed(mimic, ahead, 2.0) + feed(mimic, aside, 3.0, 2.0) if isinstance(a, Look)]
    first, last = np.array(looks[0].to), np.array(looks[-1].to)
    assert abs(first[0]) < 0.1 and first[2] > 1.5
    assert np.arctan2(last[0], last[2]) == pytest.approx(0.6, abs=0.15)
    assert 2 <= len(looks) < 10
    assert not any(isinstance(a, Look) for a in feed(Mimic(somebody, mirror=False), aside, 3.0))


# --- how well, on the recorded script


@pytest.fixture(scope="module", autouse=True)
def worlds_seen_once() -> Iterator[None]:
    """Where the same person's points are in space is worked out once, however they are looked at."""
    known: dict[tuple[int, int, int], Any] = {}
    real = sample_keypoints.world

    def world(project: Project, plan: Any, times: Any, *person: Any) -> Any:
        key = (id(project), id(plan), len(times))
        if person or key not in known:
            known[key] = real(project, plan, times, *person)
        return known[key]

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(sample_keypoints, "world", world)
        yield


def frames(talk: Talk, dims: int, view: View, layout: str = "mediapipe") -> Iterator[tuple[float, Any, Any]]:
    times, picture, space, sure = seen(*talk, layout, FPS, SECONDS, view)
    points = space * [1, -1, -1] if dims == 3 else picture * [1, -1]
    return zip(times, points, sure, strict=True)


def scored(
    talk: Talk, dims: int, view: View, mirror: bool = False, layout: str = "mediapipe"
) -> dict[str, tuple[float, int]]:
    """Layer -> share of the time in which the stance that is seen is the true one, and how many changes too
    many are seen.
    """
    project, plan = talk
    mimic = Mimic(project, mirror=mirror)
    said: dict[str, list[tuple[float, str | None]]] = {layer: [] for layer in LAYERS}
    for time, points, sure in frames(talk, dims, view, layout):
        mimic.feed(float(time), points, sure)
        for layer in LAYERS:
            ident = mimic.seen.get(layer)
            said[layer].append((float(time), project.graphs[layer].stances[ident].name if ident else None))
    other = {"left": "right", "right": "left"}
    out = {}
    for layer, rows in truth(project, plan).items():
        good = total = 0
        for start, end, name in rows:
            if mirror and layer != "arms":
                name = " ".join(other.get(word, word) for word in name.split())
            inside = [s for t, s in said[layer] if start <= t < end]
            good, total = good + inside.count(name), total + len(inside)
        names = [s for _, s in said[layer] if s is not None]
        changes = sum(a != b for a, b in pairwise(names))
        out[layer] = (good / total, changes - (len(rows) - 1))
    return out


@pytest.mark.nightly
@pytest.mark.parametrize(("turn", "mirror"), VIEWS)
def test_in_space_nine_tenths_of_the_time_every_layer_is_right(talk: Talk, turn: float, mirror: bool) -> None:
    for layer, (share, extra) in scored(talk, 3, View(turn=turn), mirror).items():
        assert share >= 0.92, (layer, share)
        assert extra <= 1, layer


@pytest.mark.nightly
@pytest.mark.parametrize(("turn", "mirror"), VIEWS)
def test_in_a_picture_too_but_for_leaning_towards_the_camera(talk: Talk, turn: float, mirror: bool) -> None:
    found = scored(talk, 2, View(turn=turn), mirror)
    assert found["arms"][0] >= 0.92 and found["head"][0] >= 0.9
    # 8.1 s of 53.6 are spent leaning, which a picture hardly shows of who stands still; hips that answer the
    # arms cost up to 0.02 more.
    assert found["body"][0] >= 0.77
    assert max(extra for _, extra in found.values()) <= 4


@pytest.mark.nightly
@pytest.mark.parametrize("layout", ["openpose body_25", "openpose coco", "coco"])
def test_every_layout_does(talk: Talk, layout: str) -> None:
    found = scored(talk, 3, View(), layout=layout)
    assert found["arms"][0] >= 0.94 and found["body"][0] >= 0.94 and found["head"][0] >= 0.8


@pytest.mark.nightly
def test_twice_the_jitter_is_borne(talk: Talk) -> None:
    found = scored(talk, 3, View(jitter=0.012))
    assert min(share for share, _ in found.values()) >= 0.88
    found = scored(talk, 2, View(jitter=0.012))
    assert found["arms"][0] >= 0.9 and found["head"][0] >= 0.85


@pytest.mark.nightly
def test_a_camera_held_askew_is_got_used_to(talk: Talk) -> None:
    for roll in (-2.0, 2.0):
        found = scored(talk, 2, View(roll=roll))
        assert found["body"][0] >= 0.75 and found["head"][0] >= 0.9, roll


@pytest.mark.nightly
def test_at_a_desk_arms_and_head_are_mimicked_without_hips_and_legs(talk: Talk) -> None:
    project, plan = talk
    names = LAYOUTS["mediapipe"]
    hidden = [
        n for n, name in enumerate(names) if any(w in name for w in ("hip", "knee", "ankle", "heel", "toes"))
    ]
    mimic = Mimic(project, mirror=False)
    good = {"arms": 0, "head": 0}
    rows = truth(project, plan)
    for time, points, sure in frames(talk, 2, View()):
        sure = sure.copy()
        sure[hidden] = 0.0
        mimic.feed(float(time), points, sure)
        for layer in good:
            name = next((s for a, b, s in rows[layer] if a <= time < b), None)  # type: ignore[index]
            ident = mimic.seen.get(layer)  # type: ignore[call-overload]
            good[layer] += name is not None and ident is not None and project.stance(ident).name == name  # type: ignore[union-attr]
    total = {layer: sum(b - a for a, b, _ in rows[layer]) * FPS for layer in good}  # type: ignore[index]
    assert "body" not in mimic.seen
    assert good["arms"] / total["arms"] > 0.9 and good["head"] / total["head"] > 0.9


def test_mirrored_points_and_a_mirror_that_is_off_are_the_same_person(somebody: Project) -> None:
    points = people.standing(somebody, "raised", tilt=-14.0)
    a, b = Mimic(somebody, mirror=True), Mimic(somebody, mirror=False)
    feed(a, points, 2.0)
    feed(b, swap(points, np.ones(17))[0], 2.0)
    assert a.seen == b.seen and a.distances("head") == pytest.approx(b.distances("head"))
