"""Deepgram's pre-recorded transcripts: results.channels[].alternatives[0].words[], in seconds."""

from __future__ import annotations

from metagraph.formats.transcripts.json_files import add_words
from metagraph.formats.transcripts.json_values import (
    list_of,
    list_row_dicts,
    name_of,
    parse_text,
    require_dict,
)
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.words import Collected, Transcript


def is_deepgram(source: TranscriptSource) -> bool:
    results = source.data.get("results") if isinstance(source.data, dict) else None
    return isinstance(results, dict) and bool({"channels", "utterances"} & set(results))


def read_deepgram(source: TranscriptSource) -> Transcript:
    """Read a channel, or a speaker within it, as a speaker. Raises FileError."""
    out = Collected(source.path)
    results = require_dict(out, source.data["results"], "results")
    channels = list(list_row_dicts(out, results, "channels", "results"))
    for n, (where, channel) in enumerate(channels):
        for place, best in list(list_row_dicts(out, channel, "alternatives", where))[:1]:
            words = list_of(out, best.get("words") or [], f"{place}.words")
            own = [name_of(w.get("speaker", "")) for w in words if isinstance(w, dict)]
            if len(channels) > 1:
                told = len(set(own)) > 1
                words = [
                    {**w, "speaker": f"{n} {name_of(w.get('speaker', ''))}" if told else str(n)}
                    if isinstance(w, dict)
                    else w
                    for w in words
                ]
            add_words(out, words, "", f"{place}.words")
    if not channels:
        for where, one in list_row_dicts(out, results, "utterances", "results"):
            speaker = name_of(one.get("speaker", ""))
            if one.get("words"):
                add_words(out, list_of(out, one["words"], f"{where}.words"), speaker, f"{where}.words")
            else:
                add_words(out, [{**one, "word": parse_text(one.get("transcript"))}], speaker, where)
    return out.finished()
