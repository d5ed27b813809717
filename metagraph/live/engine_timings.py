"""The times that speech synthesisers send, as their services have them, turned into those of the request
`say`: Cartesia's and ElevenLabs' lists beside each other, words whose times are called otherwise, Azure's
frames of blend shapes, phones in IPA, ARPAbet or SAMPA, and mouth shapes of Rhubarb.

Only the form changes. What is wrong with the times is found where the request is read.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from metagraph.formats.transcripts.json_values import parse_json_number, timed_row_of
from metagraph.graph.face.arkit import ARKIT
from metagraph.playback.life import line_timing
from metagraph.speech.mouth_files.model import RHUBARB
from metagraph.speech.phones import find_visemes, is_arpabet

AZURE_RATE = 60.0  # frames of blend shapes a second
TICKS = 1e7  # a second, in which Azure counts
LAST = 0.12  # seconds of a phone after which nothing comes
SHAPES = {"PP", "FF", "DD", "SS", "RR", "kk", "nn"}  # visemes of Oculus that are no phones
PHONES = ("ipa", "arpabet", "sampa")  # sets of phones, beside those of visemes
_ALIGNMENTS = ("alignment", "normalizedAlignment", "normalized_alignment")
_LISTS = (  # text, start, end, length of lists beside each other; thousandths of a second where it says Ms
    ("words", "start", "end", ""),
    ("phonemes", "start", "end", ""),
    ("characters", "character_start_times_seconds", "character_end_times_seconds", ""),
    ("chars", "charStartTimesMs", "", "charDurationsMs"),
    ("chars", "charStartTimesMs", "", "charsDurationsMs"),
    ("characters", "characterStartTimesMs", "", "characterDurationsMs"),
)


def adopt_engine_timing(fields: dict[str, Any]) -> bool:
    """Change the fields of a `say` to its own where they are a service's; return whether any were."""
    before = {name: fields.get(name) for name in ("words", "characters", "visemes", "set")}
    size = len(fields)
    for name in _ALIGNMENTS:
        found = fields.pop(name, None)
        if found is not None and "characters" not in fields:
            fields["characters"] = found
    for name, own in (("word_timestamps", "words"), ("phoneme_timestamps", "visemes")):
        if name in fields and own not in fields:
            fields[own] = fields.pop(name)
    for name in ("words", "characters"):
        if name in fields:
            fields[name] = _adopt_rows(fields[name])
    if "visemes" in fields:
        _adopt_visemes(fields)
    return size != len(fields) or any(fields.get(name) is not value for name, value in before.items())


def _adopt_rows(value: Any) -> Any:
    """Return words or letters as rows; the same value if they are, or are nothing known."""
    if isinstance(value, Mapping):
        return _side_by_side(value) or value
    if not isinstance(value, Sequence) or isinstance(value, str):
        return value
    rows = [_adopt_word(row) for row in value]
    return rows if any(new is not old for new, old in zip(rows, value, strict=True)) else value


def _side_by_side(lists: Mapping[str, Any]) -> list[Any] | None:
    """Return rows of lists that lie beside each other; None if there are none of one length."""
    for text, start, end, length in _LISTS:
        columns = [lists.get(name) for name in (text, start, end or length)]
        if all(isinstance(column, list) for column in columns) and len({len(c or ()) for c in columns}) == 1:
            unit = 1e-3 if start.endswith("Ms") else 1.0
            rows = []
            for word, begin, last in zip(*(column or () for column in columns), strict=True):
                times = parse_json_number(begin), parse_json_number(last)
                if times[0] is None or times[1] is None:
                    return None
                stop = times[1] if end else times[0] + times[1]
                rows.append([word, times[0] * unit, stop * unit])
            return rows
    return None


def _adopt_word(row: Any) -> Any:
    """Return a word as text, start and end; the same row if it is known as it is."""
    if not isinstance(row, Mapping) or "type" in row or "audioOffset" in row:
        return row
    if "Offset" in row and "Duration" in row:  # Azure's detailed results
        start, length = parse_json_number(row["Offset"]), parse_json_number(row["Duration"])
        if start is not None and length is not None:
            return [row.get("Word", row.get("Text")), start / TICKS, (start + length) / TICKS]
    timed = timed_row_of(row)
    start, end = parse_json_number(timed.start), parse_json_number(timed.end)
    plain = {"word", "text", "character"} & set(row) and "start" in row and "punctuated_word" not in row
    if plain or start is None or not timed.text:
        return row
    unit = 1e-3 if timed.milliseconds else 1.0
    if end is None and (length := parse_json_number(timed.length)) is not None:
        end = start + length
    return [timed.text, start * unit, None if end is None else end * unit]


