"""The mouth at any time: the voice of what is said, then silence."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.graphemes import spelled
from metagraph.playback.life.lips import CLOSING, compute_mouth_shapes
from metagraph.playback.life.track import Speech, Track, track_of
from metagraph.playback.life.voice import Voice, choose_voice, guess_voice

TEXT = "Papa may have many memories."


def spoken(*speeches: Speech) -> Track:
    return track_of(speeches)


def open_mouth(seconds: float) -> Voice:
    weights = np.zeros((2, 15), np.float32)
    weights[:, 10] = 1
    return Voice(seconds, np.zeros(0), np.array([0.0, seconds]), weights)


def test_nobody_who_is_silent_moves_the_mouth() -> None:
    times = np.linspace(0, 5, 20)
    assert compute_mouth_shapes(Track(), {}, 0.03, times) is None
    assert compute_mouth_shapes(spoken(Speech("s", 10, 12, text=TEXT)), {}, 0.03, times) is None
    assert compute_mouth_shapes(spoken(Speech("s", 1, 2, text=TEXT)), {}, 0.03, np.zeros(0)) is None


def test_a_line_is_said_with_its_own_voice_and_text_with_its_letters() -> None:
    voice = open_mouth(2.0)
    assert choose_voice({"a": voice}, Speech("s", 0, 2, "a", TEXT)) is voice
    assert choose_voice({}, Speech("s", 0, 2, "a", TEXT)) is guess_voice(TEXT, 2.0)
    assert choose_voice({"a": voice}, Speech("s", 0, 2, None, TEXT)) is guess_voice(TEXT, 2.0)


def test_without_smoothing_the_mouth_shows_the_voice_as_it_is() -> None:
    voice = guess_voice(TEXT, 3.0)
    times = np.linspace(1.0, 4.0, 61)
    shown = compute_mouth_shapes(spoken(Speech("s", 1.0, 4.0, text=TEXT)), {}, 0.0, times)
    assert shown is not None
    want = np.stack([np.interp(times - 1.0, voice.times, voice.weights[:, k]) for k in range(1, 15)], 1)
    assert np.allclose(shown, want, atol=1e-6)


def test_smoothing_makes_the_mouth_slower_not_later() -> None:
    times = np.arange(0.5, 4.5, 1 / 100)
    track = spoken(Speech("s", 1.0, 4.0, text="Nelly and her sister listened to a tall story."))
    sharp, soft = (compute_mouth_shapes(track, {}, s, times) for s in (0.0, 0.08))
    assert sharp is not None and soft is not None
    assert np.abs(np.diff(soft, axis=0)).max() < 0.7 * np.abs(np.diff(sharp, axis=0)).max()
    centre = [float((m.sum(1) * times).sum() / m.sum()) for m in (sharp, soft)]
    assert centre[0] == pytest.approx(centre[1], abs=0.01)


@pytest.mark.parametrize("smoothing", [0.0, 0.03, 0.1, 0.2])
def test_smoothing_never_parts_lips_that_meet(smoothing: float) -> None:
    length = len(TEXT) / 18  # quick
    found = spelled(ALPHABET, TEXT, length)
    track = spoken(Speech("s", 1.0, 1.0 + length, text=TEXT, length=length))
    shut = [piece for piece in found.pieces if piece.viseme == "PP"]
    assert len(shut) == 6
    shown = compute_mouth_shapes(
        track, {}, smoothing, np.array([1.0 + 0.5 * (p.start + p.end) for p in shut])
    )
    assert shown is not None and shown[:, 0].min() > 0.95
    assert shown[:, 1:].sum(1).max() < 0.05


def test_speech_that_is_cut_shuts_the_mouth_at_once_but_not_in_one_frame() -> None:
    track = spoken(Speech("s", 1.0, 9.0, "a"), Speech("t", 2.0, 2.0001, None, ""))
    times = np.arange(1.9, 2.4, 1 / 120)
    shown = compute_mouth_shapes(track, {"a": open_mouth(8.0)}, 0.0, times)
    assert shown is not None
    opened = shown.sum(1)
    assert opened[0] == pytest.approx(1) and (opened[times > 2.0 + CLOSING] == 0).all()
    assert np.abs(np.diff(opened)).max() < 0.2


def test_what_was_cut_off_is_not_mouthed() -> None:
    voice = open_mouth(8.0)
    voice.weights[0] = np.eye(15)[0]
    late = Voice(8.0, voice.peaks, np.array([1.9, 2.0]), voice.weights)  # opens at 2 s, where it is cut
    shown = compute_mouth_shapes(
        spoken(Speech("s", 0.0, 1.9, "a", length=8.0)), {"a": late}, 0.0, np.arange(1.9, 2.1, 0.01)
    )
    assert shown is not None and shown.max() < 1e-9


def test_a_cut_speech_was_as_quick_before_the_cut() -> None:
    whole = spoken(Speech("s", 0.0, 4.0, text=TEXT))
    cut = whole.without({"s"}, 2.0)
    times = np.linspace(0.1, 1.9, 50)
    assert np.array_equal(
        compute_mouth_shapes(whole, {}, 0.0, times), compute_mouth_shapes(cut, {}, 0.0, times)
    )  # type: ignore[arg-type]


def test_two_speeches_that_meet_share_one_mouth() -> None:
    track = spoken(Speech("s", 0.0, 5.0, "a"), Speech("t", 2.0, 6.0, "a"))
    shown = compute_mouth_shapes(track, {"a": open_mouth(5.0)}, 0.03, np.linspace(1.5, 3, 200))
    assert shown is not None and shown.sum(1).max() <= 1 + 1e-6


def test_a_time_alone_gives_what_it_gives_among_others() -> None:
    track = spoken(Speech("s", 0.5, 3.0, text=TEXT), Speech("t", 3.2, 5.0, text="And so on."))
    times = np.random.default_rng(0).uniform(0, 6, 300)
    whole = compute_mouth_shapes(track, {}, 0.03, times)
    assert whole is not None
    for n, time in enumerate(times):
        one = compute_mouth_shapes(track, {}, 0.03, np.array([time]))
        assert np.array_equal(whole[n], one[0] if one is not None else np.zeros(14))
