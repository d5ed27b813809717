"""Two characters who talk with each other."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np
import pytest

from metagraph.graph.conversation import Conversation, Segment, Side, Word
from metagraph.graph.model import Project
from metagraph.speech.duet import duet, stands, voices
from metagraph.speech.peak_blinks import peak_blinks

RATE = 16000
SAMPLE = Path(__file__).resolve().parents[2] / "sample_clips"


def talk(**changes: object) -> Conversation:
    left = Side(
        name="Left", audio="talk.wav", channel=0, segments=(Segment("clause", 1.0, 2.0, 1.5, "hello there"),)
    )
    right = Side(
        name="Right", audio="talk.wav", channel=1, segments=(Segment("response", 2.2, 2.6, None, "yeah"),)
    )
    return Conversation(name="talk", length=6.0, sides=(left, right), **changes)  # type: ignore[arg-type]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with two channels of humming: the left one's at 1-2 s, the right one's at 2.2-2.6 s."""
    import soundfile

    t = np.arange(6 * RATE) / RATE
    hum = 0.3 * np.sin(2 * np.pi * 150 * t) + 0.1 * np.sin(2 * np.pi * 700 * t)
    sound = np.stack([hum * ((t >= a) & (t < b)) for a, b in ((1.0, 2.0), (2.2, 2.6))], 1)
    soundfile.write(
        tmp_path / "talk.wav", sound + np.random.default_rng(1).normal(0, 1e-4, sound.shape), RATE
    )
    return tmp_path


def test_each_side_speaks_with_its_own_channel(folder: Path) -> None:
    heard, notes = voices(talk(), folder)
    assert not notes
    for voice, (start, end) in zip(heard, ((1.0, 2.0), (2.2, 2.6)), strict=True):
        assert voice is not None and voice.duration == 6.0
        moving = voice.times[voice.weights[:, 1:].max(1) > 0.2]
        assert len(moving) and moving.min() > start - 0.3 and moving.max() < end + 0.3


def test_a_channel_that_is_not_there_is_told_and_the_other_side_still_speaks(folder: Path) -> None:
    sides = talk().sides
    odd = Conversation(
        name="talk", length=6.0, sides=(Side(name="Left", audio="talk.wav", channel=5), sides[1])
    )
    heard, notes = voices(odd, folder)
    assert heard[0] is None and heard[1] is not None
    assert len(notes) == 1 and "Left" in notes[0] and "2 channels" in notes[0]


def test_a_missing_sound_leaves_both_moving(folder: Path, sample: Project) -> None:
    (folder / "talk.wav").unlink()
    heard, notes = voices(talk(), folder)
    assert heard == (None, None) and notes
    made = duet(talk(), "v1", (sample, sample), heard)
    assert all(part.plan.end == 6.0 and not part.plan.track.speeches for part in made.parts)


def test_words_shape_the_mouth_where_there_are_any(folder: Path) -> None:
    sides = (Side(audio="talk.wav", channel=0, words=(Word(text="mama", start=1.2, end=1.6),)), Side())
    heard, _ = voices(Conversation(name="talk", length=6.0, sides=sides), folder)
    assert heard[0] is not None and heard[1] is None
    moving = heard[0].times[heard[0].weights[:, 1:].max(1) > 0.2]
    assert moving.min() > 1.0 and moving.max() < 1.8


def test_both_speak_their_lines_and_look_at_each_other(folder: Path, sample: Project) -> None:
    made = duet(talk(), "v1", (sample, sample), voices(talk(), folder)[0])
    lines = [part.plan.track.speeches[0].line for part in made.parts]
    assert lines == ["v1.1", "v1.2"]
    for part in made.parts:
        assert set(lines) & set(part.project.lines) == {part.plan.track.speeches[0].line}
        assert part.plan.track.looks[0].to == "partner"
        assert part.plan.track.places[0].point[2] == pytest.approx(1.3)


def test_a_line_of_the_same_id_is_kept(folder: Path, sample: Project) -> None:
    from dataclasses import replace

    from metagraph.graph.requests import Line

    taken = replace(sample, lines={"v1.1": Line(text="mine")})
    made = duet(talk(), "v1", (taken, taken), voices(talk(), folder)[0])
    assert made.parts[0].project.lines["v1.1"].text == "mine"
    assert made.parts[0].plan.track.speeches[0].line == "v1.1'"


@pytest.mark.parametrize("distance", [0.6, 1.3, 4.0])
def test_the_two_stand_so_far_apart_and_face_each_other(distance: float) -> None:
    turned = np.array([[0.0, 0.0, 0.0, 1.0]])
    ahead = np.array([[0.0, 1.0, 0.5]])
    places = []
    for n, stand in enumerate(stands(talk(distance=distance))):
        _, feet = stand.placed(turned, np.zeros((1, 3)))
        _, nose = stand.placed(turned, ahead)
        places.append(feet[0])
        assert (nose - feet)[0] == pytest.approx([0.5 if n == 0 else -0.5, 1.0, 0.0], abs=1e-9)
    assert np.linalg.norm(places[0] - places[1]) == pytest.approx(distance)


def test_what_is_placed_turns_with_its_joints() -> None:
    """A joint's own axes, and what hangs on it, are turned alike."""
    stand = stands(talk(distance=2.0))[0]
    rotations, positions = stand.placed(np.tile([0.0, 0.0, 0.0, 1.0], (3, 2, 1)), np.ones((3, 2, 3)))
    assert rotations.shape == (3, 2, 4) and positions.shape == (3, 2, 3)
    assert positions[0, 0] == pytest.approx([0.0, 1.0, -1.0])
    assert rotations[0, 0] == pytest.approx([0, np.sqrt(0.5), 0, np.sqrt(0.5)])


def test_blinks_come_near_the_peaks_of_the_pitch_of_clauses(sample: Project) -> None:
    """By loudness 5 of 18 peaks had a blink within 0.15 s on the sample's conversation; now those do that
    come a second after the last blink.
    """
    conversation = next(iter(sample.conversations.values()))
    heard, _ = voices(conversation, SAMPLE)
    made = duet(conversation, "v", (sample, sample), heard)
    near = total = 0
    for part, side in zip(made.parts, conversation.sides, strict=True):
        blinks = part.plan.life.blinks.starts
        peaks = [s.peak for s in side.segments if s.kind == "clause" and s.peak is not None]
        near += sum(bool((abs(blinks - p) <= 0.15).any()) for p in peaks)
        total += len(peaks)
    assert near >= 0.6 * total


def test_blinks_by_the_papers_rule_are_those_and_no_others(sample: Project) -> None:
    conversation = msgspec.structs.replace(next(iter(sample.conversations.values())), blinks="peaks")
    made = duet(conversation, "v", (sample, sample), (None, None))
    for n, (part, side) in enumerate(zip(made.parts, conversation.sides, strict=True)):
        peaks = [s.peak for s in side.segments if s.peak is not None]
        expected = peak_blinks(peaks, conversation.length, conversation.seed, str(n))
        assert part.plan.life.blinks.starts.tolist() == pytest.approx(expected, abs=1e-9)
