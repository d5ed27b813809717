"""ELAN annotations (.eaf): tiers of intervals with times in seconds.

Read with Expat rather than pympi-ling, which ends in a KeyError where annotations refer to others that refer
to others, and cannot say in which line a broken file is broken. Nothing is fetched that a file names.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

from metagraph.common.budgets import MARKS, MARKS_FILE, NESTING
from metagraph.common.files import guard_reader, read_file
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.playback.learning.annotation import Annotation, AnnotationInterval, AnnotationTier

LONGEST = 1e7  # seconds, four months
UNITS: Mapping[str, float] = {
    "milliseconds": 1e-3,
    "PAL-frames": 1 / 25,
    "PAL-50-frames": 1 / 50,
    "NTSC-frames": 1001 / 30000,
}
_AGAIN = phrase("Open it in ELAN and save it again.")
_NOT = phrase("Choose a file that ELAN saved (.eaf).")


@dataclass
class _Mark:
    """An annotation while it is being read. slots: its two time slots, or else `of`: the annotation it refers
    to.
    """

    ident: str
    line: int
    slots: tuple[str, str] | None = None
    of: str = ""
    after: str = ""  # the one before it among those that share a parent
    text: str = ""


@dataclass(frozen=True)
class _Medium:
    """url: as the file names it; of: the URL of what it was extracted from. origin: seconds, None if it has
    none.
    """

    name: str
    url: str
    of: str
    origin: float | None


@dataclass
class _Tier:
    name: str
    participant: str
    parent: str
    annotator: str
    marks: list[_Mark] = field(default_factory=list)


class _Reader:
    """Collects what the elements say; times are worked out when all is read."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.parser = expat.ParserCreate()
        self.parser.buffer_text = True
        self.parser.StartElementHandler = self._begin
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._say
        self.parser.EntityDeclHandler = self._entity
        self.slots: dict[str, float | None] = {}  # seconds, in the file's order
        self.tiers: dict[str, _Tier] = {}
        self.marks: dict[str, _Mark] = {}
        self.media: list[_Medium] = []
        self.old_media = ""  # where format 2.0 named it
        self.vocabularies: dict[str, list[str]] = {}
        self.unit = UNITS["milliseconds"]
        self.depth = 0
        self.tier: _Tier | None = None
        self.mark: _Mark | None = None
        self.vocabulary: list[str] | None = None
        self.words: list[str] | None = None

    @property
    def line(self) -> int:
        return self.parser.CurrentLineNumber

    def fail(self, cause: str, line: int | None = None, remedy: str = _AGAIN) -> FileError:
        return FileError(
            self.path, cause, phrase("line {value}", value=self.line if line is None else line), remedy
        )

    def _entity(self, *_: object) -> None:
        raise self.fail(
            phrase("it defines its own XML entities, which no annotation program does"), remedy=_NOT
        )

    def _begin(self, name: str, at: dict[str, str]) -> None:
        self.depth += 1
        if self.depth == 1 and name != "ANNOTATION_DOCUMENT":
            raise self.fail(
                phrase(
                    "its outermost element is '{name}', not 'ANNOTATION_DOCUMENT': this is not an "
                    "ELAN annotation",
                    name=name,
                ),
                remedy=_NOT,
            )
        if self.depth > NESTING:  # ELAN writes 5
            raise self.fail(phrase("its elements are nested more than {most} levels deep", most=NESTING))
        if name == "HEADER":
            unit = at.get("TIME_UNITS", "milliseconds")
            if unit not in UNITS:
                raise self.fail(
                    phrase(
                        "times are in '{unit}', which is none of {names}", unit=unit, names=", ".join(UNITS)
                    )
                )
            self.unit = UNITS[unit]
            self.old_media = at.get("MEDIA_FILE", "")
        elif name == "MEDIA_DESCRIPTOR":
            self._medium(at)
        elif name == "TIME_SLOT":
            self._slot(at)
        elif name == "TIER":
            self._tier(at)
        elif name in ("ALIGNABLE_ANNOTATION", "REF_ANNOTATION"):
            self._mark(name, at)
        elif name == "CONTROLLED_VOCABULARY":
            self.vocabulary = self.vocabularies.setdefault(self._need(at, "CV_ID", name), [])
        elif name == "ANNOTATION_VALUE" or (
            name in ("CV_ENTRY", "CVE_VALUE") and self.vocabulary is not None
        ):
            self.words = []

    def _need(self, at: Mapping[str, str], key: str, element: str) -> str:
        if not at.get(key):
            raise self.fail(phrase("a {element} has no {key}", element=element, key=key))
        return at[key]

    def _medium(self, at: Mapping[str, str]) -> None:
        """Keep a medium and its origin: the time in it, milliseconds, at which the annotation's time is 0."""
        text = at.get("TIME_ORIGIN", "").strip()
        origin = None
        if text:
            try:
                origin = int(text[:40]) / 1000
            except ValueError:
                raise self.fail(
                    phrase("a time origin is '{text}', not a whole number of milliseconds", text=text[:40])
                ) from None
            if not abs(origin) <= LONGEST:
                raise self.fail(
                    phrase(
                        "a time origin of {origin:g} s is not between 0 and {most:g}",
                        origin=origin,
                        most=LONGEST,
                    )
                )
        url = at.get("MEDIA_URL", "")
        self.media.append(
            _Medium(at.get("RELATIVE_MEDIA_URL") or url, url, at.get("EXTRACTED_FROM", ""), origin)
        )

    def _slot(self, at: Mapping[str, str]) -> None:
        ident, text = self._need(at, "TIME_SLOT_ID", "TIME_SLOT"), at.get("TIME_VALUE")
        if len(self.slots) > 2 * MARKS:
            raise self.fail(phrase("it has more than {value:,} time slots", value=2 * MARKS))
        if ident in self.slots:
            raise self.fail(phrase("time slot '{ident}' occurs twice", ident=ident))
        seconds = None
        if text is not None:
            try:
                seconds = int(text[:40]) * self.unit
            except ValueError:
                raise self.fail(
                    phrase("'{text}' is not a whole number of {value}", text=text, value=self._unit_name())
                ) from None
            if not 0 <= seconds <= LONGEST:
                raise self.fail(
                    phrase(
                        "a time of {seconds:g} s is not between 0 and {most:g}",
                        seconds=seconds,
                        most=LONGEST,
                    )
                )
        self.slots[ident] = seconds

    def _unit_name(self) -> str:
        return next(name for name, unit in UNITS.items() if unit == self.unit)

    def _tier(self, at: Mapping[str, str]) -> None:
        name = self._need(at, "TIER_ID", "TIER")
        if name in self.tiers:
            raise self.fail(
                phrase("tier '{name}' occurs twice", name=name),
                remedy=phrase("Rename one of them in ELAN."),
            )
        self.tier = self.tiers[name] = _Tier(
            name,
            at.get("PARTICIPANT", "").strip(),
            at.get("PARENT_REF", ""),
            at.get("ANNOTATOR", "").strip(),
        )

    def _mark(self, name: str, at: Mapping[str, str]) -> None:
        if self.tier is None:
            raise self.fail(phrase("an annotation is outside any tier"))
        ident = self._need(at, "ANNOTATION_ID", name)
        if len(self.marks) >= MARKS:
            raise self.fail(phrase("it has more than {most:,} annotations", most=MARKS))
        if ident in self.marks:
            raise self.fail(phrase("annotation '{ident}' occurs twice", ident=ident))
        if name == "ALIGNABLE_ANNOTATION":
            slots = self._need(at, "TIME_SLOT_REF1", name), self._need(at, "TIME_SLOT_REF2", name)
            unknown = next((s for s in slots if s not in self.slots), None)
            if unknown is not None:
                raise self.fail(
                    phrase(
                        "annotation '{ident}' starts or ends at time slot '{unknown}', which does not exist",
                        ident=ident,
                        unknown=unknown,
                    )
                )
            self.mark = _Mark(ident, self.line, slots)
        else:
            self.mark = _Mark(
                ident,
                self.line,
                None,
                self._need(at, "ANNOTATION_REF", name),
                at.get("PREVIOUS_ANNOTATION", ""),
            )
        self.marks[ident] = self.mark
        self.tier.marks.append(self.mark)

    def _say(self, text: str) -> None:
        if self.words is not None:
            self.words.append(text)

    def _end(self, name: str) -> None:
        self.depth -= 1
        if name == "TIER":
            self.tier = None
        elif name in ("ALIGNABLE_ANNOTATION", "REF_ANNOTATION"):
            self.mark = None
        elif name == "CONTROLLED_VOCABULARY":
            self.vocabulary = None
        elif self.words is not None and name in ("ANNOTATION_VALUE", "CV_ENTRY", "CVE_VALUE"):
            text = "".join(self.words).strip()
            self.words = None
            if name != "ANNOTATION_VALUE":
                if self.vocabulary is not None and text:
                    self.vocabulary.append(text)
            elif self.mark is not None:
                self.mark.text = text


