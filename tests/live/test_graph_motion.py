"""Motion that a graph of long takes makes live, of what is heard and of what is said to come."""

from __future__ import annotations

import base64
import json
from dataclasses import replace
from itertools import pairwise
from typing import Any

import msgspec
import numpy as np
import pytest

from metagraph.graph import anatomy, edits
from metagraph.graph.model import Project
from metagraph.live.graph_motion import NEWS, WAITS, GraphMotion, LiveGraph, as_clauses, fade_turns
from metagraph.live.kept_motion import read_kept, remake_motion, write_kept
from metagraph.live.live_session import LiveSession
from metagraph.motion.skeleton import Skeleton
from metagraph.playback.life.track import Speech
from metagraph.synthesis.extending.path import FADE, replay_path
from tests.live.test_heard_voice import voice
from tests.posing import pose_at
from tests.synthesis.talking import talkers, talkers_graph

TICK = 1 / 60


@pytest.fixture(scope="module")
def graph() -> LiveGraph:
    return LiveGraph(talkers()[0], talkers_graph())


@pytest.fixture
def session(sample: Project, graph: LiveGraph) -> LiveSession:
    out = LiveSession(sample, idle=False, graphs={"takes": graph})
    out.join(1)
    out.tick(1.0)
    return out


def ask(session: LiveSession, request: dict[str, Any], client: int = 1) -> dict[str, Any]:
    session.receive(client, json.dumps(request))
    (reply,) = session.tick(session.now + TICK).replies
    return msgspec.json.decode(reply) if isinstance(reply, bytes) else msgspec.to_builtins(reply)


def begin(session: LiveSession, **wish: Any) -> GraphMotion:
    assert ask(session, {"do": "generate", "model": "takes", "side": "speaker", **wish})["state"] == "planned"
    motion = session.generating.motion
    assert isinstance(motion, GraphMotion)
    return motion


def go_on(session: LiveSession, seconds: float, every: float = TICK) -> list[int]:
    """Let time go by; return the states that are shown."""
    way, until = [], session.now + seconds
    while session.now < until - 1e-9:
        session.tick(session.now + every)
        motion = session.generating.motion
        if isinstance(motion, GraphMotion):
            way.append(motion.path.at(motion.path.frame))
    return way


def sound(samples: np.ndarray) -> str:
    return base64.b64encode(np.clip(samples * 32768, -32768, 32767).astype("<i2").tobytes()).decode()


def speak(session: LiveSession, samples: np.ndarray, piece: float = 0.1) -> None:
    size = round(piece * 16000)
    for n in range(0, len(samples), size):
        session.receive(1, json.dumps({"do": "hear", "audio": sound(samples[n : n + size])}))
        go_on(session, piece)


@pytest.mark.nightly
def test_arms_and_head_move_as_the_takes_and_the_legs_as_the_body_does(session, sample, graph) -> None:
    assert ask(session, {"do": "describe"})["graphs"] == ["takes"]
    reply = ask(session, {"do": "generate", "model": "takes", "side": "speaker", "id": "g"})
    assert reply["id"] == "g" and reply["state"] == "planned" and "0.10 s after" in reply["notes"][0]
    ask(session, {"do": "hear", "comes": [{"in": 0.5, "duration": 1.2, "stress": 0.6}]})
    rotations, plain = [], []
    for _ in range(150):
        session.tick(session.now + TICK)
        rotations.append(session.pose(session.now).rotations)
        plain.append(pose_at(session.plan, sample, session.now).rotations)
    apart = np.abs(np.stack(rotations) - np.stack(plain)).max((0, 2))
    parts = np.array(anatomy.project_parts(sample))
    assert apart[parts == "legs"].max() < 1e-6 and apart[parts == "arms"].max() > 0.1
    fastest = max(np.abs(np.diff(take.rotations, axis=0)).max() for take in graph.takes) / 2
    moved = np.abs(np.diff(np.stack(rotations)[40:], axis=0)).max((0, 2))
    assert moved[parts == "arms"].max() < 2.5 * fastest  # no jump, where frames fade into each other neither


def test_a_clause_that_is_announced_meets_its_stroke(session, graph) -> None:
    motion = begin(session)
    at = session.now + 1.5
    ask(session, {"do": "hear", "comes": [{"at": at, "duration": 1.2, "stress": 0.6}]})
    way = go_on(session, 3.0, 1 / 30)
    first = motion.path.frame - len(way) + 1
    strokes = (first + np.flatnonzero(graph.driver.heard.peaks[way])) / 30 + motion.begun
    assert np.abs(strokes - (at + 0.6)).min() <= 0.12


def test_a_voice_is_heard_and_moved_to(session, graph) -> None:
    motion = begin(session)
    speak(session, voice(1.6, [0.4, 1.2], 0.5, 0.7))
    told = [news.what for _, news in motion.told]
    assert told == ["begins", "stress", "stress", "ends"]
    assert [frame for frame, _ in motion.told] == sorted(frame for frame, _ in motion.told)
    go_on(session, 1.0)
    assert motion.waiting == 0.0


