"""Keypoints in a live session: whoever is before a client's camera is mimicked."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from metagraph.graph import edits
from metagraph.graph.model import LAYERS, Project
from metagraph.live.live_session import LiveSession
from metagraph.live.messages import Reply, encode
from metagraph.playback.planning.running_plan import plan_performance
from sample_clips.make.sample_keypoints import View, played, seen

TICK = 1 / 60


@pytest.fixture(scope="module")
def talk(sample: Project) -> Any:
    """What a camera sees for 18 s: times, points as MediaPipe has them, confidence."""
    times, _, space, sure = seen(*played(sample), "mediapipe", 20.0, 18.0, View())
    return times, space, sure


def sent(session: LiveSession, client: int, now: float, *messages: dict[str, Any]) -> list[Any]:
    for message in messages:
        session.receive(client, json.dumps(message))
    return [json.loads(r if isinstance(r, bytes) else encode(r)) for r in session.tick(now).replies]


def watch(session: LiveSession, talk: Any, until: float = 18.0, client: int = 1, **wish: Any) -> list[Any]:
    """Send every frame; return the replies."""
    out = []
    for time, points, sure in zip(*talk, strict=True):
        if time < until:
            frame = {
                "do": "keypoints",
                "points": points.round(4).tolist(),
                "confidence": sure.round(2).tolist(),
                **wish,
            }
            out += sent(session, client, float(time) + TICK, frame)
    return out


@pytest.mark.nightly
def test_every_frame_is_answered_and_says_what_is_seen(sample: Project, talk: Any) -> None:
    session = LiveSession(sample)
    replies = watch(session, talk, mirror=False)
    assert len(replies) == 360 and not [r for r in replies if "error" in r]
    assert replies[0] == {"state": "done"}
    assert replies[-1]["seen"] == {"body": "weight left", "arms": "arms crossed", "head": "head tilt left"}
    parts = [part for r in replies for part in r.get("parts", ())]
    assert [p["id"] for p in parts] == [f"mimic{n + 1}" for n in range(len(parts))]
    assert {p["do"] for p in parts} == {"stance"} and {p["state"] for p in parts} <= {
        "planned",
        "late",
        "done",
    }
    assert 6 <= len(parts) <= 9


def test_the_character_goes_where_the_person_is_and_stays(sample: Project, talk: Any) -> None:
    session = LiveSession(sample)
    watch(session, talk, 13.0, mirror=False)
    arms = session.plan.layers["arms"]
    assert sample.graphs["arms"].stances[arms.stance_at(13.0)].name == "on hips"  # type: ignore[index]
    assert not [
        c
        for layer in LAYERS
        for c in session.plan.layers[layer].cues
        if c.then != c.stance and c.meta.startswith("auto/") and c.start > 1
    ]


def test_in_a_mirror_sides_change_over(sample: Project, talk: Any) -> None:
    assert watch(LiveSession(sample), talk, 12.0)[-1]["seen"]["body"] == "weight right"


@pytest.mark.nightly
def test_a_session_with_a_camera_performs_again_as_it_was_played(sample: Project, talk: Any) -> None:
    session = LiveSession(sample)
    watch(session, talk, mirror=False, gaze=True)
    kept = session.performance("seen")
    again = plan_performance(sample, kept.asks, kept.length, kept.seed)
    for layer in LAYERS:
        live = [c for c in session.plan.layers[layer].cues if c.start < kept.length]
        assert [c for c in again.layers[layer].cues if c.start < kept.length] == live


def test_what_a_camera_asked_for_can_be_taken_back(sample: Project, talk: Any) -> None:
    session = LiveSession(sample)
    watch(session, talk, 13.0, mirror=False)
    assert session.plan.track.stays_at("arms", 13.1)
    (reply,) = sent(session, 1, 13.1, {"do": "withdraw"})
    assert reply["state"] == "done"
    sent(session, 1, 13.5)
    assert not session.plan.track.stays_at("arms", 14.0)


def test_each_client_has_a_camera_of_its_own(sample: Project, talk: Any) -> None:
    session = LiveSession(sample)
    times, space, sure = talk
    for time, points, some in zip(times[:60], space, sure, strict=False):
        frame = {
            "do": "keypoints",
            "points": points.round(4).tolist(),
            "confidence": some.round(2).tolist(),
            "mirror": False,
        }
        first, second = (
            sent(session, 1, float(time) + TICK, frame),
            sent(session, 2, float(time) + TICK * 1.5, {**frame, "layers": ["arms"]}),
        )
    assert set(first[0]["seen"]) == set(LAYERS) and set(second[0]["seen"]) == {"arms"}


def test_a_wish_that_changes_begins_anew_and_ids_are_not_used_twice(sample: Project, talk: Any) -> None:
    session = LiveSession(sample)
    times, space, sure = talk
    first = watch(session, talk, 3.0)
    later = watch(session, (times + 3.0, space, sure), 6.0, mirror=False)
    ids = [part["id"] for r in (*first, *later) for part in r.get("parts", ())]
    assert len(ids) == len(set(ids)) == 6


@pytest.mark.nightly
def test_an_edited_project_is_mimicked_with_at_once(sample: Project, talk: Any) -> None:
    session = LiveSession(sample)
    watch(session, talk, 2.0)
    hips = next(s.id for s in sample.graphs["arms"].stances.values() if s.name == "on hips")
    session.change(edits.rename_stance(sample, hips, "akimbo"))
    times, space, sure = talk
    assert watch(session, (times, space, sure), 12.0)[-1]["seen"]["arms"] == "akimbo"


FRAME = {"do": "keypoints", "points": [[0.1 * n, 0.2] for n in range(17)]}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"points": []}, "length >= 17"),
        ({"points": [[0, 0]] * 20}, "20 points are none of the layouts"),
        ({"points": [[0]] * 17}, "length >= 2"),
        (
            {"points": [[0, 0]] * 16 + [[0, 0, 0]]},
            "give two numbers for every point, or three for every point",
        ),
        ({"points": [[0, 1e9]] * 17}, "<= 10000000"),
        ({"confidence": [1.0]}, "17 keypoints have 17 confidences"),
        ({"confidence": [7.0] * 17}, "<= 1"),
        ({"layers": ["legs"]}, "legs"),
        ({"layers": []}, "no stance that could be mimicked"),
        ({"in": 2}, "only what the character does can be put off"),
    ],
)
def test_what_is_no_frame_is_refused_with_the_reason(
    sample: Project, change: dict[str, Any], words: str
) -> None:
    (reply,) = sent(LiveSession(sample), 1, 0.1, {**FRAME, **change, "id": "k"})
    assert reply["id"] == "k" and words in reply["error"]


def test_a_project_without_a_character_says_that_nobody_can_mimic() -> None:
    (reply,) = sent(LiveSession(Project()), 1, 0.1, FRAME)
    assert "no clips" in reply["error"]


def test_a_camera_that_floods_is_told_to_wait(sample: Project) -> None:
    session = LiveSession(sample)
    replies = sent(session, 1, 0.1, *[FRAME] * 1100)
    assert [r for r in replies if r["state"] == "refused"] and len(replies) == 1100
    assert all(isinstance(x, dict) for x in replies) and Reply


def test_nothing_is_seen_in_points_that_are_nobody(sample: Project) -> None:
    session = LiveSession(sample)
    for n in range(30):
        (reply,) = sent(session, 1, 0.1 + n / 30, {**FRAME, "points": np.zeros((17, 2)).tolist()})
    assert reply == {"state": "done"}
