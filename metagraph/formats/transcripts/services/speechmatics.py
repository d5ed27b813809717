"""Speechmatics' transcripts (json-v2): results[], words and marks with their times in seconds."""

from __future__ import annotations

from typing import Any

from metagraph.formats.transcripts.json_files import add_words
from metagraph.formats.transcripts.json_values import list_row_dicts, name_of, parse_text
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.words import Collected, Transcript


def is_speechmatics(source: TranscriptSource) -> bool:
    results = source.data.get("results") if isinstance(source.data, dict) else None
    first = results[0] if isinstance(results, list) and results else None
    return isinstance(first, dict) and {"type", "alternatives", "start_time"} <= set(first)


def read_speechmatics(source: TranscriptSource) -> Transcript:
    """Read words by their speaker, else by their channel; marks stay with the word before them. Raises
    FileError.
    """
    out = Collected(source.path)
    words: list[dict[str, Any]] = []
    for place, item in list_row_dicts(out, source.data, "results"):
        best = next((one for _, one in list_row_dicts(out, item, "alternatives", place)), {})
        text = parse_text(best.get("content"))
        if item.get("type") == "punctuation":
            if words:
                words[-1]["word"] += text
        elif item.get("type", "word") in ("word", "entity"):
            who = name_of(best.get("speaker", "")) or name_of(item.get("channel", ""))
            row = {"word": text, "start": item.get("start_time"), "end": item.get("end_time")}
            words.append(row | {"speaker": "" if who == "UU" else who})  # UU: nobody it knows
    add_words(out, words, "", "results")
    return out.finished()
