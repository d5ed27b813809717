"""Characters who talk with each other: two, and more."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np
import pytest

from metagraph.graph.conversation.model import (
    Conversation,
    Rates,
    Segment,
    Side,
    Word,
    list_segments_heard_by,
)
from metagraph.graph.model import Project
from metagraph.playback.plan import Plan
from metagraph.speech.drive import drive, find_partner_points
from metagraph.speech.duet import load_conversation_voices, place_sides, plan_duet
from metagraph.speech.mirroring import Mover, list_mirrored_stances
from metagraph.speech.peak_blinks import place_peak_blinks
from tests.speech.group import group, said

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
    heard, notes = load_conversation_voices(talk(), folder)
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
    heard, notes = load_conversation_voices(odd, folder)
    assert heard[0] is None and heard[1] is not None
    assert len(notes) == 1 and "Left" in notes[0] and "2 channels" in notes[0]


def test_a_missing_sound_leaves_both_moving(folder: Path, sample: Project) -> None:
    (folder / "talk.wav").unlink()
    heard, notes = load_conversation_voices(talk(), folder)
    assert heard == (None, None) and notes
    made = plan_duet(talk(), "v1", (sample, sample), heard)
    assert all(part.plan.end == 6.0 and not part.plan.track.speeches for part in made.parts)


def test_words_shape_the_mouth_where_there_are_any(folder: Path) -> None:
    sides = (Side(audio="talk.wav", channel=0, words=(Word(text="mama", start=1.2, end=1.6),)), Side())
    heard, _ = load_conversation_voices(Conversation(name="talk", length=6.0, sides=sides), folder)
    assert heard[0] is not None and heard[1] is None
    moving = heard[0].times[heard[0].weights[:, 1:].max(1) > 0.2]
    assert moving.min() > 1.0 and moving.max() < 1.8


def test_both_speak_their_lines_and_look_at_each_other(folder: Path, sample: Project) -> None:
    made = plan_duet(talk(), "v1", (sample, sample), load_conversation_voices(talk(), folder)[0])
    lines = [part.plan.track.speeches[0].line for part in made.parts]
    assert lines == ["v1.1", "v1.2"]
    for part in made.parts:
        assert set(lines) & set(part.project.lines) == {part.plan.track.speeches[0].line}
        assert part.plan.track.looks[0].to == "partner"
        assert part.plan.track.places[0].point[2] == pytest.approx(1.3 - 0.07, abs=0.01)  # its eyes


def test_a_line_of_the_same_id_is_kept(folder: Path, sample: Project) -> None:
    from dataclasses import replace

    from metagraph.graph.requests import Line

    taken = replace(sample, lines={"v1.1": Line(text="mine")})
    made = plan_duet(talk(), "v1", (taken, taken), load_conversation_voices(talk(), folder)[0])
    assert made.parts[0].project.lines["v1.1"].text == "mine"
    assert made.parts[0].plan.track.speeches[0].line == "v1.1'"


@pytest.mark.parametrize("distance", [0.6, 1.3, 4.0])
def test_the_two_stand_so_far_apart_and_face_each_other(distance: float) -> None:
    turned = np.array([[0.0, 0.0, 0.0, 1.0]])
    ahead = np.array([[0.0, 1.0, 0.5]])
    places = []
    for n, stand in enumerate(place_sides(talk(distance=distance))):
        _, feet = stand.placed(turned, np.zeros((1, 3)))
        _, nose = stand.placed(turned, ahead)
        places.append(feet[0])
        assert (nose - feet)[0] == pytest.approx([0.5 if n == 0 else -0.5, 1.0, 0.0], abs=1e-9)
    assert np.linalg.norm(places[0] - places[1]) == pytest.approx(distance)


def test_what_is_placed_turns_with_its_joints() -> None:
    """A joint's own axes, and what hangs on it, are turned alike."""
    stand = place_sides(talk(distance=2.0))[0]
    rotations, positions = stand.placed(np.tile([0.0, 0.0, 0.0, 1.0], (3, 2, 1)), np.ones((3, 2, 3)))
    assert rotations.shape == (3, 2, 4) and positions.shape == (3, 2, 3)
    assert positions[0, 0] == pytest.approx([0.0, 1.0, -1.0])
    assert rotations[0, 0] == pytest.approx([0, np.sqrt(0.5), 0, np.sqrt(0.5)])


def test_blinks_come_near_the_peaks_of_the_pitch_of_clauses(sample: Project) -> None:
    """By loudness 5 of 18 peaks had a blink within 0.15 s on the sample's conversation; of those that
    come a second after the last blink, 7 in 10 do.
    """
    conversation = next(iter(sample.conversations.values()))
    heard, _ = load_conversation_voices(conversation, SAMPLE)
    made = plan_duet(conversation, "v", (sample, sample), heard)
    near = total = 0
    for part, side in zip(made.parts, conversation.sides, strict=True):
        blinks = part.plan.life.blinks.starts
        peaks = [s.peak for s in side.segments if s.kind == "clause" and s.peak is not None]
        near += sum(bool((abs(blinks - p) <= 0.15).any()) for p in peaks)
        total += len(peaks)
    assert near >= 0.3 * total


def test_blinks_by_the_papers_rule_are_those_and_no_others(sample: Project) -> None:
    conversation = msgspec.structs.replace(next(iter(sample.conversations.values())), blinks="peaks")
    made = plan_duet(conversation, "v", (sample, sample), (None, None))
    for n, (part, side) in enumerate(zip(made.parts, conversation.sides, strict=True)):
        peaks = [s.peak for s in side.segments if s.peak is not None]
        expected = place_peak_blinks(peaks, conversation.length, conversation.seed, str(n))
        assert part.plan.life.blinks.starts.tolist() == pytest.approx(expected, abs=1e-9)


