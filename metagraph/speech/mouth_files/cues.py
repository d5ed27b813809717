"""Files of cues: Rhubarb Lip Sync (TSV, XML, JSON, Moho), Papagayo (.pgo, .pg2, Moho), lists of visemes of
Oculus, Amazon Polly and Azure, Gentle's phones, and tables of times and shapes.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any
from xml.parsers import expat

from metagraph.common.wording import phrase
from metagraph.speech.mouth_files.model import MouthCues, MouthFile, MouthShapes, parse_mouth_number

SECONDS, MILLISECONDS, TICKS = (1.0, "seconds"), (1e-3, "milliseconds"), (1e-7, "ticks of 100 nanoseconds")
MOHO_RATE = 24.0  # frames a second that Rhubarb and Papagayo write where they are not asked for others
_RATES = (24.0, 25.0, 30.0, 48.0, 50.0, 60.0, 100.0, 120.0)
_TIMES = ("time", "t", "start", "startTime", "start_time", "begin", "timestamp", "at")
_OFFSETS = ("audioOffset", "AudioOffset", "audio_offset", "offset", "Offset")
_ENDS = ("end", "endTime", "end_time", "stop")
_LENGTHS = ("duration", "dur", "length", "vduration")
_NAMES = (
    "viseme",
    "Viseme",
    "value",
    "visemeId",
    "VisemeId",
    "viseme_id",
    "phoneme",
    "phone",
    "shape",
    "name",
)
_SPLIT = re.compile(r"[\t,; ]+")
_COMMA = re.compile(r"(?<=\d),(?=\d)")


# --- Rhubarb


def is_rhubarb_xml(file: MouthFile) -> bool:
    return "<rhubarbResult" in file.head


def read_rhubarb_xml(file: MouthFile) -> MouthShapes:
    """Read mouthCue elements. Raises FileError."""
    cues = MouthCues(file)
    held: list[dict[str, str]] = []
    texts: list[str] = []
    parser = expat.ParserCreate()

    def begin(name: str, at: dict[str, str]) -> None:
        if name == "mouthCue":
            held.append(at)
            texts.clear()

    def end(name: str) -> None:
        if name == "mouthCue" and held:
            at = held.pop()
            place = phrase("line {lineno}", lineno=parser.CurrentLineNumber)
            cues.add(at.get("start"), at.get("end"), "".join(texts), place)

    def entity(*_: object) -> None:
        raise file.fail(phrase("it defines its own XML entities, which no annotation program does"))

    parser.StartElementHandler, parser.EndElementHandler = begin, end
    parser.CharacterDataHandler, parser.EntityDeclHandler = texts.append, entity
    try:
        parser.Parse(file.text.encode(), True)
    except expat.ExpatError as error:
        cause = phrase("it is not well-formed XML ({cause})", cause=expat.errors.messages[error.code])
        raise file.fail(cause, phrase("line {lineno}", lineno=error.lineno)) from None
    except (LookupError, ValueError) as error:
        raise file.fail(phrase("its text cannot be decoded ({error})", error=error)) from None
    return cues.finished()


# --- Moho's switches, and Papagayo


def is_moho(file: MouthFile) -> bool:
    return file.head.startswith("MohoSwitch")


def read_moho(file: MouthFile) -> MouthShapes:
    """Read lines of a frame, from 1, and a shape. The file does not say how many frames a second there are:
    24, or the next usual rate at which they fit into the sound. Raises FileError.
    """
    cues = MouthCues(file)
    for n, line in enumerate(file.text.split("\n")[1:], 2):
        cells = line.split()
        if cells:
            frame = parse_mouth_number(cells[0])
            start = cells[0] if frame is None else max(frame - 1, 0)
            cues.add(start, None, " ".join(cells[1:]), phrase("line {n}", n=n))
    last = max((start for start, *_ in cues.rows), default=0.0)
    rate = MOHO_RATE
    if file.sound is not None and last / rate > file.sound + 0.5:
        rate = next((r for r in _RATES if last / r <= file.sound + 0.5), rate)
    cues.notes.append(
        phrase("it does not give its frame rate: {rate:g} frames a second were assumed", rate=rate)
    )
    cues.unit = 1 / rate
    return cues.finished()


def is_papagayo(file: MouthFile) -> bool:
    return file.head.startswith("lipsync version")


def read_papagayo(file: MouthFile) -> MouthShapes:
    """Read the phonemes of the first voice of a project: lines of a frame and a shape, four tabs deep. Raises
    FileError.
    """
    cues = MouthCues(file)
    lines = file.text.lstrip("\ufeff \n").split("\n")
    rate = parse_mouth_number(lines[2].strip()) if len(lines) > 4 else None
    if rate is None or not 1 <= rate <= 1000:
        raise file.fail(phrase("it does not give its frame rate"), phrase("line {n}", n=3))
    heads = 0  # a voice begins with three lines at one tab: its name, its text, how many phrases it has
    for n, line in enumerate(lines[5:], 6):
        tabs, cells = len(line) - len(line.lstrip("\t")), line.split()
        heads += tabs == 1
        if tabs == 4 and len(cells) == 2 and heads <= 3:
            cues.add(cells[0], None, cells[1], phrase("line {n}", n=n))
    cues.unit = 1 / rate
    _tell_voices(cues, parse_mouth_number(lines[4].strip()))
    return cues.finished()


def _tell_voices(cues: MouthCues, count: float | None) -> None:
    if count is not None and count > 1:
        cues.notes.append(phrase("it has {count:.0f} voices; the first was read", count=count))


def is_papagayo_ng(file: MouthFile) -> bool:
    return isinstance(file.data, dict) and "voices" in file.data and "fps" in file.data


def read_papagayo_ng(file: MouthFile) -> MouthShapes:
    """Read the phonemes of the first voice of a Papagayo-NG project. Raises FileError."""
    cues = MouthCues(file)
    rate, voices = parse_mouth_number(file.data["fps"]), file.data["voices"]
    if rate is None or not 1 <= rate <= 1000:
        raise file.fail(phrase("it does not give its frame rate"), "'fps'")
    if not isinstance(voices, list) or not voices:
        raise file.fail(phrase("it has no mouth shapes"), "'voices'")
    for n, one in enumerate(_phonemes(voices[0])):
        cues.add(
            one.get("frame", one.get("start")), None, one.get("text"), phrase("shape {number}", number=n + 1)
        )
    cues.unit = 1 / rate
    _tell_voices(cues, float(len(voices)))
    return cues.finished()


def _phonemes(value: Any) -> Iterator[Mapping[str, Any]]:
    """Yield the phonemes in a voice, however deep its phrases and words hold them."""
    waiting = [value]
    while waiting:
        one = waiting.pop()
        if not isinstance(one, dict):
            continue
        for key in ("phonemes", "words", "phrases", "children"):
            some = (
                [x for x in (one.get(key) or []) if isinstance(x, dict)]
                if isinstance(one.get(key), list)
                else []
            )
            if key == "phonemes" or (key == "children" and some and "children" not in some[0]):
                yield from some
            else:
                waiting.extend(reversed(some))


# --- lists of cues in JSON


def _list_in(data: Any) -> list[Any]:
    """Return the list of cues that JSON holds; empty where it holds none."""
    if isinstance(data, dict):
        keys = ("mouthCues", "visemes", "cues", "phonemes", "marks", "events")
        data = next((data[k] for k in keys if isinstance(data.get(k), list)), None)
    return data if isinstance(data, list) else []


def is_cue_list(file: MouthFile) -> bool:
    rows = _list_in(file.data)
    first = next((r for r in rows if not isinstance(r, dict) or r.get("type") in (None, "viseme")), None)
    if isinstance(first, list):
        return 2 <= len(first) <= 3 and parse_mouth_number(first[0]) is not None and isinstance(first[1], str)
    return (
        isinstance(first, dict)
        and any(k in first for k in (*_TIMES, *_OFFSETS))
        and any(k in first for k in _NAMES)
    )


def read_cue_list(file: MouthFile) -> MouthShapes:
    """Read objects with a time and a shape, or pairs of them: Rhubarb's in seconds, Polly's in milliseconds,
    Azure's in ticks; others as they fit the sound. Raises FileError.
    """
    cues = MouthCues(file)
    marks = azure = False
    for n, row in enumerate(_list_in(file.data)):
        where = phrase("shape {number}", number=n + 1)
        if isinstance(row, list) and len(row) >= 2:
            cues.add(row[0], None, row[1], where)
            continue
        if not isinstance(row, dict):
            raise file.fail(phrase("has no time and no name of a shape"), where)
        if row.get("type") not in (None, "viseme"):
            continue
        marks |= row.get("type") == "viseme"
        azure |= any(k in row for k in _OFFSETS)
        start, end, label = (
            next((row[k] for k in keys if row.get(k) is not None), None)
            for keys in ((*_TIMES, *_OFFSETS), _ENDS, _NAMES)
        )
        at = parse_mouth_number(start)
        lasts = next((parse_mouth_number(row[k]) for k in _LENGTHS if row.get(k) is not None), None)
        if end is None and at is not None and lasts is not None:
            end = at + lasts
        cues.add(start, end, label, where)
    if marks:
        cues.choose_unit((MILLISECONDS,), MILLISECONDS[0])
    elif azure:
        cues.choose_unit((TICKS, MILLISECONDS, SECONDS), _azure_unit(cues))
    else:
        cues.choose_unit((SECONDS, MILLISECONDS), SECONDS[0])
    return cues.finished()


def _azure_unit(cues: MouthCues) -> float:
    """Return ticks, as the SDK has them, unless the last is too early for ticks: within a fifth of a
    second.
    """
    last = max((start for start, *_ in cues.rows), default=0.0)
    return TICKS[0] if last * TICKS[0] > 0.2 or last == 0 else MILLISECONDS[0]


# --- Gentle


def is_gentle(file: MouthFile) -> bool:
    words = file.data.get("words") if isinstance(file.data, dict) else None
    return isinstance(words, list) and any(isinstance(w, dict) and "phones" in w for w in words)


def read_gentle(file: MouthFile) -> MouthShapes:
    """Read the phones of words: each lasts its duration from the word's start on. Raises FileError."""
    cues = MouthCues(file)
    for n, word in enumerate(file.data["words"]):
        where = f"words[{n}]"
        phones = word.get("phones") if isinstance(word, dict) else None
        if not isinstance(phones, list) or word.get("start") is None:
            continue
        at = parse_mouth_number(word["start"])
        for one in phones:
            length = parse_mouth_number(one.get("duration")) if isinstance(one, dict) else None
            if at is None or length is None:
                raise file.fail(phrase("has no time"), where)
            cues.add(at, at + length, one.get("phone"), where)
            at += length
    return cues.finished()


