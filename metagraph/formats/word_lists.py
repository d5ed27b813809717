"""Files of words that want motion: a line for each word, or for words that may stand for each other."""

from __future__ import annotations

from pathlib import Path

from metagraph.common.files import guard_reader
from metagraph.errors import FileError
from metagraph.formats.transcripts.words import read_text_file
from metagraph.synthesis.iconic_words import WordWish, parse_word_wish

REMEDY = "Write a line for each: big, or big = huge, tall, or big, huge where each may stand for the other."


@guard_reader
def read_word_lists(path: str | Path) -> tuple[WordWish, ...]:
    """Read words that want motion; lines that begin with # are none. Raises FileError naming the line."""
    path = Path(path)
    out = []
    for number, line in enumerate(read_text_file(path).lstrip("\ufeff").splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        try:
            out.append(parse_word_wish(line))
        except ValueError:
            raise FileError(path, f"'{line.strip()[:60]}' names no word", f"line {number}", REMEDY) from None
    if not out:
        raise FileError(path, "it names no words", "", REMEDY)
    return tuple(out)
