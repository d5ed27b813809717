"""Transcripts: who says which word when, from TextGrid, ELAN, WebVTT, SRT, CTM, tables and the JSON of
Whisper's kin and of IBM.

What a file is, its content says. Our own exports are read back whole: words and segments, as corrected by
hand.
"""

from __future__ import annotations

from pathlib import Path

from metagraph.common.files import guard_reader
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.transcripts.json_files import read_json
from metagraph.formats.transcripts.text_files import (
    is_ctm,
    is_word_table,
    read_ctm,
    read_cues,
    read_word_table,
)
from metagraph.formats.transcripts.tiers import read_elan_tiers, read_textgrid_tiers
from metagraph.formats.transcripts.words import REMEDY, Transcript, read_text_file


@guard_reader
def read_transcript(path: str | Path) -> Transcript:
    """Read a transcript, whatever of `SUFFIXES` it is. Raises FileError."""
    path = Path(path)
    text = read_text_file(path)
    head = text.lstrip("\ufeff \t\n")[:4000]
    if not head:
        return Transcript({}, {}, ("it is empty",))
    if "\0" in head[:200]:
        raise FileError(path, phrase("is not text"), phrase("its beginning"), REMEDY)
    if head.startswith(('File type = "ooTextFile', '"ooTextFile')) or path.suffix.casefold() == ".textgrid":
        return read_textgrid_tiers(path)
    if head.startswith("<"):
        return read_elan_tiers(path)
    if head.startswith(("{", "[")):
        return read_json(path, text)
    if head.startswith("WEBVTT") or "-->" in text:
        return read_cues(path, text)
    if is_word_table(text):
        return read_word_table(path, text)
    if is_ctm(text):
        return read_ctm(path, text)
    raise FileError(path, phrase("is not a transcript in a known format"), phrase("its beginning"), REMEDY)