def _adopt_visemes(fields: dict[str, Any]) -> None:
    value = fields["visemes"]
    if isinstance(value, Mapping):
        if isinstance(value.get("BlendShapes"), list):
            value = [value]
        elif (rows := _side_by_side(value)) is not None:
            value = [[start, phone, end] for phone, start, end in rows]
            fields["visemes"] = _spread_phones(value, fields)
            return
    if not isinstance(value, Sequence) or isinstance(value, str) or not value:
        return
    if any(isinstance(row, Mapping) and isinstance(row.get("BlendShapes"), list) for row in value):
        fields["visemes"] = [frame for row in value for frame in _list_frames(row)]
        fields["set"] = "arkit"
        return
    cues = [_cue_of(row) for row in value]
    if all(cue is not None for cue in cues):
        known = [cue for cue in cues if cue is not None]
        given = fields.get("set")
        shaped = all(name in RHUBARB for _, name, _ in known)  # "E" and "O" are visemes elsewhere
        if given == "rhubarb" or (
            given is None and shaped and all(isinstance(row, Mapping) for row in value)
        ):
            if shaped:
                fields["visemes"], fields["set"] = _show_cues(known), "oculus"
            return
        marks = [line_timing.VisemeMark(0.0, name, 1.0) for _, name, _ in known]
        if given in PHONES or (given is None and not line_timing.set_of(marks) and _are_phones(known)):
            fields["visemes"] = _spread_phones([list(cue) for cue in known], fields)


def _cue_of(row: Any) -> tuple[float, str, float | None] | None:
    """Return start, name and end of a shape or phone; None for what is none, or has a weight."""
    if isinstance(row, Mapping):
        if "type" in row or "audioOffset" in row or "weight" in row or "weights" in row:
            return None
        timed = timed_row_of(row)
        name = timed.text or row.get("viseme") or row.get("phone") or row.get("phoneme") or ""
        start = parse_json_number(timed.start if timed.start is not None else row.get("time"))
        end = parse_json_number(timed.end)
        unit = 1e-3 if timed.milliseconds else 1.0
        if start is None or not isinstance(name, str):
            return None
        return start * unit, name, None if end is None else end * unit
    if isinstance(row, Sequence) and len(row) == 2 and isinstance(row[1], str):
        start = parse_json_number(row[0])
        return None if start is None else (start, row[1], None)
    return None


def _are_phones(cues: Sequence[tuple[float, str, float | None]]) -> bool:
    """Return whether names are phones: ARPAbet's, or nearly all of them short and with a mouth shape."""
    names = [name for _, name, _ in cues if name.strip() not in ("", "sil", "sp", "pau")]
    if not SHAPES.isdisjoint(names):
        return False
    if is_arpabet(names):
        return True
    known = sum(bool(find_visemes(name, False)[0]) for name in names)
    short = all(sum(c.isascii() and c.isalpha() for c in name) <= 2 and len(name) <= 6 for name in names)
    return bool(names) and known >= 0.75 * len(names) and short


def _spread_phones(cues: Sequence[Sequence[Any]], fields: dict[str, Any]) -> list[Any]:
    """Return the visemes of phones, [start, name, end or None] each; diphthongs share their time."""
    fields["set"] = "oculus"
    arpabet = is_arpabet([str(name) for _, name, *_ in cues])
    out: list[Any] = []
    for n, (start, name, end) in enumerate(cues):
        until = end if end is not None else cues[n + 1][0] if n + 1 < len(cues) else start + LAST
        shapes, weight = find_visemes(str(name), arpabet)
        step = max(until - start, 0.0) / max(1, len(shapes))
        out += [[round(start + step * k, 6), shape, weight] for k, shape in enumerate(shapes)]
        gap = n + 1 == len(cues) or cues[n + 1][0] > until + 1e-6
        if not shapes or (end is not None and gap) or n + 1 == len(cues):
            out.append([start if not shapes else until, "sil"])
    return out


def _show_cues(cues: Sequence[tuple[float, str, float | None]]) -> list[Any]:
    out: list[Any] = [[start, RHUBARB[name]] for start, name, _ in cues]
    last = cues[-1]
    return out if last[2] is None else [*out, [last[2], "sil"]]


def _list_frames(row: Any) -> list[Any]:
    """Return the weights of the mouth in Azure's frames, each with its time."""
    if not isinstance(row, Mapping) or not isinstance(row.get("BlendShapes"), list):
        return [row]
    first = parse_json_number(row.get("FrameIndex", 0)) or 0.0
    out: list[Any] = []
    for n, frame in enumerate(row["BlendShapes"]):
        if not isinstance(frame, list) or len(frame) < len(ARKIT):
            return [row]
        weights = {
            name: min(1.0, max(0.0, value))
            for name, given in zip(ARKIT, frame, strict=False)
            if name in line_timing.ARKIT and (value := parse_json_number(given)) is not None
        }
        out.append({"time": round((first + n) / AZURE_RATE, 6), "weights": weights})
    return out
