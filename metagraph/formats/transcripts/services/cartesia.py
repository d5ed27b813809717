"""Cartesia's word timestamps: lists of words, starts and ends beside each other, seconds; a message, or one a
line.
"""

from __future__ import annotations

from metagraph.common.wording import phrase
from metagraph.formats.transcripts.json_files import add_words
from metagraph.formats.transcripts.json_values import REMEDY_JSON, list_of, require_dict
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.words import Collected, Transcript


def is_cartesia(source: TranscriptSource) -> bool:
    rows = source.data if isinstance(source.data, list) else [source.data]
    return any(isinstance(row, dict) and isinstance(row.get("word_timestamps"), dict) for row in rows)


def read_cartesia(source: TranscriptSource) -> Transcript:
    """Read the words of all messages that have some. Raises FileError."""
    out = Collected(source.path)
    for n, message in enumerate(source.data if isinstance(source.data, list) else [source.data]):
        where = f"[{n}].word_timestamps"
        told = message.get("word_timestamps") if isinstance(message, dict) else None
        if told is None:
            continue
        lists = require_dict(out, told, where)
        columns = [list_of(out, lists.get(key), f"{where}.{key}") for key in ("words", "start", "end")]
        if len({len(column) for column in columns}) > 1:
            raise out.fail(phrase("has lists of words and times that differ in length"), where, REMEDY_JSON)
        rows = [{"word": word, "start": start, "end": end} for word, start, end in zip(*columns, strict=True)]
        add_words(out, rows, "", where)
    return out.finished()
