"""Transcripts: who says which word when, from every format in the registry.

What a file is, its content says. Our own exports are read back whole: words and segments, as corrected by
hand.
"""

from __future__ import annotations

from pathlib import Path

from metagraph.common.budgets import TEXT_FILE
from metagraph.common.files import guard_reader, read_file
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.transcripts.registry import describe_transcript_formats, find_transcript_reader
from metagraph.formats.transcripts.source import UNKNOWN_SOUND, TranscriptSound, TranscriptSource
from metagraph.formats.transcripts.words import Transcript, decode_text


@guard_reader
def read_transcript(path: str | Path, sound: TranscriptSound = UNKNOWN_SOUND) -> Transcript:
    """Read a transcript of any known format. sound: what it was made of, which tells the unit of times that
    name none, and which of several media an annotation's times are meant for. Raises FileError.
    """
    path = Path(path)
    raw = read_file(path, TEXT_FILE)
    source = TranscriptSource(path, decode_text(raw), raw, sound)
    if not source.head:
        return Transcript({}, {}, ("it is empty",))
    remedy = phrase("Known formats are {names}.", names=describe_transcript_formats())
    if "\0" in source.head[:200]:
        raise FileError(path, phrase("is not text"), phrase("its beginning"), remedy)
    reader = find_transcript_reader(source)
    if reader is not None:
        return reader.read(source)
    if source.data is not None:
        names = ", ".join(f"'{str(k)[:30]}'" for k in sorted(source.keys)[:6]) or phrase("nothing")
        raise FileError(
            path,
            phrase("is JSON, but not of a known transcript format; it contains {names}", names=names),
            "",
            phrase(
                "Expected are 'words' or 'segments' whose entries have a text, a start and an end, or what "
                "one of these writes: {names}.",
                names=describe_transcript_formats(".json"),
            ),
        )
    if source.root:
        raise FileError(
            path,
            phrase(
                "is XML, but not of a known transcript format; its outermost element is '{root}'",
                root=source.root[:60],
            ),
            phrase("its beginning"),
            remedy,
        )
    raise FileError(path, phrase("is not a transcript in a known format"), phrase("its beginning"), remedy)