@guard_reader
def read_elan(path: str | Path) -> Annotation:
    """Read an .eaf file (format 2.x or 3.0).

    Annotations without times of their own share their parent's evenly with those beside them; time slots that
    were never aligned are spread evenly between those that were. What lasts no time at all is left out, and
    noted. Raises FileError.
    """
    path = Path(path)
    reader = _Reader(path)
    try:
        # At once: fed in pieces, what never ends is looked at again from its beginning with each of them.
        reader.parser.Parse(read_file(path, MARKS_FILE), True)
    except expat.ExpatError as error:
        empty = path.stat().st_size == 0
        cause = "it is empty" if empty else f"it is not well-formed XML ({expat.errors.messages[error.code]})"
        raise FileError(
            path,
            cause,
            phrase("line {lineno}, column {offset}", lineno=error.lineno, offset=error.offset + 1),
            _NOT if not reader.tiers else _AGAIN,
        ) from None
    except (LookupError, ValueError) as error:  # an encoding nobody knows
        raise FileError(
            path, phrase("its text cannot be decoded ({error})", error=error), phrase("line 1"), _AGAIN
        ) from None
    return _annotation(reader)


def _annotation(reader: _Reader) -> Annotation:
    aligned = _aligned(reader)
    spans: dict[str, tuple[float, float]] = {
        m.ident: (aligned[m.slots[0]], aligned[m.slots[1]])
        for m in reader.marks.values()
        if m.slots is not None
    }
    _refer(reader, spans)
    tiers, lost = [], Counter[str]()
    for tier in reader.tiers.values():
        if tier.parent and tier.parent not in reader.tiers:
            lost[f"tier '{tier.name}' refers to tier '{tier.parent}', which is not there"] += 1
        intervals = []
        for mark in tier.marks:
            start, end = spans[mark.ident]
            if start < end:
                intervals.append(AnnotationInterval(start, end, mark.text))
            else:
                lost[f"tier '{tier.name}'"] += 1
        intervals.sort(key=lambda i: (i.start, i.end))
        tiers.append(
            AnnotationTier(tier.name, tuple(intervals), tier.participant, tier.parent, tier.annotator)
        )
    notes = [
        x
        if "refers" in x
        else f"{x}: {n} annotation{'s' if n > 1 else ''} left out that end before they begin"
        for x, n in lost.items()
    ]
    vocabularies = {name: tuple(dict.fromkeys(words)) for name, words in reader.vocabularies.items()}
    origins = _origins(reader)
    return Annotation(
        tuple(tiers),
        tuple(origins) or ((reader.old_media,) if reader.old_media else ()),
        vocabularies,
        tuple(notes),
        tuple(origins.values()) if any(origins.values()) else (),
    )


