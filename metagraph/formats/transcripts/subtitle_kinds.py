"""Subtitles besides WebVTT and SubRip: YouTube's SBV, SubStation Alpha (ASS, SSA), song texts (LRC) and TTML,
each from its published description. All become cues.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from xml.etree.ElementTree import Element

from metagraph.common.wording import phrase
from metagraph.formats.transcripts.chat_logs import SPOKEN
from metagraph.formats.transcripts.cues import TextCue, collect_cues
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.words import Collected, Transcript

# --- SBV: two times in a line, the text below, an empty line

_CLOCK = r"(\d{1,4}):(\d{1,2}):(\d{1,2}(?:[.,]\d{1,3})?)"
_SBV = re.compile(rf"\s*{_CLOCK},{_CLOCK}\s*$")


def is_sbv(source: TranscriptSource) -> bool:
    return _SBV.match(source.head.split("\n", 1)[0]) is not None


def read_sbv(source: TranscriptSource) -> Transcript:
    """Read YouTube's SubViewer. Raises FileError."""
    out = Collected(source.path)
    cues: list[TextCue] = []
    for n, line in enumerate(source.text.split("\n"), 1):
        if (found := _SBV.match(line)) is not None:
            cues.append(TextCue(n, _seconds(*found.groups()[:3]), _seconds(*found.groups()[3:]), []))
        elif cues and line.strip():
            cues[-1].text.append(line)
    return collect_cues(out, [_in_order(out, cue) for cue in cues])


def _seconds(hours: str, minutes: str, seconds: str) -> float:
    return int(hours) * 3600 + int(minutes) * 60 + float(seconds.replace(",", "."))


def _in_order(out: Collected, cue: TextCue) -> TextCue:
    """Return a cue as it is. Raises FileError if it ends before it starts."""
    if cue.end < cue.start:
        cause = phrase(
            "a cue ends at {end:g} s, before it starts at {start:g} s", end=cue.end, start=cue.start
        )
        raise out.fail(cause, phrase("line {n}", n=cue.line))
    return cue


# --- SubStation Alpha: a table of events, whose columns its Format line names

_STYLED = re.compile(r"\{[^{}]*\}")


def is_substation(source: TranscriptSource) -> bool:
    return source.head.casefold().startswith("[script info]")


def read_substation(source: TranscriptSource) -> Transcript:
    """Read the lines of dialogue of an ASS or SSA file; a Name is who speaks. Raises FileError."""
    out = Collected(source.path)
    columns: list[str] = []
    cues = []
    events = False
    for n, line in enumerate(source.text.split("\n"), 1):
        key, colon, rest = line.partition(":")
        key = key.strip().casefold()
        if key.startswith("["):
            events = key == "[events]"
        elif events and key == "format" and colon:
            columns = [cell.strip().casefold() for cell in rest.split(",")]
        elif events and key == "dialogue" and columns:
            cells = dict(zip(columns, rest.split(",", len(columns) - 1), strict=False))
            times = [re.fullmatch(_CLOCK, cells.get(name, "").strip()) for name in ("start", "end")]
            if times[0] is None or times[1] is None:
                raise out.fail(phrase("a line of dialogue has no start and end"), phrase("line {n}", n=n))
            text = re.split(r"\\[Nn]", _STYLED.sub("", cells.get("text", "")).replace("\\h", " "))
            who = cells.get("name", cells.get("actor", "")).strip()
            if who:
                text[0] = f"<v {who}>{text[0]}"
            start, end = (_seconds(*found.groups()) for found in times if found is not None)
            cues.append(_in_order(out, TextCue(n, start, end, text)))
    cues.sort(key=lambda cue: cue.start)
    return collect_cues(out, cues)


# --- LRC: [01:02.50] before each line of a song

_LRC = re.compile(r"\[(\d{1,3}):(\d{1,2}(?:[.:]\d{1,3})?)\]")
_LRC_HEAD = re.compile(r"\[[a-zA-Z#]{1,10}:.*\]\s*$")
_LRC_WORD = re.compile(r"<(\d{1,3}):(\d{1,2}(?:[.:]\d{1,3})?)>")


def is_lyrics(source: TranscriptSource) -> bool:
    lines = [x.strip() for x in source.text.split("\n")[:400] if x.strip()]
    timed = [x for x in lines if _LRC.match(x)]
    known = len(timed) + sum(_LRC_HEAD.match(x) is not None for x in lines)
    named = any("]" in x and re.match(r"\S[^:]{0,40}:\s", _LRC.sub("", x).strip()) for x in timed)
    headed = bool(lines) and _LRC_HEAD.match(lines[0]) is not None
    return (
        bool(timed) and known == len(lines) and (headed or source.path.suffix.lower() == ".lrc") and not named
    )


def read_lyrics(source: TranscriptSource) -> Transcript:
    """Read the timed lines of a song; a line lasts until the next begins, at most as long as its letters
    take. Raises FileError.
    """
    out = Collected(source.path)
    rows = sorted(
        (_minutes(*found), n, line)
        for n, line in enumerate(source.text.split("\n"), 1)
        for found in _LRC.findall(line)
    )
    cues = []
    for (start, n, line), (until, _, _) in pairwise([*rows, (float("inf"), 0, "")]):
        text = _LRC.sub("", line).strip()
        words = _LRC_WORD.sub(lambda found: _vtt_time(_minutes(found[1], found[2])), text)
        spoken = start + SPOKEN * (len(_LRC_WORD.sub("", text)) + 1)
        told = [_minutes(a, b) for a, b in _LRC_WORD.findall(text)]
        cues.append(
            TextCue(n, start, max(start, min(until, max([spoken, *(t + 0.3 for t in told)]))), [words])
        )
    out.notes.append(
        phrase("it says only when texts begin; how long they last is estimated from their letters")
    )
    return collect_cues(out, cues)


