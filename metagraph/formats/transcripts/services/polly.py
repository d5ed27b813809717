"""Amazon Polly's speech marks: an object a line, `time` in milliseconds; a word ends where the next mark of a
word begins.
"""

from __future__ import annotations

from itertools import pairwise

from metagraph.common.wording import phrase
from metagraph.formats.transcripts.json_values import parse_json_seconds, parse_text, require_dict
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.words import Collected, Transcript

_LAST = 0.07  # seconds a letter of the last word, where the sound does not say when it ends


def is_polly(source: TranscriptSource) -> bool:
    return {"time", "type", "value"} <= source.keys


def read_polly(source: TranscriptSource) -> Transcript:
    """Read the marks of words. Raises FileError."""
    out = Collected(source.path)
    rows: list[tuple[float, str]] = []
    ends = 0.0
    for n, item in enumerate(source.data if isinstance(source.data, list) else [source.data]):
        one = require_dict(out, item, f"[{n}]")
        time = parse_json_seconds(out, one.get("time"), f"[{n}]", 1e-3)
        if time is None:
            raise out.fail(phrase("has no time"), f"[{n}]")
        ends = max(ends, time)
        if one.get("type") == "word":
            rows.append((time, parse_text(one.get("value"))))
    if not rows:
        raise out.fail(
            phrase("it has no marks of words"), "", phrase("Request speech marks of type 'word' from Polly.")
        )
    last = rows[-1]
    rows.append((max(ends, last[0] + _LAST * (len(last[1]) + 1)), ""))
    for (start, text), (end, _) in pairwise(rows):
        out.add("", text, start, end, whole=True)
    out.notes.append(phrase("its words have no ends: each ends where the next begins"))
    return out.finished()
