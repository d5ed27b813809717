"""Files of words that want motion."""

from __future__ import annotations

from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.formats.word_lists import read_word_lists
from metagraph.synthesis.iconic_words import WordWish


def test_a_line_is_a_word_or_words_alike(tmp_path: Path) -> None:
    file = tmp_path / "words.txt"
    file.write_text("# what hands show\n\nbig = huge, tall\n円, 丸い\n", "utf-8-sig")
    assert read_word_lists(file) == (WordWish(("big",), ("huge", "tall")), WordWish(("円", "丸い")))


def test_what_names_no_word_is_told_with_its_line(tmp_path: Path) -> None:
    file = tmp_path / "words.txt"
    file.write_text("big\n= huge\n")
    with pytest.raises(FileError, match="line 2") as told:
        read_word_lists(file)
    assert "'= huge' names no word" in str(told.value)
    file.write_text("# nothing\n")
    with pytest.raises(FileError, match="it names no words"):
        read_word_lists(file)
    with pytest.raises(FileError):
        read_word_lists(tmp_path / "nowhere.txt")