def _minutes(minutes: str, seconds: str) -> float:
    return int(minutes) * 60 + float(seconds.replace(":", "."))


def _vtt_time(seconds: float) -> str:
    """Return a time as WebVTT has it inside a cue."""
    return f"<{int(seconds // 3600):02d}:{int(seconds % 3600 // 60):02d}:{seconds % 60:06.3f}>"


# --- TTML (DFXP, IMSC): paragraphs with begin, end or dur, in elements that may have some, too


@dataclass(frozen=True)
class _Rates:
    """How a TTML file counts: frames and ticks a second."""

    frames: float
    ticks: float


_TTML_CLOCK = re.compile(r"(\d{2,}):(\d{2}):(\d{2})(?:\.(\d{1,9})|:(\d{1,3})(?:\.\d+)?)?$")
_TTML_OFFSET = re.compile(r"(\d{1,9}(?:\.\d{1,9})?)(h|ms|m|s|f|t)$")


def is_ttml(source: TranscriptSource) -> bool:
    return source.root.rpartition(":")[2] == "tt"


def read_ttml(source: TranscriptSource) -> Transcript:
    """Read paragraphs, and the spans with times in them; an agent's name is who speaks. Raises FileError."""
    out, root = Collected(source.path), source.xml()
    told = {_bare(key): value for key, value in root.attrib.items()}
    frames = _positive(told.get("frameRate"), 30.0)
    above, _, below = told.get("frameRateMultiplier", "").partition(" ")
    frames *= _positive(above, 1.0) / _positive(below, 1.0)
    rates = _Rates(frames, _positive(told.get("tickRate"), 1.0))
    names = {}
    for agent in root.iter():
        if _bare(agent.tag) == "agent":
            named = next((x.text for x in agent.iter() if _bare(x.tag) == "name" and x.text), None)
            ident = next((value for key, value in agent.attrib.items() if _bare(key) == "id"), "")
            names[ident] = (named or ident).strip()
    cues = list(_paragraphs(out, root, 0.0, None, "", rates, names))
    return collect_cues(out, sorted(cues, key=lambda cue: cue.start))


def _bare(name: str) -> str:
    """Return the name of an element or attribute without its namespace's prefix."""
    return name.rpartition(":")[2]


def _positive(text: str | None, otherwise: float) -> float:
    try:
        value = float(text or otherwise)
    except ValueError:
        return otherwise
    return value if 0 < value < 1e9 else otherwise


def _ttml_seconds(out: Collected, text: str, rates: _Rates) -> float:
    if (clock := _TTML_CLOCK.match(text.strip())) is not None:
        hours, minutes, seconds, rest, frames = clock.groups()
        part = float(f"0.{rest}") if rest else int(frames or 0) / rates.frames
        return int(hours) * 3600 + int(minutes) * 60 + int(seconds) + part
    if (offset := _TTML_OFFSET.match(text.strip())) is not None:
        units = {"h": 3600.0, "m": 60.0, "s": 1.0, "ms": 1e-3, "f": 1 / rates.frames, "t": 1 / rates.ticks}
        return float(offset[1]) * units[offset[2]]
    raise out.fail(phrase("a time is '{value}'", value=text[:30]), "")


def _paragraphs(
    out: Collected,
    element: Element,
    begin: float,
    end: float | None,
    who: str,
    rates: _Rates,
    names: Mapping[str, str],
) -> Iterator[TextCue]:
    """Yield the paragraphs in an element that begins and ends at these times."""
    told = {_bare(key): value for key, value in element.attrib.items()}
    start = begin + (_ttml_seconds(out, told["begin"], rates) if "begin" in told else 0.0)
    if "dur" in told:
        until: float | None = start + _ttml_seconds(out, told["dur"], rates)
    else:
        until = begin + _ttml_seconds(out, told["end"], rates) if "end" in told else end
    who = names.get(told.get("agent", "").split(" ")[0], who)
    if _bare(element.tag) != "p":
        for child in element:
            yield from _paragraphs(out, child, start, until, who, rates, names)
        return
    text = _text_of(out, element, start, rates).strip()
    if not text:
        return
    if until is None:
        raise out.fail(phrase("a paragraph has no end"), "p")
    lines = [" ".join(line.split()) for line in text.split("\v")]
    lines[0] = f"<v {who}>{lines[0]}" if who else lines[0]
    yield _in_order(out, TextCue(1, start, until, [line for line in lines if line]))


def _text_of(out: Collected, element: Element, start: float, rates: _Rates) -> str:
    """Return an element's text, its line breaks as \\v, the times of its spans as WebVTT has them."""
    parts = [element.text or ""]
    for child in element:
        name = _bare(child.tag)
        if name == "br":
            parts.append("\v")
        elif name == "span":
            told = {_bare(key): value for key, value in child.attrib.items()}
            at = start + _ttml_seconds(out, told["begin"], rates) if "begin" in told else None
            parts.append(_vtt_time(at) if at is not None else "")
            parts.append(_text_of(out, child, at if at is not None else start, rates))
        parts.append(child.tail or "")
    return "".join(parts)
