"""Loudness, against tones of which the standard says how loud they are."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.generation.loudness import TARGET, compute_gain, measure_integrated_loudness


@pytest.mark.parametrize("rate", [16000, 44100, 48000])
def test_a_tone_of_1_khz_at_full_scale_is_minus_3_lufs(rate):
    t = np.arange(5 * rate) / rate
    assert measure_integrated_loudness(np.sin(2 * np.pi * 997 * t), rate) == pytest.approx(-3.01, abs=0.05)
    assert measure_integrated_loudness(0.1 * np.sin(2 * np.pi * 997 * t), rate) == pytest.approx(
        -23.01, abs=0.05
    )


def test_low_hum_counts_less_than_a_voice():
    t = np.arange(5 * 16000) / 16000
    hum, high = (measure_integrated_loudness(0.1 * np.sin(2 * np.pi * f * t), 16000) for f in (30, 3000))
    assert high - hum > 10
    assert high == pytest.approx(-23 + 3.3, abs=0.4)


def test_pauses_do_not_make_a_voice_softer():
    t = np.arange(20 * 16000) / 16000
    voice = 0.1 * np.sin(2 * np.pi * 500 * t)
    paused = np.where(t % 10 < 5, voice, 1e-4 * voice)
    assert measure_integrated_loudness(paused, 16000) == pytest.approx(
        measure_integrated_loudness(voice, 16000), abs=0.5
    )


def test_long_sounds_are_as_loud_as_their_pieces():
    chance = np.random.default_rng(1)
    noise = 0.1 * chance.standard_normal(95 * 16000)
    assert measure_integrated_loudness(noise, 16000) == pytest.approx(
        measure_integrated_loudness(noise[: 10 * 16000], 16000), abs=0.05
    )


def test_every_voice_is_brought_to_the_same_level():
    chance = np.random.default_rng(1)
    noise = chance.standard_normal(5 * 16000)
    for level in (0.9, 0.01, 1e-3):
        assert measure_integrated_loudness(
            level * noise * compute_gain(level * noise, 16000), 16000
        ) == pytest.approx(TARGET, abs=0.01)


def test_silence_and_less_than_a_block_are_no_trouble():
    assert measure_integrated_loudness(np.zeros(0), 16000) == -np.inf
    assert measure_integrated_loudness(np.zeros(16000), 16000) == -np.inf
    assert compute_gain(np.zeros(16000), 16000) == 1
    assert np.isfinite(measure_integrated_loudness(np.full(100, 0.5) * (-1.0) ** np.arange(100), 16000))
    assert compute_gain(1e-5 * np.sin(np.arange(16000)), 16000) == 1  # below the gate: not raised to a roar
