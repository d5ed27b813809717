"""What is heard, whole and as it comes in."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.generation.features import (
    FLOOR,
    HESITATION,
    HOP,
    KNOWN,
    MARKS,
    MELS,
    OWN_STRESS,
    PARTNER_STRESS,
    PITCH,
    RATE,
    RESPONSE,
    STRANGEST,
    AudioStream,
    FeatureError,
    FeatureStream,
    as_heard,
    compute_conversation_activity,
    compute_conversation_marks,
    compute_features,
    count_sound_frames,
    detect_voice_activity,
    encode_activity,
    find_speaking,
    make_silence,
    tell_by_sound,
    tell_conversation,
    with_edges,
)
from metagraph.generation.features import (
    TOLD as ALL_TOLD,
)
from metagraph.generation.poses import Standardisation
from metagraph.graph.conversation.model import Conversation, Segment, Side
from tests.generation.makers import babble

SOUND = np.stack([babble(1.3, 1), babble(1.3, 2)])
TOLD = encode_activity(np.arange(60) % 7 < 3, np.arange(60) % 5 < 2)


@settings(max_examples=60)
@given(
    cuts=st.lists(st.integers(0, SOUND.shape[1]), max_size=12),
    told=st.lists(st.integers(0, 33), max_size=6),
    length=st.integers(0, SOUND.shape[1]),
    tracks=st.sampled_from([1, 2]),
)
def test_in_pieces_features_are_the_same_to_the_bit(cuts, told, length, tracks):
    sound = SOUND[:, :length]
    activity = TOLD[: count_sound_frames(length)]
    whole = compute_features(sound, activity, tracks, gains=(0.7, 1.9))
    stream = FeatureStream(2, tracks, (0.7, 1.9))
    edges = [0, *sorted(min(c, length) for c in cuts), length]
    steps = [0, *sorted(min(c, len(activity)) for c in told), len(activity)]
    parts = []
    for n in range(max(len(edges), len(steps)) - 1):
        piece = sound[:, edges[n] : edges[n + 1]] if n + 1 < len(edges) else sound[:, :0]
        said = activity[steps[n] : steps[n + 1]] if n + 1 < len(steps) else activity[:0]
        parts.append(stream.push(piece, said))
    parts.append(stream.finish())
    out = np.concatenate(parts)
    assert out.tobytes() == whole.tobytes()
    assert out.shape == (count_sound_frames(length), 27 * tracks + PITCH + MARKS + 4)


def test_sample_by_sample_is_the_whole():
    sound = SOUND[:, :1700]
    stream = AudioStream()
    parts = [stream.push(sound[:, n : n + 1]) for n in range(1700)]
    assert (
        np.concatenate([*parts, stream.finish()]).tobytes()
        == compute_features(sound, TOLD[:3], gains=(1, 1))[:, : 27 + PITCH].tobytes()
    )


def test_a_frame_is_ready_as_soon_as_its_window_is_heard():
    stream = AudioStream(1)
    assert len(stream.push(np.zeros(511))) == 0
    assert len(stream.push(np.zeros(1))) == 1
    assert len(stream.push(np.zeros(HOP - 1))) == 0
    assert len(stream.push(np.zeros(1))) == 1


def test_silence_is_the_floor_and_no_sound_has_no_frames():
    quiet = compute_features(np.zeros((1, 2000)), encode_activity(np.zeros(4, bool), np.zeros(4, bool)))
    assert quiet.tobytes() == np.tile(make_silence(), (4, 1)).tobytes()
    assert quiet[0, 0] == np.float32(np.log(FLOOR))
    assert compute_features(np.zeros((2, 0)), np.zeros((0, 4))).shape == (0, 38)
    assert with_edges(quiet, 5, 25).shape == (34, 38)


def test_a_tone_is_loudest_in_its_own_mel():
    t = np.arange(RATE) / RATE
    loudest = [
        int(compute_features(np.sin(2 * np.pi * f * t), TOLD[:26])[12, :MELS].argmax())
        for f in (200, 1000, 5000)
    ]
    assert loudest == sorted(set(loudest))
    assert loudest[0] < 5
    assert loudest[2] > 20


def test_a_click_is_heard_in_the_frame_at_its_time():
    sound = np.zeros(RATE)
    sound[10 * HOP] = 1
    mels = compute_features(sound, TOLD[:26], gains=(1,))[:, :MELS].mean(1)
    assert mels.argmax() == 10
    assert mels[9] < mels[10] > mels[11]


def test_both_voices_are_as_loud_whatever_their_microphones():
    soft = compute_features(SOUND * [[0.05], [1.0]], TOLD[:33], tracks=2)
    loud = compute_features(SOUND, TOLD[:33], tracks=2)
    assert np.abs(soft[:, :54] - loud[:, :54]).max() < 0.02


def test_what_cannot_be_heard_is_told():
    stream = FeatureStream(2)
    with pytest.raises(FeatureError, match="has 1 channels, expected 2"):
        stream.push(np.zeros(5), np.zeros((0, 4)))
    with pytest.raises(FeatureError, match="not a number"):
        stream.push(np.full((2, 5), np.nan), np.zeros((0, 4)))
    with pytest.raises(FeatureError, match="one 1 and three 0"):
        stream.push(np.zeros((2, 0)), np.ones((1, 4)))
    stream.finish()
    with pytest.raises(FeatureError, match="ended already"):
        stream.push(np.zeros((2, 5)), np.zeros((0, 4)))
    with pytest.raises(FeatureError, match="two channels"):
        AudioStream(1, 2)
    with pytest.raises(FeatureError, match="as many gains"):
        AudioStream(2, 1, (1.0,))


def test_short_gaps_in_speech_are_none():
    own = find_speaking([(1.0, 2.0), (2.19, 2.5), (2.75, 3.0)], 100)
    assert own[25:63].all()
    assert not own[63:69].any()
    assert own[69:75].all()
    assert not own[:25].any()
    assert not own[75:].any()
    assert not find_speaking([], 5).any()


def test_a_long_stretch_is_not_forgotten_for_a_short_one_inside():
    assert find_speaking([(0.0, 4.0), (1.0, 1.1), (4.1, 5.0)], 130)[:125].all()


def test_who_speaks_is_one_of_four():
    told = Side(segments=(Segment("clause", 0.0, 1.0), Segment("hesitation", 1.5, 2.0)))
    other = Side(segments=(Segment("response", 0.8, 1.2),))
    talk = Conversation(name="t", length=3, sides=(told, other))
    first, second = (compute_conversation_activity(talk, side, 75) for side in (0, 1))
    assert (first.sum(1) == 1).all()
    assert [int(first[n].argmax()) for n in (0, 22, 27, 34, 40, 60)] == [0, 2, 1, 3, 0, 3]
    assert (second[:, [1, 0, 2, 3]] == first).all()


def test_of_three_whoever_else_speaks_is_the_partner():
    sides = [Side(segments=(Segment("clause", n, n + 1.5),)) for n in (0.0, 1.0, 3.0)]
    talk = Conversation(name="t", length=6, sides=tuple(sides))
    first = compute_conversation_activity(talk, 0, 150)
    assert [int(first[n].argmax()) for n in (0, 30, 40, 70, 80, 130)] == [0, 2, 1, 3, 1, 3]


def test_marks_are_the_stresses_of_both_own_responses_and_the_partners_hesitations():
    told = Side(segments=(Segment("clause", 0.0, 1.0, 0.4), Segment("response", 2.0, 2.4)))
    other = Side(segments=(Segment("clause", 1.2, 1.9, 1.6), Segment("hesitation", 2.6, 2.9)))
    talk = Conversation(name="t", length=4, sides=(told, other))
    first, second = (compute_conversation_marks(talk, side, 100) for side in (0, 1))
    assert first.shape == (100, MARKS) and (first[:, KNOWN] == 1).all()
    assert first[:, OWN_STRESS].argmax() == 10 and first[10, OWN_STRESS] == 1
    assert np.flatnonzero(first[:, OWN_STRESS]).tolist() == list(range(7, 14))
    assert first[:, PARTNER_STRESS].argmax() == 40
    assert np.flatnonzero(first[:, RESPONSE]).tolist() == list(range(50, 60))
    assert np.flatnonzero(first[:, HESITATION]).tolist() == list(range(65, 73))
    assert (second[:, OWN_STRESS] == first[:, PARTNER_STRESS]).all()
    assert not second[:, RESPONSE].any() and not second[:, HESITATION].any()
    both = tell_conversation(talk, 0, 100)
    assert (both == np.concatenate([first, compute_conversation_activity(talk, 0, 100)], 1)).all()


def test_marks_reach_the_features_and_without_them_they_are_not_known():
    told = tell_conversation(Conversation(name="t", length=2, sides=(Side(), Side())), 0, 33)
    told[12, OWN_STRESS] = 1
    heard = compute_features(SOUND, told)
    assert (heard[:33, -ALL_TOLD:] == told).all()
    assert not compute_features(SOUND, told[:, -4:])[:, -ALL_TOLD:-4].any()
    told[12, OWN_STRESS] = 1.5
    with pytest.raises(FeatureError, match="from 0 to 1"):
        FeatureStream(2).push(SOUND[:, :0], told)


def test_pitch_is_told_relative_to_what_the_speaker_usually_has():
    t = np.arange(4 * RATE) / RATE
    for usual in (90.0, 220.0):
        hertz = np.where((t > 2.0) & (t < 2.5), usual * 2 ** (4 / 12), usual)  # four semitones higher
        voice = sum(np.sin(2 * np.pi * k * np.cumsum(hertz) / RATE) / k for k in range(1, 9))
        heard = compute_features(0.1 * voice, np.zeros((0, 4)))[:, MELS : MELS + PITCH]
        assert heard[2:98, 0].mean() > 0.95
        assert np.abs(heard[5:48, 1]).max() < 0.2
        assert 4 / 3 - 0.3 < heard[52:61, 1].mean() < 4 / 3 + 0.1
    noise = np.random.default_rng(1).standard_normal(2 * RATE)
    assert compute_features(0.1 * noise, np.zeros((0, 4)))[:, MELS].mean() < 0.1


def test_of_two_channels_the_louder_ones_pitch_is_told():
    t = np.arange(2 * RATE) / RATE
    voices = [sum(np.sin(2 * np.pi * k * f * t) / k for k in range(1, 9)) for f in (100.0, 230.0)]
    turns = np.stack([voices[0] * (t < 1), voices[1] * (t >= 1)])
    heard = compute_features(0.1 * turns, np.zeros((0, 4)))[:, MELS : MELS + PITCH]
    assert heard[2:48, 0].all() and np.abs(heard[2:24, 1]).max() < 0.3 and np.abs(heard[28:48, 1]).max() < 0.3


def test_by_the_sound_alone_stresses_are_found_where_somebody_speaks():
    sound = babble(8, 3)
    told = tell_by_sound(sound, None, RATE, 200)
    speaking = told[:, MARKS] == 1  # only the first can
    stressed = told[:, OWN_STRESS] == told[:, OWN_STRESS].max()
    assert told.shape == (200, ALL_TOLD) and told[:, KNOWN].all()
    assert stressed.any() and speaking[stressed].mean() > 0.9
    assert not told[:, PARTNER_STRESS].any()


def test_without_words_loudness_tells_who_speaks():
    own, other = babble(8, 3), babble(8, 4)
    own[: 4 * RATE] *= 1e-3
    other[4 * RATE :] *= 1e-3
    told = detect_voice_activity(own, other, RATE, 200)
    assert told[:100, 0].mean() < 0.05 < 0.2 < told[100:, 0].mean()
    assert told[100:, 1].mean() < 0.05 < 0.2 < told[:100, 1].mean()
    alone = detect_voice_activity(own, None, RATE, 200)
    assert not alone[:, 1].any()
    assert not alone[:, 2].any()


def test_sounds_that_were_never_learned_from_are_heard_as_strange_and_not_as_nonsense() -> None:
    scale = Standardisation(np.zeros(3, np.float32), np.full(3, 0.5, np.float32))
    rows = np.array([[0.5, 100.0, -100.0, 1.0, 0.0, 9.0, 0.0]], np.float32)
    heard = as_heard(rows, scale)
    assert heard.dtype == np.float32
    assert heard.tolist() == [[1.0, STRANGEST, -STRANGEST, 1.0, 0.0, 9.0, 0.0]]
