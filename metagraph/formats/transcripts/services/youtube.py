"""YouTube's captions as its player gets them (json3): events with segments, milliseconds."""

from __future__ import annotations

from itertools import pairwise

from metagraph.formats.transcripts.json_values import list_row_dicts, parse_json_seconds, parse_text
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.words import Collected, Transcript

_LAST = 0.07  # seconds a letter of the last word, where nothing says when it ends


def is_youtube(source: TranscriptSource) -> bool:
    if "events" not in source.keys:
        return False
    events = source.data["events"]
    first = events[:50] if isinstance(events, list) else []
    return "wireMagic" in source.keys or any(isinstance(e, dict) and "tStartMs" in e for e in first)


def read_youtube(source: TranscriptSource) -> Transcript:
    """Read each segment once, until the next begins or its event ends. Raises FileError."""
    out = Collected(source.path)
    rows: list[tuple[float, float, str, str]] = []
    for where, event in list_row_dicts(out, source.data, "events"):
        start = parse_json_seconds(out, event.get("tStartMs", 0), where, 1e-3) or 0.0
        length = parse_json_seconds(out, event.get("dDurationMs", 0), where, 1e-3) or 0.0
        for place, segment in list_row_dicts(out, event, "segs", where):
            text = parse_text(segment.get("utf8"))
            late = parse_json_seconds(out, segment.get("tOffsetMs", 0), place, 1e-3) or 0.0
            if text.strip():
                rows.append((start + late, start + length, text, place))
    rows.sort(key=lambda row: row[0])
    for (start, until, text, place), (after, _, _, _) in pairwise([*rows, (float("inf"), 0.0, "", "")]):
        end = min(until if until > start else start + _LAST * (len(text) + 1), max(after, start))
        out.add("", text, start, end, place)
    return out.finished()