# --- tables


def is_cue_table(file: MouthFile) -> bool:
    """Return whether most lines hold a time, perhaps an end, and one word."""
    rows, *_ = _rows_of(file)
    found = sum(_cells(x) is not None for _, x in rows[:200])
    return len(rows) > 1 and found >= len(rows[:200]) - 1


def _rows_of(file: MouthFile) -> tuple[list[tuple[int, str]], bool, bool]:
    """Return the lines that are not empty with their numbers, whether decimal commas became points in them,
    and whether they are an xwaves label file (Festival, ESPS): below a line with # each has when its label
    ends, a colour, and the label.
    """
    rows = [(n, x) for n, x in enumerate(file.text.lstrip("\ufeff").split("\n"), 1) if x.strip()]
    head = next((k for k, (_, x) in enumerate(rows[:20]) if x.strip() == "#"), None)
    if head is not None:
        rows = rows[head + 1 :]
    commas = not any("." in x for _, x in rows) and any(
        _COMMA.search(x) and re.search(r"[\t;]", x) for _, x in rows
    )
    if commas:
        rows = [(n, _COMMA.sub(".", x)) for n, x in rows]
    colours = {x.split()[1] for _, x in rows if len(x.split()) > 1}
    return rows, commas, head is not None and len(colours) == 1 and next(iter(colours)).isdigit()