def test_a_voice_that_stops_arriving_has_ended(session) -> None:
    motion = begin(session)
    speak(session, voice(1.0, [0.5], 0.2, 0.0))
    go_on(session, 0.8)
    assert motion.told[-1][1].what == "ends"
    speak(session, voice(0.6, [0.3], 0.2, 0.0))
    assert [n.what for _, n in motion.told].count("begins") == 2  # and who speaks again is heard again


def test_who_is_cut_short_gestures_no_more(session, graph) -> None:
    begin(session)
    clauses = [{"in": 0.5 + n, "duration": 0.9, "stress": 0.5} for n in range(8)]
    ask(session, {"do": "hear", "speaks": "self", "comes": clauses})
    go_on(session, 2.0)
    ask(session, {"do": "hear", "speaks": "none"})
    way = go_on(session, 3.0, 1 / 30)
    assert not graph.driver.heard.peaks[way[12:]].any()
    assert (graph.driver.heard.kinds[way[45:]] == 1).mean() > 0.8


def test_what_the_character_says_itself_it_knows_beforehand(session, sample) -> None:
    motion = begin(session)
    reply = ask(
        session, {"do": "say", "text": "A rather long sentence, spoken by the character itself.", "in": 1.0}
    )
    go_on(session, reply["until"] - session.now)
    comes = [n for _, n in motion.told if n.what == "comes"]
    assert comes and abs(comes[0].at + motion.begun - reply["at"]) < 0.05
    assert all(a.end <= b.at + 1e-9 for a, b in pairwise(comes))
    assert as_clauses(Speech("a", 1.0, 1.0), sample, 0.0) == []


def test_taking_back_what_it_was_about_to_say_hushes_it(session) -> None:
    motion = begin(session)
    ask(
        session,
        {"do": "say", "text": "These words are never going to be spoken by anybody.", "in": 0.8, "id": "s"},
    )
    go_on(session, 0.3)
    assert any(n.what == "comes" for _, n in motion.told)
    ask(session, {"do": "withdraw", "what": "s"})
    go_on(session, 0.2)
    assert motion.told[-1][1].what == "hush"


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        ({"comes": [{"in": 61, "duration": 1}]}, "in"),
        ({"comes": [{"at": 500.0, "duration": 1}]}, "more than 60 s ahead"),
        ({"comes": [{"at": 0.0, "duration": 0.5}]}, "is over"),
        ({"comes": [{"in": 1}]}, "duration"),
        ({"comes": [{"in": 1, "duration": 1, "kind": "idle"}]}, "kind"),
        ({"comes": [{"in": 1, "duration": 1}] * 17}, "comes"),
        ({"audio": base64.b64encode(b"abc").decode()}, "two bytes"),
    ],
)
def test_what_cannot_be_heard_is_said_in_words(session, request_, words) -> None:
    begin(session)
    reply = ask(session, {"do": "hear", **request_})
    assert words in (reply.get("why") or "") + (reply.get("error") or "")


def test_a_flood_is_refused_and_what_is_kept_stays_small(session) -> None:
    motion = begin(session)
    clauses = [{"in": 0.1 * n, "duration": 0.1} for n in range(16)]
    for _ in range(12):
        session.receive(1, json.dumps({"do": "hear", "comes": clauses}))
    replies = [msgspec.to_builtins(r) for r in session.tick(session.now + TICK / 10).replies]
    assert any("too much at once" in r.get("why", "") for r in replies) and len(motion._news) <= NEWS
    piece = sound(voice(1.4, [], 0.0, 0.0))
    why = [ask(session, {"do": "hear", "audio": piece}).get("why", "") for _ in range(4)]
    assert "in real time" in why[-1] and motion.waiting <= WAITS


def test_a_skeleton_other_than_the_characters_is_refused_with_a_remedy(graph) -> None:
    take = graph.takes[0]
    s = take.skeleton
    other = Skeleton(tuple(f"x{n}" for n in s.names), s.parents, s.rest_rotations, s.rest_translations * 1.1)
    project = edits.add_clips(Project(), [("a.glb", 0, "", replace(take, skeleton=other))])
    stranger = LiveSession(project, graphs={"takes": graph})
    stranger.join(1)
    assert "--retarget" in ask(stranger, {"do": "generate", "model": "takes"})["why"]
    assert "there are takes" in ask(stranger, {"do": "generate", "model": "other"})["why"]


