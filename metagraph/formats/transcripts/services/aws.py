"""Amazon Transcribe's output: results.items[], times as texts in seconds; and Call Analytics' Transcript[],
in milliseconds.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from metagraph.common.wording import phrase
from metagraph.formats.transcripts.json_files import add_words
from metagraph.formats.transcripts.json_values import (
    list_row_dicts,
    name_of,
    parse_json_seconds,
    parse_text,
    require_dict,
)
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.words import Collected, Transcript


def is_aws(source: TranscriptSource) -> bool:
    data = source.data
    if not isinstance(data, dict):
        return False
    results = data.get("results")
    plain = isinstance(results, dict) and bool({"items", "transcripts"} & set(results))
    return plain or isinstance(data.get("Transcript"), list)


def read_aws(source: TranscriptSource) -> Transcript:
    """Read items by their speaker label, else by their channel. Marks stay with the word before them. Raises
    FileError.
    """
    out = Collected(source.path)
    if "Transcript" in source.data:
        return _analytics(out, source.data)
    results = require_dict(out, source.data["results"], "results")
    channels = require_dict(out, results.get("channel_labels") or {}, "results.channel_labels")
    several = list(list_row_dicts(out, channels, "channels", "results.channel_labels"))
    if several:
        for where, channel in several:
            _items(out, channel, name_of(channel.get("channel_label", "")), {}, where)
        return out.finished()
    labels: dict[str, str] = {}
    known = require_dict(out, results.get("speaker_labels") or {}, "results.speaker_labels")
    for where, segment in list_row_dicts(out, known, "segments", "results.speaker_labels"):
        for _, item in list_row_dicts(out, segment, "items", where):
            labels[name_of(item.get("start_time", ""))] = name_of(item.get("speaker_label", ""))
    _items(out, results, "", labels, "results")
    return out.finished()


def _items(
    out: Collected, data: Mapping[str, Any], speaker: str, labels: Mapping[str, str], where: str
) -> None:
    words: list[dict[str, Any]] = []
    for place, item in list_row_dicts(out, data, "items", where):
        best = next((one for _, one in list_row_dicts(out, item, "alternatives", place)), {})
        text = parse_text(best.get("content"))
        if item.get("type") == "punctuation" or item.get("start_time") is None:
            if words:
                words[-1]["word"] += text
            continue
        start = item["start_time"]
        who = name_of(item.get("speaker_label", "")) or labels.get(name_of(start), "") or speaker
        words.append({"word": text, "start": start, "end": item.get("end_time"), "speaker": who})
    if words:
        add_words(out, words, speaker, f"{where}.items")


def _analytics(out: Collected, data: Mapping[str, Any]) -> Transcript:
    for where, turn in list_row_dicts(out, data, "Transcript"):
        who = name_of(turn.get("ParticipantRole", turn.get("ParticipantId", "")))
        words: list[dict[str, Any]] = []
        for place, item in list_row_dicts(out, turn, "Items", where):
            text = parse_text(item.get("Content"))
            if item.get("Type") == "punctuation":
                if words:
                    words[-1]["word"] += text
                continue
            start, end = (
                parse_json_seconds(out, item.get(f"{k}OffsetMillis"), place, 1e-3) for k in ("Begin", "End")
            )
            words.append({"word": text, "start": start, "end": end})
        if words:
            add_words(out, words, who, f"{where}.Items")
            continue
        start, end = (
            parse_json_seconds(out, turn.get(f"{k}OffsetMillis"), where, 1e-3) for k in ("Begin", "End")
        )
        if start is None or end is None:
            raise out.fail(phrase("has no start and end"), where)
        out.add(who, parse_text(turn.get("Content")), start, end, where)
    return out.finished()
