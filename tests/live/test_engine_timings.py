"""What speech synthesisers send is said as they send it: the same words at the same times."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph.model import Project
from metagraph.live.engine_timings import adopt_engine_timing
from metagraph.live.live_session import LiveSession
from metagraph.live.messages import HeardMessage, Reply, read_live_request

LETTERS = list("so we")
WORDS: dict[str, dict[str, Any]] = {
    "Cartesia": {"word_timestamps": {"words": ["so", "we"], "start": [0.1, 0.4], "end": [0.3, 0.7]}},
    "Cartesia's lists as words": {"words": {"words": ["so", "we"], "start": [0.1, 0.4], "end": [0.3, 0.7]}},
    "Deepgram": {
        "words": [
            {"word": "x", "punctuated_word": "so", "start": 0.1, "end": 0.3},
            {"word": "y", "punctuated_word": "we", "start": 0.4, "end": 0.7},
        ]
    },
    "Kokoro": {
        "words": [
            {"text": "so", "start_ts": 0.1, "end_ts": 0.3, "whitespace": " "},
            {"text": "we", "start_ts": 0.4, "end_ts": 0.7},
        ]
    },
    "services that say start_time": {
        "words": [
            {"word": "so", "start_time": 0.1, "end_time": 0.3},
            {"word": "we", "start_time": 0.4, "end_time": 0.7},
        ]
    },
    "services that say milliseconds": {
        "words": [
            {"word": "so", "start_ms": 100, "end_ms": 300},
            {"word": "we", "startMs": 400, "endMs": 700},
        ]
    },
    "Azure's detailed results": {
        "words": [
            {"Word": "so", "Offset": 1_000_000, "Duration": 2_000_000},
            {"Word": "we", "Offset": 4_000_000, "Duration": 3_000_000},
        ]
    },
    "ElevenLabs": {
        "alignment": {
            "characters": LETTERS,
            "character_start_times_seconds": [0.1, 0.2, 0.3, 0.4, 0.5],
            "character_end_times_seconds": [0.2, 0.3, 0.4, 0.5, 0.7],
        }
    },
    "ElevenLabs' stream": {
        "normalizedAlignment": {
            "chars": LETTERS,
            "charStartTimesMs": [100, 200, 300, 400, 500],
            "charDurationsMs": [100, 100, 100, 100, 200],
        }
    },
    "our own": {"words": [["so", 0.1, 0.3], ["we", 0.4, 0.7]]},
    "our own objects": {
        "words": [{"word": "so", "start": 0.1, "end": 0.3}, {"word": "we", "start": 0.4, "end": 0.7}]
    },
}


def say(sample: Project, **fields: Any) -> Any:
    """Return the speech that a session makes of a request."""
    session = LiveSession(sample, idle=False)
    session.join(1)
    session.receive(1, json.dumps({"do": "say", "id": "x", **fields}))
    (reply,) = session.tick(1.0).replies
    assert isinstance(reply, Reply) and reply.state == "planned", reply
    return next(s for s in session.plan.track.speeches if s.id.endswith("x"))


@pytest.mark.parametrize("service", WORDS)
def test_the_words_of_each_service_come_at_their_times(sample: Project, service: str) -> None:
    speech = say(sample, **WORDS[service])
    assert speech.text == "so we"
    words = [(word.text, word.start, word.end) for word in speech.timing.words]
    assert words == [
        ("so", pytest.approx(0.1), pytest.approx(0.3)),
        ("we", pytest.approx(0.4), pytest.approx(0.7)),
    ]


def test_frames_of_blend_shapes_are_a_sixtieth_of_a_second_apart() -> None:
    frame = [0.0] * 55
    frame[17] = 0.5  # jawOpen
    fields: dict[str, Any] = {
        "do": "say",
        "visemes": [{"FrameIndex": 60, "BlendShapes": [[0.0] * 55, frame]}],
    }
    assert adopt_engine_timing(fields)
    assert fields["set"] == "arkit"
    first, second = fields["visemes"]
    assert (first["time"], second["time"]) == (1.0, pytest.approx(61 / 60))
    assert (first["weights"]["jawOpen"], second["weights"]["jawOpen"]) == (0.0, 0.5)
    assert "eyeBlinkLeft" not in second["weights"], "the eyes are the character's own"


@pytest.mark.parametrize(
    ("visemes", "name", "shapes"),
    [
        ([[0.0, "m"], [0.1, "aɪ"], [0.3, ""]], None, [(0.0, "PP"), (0.1, "aa"), (0.2, "I"), (0.3, "sil")]),
        (
            [[0.0, "M"], [0.1, "AY1"], [0.3, "sil"]],
            None,
            [(0.0, "PP"), (0.1, "aa"), (0.2, "I"), (0.3, "sil")],
        ),
        ([[0.0, "p"], [0.1, "aː"], [0.3, ""]], "ipa", [(0.0, "PP"), (0.1, "aa"), (0.3, "sil")]),
        (
            {"phonemes": ["m", "a"], "start": [0.0, 0.2], "end": [0.1, 0.3]},
            None,
            [(0.0, "PP"), (0.1, "sil"), (0.2, "aa"), (0.3, "sil")],
        ),
        (
            [{"start": 0.0, "end": 0.1, "value": "A"}, {"start": 0.1, "end": 0.3, "value": "D"}],
            None,
            [(0.0, "PP"), (0.1, "aa"), (0.3, "sil")],
        ),
        ([[0.0, "A"], [0.1, "X"]], "rhubarb", [(0.0, "PP"), (0.1, "sil")]),
    ],
)
def test_phones_and_mouth_cues_become_visemes(
    visemes: Any, name: str | None, shapes: list[tuple[float, str]]
) -> None:
    fields: dict[str, Any] = {"do": "say", "visemes": visemes}
    if name is not None:
        fields["set"] = name
    assert adopt_engine_timing(fields)
    found = [(pytest.approx(row[0]), row[1]) for row in fields["visemes"]]
    assert found == shapes and fields["set"] == "oculus"


@pytest.mark.parametrize(
    "visemes",
    [
        [[0.0, "PP"], [0.1, "aa"]],
        [[0.0, "p"], [0.1, "a"], [0.2, "sil"]],
        [[0.0, 21], [0.1, 2]],
        [[0.0, "E"], [0.1, "O"]],
        [{"time": 6, "type": "viseme", "value": "p"}],
        [{"audioOffset": 500000, "visemeId": 21}],
        [{"time": 0.0, "weights": {"jawOpen": 0.3}}],
        [[0.0, "aa", 0.5]],
    ],
)
def test_visemes_that_are_known_already_stay_as_they_are(visemes: Any) -> None:
    fields = {"do": "say", "visemes": visemes}
    assert not adopt_engine_timing(fields) and fields == {"do": "say", "visemes": visemes}


@pytest.mark.parametrize(
    "fields",
    [
        {"word_timestamps": {"words": ["so", "we"], "start": [0.1], "end": [0.3, 0.7]}},
        {"alignment": {"characters": ["s"], "character_start_times_seconds": ["soon"]}},
        {"words": [{"word": "so", "start_ts": "now"}]},
        {"visemes": [{"BlendShapes": [[0.1, 0.2]]}]},
        {"visemes": [[0.0, "zzzz"]]},
        {"words": [{"word": "we", "start_time": 5.0, "end_time": 4.0}]},
    ],
)
def test_what_is_wrong_is_refused_with_its_place(sample: Project, fields: dict[str, Any]) -> None:
    session = LiveSession(sample, idle=False)
    session.join(1)
    session.receive(1, json.dumps({"do": "say", "id": "x", **fields}))
    (reply,) = session.tick(1.0).replies
    assert isinstance(reply, Reply) and (reply.error or (reply.state == "refused" and reply.why)), reply
    said = reply.error or reply.why
    assert any(name in said for name in ("words", "characters", "visemes", "alignment")), said


def test_a_request_in_a_while_may_have_a_services_times_too() -> None:
    heard = read_live_request(json.dumps({"do": "say", "in": 2, **WORDS["Cartesia"]}))
    assert isinstance(heard, HeardMessage) and heard.after == 2.0


TEXTS = st.sampled_from(["so", "PP", "aɪ", "AH0", "D", ""])
NAMES = st.sampled_from(
    [
        "words",
        "start",
        "end",
        "text",
        "BlendShapes",
        "chars",
        "charStartTimesMs",
        "charDurationsMs",
        "value",
        "time",
        "Offset",
        "Duration",
    ]
)
JSON = st.recursive(
    st.none() | st.booleans() | st.integers(-5, 5000) | st.floats(-2, 9) | TEXTS,
    lambda some: st.lists(some, max_size=4) | st.dictionaries(NAMES, some, max_size=5),
    max_leaves=12,
)
FIELDS = st.sampled_from(
    ["words", "visemes", "characters", "alignment", "word_timestamps", "phoneme_timestamps", "set"]
)


@given(st.dictionaries(FIELDS, JSON))
def test_whatever_is_sent_is_read_or_refused(fields: dict[str, Any]) -> None:
    assert isinstance(read_live_request(json.dumps({"do": "say", **fields})), HeardMessage | Reply)


def test_a_mouth_shape_that_nobody_knows_among_known_ones_is_refused(sample: Project) -> None:
    session = LiveSession(sample)
    visemes = [[0, "PP"], [0.1, "aa"], [0.2, "PP"], [0.26, "xx"]]
    session.receive(1, json.dumps({"do": "say", "visemes": visemes}))
    (reply,) = session.tick(0.1).replies
    assert isinstance(reply, Reply)
    assert "'xx': is in no set of visemes" in f"{reply.error} {reply.why}"
