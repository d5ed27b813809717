"""Lines of dialogue from files: sounds, each with its text and phones where those lie beside it, and lists of
lines.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import Any

from app.translation import tr
from metagraph.common.budgets import LIST_FILE
from metagraph.common.files import is_file, is_inside, make_unforeseen_error, read_file
from metagraph.errors import FileError
from metagraph.formats.project.paths import make_path_for_project
from metagraph.graph.editing import performances as performance_edits
from metagraph.graph.edits import find_free_name
from metagraph.graph.model import Project
from metagraph.graph.requests import Line

SOUNDS = (".wav", ".flac", ".ogg", ".mp3")
LISTS = (".csv", ".tsv", ".txt")
# Of phones and mouth shapes beside a sound; other endings may be of anything, and count where they are read.
PHONES = (".TextGrid", ".textgrid", ".pgo", ".pg2", ".dat", ".xml", ".tsv", ".json", ".csv")
_SURE = (".textgrid", ".pgo", ".pg2")
LONGEST = 20_000  # characters of a text
MOST = 100_000  # lines of a list


@dataclass(frozen=True)
class Lines:
    """What was read: lines by id, their voices, and what could not be read, in words."""

    lines: Mapping[str, Line]
    voices: Mapping[str, Any]
    notes: tuple[str, ...] = ()


def read_lines(
    paths: Iterable[Path],
    folder: Path | None,
    keep: Callable[[Iterable[Path]], None] = lambda paths: None,
) -> Lines:
    """Read sound files and lists. folder: what paths in the lines are relative to, None for absolute ones.
    keep: told which sounds the user chose by that: those given, and those beside a list that was. One bad
    file spoils no other.
    """
    paths = list(paths)
    lines: dict[str, Line] = {}
    notes: list[str] = []
    for path in paths:
        try:
            if path.suffix.lower() in SOUNDS:
                lines[find_free_name(path.stem, lines)] = _beside(path, folder)
            elif path.suffix.lower() in LISTS:
                for ident, line in _listed(path, folder):
                    lines[find_free_name(ident, lines)] = line
            else:
                raise FileError(
                    path,
                    tr("is neither a sound nor a list of lines"),
                    remedy=tr("Choose a sound ({names}) or a list (.csv, .tsv).", names=", ".join(SOUNDS)),
                )
        except Exception as error:  # one bad file spoils no other
            notes.append(str(make_unforeseen_error(path, error)))
    voices: dict[str, Any] = {}
    from metagraph.speech.lines import load_voices

    read, told = load_voices(Project(lines=lines), folder or Path())
    voices.update(read.voices)
    sounds = [(folder or Path()) / line.audio for line in lines.values() if line.audio]
    keep([s for s in sounds if any(is_inside(s, p.parent) for p in paths)])
    # A sound that cannot be read is no line; its text, if it has any, still is.
    for ident, line in list(lines.items()):
        if line.audio and ident not in voices:
            if line.text:
                lines[ident] = Line(text=line.text)
            else:
                del lines[ident]
    return Lines(lines, voices, (*notes, *told))


def _beside(path: Path, folder: Path | None) -> Line:
    """Return a sound's line, with the text and phones of files called like it."""
    text = path.with_suffix(".txt")
    words = " ".join(_text(text).split())[:LONGEST] if is_file(text) else path.stem.replace("_", " ")
    phones = next((p for s in PHONES if is_file(p := path.with_suffix(s)) and _holds_shapes(p)), None)
    return Line(
        text=words,
        audio=make_path_for_project(path, folder),
        phones=make_path_for_project(phones, folder) if phones else None,
    )


def _holds_shapes(path: Path) -> bool:
    """Return whether a file beside a sound says what the mouth does."""
    if path.suffix.lower() in _SURE:
        return True
    from metagraph.speech.mouth_files.registry import read_mouth_file

    try:
        read_mouth_file(path)
    except FileError:
        return False
    return True


def _text(path: Path) -> str:
    data = read_file(path, LIST_FILE)
    for encoding in ("utf-8-sig", "utf-16" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8", "latin-1"):
        try:
            return data.decode(encoding)
        except UnicodeDecodeError:
            continue
    return ""


def _listed(path: Path, folder: Path | None) -> list[tuple[str, Line]]:
    """Return the lines of a list: id and text, and perhaps a sound file; apart by commas, semicolons or tabs.
    A head is passed over.
    """
    text = _text(path)
    first = text.split("\n", 1)[0]
    apart = "\t" if "\t" in first else ";" if first.count(";") > first.count(",") else ","
    out: list[tuple[str, Line]] = []
    try:
        reader = csv.reader(io.StringIO(text.replace("\0", "")), delimiter=apart)
        rows = list(islice(reader, MOST + 1))
    except csv.Error as error:
        raise FileError(
            path,
            tr("cannot be read as a list of lines: {error}", error=error),
            remedy=tr("Write one line in each row: id, text, and optionally a sound file."),
        ) from None
    if len(rows) > MOST:
        raise FileError(
            path,
            tr("has more than {count:,} rows", count=MOST),
            remedy=tr("A list can have up to {count:,} lines. Split the file.", count=MOST),
        )
    for n, row in enumerate(rows):
        cells = [c.strip() for c in row]
        if not any(cells) or (n == 0 and cells[0].lower() in ("id", "line", "number", "nr", "no")):
            continue
        if len(cells) < 2 or not cells[0]:
            raise FileError(
                path,
                tr("has no id or no text"),
                tr("row {number}", number=n + 1),
                tr("Write one line in each row: id, text, and optionally a sound file."),
            )
        audio = path.parent / cells[2] if len(cells) > 2 and cells[2] else None
        if audio is not None and not is_file(audio):
            raise FileError(
                path,
                tr("names a sound file that is missing: {name}", name=cells[2]),
                tr("row {number}", number=n + 1),
                tr("Put the sound beside the list, or correct its name."),
            )
        out.append(
            (
                cells[0][:200],
                Line(text=cells[1][:LONGEST], audio=make_path_for_project(audio, folder) if audio else None),
            )
        )
    return out


def add_lines(project: Project, read: Lines) -> Project:
    """Return the project with lines added; one of an id that is there already replaces it, but keeps its
    asks.
    """
    for ident, line in read.lines.items():
        before = project.lines.get(ident)
        if before is not None and before.asks:
            line = type(line)(
                **{f: getattr(line, f) for f in line.__struct_fields__ if f != "asks"}, asks=before.asks
            )
        project = performance_edits.set_line(project, ident, line)
    return replace(project, voices={**project.voices, **read.voices})
