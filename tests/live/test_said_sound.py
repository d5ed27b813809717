"""A line's sound that is streamed moves the mouth."""

from __future__ import annotations

import base64
import json
from typing import Any

import numpy as np
import pytest

from metagraph.graph.model import Project
from metagraph.live.live_session import LiveSession
from metagraph.playback.life.lips import compute_mouth_shapes

RATE = 16_000
PIECE = 0.1  # seconds


def voice(seconds: float) -> Any:
    """Return a voice that says a vowel, is silent for a second, and says it again."""
    t = np.arange(round(seconds * RATE)) / RATE
    tone = sum(np.sin(2 * np.pi * 140 * n * t) / n for n in range(1, 12)) * 0.15
    loud = np.where((t < 0.8) | ((t > 1.8) & (t < 2.6)), 1.0, 0.0)
    smooth = np.convolve(loud, np.ones(320) / 320, "same")
    return tone * smooth * (0.75 + 0.25 * np.sin(2 * np.pi * 4 * t))


def coded(samples: Any) -> str:
    return base64.b64encode((np.clip(samples, -1, 1) * 32767).astype("<i2").tobytes()).decode()


def one(session: LiveSession, now: float, **fields: Any) -> Any:
    session.receive(1, json.dumps({"do": "say", "id": "s", **fields}))
    (reply,) = session.tick(now).replies
    return reply


@pytest.mark.parametrize("ahead", [0.0, 0.6])
def test_the_mouth_is_open_where_the_voice_is_and_shut_where_it_is_silent(
    sample: Project, ahead: float
) -> None:
    session = LiveSession(sample, idle=False)
    session.join(1)
    samples, step = voice(3.0), round(PIECE * RATE)
    for n in range(0, len(samples), step):
        now = 1.0 + max(0.0, n / RATE - ahead)
        reply = one(session, now, audio=coded(samples[n : n + step]))
        assert reply.state == "planned", reply.why
    (speech,) = session.plan.track.speeches
    assert speech.end - speech.start == pytest.approx(3.0, abs=0.2)
    shown = compute_mouth_shapes(
        session.plan.track, {}, 0.03, speech.start + np.array([0.4, 0.6, 1.3, 1.6, 2.1, 2.4])
    )
    assert shown is not None
    opened = shown.sum(1)
    assert (opened[[0, 1, 4, 5]] > 0.4).all(), opened
    assert (opened[[2, 3]] < 0.05).all(), opened
    fine = compute_mouth_shapes(session.plan.track, {}, 0.03, np.arange(0.9, 4.5, 1 / 240))
    assert fine is not None and np.abs(np.diff(fine, axis=0)).max() < 0.2


def test_pieces_that_come_at_once_are_all_heard(sample: Project) -> None:
    session = LiveSession(sample, idle=False)
    session.join(1)
    samples, step = voice(0.8), round(PIECE * RATE)
    asks = [
        {"do": "say", "id": "s", "audio": coded(samples[n : n + step])} for n in range(0, len(samples), step)
    ]
    session.receive(1, json.dumps(asks))
    assert session.tick(1.0).replies[-1].state == "planned"  # type: ignore[union-attr]
    (speech,) = session.plan.track.speeches
    shown = compute_mouth_shapes(session.plan.track, {}, 0.03, speech.start + np.array([0.2, 0.4, 0.6]))
    assert shown is not None and (shown.sum(1) > 0.4).all()


def test_words_tell_more_than_loudness(sample: Project) -> None:
    session = LiveSession(sample, idle=False)
    session.join(1)
    one(session, 1.0, audio=coded(voice(0.5)), words=[["mama", 0.1, 0.4]])
    (speech,) = session.plan.track.speeches
    assert speech.timing is not None and not speech.timing.marks


def test_a_kept_session_needs_no_sound(sample: Project) -> None:
    session = LiveSession(sample, idle=False)
    session.join(1)
    one(session, 1.0, audio=coded(voice(0.5)))
    (ask,) = session.tape.asks()
    assert ask.audio is None and ask.visemes


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"audio": "???"}, "audio: give base64"),
        ({"audio": base64.b64encode(b"abc").decode()}, "an even number of bytes"),
        ({"audio": ""}, "an even number of bytes"),
    ],
)
def test_what_is_no_sound_is_told(sample: Project, fields: dict[str, Any], words: str) -> None:
    session = LiveSession(sample, idle=False)
    session.join(1)
    reply = one(session, 1.0, **fields)
    assert reply.state == "refused" and words in reply.why
