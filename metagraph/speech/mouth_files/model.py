"""What a file says of the mouth, and what readers of such files share: units of time, and names of shapes."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import MARKS
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.playback.life.line_timing import AZURE, OCULUS, POLLY, WEAK
from metagraph.playback.life.mouth import MouthPiece
from metagraph.speech.phones import drop_tones, find_visemes, is_arpabet

Array = NDArray[Any]
LONGEST = 3600.0  # seconds of a line
LAST = 0.2  # seconds a last shape stays that has no end
# Rhubarb's shapes, by the sounds for which its manual says they are.
RHUBARB = {"A": "PP", "B": "SS", "C": "E", "D": "aa", "E": "O", "F": "U", "G": "FF", "H": "nn", "X": "sil"}
# Preston Blair's shapes, by the letters that name them; "etc" is of the consonants that are left.
PRESTON_BLAIR = {
    "AI": "aa", "E": "E", "O": "O", "U": "U", "etc": "SS", "L": "nn", "WQ": "U", "MBP": "PP", "FV": "FF",
    "rest": "sil",
}  # fmt: skip
SHAPE_SETS = {
    "Rhubarb": RHUBARB,
    "Preston Blair": PRESTON_BLAIR,
    "Oculus": OCULUS,
    "Polly": POLLY,
    "Azure": AZURE,
}
REMEDY_MOUTH = phrase("Export it again, or choose another file of mouth shapes or phones.")


@dataclass(frozen=True, eq=False)
class MouthShapes:
    """pieces: shapes in time, in order. times `[K]`, weights `[K, 15]`: instead, how much of each of
    `VISEMES`
    shows, where a file says that for each frame. end: seconds. notes: what was inferred or left out.
    """

    pieces: tuple[MouthPiece, ...] = ()
    times: Array | None = None
    weights: Array | None = None
    end: float = 0.0
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class MouthFile:
    """A file that says what the mouth does. text: its content. sound: how long the line's sound is, seconds;
    None if nobody knows.
    """

    path: Path
    text: str
    sound: float | None = None

    @cached_property
    def head(self) -> str:
        return self.text.lstrip("\ufeff \t\n")[:4000]

    @cached_property
    def data(self) -> Any:
        """What it holds as JSON, of several lines the list of them; None if it is no JSON."""
        if not self.head.startswith(("{", "[")):
            return None
        try:
            return json.loads(self.text)
        except (RecursionError, ValueError):
            pass
        try:
            lines = [line for line in self.text.split("\n") if line.strip()]
            return [json.loads(line) for line in lines[:MARKS]]
        except (RecursionError, ValueError):
            return None

    def fail(self, cause: str, where: str = "") -> FileError:
        return FileError(self.path, cause, where, REMEDY_MOUTH)


@dataclass
class MouthCues:
    """Names of shapes or phones with their times, as they are collected. unit: seconds of one of the
    file's units of time.
    """

    file: MouthFile
    rows: list[tuple[float, float | None, str]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    unit: float = 1.0

    def add(self, start: Any, end: Any, label: Any, where: str) -> None:
        """Add a cue; end None for until the next. Raises FileError."""
        times = []
        for value in (start, end):
            number = None if value is None else parse_mouth_number(value)
            if value is not None and (number is None or not abs(number) < 1e15):
                raise self.file.fail(phrase("a time is '{value}'", value=str(value)[:30]), where)
            times.append(number)
        if times[0] is None:
            raise self.file.fail(phrase("has no time"), where)
        if not isinstance(label, str | int) or isinstance(label, bool):
            raise self.file.fail(phrase("has no name of a shape"), where)
        if len(self.rows) >= MARKS:
            raise self.file.fail(phrase("has more than {most:,} shapes", most=MARKS), where)
        self.rows.append((times[0], times[1], str(label).strip()))

    def choose_unit(self, units: Sequence[tuple[float, str]], plain: float) -> None:
        """Settle the unit: the first at which all fits into the sound and fills a twentieth of it; `plain`
        without the sound. units: seconds, and how they are called.
        """
        last = max((e if e is not None else s for s, e, _ in self.rows), default=0.0)
        sound = self.file.sound
        fitting = [unit for unit, _ in units if sound and 0.05 * sound <= last * unit <= 1.05 * sound + 0.5]
        self.unit = plain if not fitting or plain in fitting else fitting[0]
        name = next(name for unit, name in units if unit == self.unit)
        if len(units) > 1 and self.unit != 1.0:
            self.notes.append(phrase("its times are read as {name}", name=name))

    def finished(self, shapes: Callable[[str], tuple[list[str], float]] | None = None) -> MouthShapes:
        """Return the pieces. shapes: what a label shows and how fully; None for the set that all labels are
        of. Raises FileError.
        """
        if not self.rows:
            raise self.file.fail(phrase("it has no mouth shapes"))
        rows = sorted(self.rows, key=lambda r: r[0])
        of = shapes if shapes is not None else self._shapes([label for *_, label in rows])
        out: list[MouthPiece] = []
        last = 0.0
        for n, (start, end, label) in enumerate(rows):
            begin = start * self.unit
            following = next((r[0] * self.unit for r in rows[n + 1 : n + 2]), None)
            until = (
                end * self.unit if end is not None else following if following is not None else begin + LAST
            )
            if following is not None:
                until = min(until, following)
            if not -1.0 <= begin <= LONGEST or not until <= LONGEST:
                raise self.file.fail(
                    phrase(
                        "a shape is at {begin:.3g} s, not from 0 to {most:.0f} s", begin=begin, most=LONGEST
                    ),
                    phrase("shape {number}", number=n + 1),
                )
            names, strength = of(label)
            begin = max(begin, 0.0)
            last = max(last, until)
            if until <= begin:
                continue
            each = (until - begin) / max(1, len(names))
            for m, name in enumerate(names):
                if name != "sil":
                    out.append(MouthPiece(begin + m * each, begin + (m + 1) * each, name, strength))
        return MouthShapes(tuple(out), end=last, notes=tuple(self.notes))

    def _shapes(self, labels: Sequence[str]) -> Callable[[str], tuple[list[str], float]]:
        """Return what labels show, by the first set that has all of them, else as phones. Raises
        FileError.
        """
        given = {label for label in labels if label}
        for name, table in SHAPE_SETS.items():
            if given <= set(table):
                self.notes.append(phrase("its shapes are read as those of {name}", name=name))
                return lambda label: ([table.get(label, "sil")], WEAK.get(label, 1.0))
        bare = {label: re.sub(r"_[BIES]$", "", label) for label in given}
        arpabet = is_arpabet(bare.values())
        toneless = drop_tones(bare.values())
        bare = {label: toneless[one] for label, one in bare.items()}
        silent = sum(not find_visemes(one, arpabet)[0] for one in bare.values())
        if 2 * silent > len(given) + 2 or any(len(one) > 12 or one.isdigit() for one in given):
            known = ", ".join(SHAPE_SETS)
            raise self.file.fail(
                phrase(
                    "'{label}' is neither a phone nor a mouth shape of {known}",
                    label=sorted(given)[0][:30],
                    known=known,
                )
            )
        kind = phrase("ARPAbet") if arpabet else phrase("IPA or SAMPA")
        self.notes.append(phrase("its labels are read as phones ({kind})", kind=kind))
        return lambda label: find_visemes(bare.get(label, label), arpabet)


def parse_mouth_number(value: Any) -> float | None:
    """Return a finite number, also one that is written as text; None for anything else."""
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        return None
    try:
        number = float(value)
    except (ValueError, OverflowError):
        return None
    return number if np.isfinite(number) else None
