"""The sample lines: small, our own, as they are made, with phones that fit their sound."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.formats.project.data import encode_struct
from metagraph.speech.lines import read_line_voice
from metagraph.speech.phones import list_mouth_pieces
from metagraph.speech.sound import read_sound
from metagraph.speech.textgrid import read_textgrid
from sample_clips.make.babble import FOLDER, LINES, RATE, sample_lines, spoken, text_grid
from tests.unchanged import only_when_changed

pytestmark = only_when_changed("sample clips")

NAMES = [name for name, _, _ in LINES]


def test_there_is_a_sound_and_a_textgrid_for_every_line_and_nothing_else() -> None:
    assert sorted(p.name for p in FOLDER.iterdir()) == sorted(
        f"{n}.{s}" for n in NAMES for s in ("flac", "TextGrid")
    )
    assert sum(p.stat().st_size for p in FOLDER.iterdir()) < 150_000


@pytest.mark.parametrize(("name", "phones"), [(name, phones) for name, _, phones in LINES])
def test_files_are_as_they_are_made(name: str, phones: str) -> None:
    samples, marks = spoken(phones)
    kept, rate = read_sound(FOLDER / f"{name}.flac")
    assert rate == RATE and np.abs(kept - samples).max() < 2e-3
    assert (FOLDER / f"{name}.TextGrid").read_text("utf-8") == text_grid(marks)


@pytest.mark.parametrize("name", NAMES)
def test_its_syllables_are_heard_where_its_vowels_are(name: str) -> None:
    voice = read_line_voice(FOLDER / f"{name}.flac", FOLDER / f"{name}.TextGrid")
    grid = read_textgrid(FOLDER / f"{name}.TextGrid")
    assert voice.duration == pytest.approx(grid.end, abs=0.02)
    vowels = [p for p in list_mouth_pieces(grid) if p.viseme in ("aa", "E", "I", "O", "U", "RR")]
    inside = [any(v.start - 0.03 <= t <= v.end + 0.03 for v in vowels) for t in voice.peaks]
    assert len(voice.peaks) >= 3 and np.mean(inside) > 0.8


def test_lines_name_their_files_beside_the_project() -> None:
    lines = sample_lines()
    assert [encode_struct(x)["audio"] for x in lines.values()] == [f"lines/{n}.flac" for n in NAMES]
    assert all((FOLDER.parent / str(x.audio)).is_file() and x.text for x in lines.values())
