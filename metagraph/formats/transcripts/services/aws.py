"""Amazon Transcribe's output: results.items[], times as texts in seconds; and Call Analytics' Transcript[],
in milliseconds.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from metagraph.common.wording import phrase
from metagraph.formats.transcripts.json_files import add_words
from metagraph.formats.transcripts.json_values import dict_of, name_of, rows_of, seconds_of, text_of
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
    results = dict_of(out, source.data["results"], "results")
    channels = dict_of(out, results.get("channel_labels") or {}, "results.channel_labels")
    several = list(rows_of(out, channels, "channels", "results.channel_labels"))
    if several:
        for where, channel in several:
            _items(out, channel, name_of(channel.get("channel_label", "")), {}, where)
        return out.finished()
    labels: dict[str, str] = {}
    known = dict_of(out, results.get("speaker_labels") or {}, "results.speaker_labels")
    for where, segment in rows_of(out, known, "segments", "results.speaker_labels"):
        for _, item in rows_of(out, segment, "items", where):
            labels[name_of(item.get("start_time", ""))] = name_of(item.get("speaker_label", ""))
    _items(out, results, "", labels, "results")
    return out.finished()


def _items(
    out: Collected, data: Mapping[str, Any], speaker: str, labels: Mapping[str, str], where: str
) -> None:
    words: list[dict[str, Any]] = []
    for place, item in rows_of(out, data, "items", where):
        best = next((one for _, one in rows_of(out, item, "alternatives", place)), {})
        text = text_of(best.get("content"))
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
    for where, turn in rows_of(out, data, "Transcript"):
        who = name_of(turn.get("ParticipantRole", turn.get("ParticipantId", "")))
        words: list[dict[str, Any]] = []
        for place, item in rows_of(out, turn, "Items", where):
            text = text_of(item.get("Content"))
            if item.get("Type") == "punctuation":
                if words:
                    words[-1]["word"] += text
                continue
            start, end = (
                seconds_of(out, item.get(f"{k}OffsetMillis"), place, 1e-3) for k in ("Begin", "End")
            )
            words.append({"word": text, "start": start, "end": end})
        if words:
            add_words(out, words, who, f"{where}.Items")
            continue
        start, end = (seconds_of(out, turn.get(f"{k}OffsetMillis"), where, 1e-3) for k in ("Begin", "End"))
        if start is None or end is None:
            raise out.fail(phrase("has no start and end"), where)
        out.add(who, text_of(turn.get("Content")), start, end, where)
    return out.finished()
