"""The sound of a performance is its lines where they are said, cut where they are cut."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import soundfile
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph import requests as a
from metagraph.graph.model import Project
from metagraph.playback.planning.running_plan import plan_performance
from metagraph.speech.lines import load_voices
from metagraph.speech.soundtrack import RATE, mix_track, place_line_sounds, place_lines, resample_sound


def tone(seconds: float, rate: int = 16000, hertz: float = 300.0) -> np.ndarray:
    return 0.5 * np.sin(2 * np.pi * hertz * np.arange(round(seconds * rate)) / rate)


@pytest.fixture
def spoken(toy: Any, tmp_path: Path) -> tuple[Project, Path]:
    soundfile.write(tmp_path / "one.wav", tone(1.0), 16000)
    soundfile.write(tmp_path / "two.flac", tone(2.0, 48000), 48000)
    (tmp_path / "bad.wav").write_bytes(b"RIFF nothing of the kind")
    lines = {
        "1": a.Line(audio="one.wav"),
        "2": a.Line(audio="two.flac"),
        "3": a.Line(text="No sound."),
        "4": a.Line(audio="bad.wav"),
    }
    project, notes = load_voices(replace(toy.project(), lines=lines), tmp_path)
    assert len(notes) == 1
    return project, tmp_path


def test_sounds_come_at_one_rate_and_a_broken_one_is_told_and_spoils_nothing(spoken: Any) -> None:
    sounds, notes = place_line_sounds(spoken[0].lines, spoken[1])
    assert set(sounds) == {"1", "2"}
    assert [len(s) / RATE for s in sounds.values()] == pytest.approx([1.0, 2.0], abs=1e-3)
    assert len(notes) == 1 and "'4'" in notes[0] and "bad.wav" in notes[0]


@pytest.mark.parametrize(
    ("rate", "wanted"), [(16000, 44100), (48000, 44100), (8000, 44100), (44100, 44100), (44100, 16000)]
)
def test_another_rate_keeps_the_tone_and_its_strength(rate: int, wanted: int) -> None:
    out = resample_sound(tone(0.5, rate), rate, wanted)
    assert len(out) == round(0.5 * wanted)
    middle = slice(wanted // 20, -wanted // 20)
    assert np.abs(out - tone(0.5, wanted))[middle].max() < 0.02


def test_lines_sound_where_they_are_said_and_one_that_is_cut_fades(spoken: Any) -> None:
    project, folder = spoken
    plan = plan_performance(
        project, [a.Say(line="2", at=1.0), a.Say(line="1", at=2.0), a.Say(text="mute", at=5.0)], 10
    )
    sounds, _ = place_line_sounds(project.lines, folder)
    parts = place_lines(plan, sounds)
    assert [(round(at, 3), round(len(s) / RATE, 2)) for at, s in parts] == [(1.0, 1.0), (2.0, 1.0)]
    assert abs(parts[0][1][-1]) < 0.02 and np.abs(parts[0][1][: RATE // 2]).max() > 0.4
    track = mix_track(parts, 0, 10 * RATE)
    loud = np.flatnonzero(np.abs(track) > 0.2) / RATE
    assert loud.min() == pytest.approx(1.0, abs=0.01) and loud.max() == pytest.approx(3.0, abs=0.02)
    assert not track[: RATE - 100].any() and not track[round(3.1 * RATE) :].any()


@settings(max_examples=50)
@given(
    st.lists(st.tuples(st.floats(0, 3), st.floats(0, 2)), max_size=4),
    st.integers(0, 4000),
    st.integers(1, 500),
)
def test_any_piece_of_the_track_is_that_piece_of_the_whole(
    parts: list[tuple[float, float]], start: int, count: int
) -> None:
    sounds = [(at, np.full(round(length * 1000), 0.2, np.float32)) for at, length in parts]
    whole = mix_track(sounds, 0, 5000, 1000)
    assert (mix_track(sounds, start, count, 1000) == whole[start : start + count]).all()


def test_too_much_at_once_is_clipped_not_wrapped() -> None:
    loud = [(0.0, np.full(10, 0.8, np.float32))] * 3
    assert mix_track(loud, 0, 10).max() == 1.0
