"""Hearing: syllables whatever the level and the noise; mouth shapes roughly as the phones have them; broken
files with a reason.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import soundfile
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from metagraph.errors import FileError
from metagraph.graph.face.names import VISEMES
from metagraph.graph.face.rig import OPENING
from metagraph.speech.lines import read_line_voice
from metagraph.speech.phones import list_mouth_pieces
from metagraph.speech.sound import (
    analyse_sound,
    find_syllables,
    guess_mouth_shapes,
    read_recording,
    read_sound,
)
from metagraph.speech.textgrid import read_textgrid

Array = np.ndarray[Any, Any]
RATE = 16000
LINES = Path(__file__).parents[2] / "sample_clips" / "lines"
SAMPLES = sorted(path.stem for path in LINES.glob("*.flac"))
REAL = (("bobby", "bobby_phones"), ("mary", "mary"), ("damon_set_test", "damon_set_test"))


def babble(
    syllable: Array,
    gap: float = 0.08,
    length: float = 0.16,
    first: float = 700.0,
    second: float = 1200.0,
    rate: int = RATE,
) -> Array:
    """Syllables of a buzz with two formants, as loud as `syllable` says, 0..1."""
    parts = [np.zeros(int(0.2 * rate))]
    t = np.arange(int(length * rate)) / rate
    buzz = sum(
        np.sin(2 * np.pi * 120 * k * t)
        * (np.exp(-(((120 * k - first) / 150) ** 2)) + 0.5 * np.exp(-(((120 * k - second) / 200) ** 2)))
        for k in range(1, 30)
    )
    for loud in syllable:
        parts += [loud * 0.3 * buzz * np.hanning(len(t)), np.zeros(int(gap * rate))]
    return np.concatenate([*parts, np.zeros(int(0.2 * rate))])


@pytest.mark.parametrize("count", [0, 1, 2, 7])
def test_syllables_are_counted(count: int) -> None:
    peaks, strengths = find_syllables(analyse_sound(babble(np.ones(count)), RATE))
    assert len(peaks) == len(strengths) == count
    if count:
        assert np.allclose(peaks, 0.28 + 0.24 * np.arange(count), atol=0.025)


@pytest.mark.parametrize(("depth", "count"), [(0.5, 8), (0.03, 0)])
def test_a_dip_that_can_be_heard_parts_syllables_and_a_tremor_does_not(depth: float, count: int) -> None:
    t = np.arange(2 * RATE) / RATE
    tone = (1 - depth * np.cos(2 * np.pi * 4 * t)) * np.sin(2 * np.pi * 500 * t) * (t > 0.001)
    samples = np.concatenate([np.zeros(RATE // 4), 0.2 * tone, np.zeros(RATE // 4)])
    assert abs(len(find_syllables(analyse_sound(samples, RATE))[0]) - count) <= 1


@pytest.mark.parametrize("gain", [1e-3, 0.05, 1.0, 3.0])
@pytest.mark.parametrize("noise", [0.0, 0.01])
def test_level_and_noise_do_not_matter(gain: float, noise: float) -> None:
    clean = babble(np.array([1, 0.6, 0.8, 1, 0.5]))
    loud = gain * (clean + noise * np.random.default_rng(0).normal(size=len(clean)))
    assert len(find_syllables(analyse_sound(loud, RATE))[0]) == 5


@pytest.mark.parametrize("rate", [8000, 16000, 44100, 48000])
def test_any_rate_of_samples_will_do(rate: int) -> None:
    assert len(find_syllables(analyse_sound(babble(np.ones(4), rate=rate), rate))[0]) == 4


def test_the_loudest_syllable_is_the_strongest() -> None:
    peaks, strengths = find_syllables(analyse_sound(babble(np.array([0.4, 0.5, 1.0, 0.4])), RATE))
    assert strengths.argmax() == 2 and len(peaks) == 4 and (strengths > 0).all() and strengths.max() <= 1


@pytest.mark.parametrize(
    "samples",
    [
        np.zeros(RATE),
        np.full(RATE, 0.5),
        1e-6 * np.ones(10),
        1e-5 * np.random.default_rng(0).normal(size=RATE),
    ],
)
def test_silence_says_nothing(samples: Array) -> None:
    heard = analyse_sound(samples, RATE)
    assert len(find_syllables(heard)[0]) == 0 and guess_mouth_shapes(heard) == []


def test_steady_noise_is_no_speech() -> None:
    assert (
        len(find_syllables(analyse_sound(0.1 * np.random.default_rng(0).normal(size=2 * RATE), RATE))[0]) <= 2
    )


def shown(samples: Array) -> dict[str, float]:
    """Seconds of each shape."""
    out: dict[str, float] = {}
    for piece in guess_mouth_shapes(analyse_sound(samples, RATE)):
        out[piece.viseme] = out.get(piece.viseme, 0.0) + piece.end - piece.start
    return out


def test_an_open_vowel_opens_the_mouth_and_a_close_one_does_not() -> None:
    wide, narrow = (
        shown(babble(np.ones(5), first=780, second=1250)),
        shown(babble(np.ones(5), first=300, second=900)),
    )
    assert wide.get("aa", 0) > 0.3 and narrow.get("aa", 0) == 0


def test_hiss_is_a_sibilant() -> None:
    hiss = np.diff(np.random.default_rng(0).normal(size=RATE // 4 + 1)) * 0.1
    samples = np.concatenate([babble(np.ones(2)), hiss, babble(np.ones(2))])
    found = shown(samples)
    assert found.get("SS", 0) + found.get("CH", 0) > 0.1


def test_a_short_gap_is_a_stop_and_a_long_one_silence() -> None:
    short, long = (
        guess_mouth_shapes(analyse_sound(babble(np.ones(4), gap=0.04), RATE)),
        guess_mouth_shapes(analyse_sound(babble(np.ones(2), gap=0.6), RATE)),
    )
    assert {"PP", "DD"} & {p.viseme for p in short}
    gap = [p for p in long if 0.5 < p.start < 0.8]
    assert not gap


# --- real speech


@pytest.mark.parametrize(("name", "phones"), REAL)
def test_syllables_of_real_speech_lie_in_its_vowels(shared_data: Path, name: str, phones: str) -> None:
    folder = shared_data / "praatio-speech"
    syllables_in_vowels(folder / f"{name}.wav", folder / f"{phones}.TextGrid")


@pytest.mark.parametrize("name", SAMPLES)
def test_syllables_of_the_samples_lines_lie_in_their_vowels(name: str) -> None:
    syllables_in_vowels(LINES / f"{name}.flac", LINES / f"{name}.TextGrid")


def syllables_in_vowels(sound: Path, grid: Path) -> None:
    peaks, _ = find_syllables(analyse_sound(*read_sound(sound)))
    vowels = [
        p for p in list_mouth_pieces(read_textgrid(grid)) if p.viseme in ("aa", "E", "I", "O", "U", "RR")
    ]
    inside = [any(v.start - 0.03 <= t <= v.end + 0.03 for v in vowels) for t in peaks]
    assert len(peaks) >= 3 and np.mean(inside) >= 0.75


@pytest.mark.parametrize(("name", "phones"), REAL)
def test_the_mouth_guessed_from_sound_opens_when_the_phones_say_so(
    shared_data: Path, name: str, phones: str
) -> None:
    folder = shared_data / "praatio-speech"
    mouth_opens(folder / f"{name}.wav", folder / f"{phones}.TextGrid")


@pytest.mark.parametrize("name", SAMPLES)
def test_the_mouth_guessed_from_the_samples_lines_opens_when_their_phones_say_so(name: str) -> None:
    mouth_opens(LINES / f"{name}.flac", LINES / f"{name}.TextGrid")


def mouth_opens(sound: Path, grid: Path) -> None:
    opening = np.array([OPENING.get(v, 0.0) for v in VISEMES])
    known, guessed = read_line_voice(sound, grid), read_line_voice(sound)
    # Lips that meet amid a loud syllable ("bobby") are in the phones, and not heard.
    assert np.corrcoef(known.weights @ opening, guessed.weights @ opening)[0, 1] > 0.3
    assert len(known.peaks) == len(guessed.peaks) and known.duration == guessed.duration


def test_depth_and_channels_of_a_recording_do_not_matter(shared_data: Path) -> None:
    found = [read_line_voice(p) for p in sorted((shared_data / "praatio-speech").glob("bobby*.wav"))]
    assert len(found) == 6 and len({len(v.peaks) for v in found}) == 1
    for voice in found[1:]:
        assert np.allclose(voice.peaks, found[0].peaks, atol=0.02)


# --- files


@pytest.mark.parametrize("suffix", [".wav", ".flac", ".ogg", ".mp3"])
def test_all_common_formats_are_read(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"line{suffix}"
    soundfile.write(str(path), np.stack([babble(np.ones(3))] * 2, 1), RATE)
    voice = read_line_voice(path)
    assert len(voice.peaks) == 3 and voice.duration == pytest.approx(len(babble(np.ones(3))) / RATE, abs=0.1)


def test_a_file_is_read_by_what_it_is_not_what_it_is_called(tmp_path: Path) -> None:
    soundfile.write(str(tmp_path / "real.mp3"), babble(np.ones(3)), RATE)
    (tmp_path / "line.wav").write_bytes((tmp_path / "real.mp3").read_bytes())
    assert len(read_line_voice(tmp_path / "line.wav").peaks) == 3


def test_numbers_that_are_none_are_silence(tmp_path: Path) -> None:
    samples = babble(np.ones(3))
    samples[:100], samples[200] = np.nan, np.inf
    soundfile.write(str(tmp_path / "line.wav"), samples, RATE, subtype="FLOAT")
    assert len(read_line_voice(tmp_path / "line.wav").peaks) == 3


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (None, "sound file does not exist"),
        (b"", "cannot be read as sound"),
        (b"RIFF....WAVEfmt nonsense" * 9, "cannot be read as sound"),
        (b"hello", "sound"),
    ],
)
def test_a_file_that_is_no_sound_is_refused_with_a_remedy(
    tmp_path: Path, content: bytes | None, words: str
) -> None:
    path = tmp_path / "line.wav"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(FileError, match=r"line\.wav") as told:
        read_line_voice(path)
    assert words in str(told.value)


def test_a_sound_without_samples_and_one_too_coarse_are_refused(tmp_path: Path) -> None:
    soundfile.write(str(tmp_path / "empty.wav"), np.zeros(0), RATE)
    soundfile.write(str(tmp_path / "coarse.wav"), np.zeros(500), 1000)
    for name, words in (("empty.wav", "contains no sound"), ("coarse.wav", "sample rate of 1000 Hz")):
        with pytest.raises(FileError, match=words):
            read_sound(tmp_path / name)


def test_a_sound_of_one_sample_is_survived(tmp_path: Path) -> None:
    soundfile.write(str(tmp_path / "tick.wav"), np.ones(1) * 0.5, RATE)
    assert read_line_voice(tmp_path / "tick.wav").duration < 0.001


@pytest.mark.nightly
@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_a_damaged_sound_is_read_or_refused(tmp_path: Path, data: st.DataObject) -> None:
    path = tmp_path / f"line{data.draw(st.sampled_from(['.wav', '.flac', '.ogg']))}"
    soundfile.write(str(path), babble(np.ones(1)), 8000)
    whole = bytearray(path.read_bytes())
    for _ in range(data.draw(st.integers(1, 5))):
        at = data.draw(st.integers(0, min(len(whole) - 1, 200)))
        whole[at : at + 4] = data.draw(st.binary(min_size=4, max_size=4))
    del whole[data.draw(st.integers(20, len(whole))) :]
    path.write_bytes(bytes(whole))
    try:
        voice = read_line_voice(path)
    except FileError as error:
        assert path.name in str(error)
    else:
        assert np.isfinite(voice.weights).all() and np.isfinite(voice.peaks).all()


def test_a_sound_under_another_kinds_ending_is_read_and_told_for_what_it_is(tmp_path: Path) -> None:
    samples = 0.1 * np.sin(np.arange(16000) / 10)
    for kind, ending, really in (
        ("MP3", "wav", "an MP3 file"),
        ("FLAC", "wav", "a FLAC file"),
        ("OGG", "mp3", "an OGG file"),
        ("WAV", "flac", "a WAV file"),
        ("WAV", "wav", ""),
        ("MP3", "mp3", ""),
    ):
        path = tmp_path / f"a.{ending}"
        soundfile.write(path, samples, 16000, format=kind)
        assert read_recording(path).really == really, (kind, ending)


@pytest.mark.parametrize(
    ("head", "words"),
    [
        (b"\x00\x00\x00\x20ftypM4A \x00\x00\x00\x00", "an MPEG-4 file"),
        (b"\x1aE\xdf\xa3" + bytes(60), "a Matroska or WebM file"),
        (b"version https://git-lfs.github.com/spec/v1\n", "a Git LFS pointer"),
        (b"<!DOCTYPE html>", "a web page"),
    ],
)
def test_what_is_no_sound_that_can_be_read_is_named_for_what_it_is(
    tmp_path: Path, head: bytes, words: str
) -> None:
    (tmp_path / "a.wav").write_bytes(head)
    with pytest.raises(FileError, match=words):
        read_recording(tmp_path / "a.wav")