def _cells(line: str) -> tuple[str, str | None, str] | None:
    cells = [c for c in _SPLIT.split(line.strip()) if c]
    if len(cells) not in (2, 3) or parse_mouth_number(cells[0]) is None:
        return None
    if len(cells) == 3:
        return None if parse_mouth_number(cells[1]) is None else (cells[0], cells[1], cells[2])
    return cells[0], None, cells[1]


def read_cue_table(file: MouthFile) -> MouthShapes:
    """Read lines of a start, perhaps an end or how long it lasts, and a shape or phone, as Rhubarb writes
    TSV; a head is passed over but for the word duration. Of xwaves labels the first number is the end. Raises
    FileError.
    """
    cues = MouthCues(file)
    rows, commas, xwaves = _rows_of(file)
    if commas:
        cues.notes.append(phrase("its decimal commas were read as points"))
    lasts, before = False, "0"
    for n, line in rows:
        cells = _cells(line)
        if cells is None:
            if cues.rows:
                raise file.fail(phrase("has no time and no name of a shape"), phrase("line {n}", n=n))
            head = [c.strip('"').casefold() for c in _SPLIT.split(line.strip())]
            lasts |= len(head) == 3 and head[1] in _LENGTHS
            continue
        start, end, label = cells
        if xwaves:
            start, end, before = before, start, start
        elif lasts and end is not None:
            end = str(float(start) + float(end))
        cues.add(start, end, label, phrase("line {n}", n=n))
    cues.choose_unit((SECONDS, MILLISECONDS, TICKS), SECONDS[0])
    return cues.finished()
