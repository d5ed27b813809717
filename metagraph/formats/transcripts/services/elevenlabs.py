"""ElevenLabs: the words of Scribe, in seconds; and the characters of spoken text with their times, seconds
(`character_start_times_seconds`) or, in a stream, milliseconds (`charStartTimesMs`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from metagraph.common.wording import phrase
from metagraph.formats.transcripts.json_files import add_words
from metagraph.formats.transcripts.json_values import list_of, parse_json_seconds, parse_text, require_dict
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.words import Collected, Transcript

_ALIGNED = ("alignment", "normalized_alignment", "normalizedAlignment")
_PAUSE = 0.04  # seconds between two parts of a stream that end a word
_CHARACTERS = ("characters", "chars")


def _has_characters(value: Any) -> bool:
    return isinstance(value, dict) and any(k in value for k in _CHARACTERS)


def is_elevenlabs(source: TranscriptSource) -> bool:
    some = source.data if isinstance(source.data, list) else [source.data]
    if any(_alignment(one) is not None for one in some[:3]):
        return True
    words = source.data.get("words") if isinstance(source.data, dict) else None
    first = words[0] if isinstance(words, list) and words else None
    return isinstance(first, dict) and first.get("type") in ("word", "spacing", "audio_event")


def _alignment(one: Any) -> Mapping[str, Any] | None:
    if not isinstance(one, dict):
        return None
    if _has_characters(one) and any(k.startswith(("character_start", "charStart")) for k in one):
        return one
    return next((one[k] for k in _ALIGNED if _has_characters(one.get(k))), None)


def read_elevenlabs(source: TranscriptSource) -> Transcript:
    """Read words, or characters joined to words at their blanks; parts of a stream follow each other. Raises
    FileError.
    """
    out = Collected(source.path)
    some = source.data if isinstance(source.data, list) else [source.data]
    parts = [found for one in some if (found := _alignment(one)) is not None]
    if not parts:
        rows = list_of(out, source.data["words"], "words")
        words = [w for w in rows if not (isinstance(w, dict) and w.get("type") in ("spacing", "audio_event"))]
        add_words(out, words, "", "words")
        return out.finished()
    before = 0.0
    characters: list[tuple[str, float, float]] = []
    for n, part in enumerate(parts):
        own = list(_characters(out, part, f"alignment {n + 1}"))
        late = before if characters and own and own[0][1] < characters[-1][1] else 0.0
        if characters and own and own[0][1] + late > characters[-1][2] + _PAUSE:
            characters.append((" ", own[0][1] + late, own[0][1] + late))
        characters += [(c, start + late, end + late) for c, start, end in own]
        before = max(before, characters[-1][2]) if characters else before
    held: list[tuple[str, float, float]] = []
    for one in [*characters, (" ", 0.0, 0.0)]:
        if one[0].strip():
            held.append(one)
        elif held:
            out.add("", "".join(c for c, _, _ in held), held[0][1], held[-1][2], "'alignment'")
            held = []
    return out.finished()


def _characters(out: Collected, part: Mapping[str, Any], where: str) -> Iterator[tuple[str, float, float]]:
    one = require_dict(out, part, where)
    letters = list_of(out, one.get("characters", one.get("chars")), where)
    if "charStartTimesMs" in one:
        unit = 1e-3
        starts = list_of(out, one["charStartTimesMs"], where)
        lengths = list_of(out, one.get("charDurationsMs", one.get("charsDurationsMs")), where)
        ends = [a + b for a, b in zip(starts, lengths, strict=False) if _number(a) and _number(b)]
    else:
        unit = 1.0
        starts = list_of(out, one.get("character_start_times_seconds"), where)
        ends = list(list_of(out, one.get("character_end_times_seconds"), where))
    if not len(letters) == len(starts) == len(ends):
        raise out.fail(
            phrase(
                "has {letters} characters, {starts} starts and {ends} ends",
                letters=len(letters),
                starts=len(starts),
                ends=len(ends),
            ),
            where,
        )
    for n, (letter, start, end) in enumerate(zip(letters, starts, ends, strict=True)):
        begin, until = (parse_json_seconds(out, t, f"{where}[{n}]", unit) for t in (start, end))
        if begin is None or until is None:
            raise out.fail(phrase("has no start and end"), f"{where}[{n}]")
        yield parse_text(letter), begin, until


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
