"""Subtitles, WebVTT and SubRip (SRT), NIST's CTM, and tables of words, as transcripts.

Cues hold sentences: their words share the cue's time by their letters, unless WebVTT gives words times of
their own. Who speaks, a voice tag (`<v Ann>`), a name before a colon, or one in brackets where most cues
begin with some ("[Ann] so", "(SPEAKER_00) so"), tells; cues that name nobody go on with who spoke before.
"""

from __future__ import annotations

import html
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from metagraph.common.wording import phrase
from metagraph.formats.transcripts.words import Collected, Transcript

_TIME = r"(?:(\d{1,4}):)?(\d{1,2}):(\d{1,2})[.,](\d{1,3})"
_CUE = re.compile(rf"\s*{_TIME}\s*-->\s*{_TIME}(?:\s.*)?$")
_INSIDE = re.compile(rf"<{_TIME}>")
_VOICE = re.compile(r"<v(?:\.[^\s>]*)?\s+([^>]{1,200})>")
_TAG = re.compile(r"</?[a-zA-Z][^<>]{0,300}>|\{\\[^{}]{0,100}\}")
_MARKS = "\u0300-\u036f\u0900-\u109f\u0e00-\u0eff"  # of vowels: none of them is a letter to a pattern
_NAME = re.compile(rf"\s*(?:[-–>]{{1,2}}\s*)?([^\W\d_][\w .'’{_MARKS}-]{{0,38}}?)\s*(?::\s+|：\s*)(?=\S)")
_BRACKETED = re.compile(rf"\s*[\[(]\s*([^\W\d_][\w .'’{_MARKS}-]{{0,38}}?)\s*[\])]\s*(?::\s*)?(?=\S)")
_DASH = re.compile(r"^\s*(?:[-–]|>{1,2})\s*")


@dataclass
class _Cue:
    line: int
    start: float
    end: float
    text: list[str]


def read_cues(path: Path, text: str) -> Transcript:
    """Read WebVTT or SRT. Raises FileError."""
    out = Collected(path)
    cues = list(_cues(out, text))
    timed = any(_INSIDE.search(line) for cue in cues for line in cue.text)
    names = _in_brackets(cues) or _before_colons(cues)
    speaker, shown = "", ""
    for cue in cues:
        lines = [x for x in cue.text if x.strip()]
        if timed and len(lines) > 1 and not _INSIDE.search(lines[0]) and _plain(lines[0]) == shown:
            lines = lines[1:]  # captions that roll up show the line before again
        elif timed and len(lines) == 1 and not _INSIDE.search(lines[0]) and _plain(lines[0]) == shown:
            continue
        for n, (start, end, part) in enumerate(_shared(cue, lines)):
            for who, said in _voices(part, names):
                speaker = who if who is not None else speaker
                _add(out, speaker, said, start, end, f"line {cue.line + 1 + n}")
        shown = _plain(lines[-1]) if lines else shown
    if not cues:
        out.notes.append(phrase("it has no cues"))
    return out.finished()


def _cues(out: Collected, text: str) -> Iterator[_Cue]:
    lines = text.split("\n")
    rolls = lines[0].lstrip("\ufeff").startswith("WEBVTT")  # there a line of blanks is a line of the cue
    n = 0
    while n < len(lines):
        if "-->" not in lines[n]:
            n += 1
            continue
        if lines[n].startswith(("NOTE", "STYLE")):
            n += 1
            continue
        found = _CUE.match(lines[n])
        if found is None:
            raise out.fail(
                phrase(
                    "'{value}' are not the times of a cue, such as 00:00:01.500 --> 00:00:04.000",
                    value=lines[n].strip()[:60],
                ),
                phrase("line {n}", n=n + 1),
            )
        times = found.groups()
        cue = _Cue(n + 1, _seconds(*times[:4]), _seconds(*times[4:]), [])
        if cue.end < cue.start:
            raise out.fail(
                phrase(
                    "a cue ends at {end:g} s, before it starts at {start:g} s", end=cue.end, start=cue.start
                ),
                phrase("line {n}", n=n + 1),
            )
        n += 1
        while n < len(lines) and (lines[n] if rolls else lines[n].strip()) and "-->" not in lines[n]:
            cue.text.append(lines[n])
            n += 1
        if n < len(lines) and "-->" in lines[n] and cue.text and cue.text[-1].strip().isdigit():
            cue.text.pop()  # the next one's number, no blank line before it
        yield cue


def _seconds(hours: str | None, minutes: str, seconds: str, rest: str) -> float:
    return int(hours or 0) * 3600 + int(minutes) * 60 + int(seconds) + float(f"0.{rest}")


def _plain(text: str) -> str:
    return " ".join(html.unescape(_TAG.sub("", _INSIDE.sub("", text))).split())


@dataclass(frozen=True)
class _Names:
    """Who speaks by what a line begins with, and how it is written there: `way` has the name in its group."""

    way: re.Pattern[str]
    known: frozenset[str]

    def of(self, line: str) -> tuple[str, str] | None:
        """Return who says a line, and the rest of it; None if it begins with no name."""
        plain = _TAG.sub("", line)
        found = self.way.match(plain)
        return (found[1], plain[found.end() :]) if found is not None and found[1] in self.known else None


