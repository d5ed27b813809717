"""Lines of dialogue become voices; what is broken is reported and spoils nothing else."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import soundfile

from metagraph.errors import FileError
from metagraph.graph.model import Project
from metagraph.graph.requests import Line
from metagraph.playback.life.schedule import Schedule, schedule
from metagraph.playback.life.track import Speech, track_of
from metagraph.speech.lines import load_voices, make_voice_from_phones, read_line, read_line_voice

GRID = """File type = "ooTextFile"
Object class = "TextGrid"
0 {end} <exists> 1 "IntervalTier" "phones" 0 {end} 4
0 0.2 "" 0.2 0.4 "m" 0.4 0.8 "AA1" 0.8 {end} "p"
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    rng = np.random.default_rng(0)
    t = np.arange(16000) / 16000
    tone = np.where((t > 0.35) & (t < 0.8), np.sin(2 * np.pi * 600 * t), 0) * 0.4 + 1e-3 * rng.normal(
        size=len(t)
    )
    soundfile.write(str(tmp_path / "good.wav"), tone, 16000)
    (tmp_path / "good.TextGrid").write_text(GRID.format(end=1.0))
    (tmp_path / "long.TextGrid").write_text(GRID.format(end=9.0))
    (tmp_path / "bad.TextGrid").write_text("nothing")
    (tmp_path / "bad.wav").write_bytes(b"noise")
    return tmp_path


def project(**lines: Line) -> Project:
    return replace(Project(), lines=lines)


def test_phones_shape_the_mouth_and_sound_the_syllables(folder: Path) -> None:
    voice = read_line_voice(folder / "good.wav", folder / "good.TextGrid")
    assert voice.duration == 1.0 and 0.4 < voice.peaks[0] < 0.8
    assert (
        voice.weights[np.searchsorted(voice.times, 0.6)].argmax() == 10
        and voice.weights[np.searchsorted(voice.times, 0.3)].argmax() == 1
    )


def test_phones_that_go_on_after_the_sound_are_cut(folder: Path) -> None:
    voice = read_line_voice(folder / "good.wav", folder / "long.TextGrid")
    assert voice.times[-1] == voice.duration == 1.0


def test_phones_alone_are_a_voice_with_a_syllable_for_each_vowel(folder: Path) -> None:
    voice = make_voice_from_phones(folder / "good.TextGrid")
    assert (
        voice.duration == 1.0 and voice.peaks.tolist() == pytest.approx([0.6]) and len(voice.strengths) == 1
    )


def test_a_line_without_files_has_no_voice(folder: Path) -> None:
    assert read_line(Line(text="Hello"), folder) is None
    with pytest.raises(FileError):
        read_line(Line(audio="bad.wav"), folder)


def test_every_line_that_can_be_read_has_a_voice_and_every_other_a_note(folder: Path) -> None:
    before = project(
        a=Line(audio="good.wav"),
        b=Line(audio="gone.wav"),
        c=Line(audio="bad.wav", text="still here"),
        d=Line(text="letters"),
        e=Line(audio="good.wav", phones="bad.TextGrid"),
        f=Line(phones="good.TextGrid"),
        g=Line(audio="bad.wav", phones="good.TextGrid"),
    )
    after, notes = load_voices(before, folder)
    assert set(after.voices) == {"a", "e", "f"} and after == before, "voices are no part of what is saved"
    assert len(notes) == 4 and len([n for n in notes if "line 'b'" in n and "gone.wav" in n]) == 1
    assert any("line 'e'" in n and "bad.TextGrid" in n for n in notes)
    assert len(after.voices["e"].peaks) == len(after.voices["a"].peaks)


def test_a_project_without_lines_has_no_voices(folder: Path) -> None:
    after, notes = load_voices(Project(), folder)
    assert after.voices == {} and notes == ()


def test_the_first_peak_of_a_real_line_brings_a_blink(shared_data: Path) -> None:
    blinks_at_the_first_peak(shared_data / "praatio-speech" / "mary.wav")


def test_the_first_peak_of_a_samples_line_brings_a_blink() -> None:
    blinks_at_the_first_peak(Path(__file__).parents[2] / "sample_clips" / "lines" / "hello.flac")


def blinks_at_the_first_peak(sound: Path) -> None:
    voice = read_line_voice(sound)
    found = schedule(
        Project().life,
        track_of([Speech("s", 10.0, 10.0 + voice.duration, "m")]),
        {"m": voice},
        1,
        20.0,
        Schedule(),
        0.0,
    )
    assert 10.0 + float(voice.peaks[0]) in found.blinks.starts


def test_sound_is_not_loaded_before_it_is_needed() -> None:
    modules = "import sys, metagraph.speech.lines, metagraph.playback.life.evaluate"
    code = f"{modules}; print([m for m in ('soundfile', 'scipy', 'numba', 'av') if m in sys.modules])"
    assert (
        subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=300
        ).stdout.strip()
        == "[]"
    )
