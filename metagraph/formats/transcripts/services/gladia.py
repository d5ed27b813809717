"""Gladia's transcripts (v2): result.transcription.utterances[], times in seconds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from metagraph.formats.transcripts.json_files import add_words
from metagraph.formats.transcripts.json_values import list_of, list_row_dicts, name_of, parse_text
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.words import Collected, Transcript


def _transcription(data: Any) -> Mapping[str, Any] | None:
    """Return what holds the utterances: whole answers have it in `result`."""
    for key in ("result", "transcription"):
        if isinstance(data, dict) and isinstance(data.get(key), dict):
            data = data[key]
    return data if isinstance(data, dict) and isinstance(data.get("utterances"), list) else None


def is_gladia(source: TranscriptSource) -> bool:
    return bool({"result", "transcription"} & source.keys) and _transcription(source.data) is not None


def read_gladia(source: TranscriptSource) -> Transcript:
    """Read utterances, with words in them where there are some. Raises FileError."""
    out = Collected(source.path)
    for where, one in list_row_dicts(out, _transcription(source.data) or {}, "utterances"):
        speaker = name_of(one.get("speaker", one.get("channel", "")))
        words = list_of(out, one.get("words") or [], f"{where}.words")
        if words:
            add_words(
                out, [w | {"speaker": speaker} if isinstance(w, dict) else w for w in words], speaker, where
            )
        else:
            add_words(out, [{**one, "word": parse_text(one.get("text")), "speaker": speaker}], speaker, where)
    return out.finished()
