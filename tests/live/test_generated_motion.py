"""Motion generated live: of what a client hears, until something is asked for by name."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from metagraph.generation.features import RATE
from metagraph.generation.networks import FlowSizes
from metagraph.generation.stored import write_model
from metagraph.graph import anatomy, edits
from metagraph.graph.model import Project
from metagraph.live.live_session import LiveSession
from metagraph.live.voice_detector import VoiceDetector
from tests.generation.makers import babble, rig, stance, untrained
from tests.posing import pose_at

TICK = 1 / 60


@pytest.fixture(scope="module")
def models(tmp_path_factory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("models")
    out = {kind: folder / f"{kind}.mgmodel" for kind in ("flow-vae", "cvae", "matching")}
    for kind, path in out.items():
        write_model(untrained(kind), path)  # type: ignore[arg-type]
    out["broken"] = folder / "broken.mgmodel"
    out["broken"].write_bytes(b"PK\3\4 nothing")
    return out


@pytest.fixture
def session(sample: Project, models: dict[str, Path]) -> LiveSession:
    out = LiveSession(sample, idle=False, models=models)
    out.join(1)
    out.tick(1.0)
    return out


def ask(session: LiveSession, request: dict[str, Any], client: int = 1) -> dict[str, Any]:
    session.receive(client, json.dumps(request))
    out = session.tick(session.now + TICK)
    (reply,) = out.replies
    return msgspec.json.decode(reply) if isinstance(reply, bytes) else msgspec.to_builtins(reply)


def sound(seconds: float, seed: int = 1) -> str:
    samples = np.clip(babble(seconds, seed) * 32768, -32768, 32767).astype("<i2")
    return base64.b64encode(samples.tobytes()).decode()


def go_on(session: LiveSession, seconds: float, voice: bool = True, client: int = 1) -> list[Any]:
    """Let it hear so much, a tenth of a second at a time; return the overlays of its ticks."""
    out, n = [], 0
    until = session.now + seconds
    heard = np.frombuffer(base64.b64decode(sound(seconds + 1.0)), "<i2")
    size = RATE // 10
    while session.now < until:
        if voice and n % 6 == 0:
            piece = heard[n // 6 * size : (n // 6 + 1) * size]
            request = {"do": "hear", "audio": base64.b64encode(piece.tobytes()).decode()}
            session.receive(client, json.dumps(request))
        session.tick(session.now + TICK)
        out.append(session.overlay(session.now))
        n += 1
    return out


@pytest.mark.parametrize("kind", ["flow-vae", "cvae", "matching"])
def test_arms_and_head_move_as_the_model_says_and_the_legs_as_the_body_does(session, sample, kind):
    reply = ask(session, {"do": "generate", "model": kind, "id": "g"})
    assert reply["id"] == "g" and reply["state"] == "planned" and "after the sound" in reply["notes"][0]
    go_on(session, 2.0)
    rotations, plain = [], []
    for _ in range(60):
        session.tick(session.now + TICK)
        rotations.append(session.pose(session.now).rotations)
        plain.append(pose_at(session.plan, sample, session.now).rotations)
    apart = np.abs(np.stack(rotations) - np.stack(plain)).max((0, 2))
    parts = np.array(anatomy.project_parts(sample))
    assert apart[parts == "legs"].max() < 1e-6 and apart[parts == "arms"].max() > 0.01
    steps = np.abs(np.diff(np.stack(rotations), axis=0)).max((1, 2))
    assert steps.max() < 0.2  # no jump, also where a chunk ends


def test_it_comes_and_goes_without_a_jump(session):
    ask(session, {"do": "generate", "model": "flow-vae"})
    weights = [0.0 if o is None else float(o.weight[0]) for o in go_on(session, 1.5)]
    assert weights[0] == 0.0 and weights[-1] == 1.0 and max(np.diff(weights)) < 0.12
    assert ask(session, {"do": "generate", "model": None})["state"] == "done"
    weights = [0.0 if o is None else float(o.weight[0]) for o in go_on(session, 0.6, voice=False)]
    assert weights[-1] == 0.0 and min(np.diff(weights)) > -0.12
    assert session.generating.motion is None
    assert ask(session, {"do": "generate", "model": None})["why"] == "nothing was generated"


def test_a_gesture_by_name_wins_and_gives_way_again(session, sample):
    ask(session, {"do": "generate", "model": "flow-vae"})
    go_on(session, 1.0)
    reply = ask(session, {"do": "action", "action": "shrug_bt_01"})
    at, until = reply["at"], reply["until"]
    shown = {}
    while session.now < until + 0.5:
        go_on(session, TICK)
        over = session.overlay(session.now)
        shown[session.now] = float(over.arms[0])
        if abs(session.now - (at + until) / 2) < TICK:
            plan = pose_at(session.plan, sample, session.now).rotations
            assert np.allclose(session.pose(session.now).rotations, plan, atol=1e-5)
    assert max(w for t, w in shown.items() if t <= at) == 0.0
    assert min(w for t, w in shown.items() if at + 0.25 < t < until - 0.25) == 1.0
    assert [w for t, w in shown.items() if t > until] and max(w for t, w in shown.items() if t > until) == 0.0
    values = list(shown.values())
    assert np.abs(np.diff(values)).max() < 0.13


def test_a_nod_takes_the_head_and_leaves_the_arms(session):
    ask(session, {"do": "generate", "model": "flow-vae"})
    go_on(session, 1.0)
    reply = ask(session, {"do": "nod"})
    go_on(session, (reply["at"] + reply["until"]) / 2 - session.now)
    over = session.overlay(session.now)
    assert over.head[0] == 1.0 and over.arms[0] == 0.0


def test_what_idles_by_itself_does_not_win(sample, models):
    session = LiveSession(sample, idle=True, models=models)
    session.join(1)
    ask(session, {"do": "generate", "model": "flow-vae"})
    assert all(o is None or (o.arms[0] == 0 and o.head[0] == 0) for o in go_on(session, 6.0))


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        ({"model": "../../etc/passwd"}, "there is no model '../../etc/passwd'; there are flow-vae"),
        ({"model": "broken"}, "broken.mgmodel"),
        ({"model": "flow-vae", "temperature": 9}, "temperature"),
        ({"model": "flow-vae", "side": "director"}, "side"),
        ({"model": "flow-vae", "ahead": -1}, "ahead"),
        ({}, "model"),
    ],
)
def test_what_cannot_be_generated_is_said_in_words(session, request_, words):
    reply = ask(session, {"do": "generate", **request_})
    assert words in (reply.get("why") or "") + (reply.get("error") or "")
    assert session.generating.motion is None


@pytest.mark.nightly
def test_a_model_of_another_skeleton_and_one_too_large_are_refused(session, sample, models, tmp_path):
    other = stance()
    names = tuple(f"x{n}" for n in other.skeleton.names)
    stranger = edits.add_clips(Project(), [("a.glb", 0, "", _renamed(other, names))])
    session = LiveSession(stranger, models=models)
    session.join(1)
    assert "another skeleton" in ask(session, {"do": "generate", "model": "flow-vae"})["why"]
    huge = tmp_path / "huge.mgmodel"
    write_model(untrained("flow-vae", sizes=FlowSizes(pose=rig().numbers, dims=24, units=1000)), huge, True)
    session = LiveSession(sample, models={"huge": huge})
    session.join(1)
    assert "million parameters" in ask(session, {"do": "generate", "model": "huge"})["why"]


def _renamed(clip, names):
    from dataclasses import replace

    from metagraph.motion.skeleton import Skeleton

    s = clip.skeleton
    return replace(clip, skeleton=Skeleton(names, s.parents, s.rest_rotations, s.rest_translations * 1.1))


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        ({"audio": "AAA="[:4] + "AAAA"[:0]}, ""),
        ({"audio": base64.b64encode(b"abc").decode()}, "two bytes"),
        ({"audio": "no base64!"}, "audio"),
        ({"speaks": "everybody"}, "speaks"),
        ({"comes": [{"in": 1, "duration": 1}]}, "only motion graphs"),
    ],
)
def test_what_is_heard_is_checked(session, request_, words):
    ask(session, {"do": "generate", "model": "cvae"})
    reply = ask(session, {"do": "hear", **request_})
    assert words in (reply.get("why") or "") + (reply.get("error") or "")


def test_sound_that_comes_too_fast_or_from_somebody_else_is_refused(session):
    session.join(2)
    assert "send `generate` first" in ask(session, {"do": "hear", "audio": sound(0.1)})["why"]
    ask(session, {"do": "generate", "model": "cvae"})
    assert "another client" in ask(session, {"do": "hear", "audio": sound(0.1)}, client=2)["why"]
    replies = [ask(session, {"do": "hear", "audio": sound(1.0)}) for _ in range(4)]
    assert replies[0]["state"] == "done" and "in real time" in replies[-1]["why"]
    status = ask(session, {"do": "status"})["generating"]
    assert status["model"] == "cvae" and 2.0 < status["waits"] <= 3.0


def test_it_ends_when_who_asked_hangs_up_and_tells_what_there_is(session):
    assert ask(session, {"do": "describe"})["models"] == ["flow-vae", "cvae", "matching", "broken"]
    session.join(2)
    ask(session, {"do": "generate", "model": "cvae"}, client=2)
    go_on(session, 0.5, client=2)
    session.leave(2)
    go_on(session, 0.5, voice=False)
    assert session.generating.motion is None and ask(session, {"do": "status"})["generating"] is None


def test_another_model_takes_over_without_a_jump(session):
    ask(session, {"do": "generate", "model": "flow-vae"})
    go_on(session, 1.5)
    before = session.pose(session.now).rotations
    ask(session, {"do": "generate", "model": "cvae", "side": "speaker"})
    after = session.pose(session.now).rotations
    assert np.abs(after - before).max() < 0.1
    rotations = []
    for _ in range(90):
        go_on(session, TICK)
        rotations.append(session.pose(session.now).rotations)
    assert np.abs(np.diff(np.stack(rotations), axis=0)).max() < 0.2


def test_a_session_that_was_not_looked_at_goes_on_with_what_is_heard_now(session):
    ask(session, {"do": "generate", "model": "flow-vae"})
    go_on(session, 1.0)
    motion = session.generating.motion
    fed = motion._fed
    session.tick(session.now + 30.0)
    assert motion._fed - fed < 30
    assert np.isfinite(session.pose(session.now).rotations).all()


def test_who_speaks_may_be_told_and_is_heard_otherwise():
    voice, noise = VoiceDetector(), 1e-4 * np.random.default_rng(1).standard_normal(16000)
    assert not any(voice.hear(noise[n : n + 640]) for n in range(0, 12800, 640))
    loud = 0.2 * np.sin(np.arange(640) / 10)
    assert voice.hear(loud) and voice.hear(noise[:640])
    assert not [voice.hear(noise[:640]) for _ in range(10)][-1]
