"""Conversations written for ELAN and Praat, and as JSON: for each side its words, its segments and their
peaks.

What is written here, `transcripts.read_transcript` reads back whole.
"""

from __future__ import annotations

import io
import os
from collections import Counter
from collections.abc import Sequence
from datetime import UTC, datetime
from itertools import zip_longest
from pathlib import Path
from urllib.parse import quote

import msgspec

from metagraph.common.xml_text import clean_xml_text, escape, quote_xml
from metagraph.formats.atomic import write_atomically
from metagraph.formats.transcripts.words import TO_ALL
from metagraph.graph.conversation.model import EVERYBODY, Conversation, Side

_PEAK = 0.02  # seconds a peak lasts where points are not known
_MEDIA = {".wav": "audio/x-wav", ".mp3": "audio/mpeg", ".flac": "audio/flac", ".ogg": "audio/ogg"}
Row = tuple[float, float, str]  # start, end (seconds), text


def write_elan(conversation: Conversation, path: str | Path, folder: Path | None = None) -> None:
    """Write an ELAN annotation (.eaf, format 3.0), times in milliseconds. folder: what the sides' sounds are
    relative to, None if they are absolute. Raises FileError.
    """
    path = Path(path)
    out = io.StringIO()
    date = datetime.now(UTC).isoformat(timespec="seconds")
    out.write('<?xml version="1.0" encoding="UTF-8"?>\n')
    out.write(
        f'<ANNOTATION_DOCUMENT AUTHOR="" DATE="{date}" FORMAT="3.0" VERSION="3.0" '
        'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
        'xsi:noNamespaceSchemaLocation="http://www.mpi.nl/tools/elan/EAFv3.0.xsd">\n'
        '    <HEADER MEDIA_FILE="" TIME_UNITS="milliseconds">\n'
    )
    for sound in dict.fromkeys(s.audio for s in conversation.sides if s.audio):
        place = Path(sound) if folder is None else folder / sound
        kind = _MEDIA.get(place.suffix.lower(), "audio/x-wav")
        near = _near(place, path.parent)
        beside = f" RELATIVE_MEDIA_URL={quote_xml(near)}" if near else ""
        out.write(
            f'        <MEDIA_DESCRIPTOR MEDIA_URL={quote_xml(_url(place))} MIME_TYPE="{kind}"{beside}/>\n'
        )
    tiers = [
        (f"{what}@{name}", name, _in_milliseconds(rows)) for name, what, rows in _tiers(conversation, _PEAK)
    ]
    # Each end has a slot of its own, as ELAN gives them: shared ones would move together there.
    moments = sorted(
        (t, n, m, end)
        for n, (_, _, rows) in enumerate(tiers)
        for m, row in enumerate(rows)
        for end, t in enumerate(row[:2])
    )
    slot = {(n, m, end): f"ts{k}" for k, (_, n, m, end) in enumerate(moments, 1)}
    count = sum(len(rows) for _, _, rows in tiers)
    out.write(
        f'        <PROPERTY NAME="lastUsedAnnotationId">{count}</PROPERTY>\n    </HEADER>\n    <TIME_ORDER>\n'
    )
    out.writelines(
        f'        <TIME_SLOT TIME_SLOT_ID="{ident}" TIME_VALUE="{t}"/>\n'
        for (t, *_), ident in zip(moments, slot.values(), strict=True)
    )
    out.write("    </TIME_ORDER>\n")
    number = 0
    for n, (ident, whose, rows) in enumerate(tiers):
        at = f'LINGUISTIC_TYPE_REF="speech" PARTICIPANT={quote_xml(whose)} TIER_ID={quote_xml(ident)}'
        out.write(f"    <TIER {at}>\n")
        for m, (_, _, text) in enumerate(rows):
            number += 1
            out.write(
                f'        <ANNOTATION>\n            <ALIGNABLE_ANNOTATION ANNOTATION_ID="a{number}" '
                f'TIME_SLOT_REF1="{slot[n, m, 0]}" '
                f'TIME_SLOT_REF2="{slot[n, m, 1]}">\n                '
                f"<ANNOTATION_VALUE>{escape(text, quote=False)}</ANNOTATION_VALUE>\n"
                "            </ALIGNABLE_ANNOTATION>\n        </ANNOTATION>\n"
            )
        out.write("    </TIER>\n")
    out.write(
        '    <LINGUISTIC_TYPE GRAPHIC_REFERENCES="false" LINGUISTIC_TYPE_ID="speech" '
        'TIME_ALIGNABLE="true"/>\n'
    )
    out.write("</ANNOTATION_DOCUMENT>\n")
    write_atomically(path, out.getvalue().encode())


