"""Moods and laughs of others that a listener takes up: how far, how late, how often; in talks and live."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import pytest

from metagraph.formats.gltf.reader import read_morph_targets
from metagraph.formats.store import open_project
from metagraph.graph.conversation.model import Conversation, Rates, Side, Word
from metagraph.graph.face.rig import with_morphs
from metagraph.graph.model import Project
from metagraph.live.live_session import LiveSession
from metagraph.playback.life.sympathy import Laugh, laughs_along, moods_taken_up, taken_up
from metagraph.playback.plan import Plan
from metagraph.playback.planning.mood import MOODS, Mood, MoodFrom, Moods, mood_at
from metagraph.speech.duet import plan_duet
from metagraph.speech.sympathies import find_laughs
from tests.posing import compute_morphs_at

SAMPLES = Path(__file__).parents[3] / "sample_clips"
HAPPY, ANGRY, SAD = (Mood(*MOODS[name]) for name in ("happy", "angry", "sad"))


@pytest.fixture(scope="module")
def sample() -> Project:
    project = open_project(SAMPLES / "sample.metagraph.yaml").project
    return with_morphs(project, read_morph_targets(SAMPLES / "ada.glb"))


def in_mood(project: Project, name: str) -> Project:
    valence, arousal = MOODS[name]
    return replace(project, life=msgspec.structs.replace(project.life, valence=valence, arousal=arousal))


def test_nothing_is_taken_up_of_neutral_moods_or_without_a_share() -> None:
    assert taken_up(SAD, Mood(), 0.5) == SAD and taken_up(SAD, HAPPY, 0.0) == SAD
    assert moods_taken_up(Moods(SAD), Moods(), 60.0, 0.5, 1, "x") == []
    assert laughs_along(Moods(), [Laugh(1, 2)], 0.0, 1, "x") == []


def test_friendly_moods_are_taken_up_farther_than_hostile_ones() -> None:
    assert taken_up(Mood(), HAPPY, 0.35).valence == pytest.approx(0.35 * HAPPY.valence)
    assert taken_up(Mood(), SAD, 0.35).valence == pytest.approx(0.35 * SAD.valence)
    angry = taken_up(Mood(), ANGRY, 0.35)
    assert 0 > angry.valence > 0.35 * ANGRY.valence and angry.arousal < 0.2 * ANGRY.arousal
    shares = [taken_up(SAD, HAPPY, s).valence for s in (0.0, 0.2, 0.5, 1.0)]
    assert shares == sorted(shares) and shares[-1] == pytest.approx(HAPPY.valence)


def test_a_mood_is_taken_up_a_moment_later_and_let_go_with_it() -> None:
    other = Moods(Mood(), (MoodFrom("a", 5.0, *MOODS["happy"], None, 12.0),))
    [told] = moods_taken_up(Moods(), other, 60.0, 0.35, 1, "x")
    assert 5.7 <= told.start <= 6.4 and told.end == 12.0
    assert [told] == moods_taken_up(Moods(), other, 60.0, 0.35, 1, "x"), "the same every time"
    [whole] = moods_taken_up(Moods(), Moods(HAPPY), 60.0, 0.35, 1, "x")
    assert whole.start == 0.0 and whole.end == 60.0


def test_as_many_laughs_as_asked_for_are_joined_and_soon() -> None:
    laughs = [Laugh(4.0 * n, 4.0 * n + 1.0) for n in range(400)]
    along = laughs_along(Moods(SAD), laughs, 0.6, 7, "x")
    assert 0.53 < len(along) / 400 < 0.67
    for one in along:
        late = one.start % 4.0
        assert 0.25 <= late <= 0.5 and one.end - one.start >= 2.0
        assert mood_at(Moods(SAD, [one]), one.start + 0.1).valence == 0.9
    assert along != laughs_along(Moods(SAD), laughs, 0.6, 8, "x")


def talk(words: tuple[str, ...] = (), **rates: float) -> Conversation:
    said = tuple(Word(text=w, start=8.0 + 0.3 * n, end=8.25 + 0.3 * n) for n, w in enumerate(words))
    return Conversation(
        name="t", length=16.0, sides=(Side(name="Ann", words=said), Side(name="Ben", rates=Rates(**rates)))
    )


def smile(project: Project, plan: Plan, seconds: float) -> float:
    return compute_morphs_at(plan, project, seconds).get("mouthSmileLeft", 0.0)


def test_a_listener_smiles_with_a_happy_partner_and_less_with_a_smaller_dial(sample: Project) -> None:
    shown = []
    for share in (0.0, 0.35, 1.0):
        made = plan_duet(talk(mood=share), "v", (in_mood(sample, "happy"), sample), (None, None))
        shown.append(max(smile(made.parts[1].project, made.parts[1].plan, t / 4) for t in range(8, 60)))
    assert shown[0] < 0.35 * shown[2] and shown[0] + 0.05 < shown[1] < shown[2]
    asks = [a for a in made.parts[1].performance.asks if a.id.startswith("side 1 mood")]
    assert len(asks) == 1 and not [a for a in made.parts[0].performance.asks if a.id.startswith("side")]


def test_laughter_among_the_words_brings_a_laughing_face(sample: Project) -> None:
    conversation = talk(("haha", "hahaha", "well"), laugh=1.0)
    [laugh] = find_laughs(conversation.sides[0], Plan(1, 16.0))
    assert laugh == Laugh(8.0, 8.55)
    made = plan_duet(conversation, "v", (sample, sample), (None, None)).parts[1]
    assert smile(made.project, made.plan, 9.8) > smile(made.project, made.plan, 7.9) + 0.2
    none = plan_duet(talk(("haha",), laugh=0.0), "v", (sample, sample), (None, None)).parts[1]
    assert not [a for a in none.performance.asks if "laugh" in a.id]


def test_a_session_is_told_of_its_partner(sample: Project) -> None:
    session = LiveSession(sample)
    replies: list[Any] = []

    def tell(at: float, **message: Any) -> None:
        session.receive(1, json.dumps({"do": "partner", **message}))
        out = session.tick(at)
        replies.extend(out.replies if hasattr(out, "replies") else [])

    session.tick(0.0)
    tell(1.0, mood="happy", share=0.8)
    session.tick(6.0)
    before = session.plan.track.moods
    assert before and before[-1].valence == pytest.approx(0.8 * 0.79, abs=1e-3)
    assert before[-1].start == pytest.approx(1.7, abs=0.11)
    tell(7.0, mood="happy", share=0.8)
    session.tick(9.0)
    assert mood_at(Moods(Mood(), session.plan.track.moods), 9.0).valence == pytest.approx(0.632, abs=1e-3)
    tell(10.0, laughs=1.5, share=1.0)
    session.tick(11.0)
    assert mood_at(Moods(Mood(), session.plan.track.moods), 11.0).valence == 0.9
    tell(14.0, mood="neutral")
    session.tick(18.0)
    assert mood_at(Moods(Mood(), session.plan.track.moods), 18.0).like(Mood())
