"""Chat logs and transcripts of meetings as plain text: a time, a name and what is said, in one line or the
name and time above it. What is said lasts as long as its letters take, at most until the next begins.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from metagraph.common.wording import phrase
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.speaker_names import find_speaker_names
from metagraph.formats.transcripts.words import Collected, Transcript

_DATE = r"(\d{1,4}[./-]\d{1,2}[./-]\d{1,4},?\s+)?"
_CLOCK = r"(?:(\d{1,2}):)?(\d{1,2}):(\d{2}(?:[.,]\d{1,3})?)(?:\s?([AaPp])\.?[Mm]\.?)?"
# [00:01:02] Ann: so / 00:01:02	From Ann : so / 12/01/2026, 10:15 - Ann: so
_LINE = re.compile(rf"\s*[\[(]?{_DATE}{_CLOCK}[\])]?\s*(?:[-–|>]\s*)?(?:From\s+)?(\S.*)$")
_AHEAD = re.compile(rf"\s*(\S[^\[(\n]{{0,60}}?)\s*[\[(]{_CLOCK}[\])]\s*:?\s*(.*)$")  # Ann [00:01:02]: so
_ABOVE = re.compile(rf"\s*([^\W\d][^\n]{{0,60}}?)\s{{2,}}{_CLOCK}\s*$")  # Ann  0:01, and what she says below
_TO = re.compile(r"^(.{1,60}?)\s+to\s+.{1,60}?(\s*:\s)", re.I)  # From Ann to Everyone : so
_BETWEEN = re.compile(r"\s+:\s+")
SPOKEN = 0.07  # seconds a letter where nothing says how long a text lasts; about 14 letters a second


def is_chat_log(source: TranscriptSource) -> bool:
    """Return whether most lines of a text begin with a time of the clock, or have it behind a name."""
    lines = [x for x in source.text.split("\n")[:400] if x.strip()]
    found = sum(_row(x) is not None for x in lines)
    return bool(lines) and 2 * found >= len(lines) and _row(lines[0]) is not None


def _row(line: str) -> tuple[float, str] | None:
    """Return the seconds and the rest of a line that has a time; the rest begins with the name."""
    dated = None
    if (found := _LINE.match(line)) is not None:
        dated, *clock, rest = found.groups()
    elif (ahead := _AHEAD.match(line)) is not None:
        name, *clock, said = ahead.groups()
        rest = f"{name}: {said}"
    elif (above := _ABOVE.match(line)) is not None:
        name, *clock = above.groups()
        rest = f"{name}:"
    else:
        return None
    first, second, third, half = clock
    if first is None and (dated or half):  # of a day, and without seconds
        first, second, third = second, third, "0"
    hours = int(first or 0) % 12 + 12 * (half in "Pp") if half else int(first or 0)
    rest = _BETWEEN.sub(": ", _TO.sub(r"\1\2", rest), count=1)
    return hours * 3600 + float(second.replace(",", ".")) * 60 + float(third.replace(",", ".")), rest


def _messages(source: TranscriptSource) -> Iterator[tuple[int, float, str]]:
    """Yield the line, the time and the text of each message; lines without a time go on with the one
    before.
    """
    held: tuple[int, float, str] | None = None
    for n, line in enumerate(source.text.split("\n")):
        row = _row(line)
        if row is not None:
            if held is not None:
                yield held
            held = (n + 1, *row)
        elif held is not None and line.strip():
            held = (held[0], held[1], f"{held[2]} {line.strip()}")
    if held is not None:
        yield held


def read_chat_log(source: TranscriptSource) -> Transcript:
    """Read a chat log. Times past the length of the sound are those of a day's clock: then they begin at the
    first message. Raises FileError.
    """
    out = Collected(source.path)
    rows = list(_messages(source))
    late = 0.0
    sound = source.sound.seconds
    if sound is not None and rows and rows[-1][1] > sound + 1:
        late = rows[0][1]
        out.notes.append(
            phrase(
                "its times are those of a clock, because the sound lasts {sound:.1f} s; they begin with the "
                "first message",
                sound=sound,
            )
        )
    names = find_speaker_names([[text] for _, _, text in rows])
    speaker = ""
    for n, (line, start, text) in enumerate(rows):
        named = names.part(text)
        said = text if named is None else named[1]
        speaker = speaker if named is None else named[0]
        end = start + SPOKEN * (len(said) + 1)
        if n + 1 < len(rows) and rows[n + 1][1] > start:
            end = min(end, rows[n + 1][1])
        out.add(speaker, said, start - late, end - late, f"line {line}")
    names.tell(out)
    out.notes.append(
        phrase("it says only when texts begin; how long they last is estimated from their letters")
    )
    return out.finished()
