"""How aroused a voice is beside how its speaker usually speaks."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from metagraph.graph import requests as a
from metagraph.graph.model import Project
from metagraph.speech.voice_mood import MOST, VoiceFeatures, measure_arousals, measure_voice, with_voice_moods
from tests.wavs import wav

RATE = 16000


def said(gain: float, a_second: float, wide: float) -> np.ndarray:
    """Return two seconds of a voice of syllables: how loud, how many a second, and semitones its pitch
    goes.
    """
    t = np.arange(2 * RATE) / RATE
    tones = wide / 2 * np.sin(2 * np.pi * 0.7 * t)
    phase = 2 * np.pi * np.cumsum(120 * 2 ** (tones / 12)) / RATE
    voice = sum(np.sin(n * phase) / n for n in range(1, 12))
    return np.asarray(gain * voice * np.clip(np.sin(np.pi * a_second * t) ** 2 * 1.3, 0, 1), np.float32)


def test_silence_and_moments_tell_nothing() -> None:
    for samples in (np.zeros(RATE, np.float32), np.ones(100, np.float32), np.zeros(0, np.float32)):
        found = measure_voice(samples, RATE)
        assert np.isnan([found.loudness, found.rate, found.range]).all()
    nan = float("nan")
    assert measure_arousals([VoiceFeatures(nan, nan, nan)] * 4) == [0.0] * 4 and measure_arousals([]) == []


def test_of_two_lines_nothing_is_told() -> None:
    assert measure_arousals([VoiceFeatures(-20, 4, 5), VoiceFeatures(-10, 6, 9)]) == [0.0, 0.0]


def test_louder_faster_and_wider_than_usual_is_more_aroused_and_never_extreme() -> None:
    usual = [VoiceFeatures(-23, 4.0, 5.0)] * 4
    for more in (VoiceFeatures(-17, 4.0, 5.0), VoiceFeatures(-23, 5.0, 5.0), VoiceFeatures(-23, 4.0, 9.0)):
        found = measure_arousals([*usual, more])
        assert found[:4] == [0.0] * 4 and 0 < found[4] < MOST
    assert measure_arousals([*usual, VoiceFeatures(0, 40, 60)])[4] == pytest.approx(MOST)
    assert measure_arousals([*usual, VoiceFeatures(-60, 0.1, 0)])[4] == pytest.approx(-MOST, abs=0.15)


def test_what_is_heard_is_how_it_was_said() -> None:
    calm, loud = measure_voice(said(0.05, 3, 3), RATE), measure_voice(said(0.4, 5, 10), RATE)
    assert loud.loudness > calm.loudness + 10 and loud.rate > calm.rate + 1 and loud.range > calm.range + 3
    assert calm.rate == pytest.approx(3, abs=0.4) and calm.range == pytest.approx(3, abs=1.0)


def test_lines_that_say_nothing_of_their_mood_get_their_voices(tmp_path: Path) -> None:
    for n, (gain, a_second) in enumerate([(0.1, 3), (0.1, 3), (0.1, 3), (0.6, 5)]):
        samples = (said(gain, a_second, 4) * 8000).astype("<i2")
        wav(tmp_path / f"{n}.wav", RATE, samples.tobytes())
    lines = {str(n): a.Line(text="Yes.", audio=f"{n}.wav") for n in range(4)}
    lines |= {
        "told": a.Line(audio="3.wav", mood="sad"),
        "gone": a.Line(audio="9.wav"),
        "bare": a.Line(text="No."),
    }
    project = with_voice_moods(replace(Project(), lines=lines), tmp_path)
    moods = {ident: line.mood for ident, line in project.lines.items()}
    assert moods["0"] is None and moods["told"] == "sad" and moods["gone"] is None and moods["bare"] is None
    assert moods["3"] is not None and moods["3"][0] == 0.0 and 0.2 < float(moods["3"][1]) <= MOST