def _origins(reader: _Reader) -> dict[str, float]:
    """Return the time origin of each medium, seconds. One that says none has that of the medium it was
    extracted from.
    """
    said = {m.url: m.origin for m in reader.media if m.origin is not None}
    out: dict[str, float] = {}
    for medium in reader.media:
        if medium.name:
            origin = medium.origin if medium.origin is not None else said.get(medium.of, 0.0)
            out.setdefault(medium.name, origin)
    return out


def _aligned(reader: _Reader) -> dict[str, float]:
    """Return the seconds of every time slot. Those never aligned lie evenly along the run of annotations that
    share them.
    """
    out = {ident: seconds for ident, seconds in reader.slots.items() if seconds is not None}
    for tier in reader.tiers.values():
        run: list[str] = []
        for first, second in (mark.slots for mark in tier.marks if mark.slots is not None):
            if run and run[-1] == first:
                run.append(second)
            else:
                run = [first, second]
            if second in out:
                if len(run) > 2 and run[0] in out:
                    for n, ident in enumerate(run[1:-1], 1):
                        out.setdefault(ident, out[run[0]] + (out[second] - out[run[0]]) * n / (len(run) - 1))
                run = []
    if len(out) < len(reader.slots):  # stray ones: evenly between those before and behind them in the file
        _spread(list(reader.slots), out)
    return out


