"""F0: known tones, noise and silence, and a synthesised voice whose octave must be right."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.speech.pitch import Pitch, find_pitch_peaks, measure_pitch, smooth
from tests.speech import talk


def voice(hertz: object, rate: int = 16000) -> object:
    """A buzz with harmonics that fall off, as a voice's do. hertz: F0 of each sample."""
    phase = 2 * np.pi * np.cumsum(np.asarray(hertz, float)) / rate
    return 0.2 * sum(np.sin(k * phase) / k for k in range(1, 9))


@pytest.mark.parametrize("rate", [8000, 22050, 44100, 48000])
@pytest.mark.parametrize("hertz", [75.0, 120.0, 220.0, 380.0])
def test_a_steady_voice_has_its_own_pitch_at_any_rate(hertz: float, rate: int) -> None:
    found = measure_pitch(voice(np.full(rate, hertz), rate), rate)
    known = found.hertz[~np.isnan(found.hertz)]
    assert len(known) > 0.9 * len(found.hertz) and np.abs(12 * np.log2(known / hertz)).max() < 0.2


def test_times_are_those_of_loudness() -> None:
    from metagraph.speech.sound import analyse_sound

    samples = voice(np.full(12345, 150.0))
    assert np.array_equal(
        measure_pitch(samples, 16000).times, analyse_sound(np.asarray(samples), 16000).times
    )


@pytest.mark.parametrize(
    "samples",
    [np.zeros(0), np.zeros(3), np.zeros(16000), 0.1 * np.random.default_rng(1).standard_normal(48000)],
)
def test_silence_and_noise_have_none(samples: object) -> None:
    found = measure_pitch(np.asarray(samples), 16000)
    assert np.isnan(found.hertz).all() and not find_pitch_peaks(found, 0, 10)


def test_pauses_between_voice_have_none() -> None:
    samples = np.concatenate([voice(np.full(8000, 150.0)), np.zeros(8000), voice(np.full(8000, 170.0))])
    found = measure_pitch(samples, 16000)
    assert np.isnan(found.hertz[55:95]).all()
    assert np.nanmedian(found.hertz[:45]) == pytest.approx(150, rel=0.01) and np.nanmedian(
        found.hertz[105:]
    ) == pytest.approx(170, rel=0.01)


def test_a_voice_over_several_blocks_is_found_the_same() -> None:
    hertz = 150 + 30 * np.sin(np.linspace(0, 60, 16000 * 40))
    found = measure_pitch(voice(hertz), 16000)
    known = ~np.isnan(found.hertz)
    right = hertz[np.minimum((found.times * 16000).astype(int), len(hertz) - 1)]
    assert known.mean() > 0.98 and np.abs(found.hertz[known] / right[known] - 1).max() < 0.03


def test_the_most_prominent_peak_comes_first() -> None:
    at = np.linspace(0, 2, 32000)
    hertz = 120 + 20 * np.exp(-(((at - 0.5) / 0.1) ** 2)) + 50 * np.exp(-(((at - 1.4) / 0.1) ** 2))
    found = measure_pitch(voice(hertz), 16000)
    assert find_pitch_peaks(found, 0, 2)[:2] == (pytest.approx(1.4, abs=0.03), pytest.approx(0.5, abs=0.03))
    assert find_pitch_peaks(found, 0, 1) == (pytest.approx(0.5, abs=0.03),)
    assert find_pitch_peaks(found, 5, 6) == () and find_pitch_peaks(found, 1, 0.5) == ()


def test_a_pitch_that_only_falls_peaks_where_it_is_highest() -> None:
    found = measure_pitch(voice(np.linspace(200, 100, 32000)), 16000)
    assert find_pitch_peaks(found, 0.5, 1.5)[0] == pytest.approx(0.5, abs=0.02)


def test_smoothing_bridges_short_voiceless_moments_and_no_pauses() -> None:
    hertz = np.full(100, 100.0)
    hertz[20:24], hertz[50:70] = np.nan, np.nan
    tones = smooth(Pitch(np.arange(100) * 0.01, hertz))
    assert (
        not np.isnan(tones[:50]).any()
        and np.isnan(tones[50:70]).all()
        and tones[10] == pytest.approx(12 * np.log2(100))
    )


def test_no_octave_is_mistaken_in_a_spoken_voice() -> None:
    """Against plain autocorrelation within an octave either side: where both find a voice they agree."""
    spoken = talk.speak()
    for samples in spoken.samples:
        found = measure_pitch(samples, spoken.rate)
        middle = float(np.nanmedian(found.hertz))
        known = np.flatnonzero(~np.isnan(found.hertz))
        apart = []
        for n in known[::3]:
            start = int(found.times[n] * spoken.rate) - 512
            frame = (
                samples[max(start, 0) : start + 1024]
                * np.hanning(1024)[: len(samples[max(start, 0) : start + 1024])]
            )
            alike = np.correlate(frame, frame, "full")[len(frame) - 1 :] / np.correlate(
                np.hanning(len(frame)), np.hanning(len(frame)), "full"
            )[len(frame) - 1 :].clip(1e-3)
            first, last = int(spoken.rate / (1.9 * middle)), int(spoken.rate / (0.55 * middle))
            apart.append(
                abs(12 * np.log2(found.hertz[n] / (spoken.rate / (first + int(alike[first:last].argmax())))))
            )
        assert np.mean(np.array(apart) < 1.0) > 0.9
