"""YIN held to what librosa 0.11.0 finds, kept in yin_librosa.npz.

For each case that is `librosa.yin(frames.reshape(-1), sr=rate, fmin=lowest, fmax=highest, frame_length=N,
hop_length=N, center=False)`; for `pitch0` and `pitch1`, what `pitch` found of a conversation when it was made
of that.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from metagraph.speech import pitch as pitch_module
from metagraph.speech.pitch import measure_pitch
from metagraph.speech.yin import measure_f0_by_yin, measure_yin_differences

ROOT = Path(__file__).resolve().parents[2]
KEPT = np.load(Path(__file__).with_name("yin_librosa.npz"))
SAMPLES = ROOT / "sample_clips"

Array = NDArray[Any]


def tone(hertz: float, rate: int = 8000, size: int = 512, harmonics: int = 6) -> Array:
    at = 2 * np.pi * hertz * np.arange(size) / rate
    return np.asarray(sum(np.sin(k * at + k) / k for k in range(1, harmonics)))[None]


def tones() -> Array:
    return np.concatenate([tone(h) for h in np.geomspace(62, 580, 60)])


def glides() -> Array:
    """Voices that rise or fall by up to an octave within a frame."""
    ends = np.geomspace(80, 160, 12)
    slopes = [np.geomspace(a, b, 512) for a in ends for b in (ends[0], ends[-1], 1.5 * a)]
    return np.array(
        [sum(np.sin(k * 2 * np.pi * np.cumsum(h) / 8000) / k for k in range(1, 5)) for h in slopes]
    )


def frames_of(samples: Array, size: int, hop: int) -> Array:
    frames = np.lib.stride_tricks.sliding_window_view(samples, size)[::hop]
    return np.asarray(frames - frames.mean(1, keepdims=True))


def sounded(name: str) -> tuple[Array, int]:
    import soundfile

    samples, rate = soundfile.read(str(SAMPLES / name), always_2d=True)
    return samples[: 8 * rate], rate


def case(name: str) -> tuple[Array, float, float, float]:
    """Return frames, their rate, and the lowest and highest pitch in question."""
    if name in ("tones", "glides"):
        return (tones() if name == "tones" else glides()), 8000, 60, 600
    if name == "noise":
        return np.random.default_rng(5).standard_normal((60, 512)), 8000, 60, 600
    if name == "line":
        samples, rate = sounded("lines/you_first.flac")
        return frames_of(samples[:, 0], 1024, 320), rate, 60, 600
    samples, rate = sounded("conversation/talk.ogg")  # spoken by eSpeak NG
    side = int(name[-1])
    return frames_of(samples[:, side], 1024, 441), rate, *((80.0, 250.0) if side else (60.0, 600.0))


CASES = ("tones", "glides", "noise", "line", "talk0", "talk1")


@pytest.mark.parametrize("name", CASES)
def test_every_frame_has_the_pitch_that_librosa_finds(name: str) -> None:
    frames, rate, lowest, highest = case(name)
    loud = (frames * frames).mean(1) > 1e-7  # what is softer, a decoder's last bit decides
    apart = 12 * np.abs(np.log2(measure_f0_by_yin(frames, rate, lowest, highest) / KEPT[name]))[loud]
    assert loud.sum() >= 30 and np.mean(apart < 0.01) > 0.99 and np.median(apart) < 1e-4


@pytest.mark.parametrize("side", [0, 1])
def test_a_spoken_side_of_a_conversation_has_the_pitch_it_had_by_librosa(side: int) -> None:
    samples, rate = sounded("conversation/talk.ogg")
    found, kept = measure_pitch(samples[:, side], rate).hertz, KEPT[f"pitch{side}"]
    both = ~np.isnan(found) & ~np.isnan(kept)
    apart = 12 * np.abs(np.log2(found[both] / kept[both]))
    assert np.mean(np.isnan(found) != np.isnan(kept)) < 0.01 and both.sum() > 100
    assert np.median(apart) < 0.005 and apart.max() < 0.2


@given(hertz=st.floats(62, 585), rate=st.sampled_from([8000, 8820, 11025]), gain=st.floats(1e-3, 1e3))
@settings(max_examples=50, deadline=None)
def test_any_tone_is_found_to_a_fifth_of_a_semitone_however_loud(
    hertz: float, rate: int, gain: float
) -> None:
    frame = tone(hertz, rate)
    found = measure_f0_by_yin(gain * frame, rate, 60, 600)
    assert 12 * abs(np.log2(found[0] / hertz)) < 0.2 and found == pytest.approx(
        measure_f0_by_yin(frame, rate, 60, 600), rel=1e-6
    )


def test_differences_are_those_of_the_paper_where_nothing_is_heard_behind_a_frame() -> None:
    frame = np.concatenate([np.random.default_rng(1).standard_normal(300), np.zeros(100)])
    apart = np.array(
        [((frame[: 400 - k] - frame[k:]) ** 2).sum() + (frame[400 - k :] ** 2).sum() for k in range(1, 101)]
    )
    # The samples that are shifted out of the frame are compared with nothing.
    assert np.allclose(
        measure_yin_differences(frame[None], 100)[0], apart / (np.cumsum(apart) / np.arange(1, 101))
    )


def test_silence_and_a_steady_level_have_no_period_and_give_the_highest_pitch() -> None:
    assert np.array_equal(measure_f0_by_yin(np.zeros((2, 512)), 8000, 60, 600), [8000 / 13] * 2)
    assert np.array_equal(measure_yin_differences(np.zeros((1, 64)), 20), np.ones((1, 20)))
    assert np.isfinite(measure_f0_by_yin(np.ones((1, 512)), 8000, 60, 600)).all()


def test_frames_do_not_mind_each_other() -> None:
    frames = np.concatenate([tones()[:5], np.zeros((1, 512)), glides()[:5]])
    assert np.allclose(
        measure_f0_by_yin(frames, 8000, 60, 600),
        [measure_f0_by_yin(f[None], 8000, 60, 600)[0] for f in frames],
        rtol=1e-12,
    )
    assert measure_f0_by_yin(frames[:0], 8000, 60, 600).shape == (0,)


@pytest.mark.parametrize(
    ("size", "rate", "lowest", "highest"), [(512, 1000, 60, 600), (10, 8000, 60, 600), (512, 8000, 200, 200)]
)
def test_pitches_that_frames_cannot_tell_are_refused(
    size: int, rate: float, lowest: float, highest: float
) -> None:
    with pytest.raises(ValueError, match="tell no pitch"):
        measure_f0_by_yin(np.zeros((3, size)), rate, lowest, highest)


@pytest.mark.parametrize("rate", [11025, 16000, 44100, 48000])
def test_the_size_of_blocks_does_not_matter(monkeypatch: pytest.MonkeyPatch, rate: int) -> None:
    turn = np.random.default_rng(2)
    hertz = 140 * 2 ** np.interp(
        np.arange(4 * rate), np.linspace(0, 4 * rate, 40), turn.uniform(-0.5, 0.5, 40)
    )
    sound = sum(
        np.sin(2 * np.pi * k * np.cumsum(hertz) / rate) / k for k in range(1, 7)
    ) * 0.2 + 1e-3 * turn.standard_normal(4 * rate)
    whole = measure_pitch(np.asarray(sound), rate).hertz
    for block in (7, 100):
        monkeypatch.setattr(pitch_module, "_BLOCK", block)
        pieces = measure_pitch(np.asarray(sound), rate).hertz
        assert (
            np.array_equal(np.isnan(whole), np.isnan(pieces)) and np.nanmax(np.abs(whole / pieces - 1)) < 1e-6
        )
    assert np.isnan(whole).mean() < 0.1
