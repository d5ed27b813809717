"""Loudness: the standard's own answers, gates, and sounds brought to one level."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.speech.loudness import level_sounds, measure_loudness


def tone(seconds: float, level: float = 1.0, rate: int = 48000, pitch: float = 997.0) -> np.ndarray:
    return (level * np.sin(2 * np.pi * pitch * np.arange(round(seconds * rate)) / rate)).astype(np.float32)


@pytest.mark.parametrize("rate", [22050, 44100, 48000, 96000])
def test_a_full_tone_of_one_channel_has_the_loudness_the_standard_says(rate: int) -> None:
    assert measure_loudness(tone(3, rate=rate), rate) == pytest.approx(-3.01, abs=0.03)
    assert measure_loudness(tone(3, 0.1, rate), rate) == pytest.approx(-23.01, abs=0.03)


def test_low_tones_are_heard_less_and_high_ones_more() -> None:
    low, high = measure_loudness(tone(3, pitch=40), 48000), measure_loudness(tone(3, pitch=6000), 48000)
    assert low is not None and high is not None and low < -7 and 0 < high < 1.2


def test_silence_and_sounds_shorter_than_a_block_have_none() -> None:
    for samples in (np.zeros(0), np.zeros(96000), tone(0.3), 1e-6 * tone(2)):
        assert measure_loudness(samples, 48000) is None


def test_pauses_do_not_make_speech_less_loud() -> None:
    paused = np.concatenate([tone(2), np.zeros(48000 * 6, np.float32), tone(2)])
    assert measure_loudness(paused, 48000) == pytest.approx(-3.01, abs=0.4)


def test_sounds_become_as_loud_as_each_other_and_silence_stays() -> None:
    made = level_sounds({"a": tone(2, 0.02), "b": tone(2, 0.5), "c": np.zeros(96000, np.float32)}, 48000, -23)
    assert measure_loudness(made["a"], 48000) == pytest.approx(-23, abs=0.01)
    assert measure_loudness(made["b"], 48000) == pytest.approx(-23, abs=0.01) and not made["c"].any()


def test_where_one_would_be_cut_all_are_less_loud() -> None:
    clicks = np.zeros(96000, np.float32)
    clicks[::4800] = 1
    made = level_sounds({"clicks": clicks, "tone": tone(2, 0.1)}, 48000, -10)
    assert max(float(np.abs(s).max()) for s in made.values()) == pytest.approx(0.95, abs=1e-3)
    assert measure_loudness(made["clicks"], 48000) == pytest.approx(
        measure_loudness(made["tone"], 48000), abs=0.01
    )