def _spread(order: list[str], known: dict[str, float]) -> None:
    before, waiting = 0.0, list[str]()
    for ident in order:
        if ident not in known:
            waiting.append(ident)
            continue
        for n, one in enumerate(waiting, 1):
            known[one] = before + (max(before, known[ident]) - before) * n / (len(waiting) + 1)
        before, waiting = known[ident], []
    known.update(dict.fromkeys(waiting, before))


def _refer(reader: _Reader, spans: dict[str, tuple[float, float]]) -> None:
    """Work out the spans of annotations that refer to others: those of one tier with one parent share its
    span evenly, in their order.
    """
    waiting: dict[str, list[list[_Mark]]] = {}  # parent -> its children on one tier, on another ...
    for tier in reader.tiers.values():
        siblings: dict[str, list[_Mark]] = {}
        for mark in tier.marks:
            if mark.slots is None:
                if mark.of not in reader.marks:
                    raise reader.fail(
                        phrase(
                            "annotation '{ident}' refers to '{of}', which does not exist",
                            ident=mark.ident,
                            of=mark.of,
                        ),
                        mark.line,
                    )
                siblings.setdefault(mark.of, []).append(mark)
        for parent, marks in siblings.items():
            waiting.setdefault(parent, []).append(marks)
    ready = [parent for parent in waiting if parent in spans]
    while ready:
        parent = ready.pop()
        start, end = spans[parent]
        for marks in waiting.pop(parent):
            for n, mark in enumerate(_ordered(marks)):
                spans[mark.ident] = (
                    start + (end - start) * n / len(marks),
                    start + (end - start) * (n + 1) / len(marks),
                )
            ready += [mark.ident for mark in marks if mark.ident in waiting]
    if waiting:
        mark = next(iter(waiting.values()))[0][0]
        raise reader.fail(
            phrase("annotation '{ident}' refers to itself through '{of}'", ident=mark.ident, of=mark.of),
            mark.line,
        )


def _ordered(marks: Iterable[_Mark]) -> list[_Mark]:
    """Return siblings in the order their `after` says; those it says nothing of as they stand in the file."""
    marks = list(marks)
    known = {m.ident for m in marks}
    following: dict[str, list[_Mark]] = {}
    for mark in marks:
        following.setdefault(mark.after if mark.after in known else "", []).append(mark)
    out: list[_Mark] = []
    stack = list(reversed(following.get("", [])))
    while stack:
        mark = stack.pop()
        out.append(mark)
        stack += reversed(following.get(mark.ident, []))
    seen = {m.ident for m in out}
    return [*out, *(m for m in marks if m.ident not in seen)]
