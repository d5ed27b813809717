"""What a voice tells while it is heard: when it begins and ends, and where it is stressed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from metagraph.live.heard_voice import RATE, SIZE, HeardVoice
from metagraph.speech.clauses import find_segments_by_sound
from metagraph.speech.pitch import measure_pitch
from metagraph.speech.sound import analyse_sound, read_sound
from metagraph.speech.soundtrack import resample_sound
from metagraph.synthesis.extending.speech_so_far import SpeechNews

REAL = Path(__file__).resolve().parents[3] / "shared" / "data" / "praatio-speech"


def voice(seconds: float, tops: list[float], before: float = 0.5, after: float = 0.6) -> np.ndarray:
    """Harmonics whose pitch rises to 180 Hz at each of these moments and is 120 between; silence around."""
    t = np.arange(round(seconds * RATE)) / RATE
    hertz = 120 + sum((60 * np.exp(-0.5 * ((t - top) / 0.08) ** 2) for top in tops), 0 * t)
    phase = 2 * np.pi * np.cumsum(hertz) / RATE
    sound = 0.1 * sum(np.sin(n * phase) / n for n in range(1, 9))
    return np.concatenate([np.zeros(round(before * RATE)), sound, np.zeros(round(after * RATE))]).astype("f4")


def told(samples: np.ndarray, noise: float = 1e-4) -> list[tuple[float, SpeechNews]]:
    """What is reported, and when it is."""
    samples = samples + noise * np.random.default_rng(1).standard_normal(len(samples)).astype("f4")
    heard, out = HeardVoice(10.0), []
    for n in range(0, len(samples) - SIZE + 1, SIZE):
        out += [(heard.now, news) for news in heard.hear(samples[n : n + SIZE])]
    return out


def test_silence_and_noise_tell_nothing() -> None:
    assert not told(np.zeros(3 * RATE, "f4"), 0.0) and not told(np.zeros(3 * RATE, "f4"), 0.02)


def test_a_voice_begins_is_stressed_where_it_is_highest_and_ends() -> None:
    news = told(voice(2.0, [0.6, 1.4]))
    assert [n.what for _, n in news] == ["begins", "stress", "stress", "ends"]
    assert np.allclose([n.at for _, n in news], [10.5, 11.1, 11.9, 12.5], atol=0.06)
    late = [at - n.at for at, n in news]
    assert late[0] <= 0.09 and max(late[1:3]) <= 0.2 and late[3] <= 0.25  # as docs/agents/long-takes.md says


def test_noise_that_begins_while_somebody_speaks_does_not_speak_on() -> None:
    said = voice(2.0, [0.6], after=0.0)
    noise = 0.08 * np.random.default_rng(2).standard_normal(6 * RATE).astype("f4")
    news = told(np.concatenate([said, noise]))
    assert [n.what for _, n in news] == ["begins", "stress", "ends"]
    at, end = news[-1]
    assert abs(end.at - 12.5) < 0.1 and at - end.at < 0.7


def test_tops_close_together_are_one_stress_and_a_level_voice_has_none_but_its_first() -> None:
    close = [n for _, n in told(voice(1.5, [0.5, 0.75])) if n.what == "stress"]
    assert len(close) == 1
    level = [n for _, n in told(voice(2.0, [])) if n.what == "stress"]
    assert len(level) <= 1


def test_frames_of_any_size_and_wild_numbers_do_no_harm() -> None:
    heard = HeardVoice(0.0)
    for samples in (np.zeros(0, "f4"), np.ones(7, "f4"), np.full(SIZE, 1e6, "f4"), voice(0.3, [])):
        assert all(np.isfinite(n.at) for n in heard.hear(samples))


@pytest.mark.skipif(not REAL.is_dir(), reason="the recordings of others are not there")
@pytest.mark.parametrize("name", ["bobby.wav", "mary.wav", "damon_set_test.wav"])
def test_recorded_voices_begin_end_and_are_stressed_where_all_of_the_sound_tells(name: str) -> None:
    samples, rate = read_sound(REAL / name)
    (clause,) = find_segments_by_sound((), measure_pitch(samples, rate), analyse_sound(samples, rate), None)
    heard = np.concatenate([resample_sound(samples, rate, RATE), np.zeros(RATE, "f4")])
    news = [n for _, n in told(heard, 0.0)]
    begins = next(n.at for n in news if n.what == "begins") - 10
    ends = [n.at for n in news if n.what == "ends"][-1] - 10
    assert abs(begins - clause.start) < 0.12 and abs(ends - clause.end) < 0.2
    assert min(abs(n.at - 10 - clause.peak) for n in news if n.what == "stress") < 0.3
