"""Subtitles, WebVTT and SubRip (SRT), as transcripts.

Cues hold sentences: their words share the cue's time by their letters, unless WebVTT gives words times of
their own. A voice tag (`<v Ann>`) or what a line begins with (`speaker_names`) tells who speaks; cues that
name nobody go on with who spoke before.
"""

from __future__ import annotations

import html
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from metagraph.common.wording import phrase, plural_phrase
from metagraph.formats.transcripts.rolling import ShownText, drop_repeats
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.speaker_names import SpeakerNames, find_speaker_names
from metagraph.formats.transcripts.words import Collected, Transcript

_TIME = r"(?:(\d{1,4}):)?(\d{1,2}):(\d{1,2})[.,](\d{1,3})"
_CUE = re.compile(rf"\s*{_TIME}\s*-->\s*{_TIME}(?:\s.*)?$")
_INSIDE = re.compile(rf"<{_TIME}>")
_VOICE = re.compile(r"<v(?:\.[^\s>]*)?\s+([^>]{1,200})>")
_TAG = re.compile(r"</?[a-zA-Z][^<>]{0,300}>|\{\\[^{}]{0,100}\}")
_DASH = re.compile(r"^\s*(?:[-–]|>{1,2})\s*")


@dataclass
class TextCue:
    """A text and when it is shown. line: of the file, from 1. start, end: seconds. text: its lines, with tags
    as WebVTT has them.
    """

    line: int
    start: float
    end: float
    text: list[str]


def is_cues(source: TranscriptSource) -> bool:
    """Return whether a text is WebVTT or SRT."""
    return source.head.startswith("WEBVTT") or "-->" in source.text


def read_cues(source: TranscriptSource) -> Transcript:
    """Read WebVTT or SRT. Raises FileError."""
    out = Collected(source.path)
    return collect_cues(out, list(_cues(out, source.text)))


def collect_cues(out: Collected, cues: Sequence[TextCue]) -> Transcript:
    """Return the transcript of cues. Raises FileError."""
    shown, repeats = drop_repeats([_shown(cue) for cue in cues])
    if repeats:
        out.notes.append(
            plural_phrase(
                "{count:,} cue shows again what was said before; each word is read once",
                "{count:,} cues show again what was said before; each word is read once",
                repeats,
            )
        )
    names = find_speaker_names([cue.plain for cue in shown])
    names.tell(out)
    speaker = ""
    for cue in shown:
        for n, (start, end, part) in enumerate(_shared(cue, names)):
            for who, said in _voices(part, names):
                speaker = who if who is not None else speaker
                _add(out, speaker, said, start, end, f"line {cue.line + 1 + n}")
    if not cues:
        out.notes.append(phrase("it has no cues"))
    return out.finished()


def _cues(out: Collected, text: str) -> Iterator[TextCue]:
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
        cue = TextCue(n + 1, _seconds(*times[:4]), _seconds(*times[4:]), [])
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


def _shown(cue: TextCue) -> ShownText:
    lines = tuple(x for x in cue.text if x.strip())
    timed = tuple(_INSIDE.search(x) is not None for x in lines)
    return ShownText(cue.line, cue.start, cue.end, lines, tuple(map(_plain, lines)), timed)


def _shared(cue: ShownText, names: SpeakerNames) -> list[tuple[float, float, str]]:
    """Return the lines of a cue, each with its share of the cue's time by its letters without the speaker's
    name; lines with times inside go on from those.
    """
    if any(cue.timed) or len(cue.text) < 2:
        return [(cue.start, cue.end, "\n".join(cue.text))] if cue.text else []
    said = [names.part(x) or ("", x) for x in cue.plain]
    sizes = [len(rest) + 1 if rest.strip() else 0 for _, rest in said]
    if not any(sizes):
        return [(cue.start, cue.end, "\n".join(cue.text))]
    out, at = [], cue.start
    for line, size in zip(cue.text, sizes, strict=True):
        end = at + (cue.end - cue.start) * size / sum(sizes)
        out.append((at, end, line))
        at = end
    return out


def _voices(text: str, names: SpeakerNames) -> Iterator[tuple[str | None, str]]:
    """Yield who says which part; None if it does not say."""
    parts = _VOICE.split(text)
    for n in range(0, len(parts), 2):
        who = html.unescape(parts[n - 1]).strip() if n else None
        said = parts[n]
        if who is None and (named := names.part(_TAG.sub("", said))) is not None:
            who, said = named
        if said.strip() or who is not None:
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
