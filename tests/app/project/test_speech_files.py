"""Which dropped files are a conversation."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import soundfile

from app.project.speech_files import (
    count_channels,
    describe_sound_file,
    find_transcripts_beside,
    is_conversation,
    sort_speech_files,
)


def sound(path: Path, channels: int, seconds: float = 0.1) -> Path:
    soundfile.write(str(path), np.zeros((round(8000 * seconds), channels)), 8000)
    return path


def test_two_channels_two_sounds_or_a_sound_with_words_are_a_conversation(tmp_path: Path) -> None:
    mono, stereo, words = sound(tmp_path / "a.wav", 1), sound(tmp_path / "b.wav", 2), tmp_path / "a.TextGrid"
    assert is_conversation([stereo])
    assert is_conversation([mono, stereo])
    assert is_conversation([mono, words])
    assert not is_conversation([mono]), "a line of dialogue"
    assert not is_conversation([words])
    assert not is_conversation([mono, stereo, tmp_path / "c.flac"]), "lines of dialogue"
    assert not is_conversation([stereo, tmp_path / "notes.pdf"])


def test_three_sounds_are_a_conversation_where_they_last_long_and_as_long_as_each_other(
    tmp_path: Path,
) -> None:
    def some(*lasts: float) -> list[Path]:
        return [sound(tmp_path / f"{n}.wav", 1, seconds) for n, seconds in enumerate(lasts)]

    assert is_conversation(some(12.0, 12.3, 12.1))
    assert not is_conversation(some(12.0, 12.0, 14.0)) and not is_conversation(some(1.0, 1.1, 1.2)), (
        "lines of dialogue"
    )
    assert is_conversation([sound(tmp_path / "b.wav", 3)]) and not is_conversation(
        [sound(tmp_path / "c.wav", 9)]
    )


def test_sounds_come_first_by_name_and_what_is_neither_is_left_out() -> None:
    paths = [Path(n) for n in ("b.JSON", "B.wav", "a.WAV", "x.png", "a.vtt")]
    assert sort_speech_files(paths) == ((Path("a.WAV"), Path("B.wav")), (Path("a.vtt"), Path("b.JSON")))


def test_words_beside_a_sound_are_found_whatever_the_case(tmp_path: Path) -> None:
    a, b = sound(tmp_path / "a.wav", 1), sound(tmp_path / "b.wav", 1)
    (tmp_path / "A.TextGrid").touch()
    assert find_transcripts_beside([a, b]) == (tmp_path / "A.TextGrid",)
    assert find_transcripts_beside([tmp_path / "nowhere" / "c.wav"]) == ()


def test_a_file_that_is_no_sound_has_no_channels(tmp_path: Path) -> None:
    (tmp_path / "no.wav").write_text("no")
    assert count_channels(tmp_path / "no.wav") == 0
    assert count_channels(tmp_path / "gone.wav") == 0
    assert describe_sound_file(tmp_path / "gone.wav") == "gone.wav"
    assert describe_sound_file(sound(tmp_path / "a.wav", 2)) == "a.wav (2 channels, 0:00)"