def test_it_comes_goes_and_gives_way_without_a_jump(session) -> None:
    begin(session)
    weights = []
    for _ in range(40):
        session.tick(session.now + TICK)
        over = session.overlay(session.now)
        weights.append(0.0 if over is None else float(over.weight[0]))
    assert weights[0] < 0.2 and weights[-1] == 1.0 and max(np.diff(weights)) < 0.12
    reply = ask(session, {"do": "nod"})
    go_on(session, (reply["at"] + reply["until"]) / 2 - session.now)
    over = session.overlay(session.now)
    assert over.head[0] == 1.0 and over.arms[0] == 0.0
    assert ask(session, {"do": "generate", "model": None})["state"] == "done"
    go_on(session, 0.5)
    assert session.generating.motion is None and session.overlay(session.now) is None


def test_a_session_that_was_not_looked_at_goes_on_where_it_was(session) -> None:
    motion = begin(session)
    go_on(session, 0.5)
    frame = motion.path.frame
    session.tick(session.now + 30.0)
    assert motion.path.frame - frame <= 2 and np.isfinite(session.pose(session.now).rotations).all()
    go_on(session, 0.2)
    assert motion.path.frame > frame


def test_the_same_messages_at_the_same_times_move_alike_whatever_the_ticks(sample, graph) -> None:
    ways = []
    for every in (1 / 60, 1 / 47, 1 / 31):
        session = LiveSession(sample, idle=False, graphs={"takes": graph})
        session.join(1)
        begin(session, seed=7)
        motion = session.generating.motion
        motion.begun = motion._first = session.now  # messages come at these moments of its own time
        way: dict[int, int] = {}
        clauses = [
            (0.5 + 1.4 * n, [{"at": session.now + 1.0 + 1.4 * n, "duration": 1.1, "stress": 0.5}])
            for n in range(4)
        ]
        begun = session.now
        while session.now < begun + 6.0:
            while clauses and clauses[0][0] <= session.now - begun - 1 / 30:
                _, comes = clauses.pop(0)
                session.receive(1, json.dumps({"do": "hear", "comes": comes}))
            session.tick(session.now + every)
            way[motion.path.frame] = motion.path.at(motion.path.frame)
        ways.append(motion.kept())
        again = replay_path(graph.driver, motion.told, motion.path.frame + 1, 7)
        assert all(again.states[frame] == state for frame, state in way.items())
    assert all(len(kept.told) == 4 for kept in ways)


def test_what_was_moved_is_kept_and_made_again(session, graph, tmp_path) -> None:
    begin(session, seed=3)
    ask(session, {"do": "hear", "comes": [{"in": 0.6, "duration": 1.0, "stress": 0.5}]})
    go_on(session, 2.0)
    ask(session, {"do": "generate", "model": "takes", "seed": 4})
    motion = session.generating.motion
    go_on(session, 1.0)
    path = tmp_path / "a.motion.json"
    write_kept(path, session.generating.motions())
    one, two = read_kept(path)
    assert (one.seed, two.seed, two.frames) == (3, 4, motion.path.frame + 1) and len(one.told) == 1
    clip = remake_motion(graph, one, "again")
    assert clip.frames == one.frames and clip.skeleton == graph.takes[0].skeleton
    less = LiveGraph(
        graph.takes, replace(graph.driver, graph=replace(graph.driver.graph, targets=np.zeros(3, int)))
    )
    with pytest.raises(ValueError, match="the takes and the speech"):
        remake_motion(less, one, "again")


def test_no_more_is_kept_of_what_became_known_than_may_be(session, graph, monkeypatch) -> None:
    for module in ("graph_motion", "generating"):
        monkeypatch.setattr(f"metagraph.live.{module}.MOST_TOLD", 5)
    for _ in range(3):
        motion = begin(session)
        for _ in range(3):
            ask(
                session, {"do": "hear", "comes": [{"in": 0.5, "duration": 1.0}, {"in": 1.6, "duration": 1.0}]}
            )
            go_on(session, 0.2)
    kept = motion.kept()
    assert len(kept.told) == 4 and kept.frames < motion.path.frame
    assert kept.frames > kept.told[-1][0]  # as far as it can be made again
    assert [len(one.told) for one in session.generating.motions()] == [4, 4]


def test_frames_fade_from_what_was_shown_without_a_step() -> None:
    driver = talkers_graph()
    turn = np.linspace(0, 1, len(driver.states))
    turns = np.stack([np.zeros_like(turn), np.zeros_like(turn), np.sin(turn / 2), np.cos(turn / 2)], -1)[
        :, None
    ]
    way = [
        *range(100, 120),
        *range(700, 709),
        *range(1300, 1330),
    ]  # the second jump comes while the first fades
    angles = [
        2 * np.arcsin(fade_turns(turns, way[max(0, n - FADE) : n + 1], driver)[0, 2]) for n in range(len(way))
    ]
    assert np.isclose(angles[10], turn[110]) and np.isclose(angles[-1], turn[1329], atol=1e-6)
    steps = np.abs(np.diff(angles))
    assert steps.max() < 0.25 * abs(turn[700] - turn[120])
