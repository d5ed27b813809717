"""When the behaviours of a block of BML play: sync points, references between them, constraints."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from math import isfinite
from typing import Any

import msgspec

from metagraph.graph import requests as a
from metagraph.playback.bml.words import SYNCS, spell_word
from metagraph.playback.bml.xml import Element

LONGEST = 250  # characters of a time


@dataclass
class Behaviour:
    """An element on its way to an ask. times: sync -> what its attribute says. offsets: sync -> seconds after
    the start, None for those of its ask's action. pinned: whether others are timed by its stroke.
    """

    element: Element
    ident: str
    asks: Sequence[Any]
    offsets: dict[str, float] | None
    times: dict[str, str] = field(default_factory=dict)
    known: dict[str, float] = field(default_factory=dict)
    prepare: bool = True
    pinned: bool = False


@dataclass
class BlockTiming:
    """Works out all times of a block that begins at `at` seconds. note: takes an element and what to say of
    it. lengths: gives the sync points of what an ask may get.
    """

    at: float
    note: Callable[[Element, str], None]
    lengths: Callable[[Any], dict[str, float]]
    behaviours: list[Behaviour] = field(default_factory=list)
    named: dict[str, Behaviour] = field(default_factory=dict)
    constraints: list[Element] = field(default_factory=list)
    resolving: set[tuple[int, str]] = field(default_factory=set)

    def add(self, found: Behaviour) -> None:
        """Take a behaviour in. Raises RequestError for a second one of its id."""
        if found.ident and found.ident in self.named:
            raise a.RequestError(
                f"{found.element.place}: there are two behaviours '{found.ident}'; give each an id of its own"
            )
        start = read_reference(found.times.get("start", ""))
        if start is not None and start[0] in ("this", found.ident) and start[1] != "start":
            found.prepare = False  # it begins where its preparation would have ended
            value = found.times.pop("start")
            if start[1] not in found.times and start[2]:
                self.note(found.element, f'start="{value}" is read as "without preparation"')
        self.behaviours.append(found)
        self.named[found.ident] = found

    def asks(self) -> tuple[a.AnyRequest, ...]:
        """Return the asks with their times, in the order of their elements."""
        self._constrain()
        for behaviour in self.behaviours:
            for sync in (*behaviour.times, "start"):
                self._time(behaviour, sync)
        return tuple(ask for behaviour in self.behaviours for ask in self._timed(behaviour))

    def _constrain(self) -> None:
        """Turn synchronisation constraints into times of the behaviours that have none."""
        for e in self.constraints:
            kind = e.name.lower()
            refs = [(x, x.get("ref")) for x in e if x.name.lower() == "sync" and x.get("ref")]
            anchor = e.get("ref")
            if kind == "synchronize" and not anchor and refs:
                spoken = [r for _, r in refs if self._is_speech(r)]
                anchor = (spoken or [r for _, r in refs])[0]
            if kind not in ("synchronize", "after") or not anchor:
                self.note(e, "is left out; of constraints <synchronize> and <after> are kept")
                continue
            base = read_reference(anchor)
            for x, ref in refs:
                found = read_reference(ref)
                if ref == anchor or (found is not None and base is not None and found[:2] == base[:2]):
                    continue
                behaviour = self.named.get(found[0]) if found else None
                if found is None or behaviour is None:
                    raise a.RequestError(
                        f"{x.place}: '{ref}' is no sync point of a behaviour of this block; write it as "
                        "id:stroke"
                    )
                if base is not None:
                    anchor = f"{base[0]}:{base[1]}{base[2] - found[2]:+}"
                behaviour.times.setdefault(found[1], anchor)

    def _is_speech(self, ref: str) -> bool:
        found = read_reference(ref)
        return (
            found is not None
            and found[0] in self.named
            and self.named[found[0]].element.name.lower() == "speech"
        )

    def _time(self, b: Behaviour, sync: str) -> float:
        """Return when a sync point comes, seconds of the performance."""
        if sync in b.known:
            return b.known[sync]
        key = (id(b), sync)
        if key in self.resolving:
            raise a.RequestError(
                f"{b.element.place}: its {sync} waits for itself; give one of these behaviours a time in "
                "seconds"
            )
        self.resolving.add(key)
        if sync in b.times:
            value = self._said(b, sync, b.times[sync])
        elif sync == "start":
            given = next(
                (
                    s
                    for s in ("ready", "strokestart", "stroke", "strokeend", "relax", "end")
                    if s in b.times and not self._own(b, s)
                ),
                None,
            )
            value = self.at if given is None else self._time(b, given) - self._offset(b, given)
        else:
            value = self._time(b, "start") + self._offset(b, sync)
        self.resolving.discard(key)
        b.known[sync] = value = max(0.0, value)
        return value

    def _offset(self, b: Behaviour, sync: str) -> float:
        offsets = b.offsets if b.offsets is not None else self.lengths(b.asks[0])
        if sync not in offsets and sync not in SYNCS:
            known = ", ".join(s for s in offsets if s not in SYNCS)
            raise a.RequestError(
                f"{b.element.place}: it has no sync point '{sync}'"
                + (f"; its marks are {known}" if known else "")
            )
        if not b.prepare:
            return max(0.0, offsets.get(sync, 0.0) - offsets.get("ready", 0.0))
        return offsets.get(sync, offsets.get("end", 0.0) if sync in ("end", "relax", "strokeend") else 0.0)

    def _own(self, b: Behaviour, sync: str) -> bool:
        """Whether a sync point is timed by another of the same behaviour."""
        found = read_reference(b.times.get(sync, ""))
        return found is not None and found[0] in ("this", b.ident)

    def _said(self, b: Behaviour, sync: str, text: str) -> float:
        value = parse_seconds(text)
        if value is not None:
            return self.at + value
        found = read_reference(text)
        if found is None:
            raise a.RequestError(
                f"{b.element.place}: {sync}=\"{text}\" is neither seconds nor 'behaviour:sync+seconds'"
            )
        ident, other, offset = found
        if ident == "bml":
            return self.at + offset
        behaviour = b if ident == "this" else self.named.get(ident) if ident else None
        if behaviour is None:
            known = ", ".join(list(filter(None, self.named))[:8]) or "none"
            raise a.RequestError(
                f"{b.element.place}: {sync}=\"{text}\": there is no behaviour '{ident}' in this block; there "
                f"are {known}"
            )
        if behaviour is not b and other not in ("start", "end"):
            behaviour.pinned = True
        return self._time(behaviour, other) + offset

    def _timed(self, b: Behaviour) -> Iterable[a.AnyRequest]:
        """Yield a behaviour's asks with what its times mean for them."""
        for ask in b.asks:
            changes: dict[str, Any] = {}
            free = {s for s in b.times if not self._own(b, s)}
            has = ask.__struct_fields__
            aimed = "stroke" in has and "stroke" in free
            # A stroke says when; then only a start of its own, or where a gesture without preparation begins,
            # says more.
            if "start" in free or (not b.prepare and "ready" in free) or (free and not aimed):
                changes["at"] = self._time(b, "start")
            if aimed or (b.pinned and "stroke" in has):
                changes["stroke"] = self._time(b, "stroke")
            if "hold" in has and "relax" in b.times and ("strokeend" in b.times or self._own(b, "relax")):
                own = read_reference(b.times["relax"]) if self._own(b, "relax") else None
                length = own[2] if own is not None else self._time(b, "relax") - self._time(b, "strokeend")
                changes["hold"] = max(0.0, length)
            if "duration" in has and "end" in b.times:
                own = read_reference(b.times["end"]) if self._own(b, "end") else None
                if own is not None and own[1] == "start":
                    changes["duration"] = max(0.0, own[2])
                elif own is None and (isinstance(ask, a.Look | a.Say) or "start" in b.times):
                    changes["duration"] = max(0.0, self._time(b, "end") - self._time(b, "start"))
            if not b.prepare:
                if "prepare" in has:
                    changes["prepare"] = False
                else:
                    self.note(b.element, "prepares as its clip does")
            try:
                yield a.make_request(msgspec.to_builtins(msgspec.structs.replace(ask, **changes)))
            except a.RequestError as error:
                raise a.RequestError(f"{b.element.place}: {error}") from None


SECONDS = re.compile(r"([+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?)\s*(s|ms)?")
REFERENCE = re.compile(
    r"([^:]+)(?::([^:]+))?:([^:]+?)\s*([+-]\s*(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?\s*(?:s|ms)?)?"
)


def parse_seconds(text: str) -> float | None:
    found = SECONDS.fullmatch(text.strip()) if len(text) <= LONGEST else None
    if found is None:
        return None
    value = float(found[1]) * (0.001 if found[2] == "ms" else 1.0)
    return value if isfinite(value) else None


def read_reference(text: str) -> tuple[str, str, float] | None:
    """Return behaviour, sync point and seconds after it of a text like `s1:tm1+0.3` or `block:s1:tm1`; None
    of any other.
    """
    found = REFERENCE.fullmatch(text.strip()) if len(text) <= LONGEST else None
    if found is None or parse_seconds(text) is not None:
        return None
    offset = parse_seconds(re.sub(r"\s", "", found[4])) if found[4] else 0.0
    if offset is None:
        return None
    if found[2] is not None:
        return f"{found[1]}:{found[2]}", spell_word(found[3]), offset
    return found[1].strip(), spell_word(found[3]), offset