def _in_brackets(cues: list[_Cue]) -> _Names | None:
    """Return the names in brackets that at least half of all cues begin with; a "[laughter]" now and then is
    none.
    """
    firsts = [_BRACKETED.match(_TAG.sub("", cue.text[0])) for cue in cues if cue.text]
    found = {m[1] for m in firsts if m is not None}
    often = 2 * sum(m is not None for m in firsts) >= len(firsts)
    return _Names(_BRACKETED, frozenset(found)) if often and 1 < len(found) <= 12 else None


def _before_colons(cues: list[_Cue]) -> _Names:
    """Return the names that stand before a colon: those that come again, or beside others; a single "Note:
    ..." is none.
    """
    found = Counter(m.group(1) for cue in cues for line in cue.text if (m := _NAME.match(_TAG.sub("", line))))
    known = frozenset(
        found if len(found) > 1 and len(found) <= 12 else (name for name, times in found.items() if times > 1)
    )
    return _Names(_NAME, known)


def _shared(cue: _Cue, lines: list[str]) -> list[tuple[float, float, str]]:
    """Return the lines of a cue, each with its share of the cue's time by its letters; lines with times
    inside go on from those.
    """
    sizes = [len(_plain(x)) + 1 for x in lines]
    timed = any(_INSIDE.search(x) for x in lines)
    if timed or len(lines) < 2:
        return [(cue.start, cue.end, "\n".join(lines))] if lines else []
    out, at = [], cue.start
    for line, size in zip(lines, sizes, strict=True):
        end = at + (cue.end - cue.start) * size / sum(sizes)
        out.append((at, end, line))
        at = end
    return out


def _voices(text: str, names: _Names) -> Iterator[tuple[str | None, str]]:
    """Yield who says which part; None if it does not say."""
    parts = _VOICE.split(text)
    for n in range(0, len(parts), 2):
        who = html.unescape(parts[n - 1]).strip() if n else None
        said = parts[n]
        if who is None and (named := names.of(said)) is not None:
            who, said = named
        if said.strip():
            yield who, _DASH.sub("", said)


def _add(out: Collected, speaker: str, text: str, start: float, end: float, where: str) -> None:
    """Add a text, its words from the times inside where it has some."""
    pieces: list[tuple[float, str]] = []
    at, last = start, 0
    for found in _INSIDE.finditer(text):
        pieces.append((at, text[last : found.start()]))
        at, last = min(max(_seconds(*found.groups()), start), end), found.end()
    pieces.append((at, text[last:]))
    for n, (begin, piece) in enumerate(pieces):
        if said := _plain(piece):
            until = next((b for b, _ in pieces[n + 1 :]), end)
            out.add(speaker, said, begin, max(until, begin), where)


# --- CTM


def is_ctm(text: str) -> bool:
    """Whether the first line that is no comment is one of CTM: recording, channel, start, duration, word."""
    for line in text.split("\n")[:1000]:
        if line.strip() and not line.lstrip().startswith((";;", "#")):
            return _ctm(line) is not None
    return False


def _ctm(line: str) -> tuple[str, str, float, float, str] | None:
    cells = line.split()
    if len(cells) < 5:
        return None
    try:
        start, length = float(cells[2]), float(cells[3])
    except ValueError:
        return None
    return cells[0], cells[1], start, length, cells[4]


def read_ctm(path: Path, text: str) -> Transcript:
    """Read NIST's time-marked words. A channel, or else a recording, is a speaker. Raises FileError."""
    out = Collected(path)
    rows = []
    for n, line in enumerate(text.split("\n")):
        if not line.strip() or line.lstrip().startswith((";;", "#")):
            continue
        row = _ctm(line)
        if row is None:
            raise out.fail(
                phrase("has no recording, channel, start, duration and word"), phrase("line {n}", n=n + 1)
            )
        if not row[3] >= 0:
            raise out.fail(phrase("a word lasts {row:g} s", row=row[3]), phrase("line {n}", n=n + 1))
        rows.append((n, row))
    recordings, channels = len({r[0] for _, r in rows}), len({r[1] for _, r in rows})
    for n, (recording, channel, start, length, word) in rows:
        who = channel if recordings < 2 else recording if channels < 2 else f"{recording} {channel}"
        out.add(who if recordings * channels > 1 else "", word, start, start + length, f"line {n + 1}")
    return out.finished()


# --- a table of words


def is_word_table(text: str) -> bool:
    """Whether the first line that is not empty is one of a table: start, end, words, parted by tabs."""
    line = next((x for x in text.split("\n")[:1000] if x.strip()), "")
    return _table_row(line) is not None


def _table_row(line: str) -> tuple[float, float, str] | None:
    cells = line.split("\t")
    if len(cells) != 3:
        return None
    try:
        return float(cells[0]), float(cells[1]), cells[2]
    except ValueError:
        return None


def read_word_table(path: Path, text: str) -> Transcript:
    """Read a line a word, start and end in seconds, as GENEA's transcripts are. Raises FileError."""
    out = Collected(path)
    for n, line in enumerate(text.split("\n")):
        if not line.strip():
            continue
        row = _table_row(line)
        if row is None:
            raise out.fail(
                phrase("has no start, end and word, separated by tabs"), phrase("line {n}", n=n + 1)
            )
        out.add("", row[2], row[0], row[1], f"line {n + 1}")
    return out.finished()
