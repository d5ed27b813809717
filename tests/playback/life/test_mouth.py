"""The mouth over time: neither popping nor mumbling."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph.face.names import VISEMES
from metagraph.playback.life.mouth import MouthPiece
from metagraph.playback.life.voice import Voice, guess_voice, make_silent_voice, make_voice

PLACE = {name: n for n, name in enumerate(VISEMES)}


def mouth_track(pieces: Sequence[MouthPiece], duration: float) -> tuple[Any, Any]:
    """Return the times and the weights of a voice that says these pieces."""
    voice = make_voice(pieces, duration, np.zeros(0), np.zeros(0))
    return voice.times, voice.weights


def said(*words: tuple[str, float], start: float = 0.2) -> tuple[list[MouthPiece], float]:
    """Pieces one after the other, and a length with room behind."""
    out, at = [], start
    for viseme, length in words:
        out.append(MouthPiece(at, at + length, viseme))
        at += length
    return out, at + 0.2


def test_nothing_said_is_a_shut_mouth() -> None:
    times, weights = mouth_track([], 1.0)
    assert (weights[:, 0] == 1).all() and times[0] == 0 and times[-1] == 1.0


@pytest.mark.parametrize("duration", [0.0, 1e-4, 0.01])
def test_a_line_of_hardly_any_length_has_two_ends(duration: float) -> None:
    times, weights = mouth_track([MouthPiece(0, duration, "aa")], duration)
    assert len(times) >= 2 and times[1] > times[0] and np.isfinite(weights).all()


def test_a_vowel_that_lasts_is_made_in_full() -> None:
    pieces, length = said(("kk", 0.06), ("aa", 0.14), ("DD", 0.06))
    _, weights = mouth_track(pieces, length)
    assert weights[:, PLACE["aa"]].max() > 0.8


@pytest.mark.parametrize("lips", ["PP", "FF"])
def test_lips_meet_between_vowels_however_quick_they_are(lips: str) -> None:
    pieces, length = said(("aa", 0.12), (lips, 0.05), ("aa", 0.12))
    times, weights = mouth_track(pieces, length)
    here = (times > pieces[1].start - 0.02) & (times < pieces[1].end + 0.02)
    assert weights[here, PLACE[lips]].max() > 0.99
    assert weights[here, PLACE["aa"]].min() < 0.01


def test_of_two_closures_in_a_row_each_has_its_moment() -> None:
    pieces, length = said(("aa", 0.1), ("PP", 0.05), ("FF", 0.05), ("aa", 0.1))
    times, weights = mouth_track(pieces, length)
    for piece in pieces[1:3]:
        middle = np.abs(times - (piece.start + piece.end) / 2).argmin()
        assert weights[middle, PLACE[piece.viseme]] > 0.95
    assert weights[(times > pieces[1].start) & (times < pieces[2].end), PLACE["aa"]].max() < 0.1


def test_lips_round_through_the_consonants_before_a_rounded_vowel() -> None:
    def rounded(vowel: str) -> float:
        pieces, length = said(("E", 0.1), ("SS", 0.06), ("DD", 0.06), (vowel, 0.12))
        times, weights = mouth_track(pieces, length)
        return float(weights[np.abs(times - pieces[1].end).argmin(), PLACE[vowel]])

    assert rounded("U") > 0.2 and rounded("O") > 0.2
    assert rounded("aa") < 0.1
    pieces, length = said(("E", 0.1), ("DD", 0.05))
    pieces.append(MouthPiece(pieces[-1].end + 0.3, pieces[-1].end + 0.5, "U"))
    times, weights = mouth_track(pieces, length + 0.5)
    assert weights[times < pieces[-1].start - 0.09, PLACE["U"]].max() == 0, "not through a pause"


def test_no_shape_pops_up_in_a_frame() -> None:
    pieces, length = said(*((v, 0.055) for v in ("PP", "aa", "DD", "I", "SS", "O", "FF", "U", "kk", "E") * 3))
    times, weights = mouth_track(pieces, length)
    speed = np.abs(np.diff(weights, axis=0)).max() / (times[1] - times[0])
    assert speed < 22, "from nothing to all takes three frames of 60 at least"


def test_a_shape_begins_before_its_sound() -> None:
    times, weights = mouth_track([MouthPiece(0.5, 0.7, "O")], 1.2)
    begins = times[np.flatnonzero(weights[:, PLACE["O"]] > 0.02)[0]]
    assert 0.4 < begins < 0.5


def test_a_weak_vowel_opens_less() -> None:
    full, weak = (
        mouth_track([MouthPiece(0.2, 0.4, "aa", s)], 0.6)[1][:, PLACE["aa"]].max() for s in (1.0, 0.5)
    )
    assert 0.35 * full < weak < 0.65 * full


pieces = st.lists(
    st.builds(
        lambda start, length, viseme, strength: MouthPiece(start, start + length, viseme, strength),
        st.floats(-0.5, 4), st.floats(0, 1), st.sampled_from(VISEMES[1:]), st.floats(0, 1),
    ),
    max_size=20,
)  # fmt: skip


@given(pieces, st.floats(0, 5))
def test_shapes_always_share_the_mouth(some: list[MouthPiece], duration: float) -> None:
    times, weights = mouth_track(some, duration)
    assert weights.shape == (len(times), len(VISEMES)) and (weights >= 0).all()
    assert np.allclose(weights.sum(1), 1, atol=1e-5)
    assert weights[0, 0] == weights[-1, 0] == 1, "shut at both ends"
    assert (np.diff(times) > 0).all()


# --- voices


def test_silence_has_no_peaks_and_no_accents() -> None:
    quiet = make_silent_voice(2.0)
    assert quiet.duration == 2.0 and len(quiet.peaks) == len(quiet.accents) == 0


def test_accents_are_the_first_syllable_and_the_loudest_well_apart() -> None:
    peaks = np.arange(0.1, 12.0, 0.25)
    strengths = np.full(len(peaks), 0.3)
    strengths[[10, 11, 30]] = (0.8, 0.9, 1.0)
    voice = Voice(12.0, peaks, np.array([0, 12.0]), np.zeros((2, 15)), strengths)
    assert voice.accents[0] == peaks[0] and peaks[11] in voice.accents and peaks[30] in voice.accents
    assert peaks[10] not in voice.accents and np.diff(voice.accents).min() >= 1.9


def test_a_voice_that_does_not_say_how_loud_it_is_still_has_accents() -> None:
    voice = Voice(6.0, np.arange(0.1, 6.0, 0.2), np.array([0, 6.0]), np.zeros((2, 15)))
    assert 2 <= len(voice.accents) <= 4 and voice.accents[0] == 0.1


def test_text_is_read_once() -> None:
    assert guess_voice("once") is guess_voice("once") and guess_voice("").peaks.size == 0