def three(**changes: object) -> Conversation:
    return msgspec.structs.replace(
        group(3, said(0, 1, 2), said(1, 2.5, 4), said(2, 5, 6), length=8.0),
        **changes,  # type: ignore[arg-type]
    )


@pytest.mark.parametrize("count", [3, 4, 8])
def test_several_stand_in_a_circle_as_far_from_their_neighbours_as_two_would(count: int) -> None:
    found = place_sides(group(count))
    places = np.array([(s.x, s.z) for s in found])
    near = np.linalg.norm(places - np.roll(places, 1, 0), axis=1)
    assert near == pytest.approx(1.3) and places.mean(0) == pytest.approx([0, 0], abs=1e-9)
    for stand in found:
        nose = np.array(stand.world((0.0, 1.0, 0.5)))[[0, 2]]
        assert np.linalg.norm(nose) == pytest.approx(np.hypot(stand.x, stand.z) - 0.5), "it faces the middle"
    assert found[0].x < 0 < found[-1].x and found[0].z == pytest.approx(found[-1].z), "open to the viewer"


def test_a_point_is_where_it_is_in_anybodys_space() -> None:
    here, there = place_sides(group(5))[1:3]
    point = (0.3, 1.5, -0.7)
    assert here.world(here.own(there.world(point))) == pytest.approx(there.world(point), abs=1e-5)


def test_who_has_a_place_stands_there_and_faces_the_others_and_the_viewer_amid_them() -> None:
    row = [msgspec.structs.replace(s, place=(float(n - 1), 0.0)) for n, s in enumerate(three().sides)]
    found = place_sides(three(sides=tuple(row)))
    assert [(s.x, s.z) for s in found] == [(-1, 0), (0, 0), (1, 0)]
    assert [s.turn for s in found] == pytest.approx([np.pi / 2, 0, -np.pi / 2])
    one = place_sides(three(sides=(*three().sides[:2], row[2])))
    assert (one[0].x, one[0].z) == pytest.approx((place_sides(three())[0].x, place_sides(three())[0].z))


def test_two_with_places_are_looked_at_there(sample: Project) -> None:
    sides = tuple(
        msgspec.structs.replace(s, place=p) for s, p in zip(talk().sides, ((0, 0), (0, 2)), strict=True)
    )
    made = plan_duet(msgspec.structs.replace(talk(), sides=sides), "v1", (sample, sample), (None, None))
    x, y, z = made.parts[0].plan.track.places[0].point
    assert x == pytest.approx(0, abs=0.02) and 1.5 < y < 1.8 and 1.7 < z < 2.0


def test_three_look_at_the_eyes_of_each_other(sample: Project) -> None:
    made = plan_duet(three(), "v1", (sample,) * 3, (None,) * 3)
    for n, part in enumerate(made.parts):
        points = find_partner_points(part.plan)
        assert sorted(points) == [m for m in range(3) if m != n]
        for m, point in points.items():
            seen = np.array(part.stand.world(point)) - np.array(
                [made.parts[m].stand.x, 0, made.parts[m].stand.z]
            )
            assert 1.5 < seen[1] < 1.8 and np.hypot(seen[0], seen[2]) < 0.15
        assert {look.to for look in part.plan.track.looks} <= {f"partner {m + 1}" for m in points}


def test_each_of_three_answers_the_hesitations_of_all_others_once(sample: Project) -> None:
    um = Segment("hesitation", 3.0, 3.4, None, "um")
    sides = list(three().sides)
    sides[1] = msgspec.structs.replace(sides[1], segments=(um,))
    sides[2] = msgspec.structs.replace(sides[2], segments=(msgspec.structs.replace(um, start=3.2, end=3.8),))
    heard = list_segments_heard_by(three(sides=tuple(sides)), 0)
    assert [(s.kind, s.start, s.end) for s in heard] == [
        ("clause", 1, 2),
        ("hesitation", 3.0, 3.4),
        ("hesitation", 3.4, 3.8),
    ]
    always = [msgspec.structs.replace(s, rates=Rates(hesitation=1.0)) for s in sides]
    made = plan_duet(three(sides=tuple(always)), "v1", (sample,) * 3, (None,) * 3)
    assert made.parts[0].told[2].drawn == 2 and made.parts[0].told[2].performed >= 1


def test_a_listener_mirrors_who_speaks_and_nobody_else(sample: Project) -> None:
    """Of three: the first speaks, the second moves meanwhile."""
    speaker = Side(name="Ann", segments=tuple(said(0, 2.0 + 8 * n, 8.0 + 8 * n)[1] for n in range(12)))
    sides = (speaker, Side(name="Ben"), Side(name="Cleo", rates=Rates(mirror=1.0)))
    talk = Conversation(name="t", length=100.0, sides=sides)
    moving = drive(talk, 0, sample)[1]
    still, own = Plan(1, 100.0), Mover(2, sample, Plan(1, 100.0))
    with_speaker = list(list_mirrored_stances(talk, own, [Mover(0, sample, moving), Mover(1, sample, still)]))
    with_other = list(list_mirrored_stances(talk, own, [Mover(0, sample, still), Mover(1, sample, moving)]))
    assert with_speaker and not with_other