def write_textgrid(conversation: Conversation, path: str | Path) -> None:
    """Write a Praat TextGrid (long text format, UTF-8): peaks are points. Raises FileError."""
    length = max(conversation.length, *(_last(s) for s in conversation.sides))
    out = [
        'File type = "ooTextFile"',
        'Object class = "TextGrid"',
        "",
        "xmin = 0",
        f"xmax = {length!r}",
        "tiers? <exists>",
    ]
    tiers = _tiers(conversation, 0.0)
    out += [f"size = {len(tiers)}", "item []:"]
    for n, (name, what, rows) in enumerate(tiers, 1):
        points = what == "peaks"
        filled = rows if points else _filled(rows, length)
        kind = "TextTier" if points else "IntervalTier"
        out += [
            f"    item [{n}]:",
            f'        class = "{kind}"',
            f"        name = {_quoted(f'{name} - {what}')}",
        ]
        out += [
            "        xmin = 0",
            f"        xmax = {length!r}",
            f"        {'points' if points else 'intervals'}: size = {len(filled)}",
        ]
        for m, (start, end, text) in enumerate(filled, 1):
            out.append(f"        {'points' if points else 'intervals'} [{m}]:")
            if points:
                out += [f"            number = {start!r}", f"            mark = {_quoted(text)}"]
            else:
                out += [
                    f"            xmin = {start!r}",
                    f"            xmax = {end!r}",
                    f"            text = {_quoted(text)}",
                ]
    write_atomically(Path(path), ("\n".join(out) + "\n").encode())


def write_json(conversation: Conversation, path: str | Path) -> None:
    """Write a conversation as JSON, with the fields it has in a project. Raises FileError."""
    write_atomically(Path(path), msgspec.json.format(msgspec.json.encode(conversation), indent=1) + b"\n")


def _tiers(conversation: Conversation, peak: float) -> list[tuple[str, str, list[Row]]]:
    """Return name, what it holds and rows by start, none overlapping, of each tier. peak: seconds a peak
    lasts.
    """
    out: list[tuple[str, str, list[Row]]] = []
    names = _names(conversation.sides)
    whom: dict[int | None, str] = {None: "", EVERYBODY: f" to {TO_ALL}"}
    whom |= {n: f" to {name}" for n, name in enumerate(names)}
    for name, side in zip(names, conversation.sides, strict=True):
        out.append((name, "words", _apart([(w.start, w.end, w.text) for w in side.words])))
        kinds = [f"{s.kind}{whom[s.to]}" for s in side.segments]
        rows = [
            (s.start, s.end, f"{kind}: {s.text}" if s.text else kind)
            for s, kind in zip(side.segments, kinds, strict=True)
        ]
        out.append((name, "segments", rows))
        peaks = [s.peak for s in side.segments if s.kind == "clause" and s.peak is not None]
        out.append(
            (
                name,
                "peaks",
                _apart([(p, p + peak, "peak") for p in peaks]) if peak else [(p, p, "peak") for p in peaks],
            )
        )
    return out


def _names(sides: Sequence[Side]) -> tuple[str, ...]:
    """Return what sides are called, no two alike."""
    names = [" ".join(s.name.split()) or f"Speaker {n}" for n, s in enumerate(sides, 1)]
    often = Counter(name.casefold() for name in names)
    return tuple(f"{x} {n}" if often[x.casefold()] > 1 else x for n, x in enumerate(names, 1))


def _apart(rows: Sequence[Row]) -> list[Row]:
    """Return rows by start, each ending where the next begins at the latest; those left without length go."""
    ordered = sorted(rows)
    out = [
        (a, min(b, after[0]) if after else b, text)
        for (a, b, text), after in zip_longest(ordered, ordered[1:])
    ]
    return [r for r in out if r[0] < r[1]]


def _in_milliseconds(rows: Sequence[Row]) -> list[tuple[int, int, str]]:
    out = [(round(1000 * a), round(1000 * b), text) for a, b, text in rows]
    return [(a, b, text) for a, b, text in out if a < b]


def _last(side: Side) -> float:
    return max([0.0, *(w.end for w in side.words), *(s.end for s in side.segments)])


def _filled(rows: Sequence[Row], length: float) -> list[Row]:
    """Return rows with empty ones between, from 0 to the length."""
    out: list[Row] = []
    at = 0.0
    for start, end, text in rows:
        if start > at:
            out.append((at, start, ""))
        out.append((start, end, text))
        at = end
    return [*out, (at, length, "")] if at < length or not out else out


def _quoted(text: str) -> str:
    return '"' + " ".join(clean_xml_text(text).split()).replace('"', '""') + '"'


def _url(place: Path) -> str:
    return "file://" + quote(
        ("" if place.resolve().as_posix().startswith("/") else "/") + place.resolve().as_posix()
    )


def _near(place: Path, folder: Path) -> str:
    try:
        return "./" + Path(os.path.relpath(place.resolve(), folder.resolve())).as_posix()
    except ValueError:  # another drive
        return ""
