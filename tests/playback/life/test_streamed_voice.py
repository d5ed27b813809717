"""A voice heard as it comes in: the same however it is cut, never out of order, never ahead of its sound."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph.face.names import VISEMES
from metagraph.playback.life.streamed_voice import LEAST, StreamedVoice

RATE = 12000


def tones(seconds: float, *parts: tuple[float, float], rate: int = RATE) -> list[float]:
    """Return sines of (hertz, loudness)."""
    time = np.arange(round(seconds * rate)) / rate
    return sum((loud * np.sin(2 * np.pi * hertz * time) for hertz, loud in parts), 0 * time).tolist()


def said(samples: list[float], rate: int = RATE) -> list[str]:
    return [mark.viseme for mark in StreamedVoice(float(rate)).hear(samples)]


def test_silence_and_no_samples_move_no_mouth() -> None:
    assert said([]) == said([0.0] * RATE) == []
    assert said((1e-4 * np.random.default_rng(0).standard_normal(RATE)).tolist()) == [], "nor does a hum"


@pytest.mark.parametrize(
    ("parts", "shape"),
    [
        (((300.0, 0.1), (800.0, 0.5)), "aa"),
        (((300.0, 0.5), (800.0, 0.1), (2200.0, 0.2)), "I"),
        (((300.0, 0.5), (800.0, 0.1)), "U"),
        (((300.0, 0.3), (800.0, 0.22), (2200.0, 0.25)), "E"),
        (((300.0, 0.3), (800.0, 0.22)), "O"),
        (((4900.0, 0.3),), "SS"),
    ],
)
def test_what_sounds_is_the_shape_that_sounds_so(parts: tuple[tuple[float, float], ...], shape: str) -> None:
    assert said(tones(0.3, *parts)) == [shape]


def test_the_mouth_shuts_in_a_pause_and_opens_again() -> None:
    vowel = tones(0.2, (800.0, 0.5))
    marks = StreamedVoice(float(RATE)).hear([*vowel, *[0.0] * 3600, *vowel])
    assert [m.viseme for m in marks] == ["aa", "sil", "aa"]
    assert [m.at for m in marks] == pytest.approx([0.0, 0.2, 0.5], abs=0.02)


def test_softer_vowels_open_less_and_a_growing_one_is_told_again() -> None:
    loud, soft = tones(0.2, (800.0, 0.5)), tones(0.2, (800.0, 0.14))
    weights = [m.weight for m in StreamedVoice(float(RATE)).hear([*loud, *soft, *loud])]
    assert weights[0] == pytest.approx(1.0) and 0.35 < min(weights) < 0.7 and weights[-1] > 0.95


def test_a_click_is_no_shape() -> None:
    click = [0.0] * 2000
    click[1000] = 0.9
    assert said(click) == []


def test_at_low_rates_nothing_hisses_and_the_rest_is_heard() -> None:
    assert said(tones(0.3, (800.0, 0.5), rate=8000), 8000) == ["aa"]
    assert "SS" not in said(tones(0.3, (3900.0, 0.3), rate=8000), 8000)


@pytest.mark.nightly
@given(st.lists(st.integers(0, 900), max_size=12), st.integers(0, 2**32 - 1))
def test_however_it_is_cut_it_is_heard_alike_in_order_and_never_ahead(cuts: list[int], seed: int) -> None:
    rng = np.random.default_rng(seed)
    sound = np.repeat(rng.uniform(0, 0.6, 9), 400) * rng.uniform(-1, 1, 3600)
    whole = StreamedVoice(float(RATE)).hear(sound.tolist())
    voice, parts, at = StreamedVoice(float(RATE)), [], 0
    for cut in (*cuts, len(sound)):
        piece = voice.hear(sound[at : at + cut].tolist())
        at = min(at + cut, len(sound))
        assert all(-1e-9 <= mark.at <= at / RATE for mark in piece)
        parts += piece
    assert parts == whole
    assert all(a.at < b.at for a, b in pairwise(whole))
    assert all(mark.viseme in VISEMES and 0 <= mark.weight <= 1 for mark in whole)
    assert voice.seconds == pytest.approx(len(sound) / RATE)


def test_sound_that_came_too_late_goes_on_where_the_line_is() -> None:
    voice = StreamedVoice(float(RATE))
    voice.hear(tones(0.2, (800.0, 0.5)))
    voice.follow(0.3)
    assert voice.seconds == pytest.approx(0.2), "a little late is as it was"
    voice.follow(2.0)
    marks = voice.hear([*[0.0] * 1200, *tones(0.2, (300.0, 0.5))])
    assert [m.at for m in marks] == pytest.approx([2.0, 2.1], abs=0.02) and voice.seconds == pytest.approx(
        2.3
    )
    assert marks[1].at - marks[0].at >= LEAST
